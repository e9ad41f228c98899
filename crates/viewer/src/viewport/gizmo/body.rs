//! Body that handles belong to.

use glam::DVec3;
use hairline_document::Description;
use hairline_document::description::{Light, LightKind};
use hairline_document::place_light;
use hairline_editor::Selection;

use super::cone::LightCone;

/// A light or an object, as far as handles are concerned.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Body {
    /// Noun in the names of handles.
    pub noun: &'static str,
    /// Middle, which it moves with and turns about.
    pub center_m: DVec3,
    /// Whether it has a place.
    pub moves: bool,
    /// Whether it has a direction.
    pub turns: bool,
    /// Whether it has one size.
    pub resizes: bool,
    /// Corners of a polygon.
    pub corners_m: Vec<DVec3>,
    /// The polygon's, unit.
    pub normal: Option<DVec3>,
    /// Cone of a light that has one.
    pub spot: Option<LightCone>,
}

impl Body {
    /// Body of the selection; none where that has no place, or is hidden.
    pub fn from_selection(description: &Description, selection: Selection) -> Option<Self> {
        match selection {
            Selection::Light(i) => {
                let light = description.lights.get(i).filter(|light| !light.hidden)?;
                Some(Self::of_light(light, description))
            }
            Selection::Object(i) => {
                let object = description.objects.get(i).filter(|it| !it.hidden)?;
                Some(Self {
                    noun: "object",
                    center_m: object.translation_m.into(),
                    moves: true,
                    turns: true,
                    ..Self::default()
                })
            }
            _ => None,
        }
    }

    fn of_light(light: &Light, description: &Description) -> Self {
        if light.kind.sunbeam().is_some() {
            // A sun has no place: its rings lie about the camera's target.
            return Self {
                noun: "light",
                center_m: description.camera.target_m.into(),
                turns: true,
                ..Self::default()
            };
        }
        Self {
            noun: "light",
            center_m: place_light::center(light),
            moves: true,
            turns: !matches!(light.kind, LightKind::Sphere { .. }) || light.cone.is_some(),
            resizes: true,
            normal: light.kind.axis(),
            corners_m: light.kind.vertices_m().iter().map(|&v| v.into()).collect(),
            spot: LightCone::from_light(light),
        }
    }
}
