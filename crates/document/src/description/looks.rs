//! `[[look]]`: another camera, exposure or light of the same objects, by a name.

use serde::Serialize;

use super::keyed::keyed;
use super::ranges::{Check, Numbers};
use super::table::{Read, Table, Value};
use super::{Camera, Description, Environment, Light, Studio};
use crate::error::Error;
use crate::schema::look;

/// `[[look]]`: tables in the place of those of the scene. What it leaves out is as in the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Look {
    /// Name of the look; no two are equal. Required.
    pub name: String,
    /// In the place of `[camera]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<Camera>,
    /// In the place of the camera's exposure.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exposure_ev: Option<f64>,
    /// In the place of `[environment]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<Environment>,
    /// In the place of `[studio]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub studio: Option<Studio>,
    /// In the place of the `[[light]]`s.
    #[serde(rename = "light", skip_serializing_if = "Vec::is_empty")]
    pub lights: Vec<Light>,
}

impl Look {
    /// The camera and the light of a scene.
    pub fn of(name: String, description: &Description) -> Self {
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
            true => error.below(&format!("look[{index}]")),
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

// Their own numbers are checked by their own keys.
impl Numbers for Camera {}
impl Numbers for Environment {}
impl Numbers for Studio {}
impl Numbers for Light {}

keyed! { Look of look::LOOK {
    name: look::NAME,
    camera: look::CAMERA,
    exposure_ev: look::EXPOSURE_EV,
    environment: look::ENVIRONMENT,
    studio: look::STUDIO,
    lights: look::LIGHT,
} }
