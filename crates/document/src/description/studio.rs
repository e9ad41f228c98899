//! The studio around a scene's objects and the ground under them, which a scene file selects by name.

use serde::Serialize;

use super::Description;
use super::keyed::keyed;
use super::ranges::Check;
use super::table::{Read, Table, Value};
use super::values::{is_false, is_zero};
use crate::error::Error;
use crate::schema::{ground, studio};

/// `[studio]`: soft boxes, a lamp and a dim room about the camera's subject. Scene files without `[[light]]` and `[environment]` have one
/// that they do not name, with a ground.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Studio {
    /// Lights nothing, as if it were not there.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// Factor on its radiances.
    #[serde(skip_serializing_if = "is_one")]
    pub intensity: f64,
    /// Turns it about the world's up axis.
    #[serde(skip_serializing_if = "is_zero")]
    pub rotation_deg: f64,
}

impl Studio {
    /// A scene without a studio.
    pub const NONE: Self = Self {
        hidden: true,
        intensity: 1.0,
        rotation_deg: 0.0,
    };

    pub(super) fn is_none(&self) -> bool {
        *self == Self::NONE
    }
}

/// `[ground]`: a wide floor under all objects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ground {
    /// Whether the ground is left out.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// Albedo, linear Rec.709, in [0, 1].
    #[serde(skip_serializing_if = "is_dark_grey")]
    pub color: [f64; 3],
    /// Roughness of the ground's gloss, as that of a material.
    #[serde(skip_serializing_if = "is_satin")]
    pub roughness: f64,
    /// Height along the world's up axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
    /// Whether it is seen by the shadows on it alone.
    #[serde(skip_serializing_if = "is_false")]
    pub shadows_only: bool,
}

impl Description {
    /// Whether the scene has a light or an environment of its own, hidden or not.
    pub(super) fn is_lit(&self) -> bool {
        self.environment.is_some() || !self.lights.is_empty()
    }
}

fn is_one(intensity: &f64) -> bool {
    *intensity == studio::INTENSITY.initial::<f64>()
}

fn is_dark_grey(color: &[f64; 3]) -> bool {
    *color == ground::COLOR.initial::<[f64; 3]>()
}

fn is_satin(roughness: &f64) -> bool {
    *roughness == ground::ROUGHNESS.initial::<f64>()
}

keyed! { Studio: Default of studio::STUDIO {
    hidden: studio::HIDDEN,
    intensity: studio::INTENSITY,
    rotation_deg: studio::ROTATION_DEG,
} }

keyed! { Ground: Default of ground::GROUND {
    hidden: ground::HIDDEN,
    color: ground::COLOR,
    roughness: ground::ROUGHNESS,
    height_m: ground::HEIGHT_M,
    shadows_only: ground::SHADOWS_ONLY,
} }
