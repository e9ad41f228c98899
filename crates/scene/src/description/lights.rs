//! Lights as an author writes them.

use std::path::PathBuf;

use glam::DVec3;
use hairline_optics::spectrum::black_body_rgb;
use serde::Serialize;

use super::light_kind::{self, LightKind, aimed};
use super::limits::{BARN_DOOR_DEG, CONE_DEG, EXPOSURE_EV, TEMPERATURE_K};
use super::ranges::{Check, components, not_negative, point, within};
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
    /// Whether the camera sees its shape. Default: false.
    #[serde(skip_serializing_if = "is_false")]
    pub visible: bool,
    /// `kind` and the keys that belong to it.
    #[serde(flatten)]
    pub kind: LightKind,
    /// W sr^-1 m^-2 in effect; not negative. Of a sun 1: its irradiance tells. Default: 1.
    #[serde(skip_serializing_if = "is_one")]
    pub radiance: f64,
    /// Stops: the radiance is multiplied by 2^`exposure_ev`. Default: 0.
    #[serde(skip_serializing_if = "is_zero")]
    pub exposure_ev: f64,
    /// Temperature, K, of a black body that the light is, with the luminance that the light has without this key. `color` is a filter before it.
    /// Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_k: Option<f64>,
    /// Factor on the radiance, linear Rec.709, not negative; `[1, 1, 1]` has the spectrum of D65. Default: `[1, 1, 1]`.
    pub color: [f64; 3],
    /// Directions into which the light shines. Default: all.
    #[serde(flatten)]
    pub cone: Option<Cone>,
    /// For a disk or a rectangle: the angles between its axis and flaps that end its light, to the left, to the right, above and below as seen from
    /// its target. 90 is open. Default: no flaps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub barn_doors_deg: Option<[f64; 4]>,
    /// For a rectangle: a picture on it, upright as seen from its target, relative to the scene file. Its linear values are factors on the
    /// radiance. Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture: Option<PathBuf>,
}

/// `cone_deg` of a `[[light]]` and the keys that belong to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cone {
    /// Full angle of the cone from rim to rim. Required.
    pub cone_deg: f64,
    /// The part of the way from rim to axis in which light falls off. Default: 0.1.
    #[serde(skip_serializing_if = "is_default_softness")]
    pub cone_softness: f64,
    /// Target of the cone of a sphere or a tube; required there. Others have their own axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_m: Option<[f64; 3]>,
}

fn is_one(factor: &f64) -> bool {
    *factor == 1.0
}

const DEFAULT_SOFTNESS: f64 = 0.1;

fn is_default_softness(softness: &f64) -> bool {
    *softness == DEFAULT_SOFTNESS
}

impl Cone {
    /// A cone with a soft rim of the default width.
    pub fn new(cone_deg: f64, target_m: Option<[f64; 3]>) -> Self {
        Self {
            cone_deg,
            cone_softness: DEFAULT_SOFTNESS,
            target_m,
        }
    }

    fn check_at(&self, key: &str, kind: &LightKind) -> Check {
        within(&format!("{key}.cone_deg"), self.cone_deg, CONE_DEG)?;
        within(
            &format!("{key}.cone_softness"),
            self.cone_softness,
            0.0..=1.0,
        )?;
        if kind.is_two_sided() {
            return Err(Error::new(
                format!("{key}.cone_deg"),
                "found a cone of a light whose two sides shine",
                "leave out `two_sided`, or the cone",
            ));
        }
        if kind.axis().is_some() {
            return Ok(());
        }
        match self.target_m {
            Some(target_m) => {
                point(&format!("{key}.target_m"), target_m)?;
                aimed(key, kind.middle_m().into(), target_m)
            }
            None => Err(Error::new(
                key,
                "`target_m` is missing",
                format!("`{key}` needs it to know where its cone points"),
            )),
        }
    }

    fn in_scene(&self, kind: &LightKind) -> scene::Cone {
        let towards = self.target_m.map_or(DVec3::NEG_Z, DVec3::from) - kind.middle_m();
        let half_rad = 0.5 * self.cone_deg.to_radians();
        scene::Cone {
            axis: kind.axis().unwrap_or(towards.normalize_or(DVec3::NEG_Z)),
            cos_outer: half_rad.cos(),
            cos_inner: (half_rad * (1.0 - self.cone_softness)).cos(),
            doors: None,
        }
    }
}

impl Light {
    /// A white light of radiance 1, without a name, not hidden.
    pub fn new(kind: LightKind) -> Self {
        Self {
            name: None,
            hidden: false,
            visible: false,
            kind,
            radiance: 1.0,
            exposure_ev: 0.0,
            temperature_k: None,
            color: [1.0; 3],
            cone: None,
            barn_doors_deg: None,
            picture: None,
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
        self.kind.check_at(key)?;
        self.check_sun(key)?;
        self.check_doors(&format!("{key}.barn_doors_deg"))?;
        if self.picture.is_some() && !matches!(self.kind, LightKind::Rectangle { .. }) {
            return Err(Error::new(
                format!("{key}.picture"),
                format!("found a picture on a {}", self.kind.title()),
                "must be on a rectangle",
            ));
        }
        match &self.cone {
            Some(cone) => cone.check_at(key, &self.kind),
            None => Ok(()),
        }
    }

    /// A sun has no surface that could be seen, and no place that a cone could begin in.
    fn check_sun(&self, key: &str) -> Check {
        if self.kind.sunbeam().is_none() {
            return Ok(());
        }
        let odd = [
            ("visible", self.visible),
            ("radiance", self.radiance != 1.0),
            ("cone_deg", self.cone.is_some()),
        ];
        match odd.into_iter().find(|(_, is_there)| *is_there) {
            Some((name, _)) => Err(Error::new(
                format!("{key}.{name}"),
                "found a sun",
                "must be left out; a sun has `direction`, `angle_deg` and `irradiance`",
            )),
            None => Ok(()),
        }
    }

    fn check_doors(&self, key: &str) -> Check {
        let Some(doors_deg) = self.barn_doors_deg else {
            return Ok(());
        };
        if self.kind.across().is_none() || self.kind.is_two_sided() {
            return Err(Error::new(
                key,
                format!("found barn doors of a {}", self.kind.title()),
                "must be those of a disk or a rectangle that shines to one side",
            ));
        }
        doors_deg.iter().enumerate().try_for_each(|(i, angle_deg)| {
            within(&format!("{key}[{i}]"), *angle_deg, BARN_DOOR_DEG)
        })
    }

    fn doors(&self) -> Option<scene::Doors> {
        Some(scene::Doors {
            across: self.kind.across()?,
            // An open door ends nothing, and its number is one.
            tans: self
                .barn_doors_deg?
                .map(|angle_deg| angle_deg.to_radians().tan().clamp(0.0, 1e6)),
        })
    }

    fn cone_in_scene(&self) -> Option<scene::Cone> {
        let cone = self.cone.as_ref().map(|cone| cone.in_scene(&self.kind));
        match (self.doors(), self.kind.axis()) {
            (Some(doors), Some(axis)) => Some(scene::Cone {
                doors: Some(doors),
                ..cone.unwrap_or(scene::Cone::open(axis))
            }),
            _ => cone,
        }
    }

    /// Converts it to a light of a scene.
    pub(crate) fn in_scene(&self) -> scene::Light {
        let tint = self.temperature_k.map_or([1.0; 3], black_body_rgb);
        let radiance = self.radiance * self.exposure_ev.exp2();
        let radiance = std::array::from_fn(|c| self.color[c] * tint[c] * radiance);
        scene::Light {
            cone: self.cone_in_scene(),
            ..self.kind.in_scene(radiance)
        }
    }
}

impl Read for Light {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let kinds = light_kind::keys();
        let kinds = kinds.each_ref().map(|(kind, own)| (*kind, &own[..]));
        let (kind, table) = Table::read_kind(
            value,
            key,
            "kind",
            &[
                "kind",
                "name",
                "hidden",
                "exposure_ev",
                "temperature_k",
                "color",
                "barn_doors_deg",
                "picture",
            ],
            &kinds,
        )?;
        let kind = LightKind::read(kind, &table)?;
        let is_sun = kind.sunbeam().is_some();
        let cone = if is_sun { None } else { cone(&table, &kind)? };
        Ok(Self {
            name: table.optional("name")?,
            hidden: table.or("hidden", false)?,
            visible: !is_sun && table.or("visible", false)?,
            radiance: if is_sun {
                1.0
            } else {
                table.or("radiance", 1.0)?
            },
            kind,
            exposure_ev: table.or("exposure_ev", 0.0)?,
            temperature_k: table.optional("temperature_k")?,
            color: table.or("color", [1.0; 3])?,
            cone,
            barn_doors_deg: table.optional("barn_doors_deg")?,
            picture: table.optional("picture")?,
        })
    }
}

fn cone(table: &Table, kind: &LightKind) -> Result<Option<Cone>, Error> {
    let own = match kind.has_target() {
        true => &["cone_softness"][..],
        false => &["cone_softness", "target_m"],
    };
    let Some(cone_deg) = table.optional("cone_deg")? else {
        return match own.iter().find(|name| table.has(name)) {
            Some(name) => Err(Error::new(
                table.way(name),
                "found no cone that it belongs to",
                "give the light a `cone_deg`, or leave it out",
            )),
            None => Ok(None),
        };
    };
    Ok(Some(Cone {
        cone_deg,
        cone_softness: table.or("cone_softness", DEFAULT_SOFTNESS)?,
        target_m: match kind.has_target() || kind.axis().is_some() {
            true => None,
            false => table.optional("target_m")?,
        },
    }))
}
