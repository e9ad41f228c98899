//! Lights as an author writes them.

use std::path::PathBuf;

use glam::DVec3;
use hairline_optics::spectrum::black_body_rgb;
use hairline_scene::scene;
use serde::Serialize;

use super::light_kind::{LightKind, aimed};
use super::ranges::Check;
use super::table::{Read, Table, Value};
use super::values::{is_false, is_zero};
use crate::error::Error;
use crate::schema::light;

/// `[[light]]`
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Light {
    /// Free text, for lists that people read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Lights nothing, as if it were not there.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// Whether the camera sees its shape.
    #[serde(skip_serializing_if = "is_false")]
    pub visible: bool,
    /// `kind` and the keys that belong to it.
    #[serde(flatten)]
    pub kind: LightKind,
    /// W sr^-1 m^-2 in effect; not negative. Of a sun 1: its irradiance tells.
    #[serde(skip_serializing_if = "is_one")]
    pub radiance: f64,
    /// Stops: the radiance is multiplied by 2^`exposure_ev`.
    #[serde(skip_serializing_if = "is_zero")]
    pub exposure_ev: f64,
    /// Temperature, K, of a black body that the light is, with the luminance that the light has without this key. `color` is a
    /// filter before it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_k: Option<f64>,
    /// Factor on the radiance, linear Rec.709, not negative; `[1, 1, 1]` has the spectrum of D65.
    pub color: [f64; 3],
    /// Directions into which the light shines.
    #[serde(flatten)]
    pub cone: Option<Cone>,
    /// For a disk or a rectangle: the angles between its axis and flaps that end its light, to the left, to the right, above and
    /// below as seen from its target. 90 is open.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub barn_doors_deg: Option<[f64; 4]>,
    /// For a rectangle: a picture on it, upright as seen from its target, relative to the scene file. Its linear values are factors
    /// on the radiance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture: Option<PathBuf>,
}

/// `cone_deg` of a `[[light]]` and the keys that belong to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cone {
    /// Full angle of the cone from rim to rim. Required.
    pub cone_deg: f64,
    /// The part of the way from rim to axis in which light falls off.
    pub cone_softness: f64,
    /// Target of the cone of a sphere or a tube; required there. Others have their own axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_m: Option<[f64; 3]>,
}

fn is_one(factor: &f64) -> bool {
    *factor == light::RADIANCE.initial::<f64>()
}

impl Cone {
    /// A cone with a soft rim of the default width.
    pub fn new(cone_deg: f64, target_m: Option<[f64; 3]>) -> Self {
        Self {
            cone_deg,
            cone_softness: light::CONE_SOFTNESS.initial(),
            target_m,
        }
    }

    fn check_at(&self, key: &str, kind: &LightKind) -> Check {
        light::CONE_DEG.check(key, &self.cone_deg)?;
        light::CONE_SOFTNESS.check(key, &self.cone_softness)?;
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
                light::CONE_TARGET_M.check(key, &target_m)?;
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
            radiance: light::RADIANCE.initial(),
            exposure_ev: light::EXPOSURE_EV.initial(),
            temperature_k: None,
            color: light::COLOR.initial(),
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
        light::RADIANCE.check(key, &self.radiance)?;
        light::COLOR.check(key, &self.color)?;
        light::EXPOSURE_EV.check(key, &self.exposure_ev)?;
        light::TEMPERATURE_K.check(key, &self.temperature_k)?;
        self.kind.check_at(key)?;
        self.check_sun(key)?;
        self.check_doors(key)?;
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
            ("radiance", !is_one(&self.radiance)),
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
        if self.barn_doors_deg.is_none() {
            return Ok(());
        }
        if self.kind.across().is_none() || self.kind.is_two_sided() {
            return Err(Error::new(
                format!("{key}.barn_doors_deg"),
                format!("found barn doors of a {}", self.kind.title()),
                "must be those of a disk or a rectangle that shines to one side",
            ));
        }
        light::BARN_DOORS_DEG.check(key, &self.barn_doors_deg)
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
            temperature_k: self.temperature_k,
            ..self.kind.in_scene(radiance)
        }
    }
}

impl Read for Light {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        let (kind, table) = Table::of_kind(&light::LIGHT, value, key)?;
        let kind = LightKind::read_kind(kind, &table)?;
        let mut read = Self::new(kind);
        if read.kind.sunbeam().is_none() {
            read.radiance = table.value(&light::RADIANCE)?;
            read.visible = table.value(&light::VISIBLE)?;
            read.cone = cone(&table, &read.kind)?;
        }
        Ok(Self {
            name: table.value(&light::NAME)?,
            hidden: table.value(&light::HIDDEN)?,
            exposure_ev: table.value(&light::EXPOSURE_EV)?,
            temperature_k: table.value(&light::TEMPERATURE_K)?,
            color: table.value(&light::COLOR)?,
            barn_doors_deg: table.value(&light::BARN_DOORS_DEG)?,
            picture: table.value(&light::PICTURE)?,
            ..read
        })
    }
}

fn cone(table: &Table, kind: &LightKind) -> Result<Option<Cone>, Error> {
    let own = match kind.has_target() {
        true => &["cone_softness"][..],
        false => &["cone_softness", "target_m"],
    };
    let Some(cone_deg) = table.value(&light::CONE_DEG)? else {
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
        cone_softness: table.value(&light::CONE_SOFTNESS)?,
        target_m: match kind.has_target() || kind.axis().is_some() {
            true => None,
            false => table.value(&light::CONE_TARGET_M)?,
        },
    }))
}
