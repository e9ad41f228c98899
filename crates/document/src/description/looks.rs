//! `[[look]]`: another camera, exposure or light of the same objects, by a name.

use hairline_keys::Keyed;

use super::{Camera, Description, Environment, Light, Studio};
use crate::error::Error;

/// `[[look]]`: tables in the place of those of the scene. What it leaves out is as in the scene.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table)]
pub struct Look {
    /// What the viewer's strip and the file of its picture call it by.
    #[key(range_words("not empty, no two equal"))]
    pub name: String,
    /// In the place of `[camera]`, all of it.
    #[key(words("the scene's").range_words("the keys of [`[camera]`](#camera)"))]
    pub camera: Option<Camera>,
    /// In the place of the camera's exposure.
    #[key(unit("stops").words("the camera's").in_range(-64.0, 64.0)
        .control("Exposure", linear(-8.0, 8.0), "Each step doubles or halves the brightness of this look."))]
    pub exposure_ev: Option<f64>,
    /// In the place of `[environment]`.
    #[key(words(LIGHT_WORDS).range_words("the keys of [`[environment]`](#environment)"))]
    pub environment: Option<Environment>,
    /// In the place of `[studio]`.
    #[key(words(LIGHT_WORDS).range_words("the keys of [`[studio]`](#studio)"))]
    pub studio: Option<Studio>,
    /// In the place of all `[[light]]`s.
    #[key("light": words(LIGHT_WORDS).range_words("the keys of [`[[light]]`](#light)"))]
    pub lights: Vec<Light>,
}

/// Where light comes from that a look leaves out.
const LIGHT_WORDS: &str = "none; the scene's, where the look has no light at all";

impl Look {
    /// The camera and the light of a scene.
    pub fn from_description(name: String, description: &Description) -> Self {
        let has_lights = description.is_lit();
        let studio = &description.studio;
        Self {
            name,
            camera: Some(description.camera.clone()),
            exposure_ev: None,
            environment: description.environment.clone(),
            // A look without any light of its own has the scene's.
            studio: (!has_lights || *studio != Studio::NONE).then(|| studio.clone()),
            lights: description.lights.clone(),
        }
    }

    /// Whether it has light of its own: then it has none of the scene's.
    pub fn has_light(&self) -> bool {
        self.environment.is_some() || self.studio.is_some() || !self.lights.is_empty()
    }

    /// Whether it leaves nothing of camera and light to the scene.
    pub fn is_whole(&self) -> bool {
        self.camera.is_some() && self.has_light()
    }

    /// Takes what it leaves out from a whole look.
    pub fn complete(&mut self, whole: &Self) {
        if self.camera.is_none() {
            self.camera.clone_from(&whole.camera);
        }
        if !self.has_light() {
            self.environment.clone_from(&whole.environment);
            self.studio.clone_from(&whole.studio);
            self.lights.clone_from(&whole.lights);
        }
    }

    /// An error of a scene that has this look, the look of this number: what the look gives has its keys.
    #[must_use]
    pub fn own_error(&self, index: usize, error: Error) -> Error {
        let is_own = match error.key().split(['.', '[']).next() {
            Some("camera") => self.camera.is_some(),
            Some("environment" | "studio" | "light") => self.has_light(),
            _ => false,
        };
        match is_own {
            true => error.in_table(&format!("look[{index}]")),
            false => error,
        }
    }

    /// Gives a scene this look.
    pub fn apply(&self, description: &mut Description) {
        if let Some(camera) = &self.camera {
            description.camera = camera.clone();
        }
        if let Some(exposure_ev) = self.exposure_ev {
            description.camera.exposure_ev = exposure_ev;
        }
        if self.has_light() {
            description.environment = self.environment.clone();
            description.studio = self.studio.clone().unwrap_or(Studio::NONE);
            description.lights.clone_from(&self.lights);
        }
    }
}
