//! Lights as an author writes them.

use hairline_optics::spectrum::black_body_rgb;
use serde::Serialize;

use super::light_kind::{self, LightKind};
use super::limits::{EXPOSURE_EV, TEMPERATURE_K};
use super::ranges::{Check, components, not_negative, within};
use super::table::{Read, Table, Value};
use super::values::{is_false, is_zero};
use crate::error::Error;
use crate::scene;

/// `[[light]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Light {
    /// Free text, for lists that people read. Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Lights nothing, as if it were not there. Default: false.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// `kind` and the keys that belong to it.
    #[serde(flatten)]
    pub kind: LightKind,
    /// W sr^-1 m^-2 in effect; not negative. Default: 1.
    pub radiance: f64,
    /// Stops: the radiance is multiplied by 2^`exposure_ev`. Default: 0.
    #[serde(skip_serializing_if = "is_zero")]
    pub exposure_ev: f64,
    /// The light is a black body of this temperature, K, of the luminance that it would have without. `color` is a filter before it. Default:
    /// none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_k: Option<f64>,
    /// Factor on the radiance, linear Rec.709, not negative; `[1, 1, 1]` has the spectrum of D65. Default: `[1, 1, 1]`.
    pub color: [f64; 3],
}

impl Light {
    /// A white light of radiance 1, without a name, not hidden.
    pub fn new(kind: LightKind) -> Self {
        Self {
            name: None,
            hidden: false,
            kind,
            radiance: 1.0,
            exposure_ev: 0.0,
            temperature_k: None,
            color: [1.0; 3],
        }
    }
}

impl Light {
    /// Refuses values out of range, and shapes that are none. Keys begin with `light`.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self) -> Result<(), Error> {
        self.check_at("light")
    }

    pub(super) fn check_at(&self, key: &str) -> Check {
        not_negative(&format!("{key}.radiance"), self.radiance)?;
        components(&format!("{key}.color"), self.color, 0.0..=f64::MAX)?;
        within(&format!("{key}.exposure_ev"), self.exposure_ev, EXPOSURE_EV)?;
        if let Some(temperature_k) = self.temperature_k {
            within(
                &format!("{key}.temperature_k"),
                temperature_k,
                TEMPERATURE_K,
            )?;
        }
        self.kind.check_at(key)
    }

    /// What it is in a scene.
    pub(crate) fn in_scene(&self) -> scene::Light {
        let tint = self.temperature_k.map_or([1.0; 3], black_body_rgb);
        let radiance = self.radiance * self.exposure_ev.exp2();
        let radiance = std::array::from_fn(|c| self.color[c] * tint[c] * radiance);
        self.kind.in_scene(radiance)
    }
}

impl Read for Light {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let (kind, table) = Table::read_kind(
            value,
            key,
            "kind",
            &[
                "kind",
                "name",
                "hidden",
                "radiance",
                "exposure_ev",
                "temperature_k",
                "color",
            ],
            &light_kind::KEYS,
        )?;
        let kind = LightKind::read(kind, &table)?;
        Ok(Self {
            name: table.optional("name")?,
            hidden: table.or("hidden", false)?,
            kind,
            radiance: table.or("radiance", 1.0)?,
            exposure_ev: table.or("exposure_ev", 0.0)?,
            temperature_k: table.optional("temperature_k")?,
            color: table.or("color", [1.0; 3])?,
        })
    }
}
