//! The studio around a scene's objects and the ground under them, which a scene file selects by name.

use serde::Serialize;

use super::ranges::{Check, components, finite, not_negative, within};
use super::table::{Read, Table, Value};
use super::values::{is_false, is_zero};
use super::{Description, limits};
use crate::error::Error;

/// `[studio]`: soft boxes, a lamp and a dim room about the camera's subject. Scene files without `[[light]]` and `[environment]` have one
/// that they do not name, with a ground.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Studio {
    /// Lights nothing, as if it were not there. Default: false.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// Factor on its radiances. Default: 1.
    #[serde(skip_serializing_if = "is_one")]
    pub intensity: f64,
    /// Turns it about the world's up axis. Default: 0, as it suits the camera.
    #[serde(skip_serializing_if = "is_zero")]
    pub rotation_deg: f64,
}

impl Default for Studio {
    fn default() -> Self {
        Self {
            hidden: false,
            intensity: 1.0,
            rotation_deg: 0.0,
        }
    }
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

    pub(super) fn check(&self) -> Check {
        not_negative("studio.intensity", self.intensity)?;
        finite("studio.rotation_deg", self.rotation_deg)
    }
}

/// `[ground]`: a wide floor under all objects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ground {
    /// Whether the ground is left out. Default: false.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// Albedo, linear Rec.709, in [0, 1]. Default: a dark grey.
    #[serde(skip_serializing_if = "is_dark_grey")]
    pub color: [f64; 3],
    /// Roughness of the ground's gloss, as that of a material. Default: 0.55.
    #[serde(skip_serializing_if = "is_satin")]
    pub roughness: f64,
    /// Height along the world's up axis. Default: under the lowest point of all objects.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
}

const DARK_GREY: [f64; 3] = [0.1, 0.1, 0.105];
const SATIN: f64 = 0.55;

impl Default for Ground {
    fn default() -> Self {
        Self {
            hidden: false,
            color: DARK_GREY,
            roughness: SATIN,
            height_m: None,
        }
    }
}

impl Ground {
    pub(super) fn check(&self) -> Check {
        components("ground.color", self.color, limits::BASE_COLOR)?;
        within("ground.roughness", self.roughness, limits::ROUGHNESS)?;
        match self.height_m {
            Some(height_m) => within("ground.height_m", height_m, limits::COORDINATE_M),
            None => Ok(()),
        }
    }
}

impl Description {
    /// Whether the scene has a light or an environment of its own, hidden or not.
    pub(super) fn is_lit(&self) -> bool {
        self.environment.is_some() || !self.lights.is_empty()
    }
}

fn is_one(value: &f64) -> bool {
    *value == 1.0
}

fn is_dark_grey(color: &[f64; 3]) -> bool {
    *color == DARK_GREY
}

fn is_satin(roughness: &f64) -> bool {
    *roughness == SATIN
}

impl Read for Studio {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::read(value, key, &["hidden", "intensity", "rotation_deg"])?;
        let default = Self::default();
        Ok(Self {
            hidden: table.or("hidden", default.hidden)?,
            intensity: table.or("intensity", default.intensity)?,
            rotation_deg: table.or("rotation_deg", default.rotation_deg)?,
        })
    }
}

impl Read for Ground {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let table = Table::read(value, key, &["hidden", "color", "roughness", "height_m"])?;
        let default = Self::default();
        Ok(Self {
            hidden: table.or("hidden", default.hidden)?,
            color: table.or("color", default.color)?,
            roughness: table.or("roughness", default.roughness)?,
            height_m: table.optional("height_m")?,
        })
    }
}
