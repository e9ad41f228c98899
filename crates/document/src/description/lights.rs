//! Lights as an author writes them.

use std::path::PathBuf;

use glam::DVec3;
use hairline_keys::Keyed;
use hairline_optics::spectrum::black_body_rgb;
use hairline_scene::scene;

use super::keyed::Keyed;
use super::light_kind::{LightKind, TARGET, aimed};
use super::ranges::Check;
use super::table::Table;
use crate::error::Error;
use crate::schema::Entry;

/// `[[light]]`
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(table, kinds = LightKind, of_kinds = OF_KINDS, check = Light::check_companions)]
pub struct Light {
    /// For you to know the light by.
    #[key(none().range_words("any text"))]
    pub name: Option<String>,
    /// Lights nothing, as if it were not there.
    #[key(flag(false).omitted())]
    pub hidden: bool,
    /// Whether the camera sees its shape, as bright as its `radiance`; of flat ones the side that shines. It hides no other light, and is in
    /// reflections either way. Not of a sun.
    #[key(flag(false).omitted().labelled("Visible", "The camera sees its shape, as bright as it is."))]
    #[of_kinds]
    pub visible: bool,
    /// `kind` and the keys that belong to it.
    #[flat]
    pub kind: LightKind,
    /// Brightness of its surface. A smaller light of the same radiance lights less. Not of a sun, which has `irradiance`.
    #[key(unit("W sr⁻¹ m⁻²").number(1.0).at_least_0().omitted()
        .control("Radiance", log(0.01, 1000.0), "Brightness of the light as it is seen. 40 to 200 for small lamps in dim surroundings lets the highlight clip and its scratches glow."))]
    #[of_kinds]
    pub radiance: f64,
    /// The radiance, or the irradiance of a sun, is multiplied by 2^`exposure_ev`.
    #[key(unit("stops").number(0.0).in_range(-64.0, 64.0).omitted()
        .control("Stops", linear(-8.0, 8.0), "Each stop doubles the radiance: for balancing lights against one another."))]
    pub exposure_ev: f64,
    /// The colour of a black body: 2700 a warm bulb, 5600 a flash, 6500 daylight. The luminance stays; `color` is a filter before it.
    #[key(unit("K").none().in_range(1000.0, 40_000.0)
        .control("Temperature", linear(1800.0, 10_000.0), "Colour of a glowing body: 2700 K for a warm bulb, 5600 K for a flash, 6500 K for daylight. Brightness stays."))]
    pub temperature_k: Option<f64>,
    /// Factor on the radiance; white has the spectrum of daylight (D65).
    #[key(color().is(Initial::Numbers(&[1.0, 1.0, 1.0])).at_least_0()
        .control("Colour", linear(0.0, 1.0), "Tint of the light. Scratches split what is in it: white light shows every colour, a warm one fewer blues."))]
    pub color: [f64; 3],
    /// Directions into which the light shines.
    #[flat]
    #[of_kinds]
    #[read(cone)]
    pub cone: Option<Cone>,
    /// Of a disk or a rectangle: barn doors: the angles between the axis and flaps that end the light, to the left, to the right, above and below as
    /// seen from the target. 90 is open. Light falls off in the last tenth of each angle. Not with `two_sided`.
    #[key(unit("°").none().in_range(0.0, 90.0).range_words("four, 0 to 90 each")
        .control("Barn door", linear(0.0, 90.0), "The angle between the light's axis and a flap that ends its light: left, right, above and below as seen from its target. 90 is open."))]
    pub barn_doors_deg: Option<[f64; 4]>,
    /// Of a rectangle: a picture on the light, upright as seen from the target, relative to the scene file: what a soft box looks like. Its linear
    /// values are factors on the radiance; those of `.hdr` and `.exr` are kept in 8 bits relative to the brightest. What is transparent sends no
    /// light. Scratches, base, shadows and the camera see it.
    #[key(none().range_words("`.png`, `.jpg`, `.webp`, `.hdr` or `.exr`"))]
    pub picture: Option<PathBuf>,
}

/// `cone_deg` of a `[[light]]` and the keys that belong to it.
#[derive(Clone, Debug, PartialEq, Keyed)]
pub struct Cone {
    /// A spot: the angle of its cone from rim to rim; no light outside. Flat lights point along their own axis. Not with `two_sided`, not of a sun.
    #[key(unit("°").none().in_range(0.1, 360.0)
        .control("Cone", linear(5.0, 180.0), "The angle of the cone from rim to rim. Outside of it there is no light."))]
    pub cone_deg: f64,
    /// With `cone_deg`: the part of the way from rim to axis in which the light falls off, as KHR_lights_punctual has it.
    #[key(number(0.1).in_range(0.0, 1.0)
        .control("Softness", linear(0.0, 1.0), "The part of the way from rim to axis in which the light falls off."))]
    pub cone_softness: f64,
    /// What the cone points to.
    #[key(like(&TARGET).none().range_words("with `cone_deg`, which needs it"))]
    pub target_m: Option<[f64; 3]>,
}

/// Keys of all lights but suns, which have no surface.
const SHINING: &[Entry] = &[
    Entry::Key(Light::RADIANCE),
    Entry::Key(Light::VISIBLE),
    Entry::Key(Cone::CONE_DEG),
    Entry::Key(Cone::CONE_SOFTNESS),
];

/// Those of lights that have no axis, whose cone needs a target.
const ROUND: &[Entry] = &[Entry::Key(Cone::TARGET_M), Entry::All(SHINING)];

const OF_KINDS: &[(&str, &[Entry])] = &[
    ("sphere", ROUND),
    ("disk", SHINING),
    ("rectangle", SHINING),
    ("polygon", SHINING),
    ("tube", ROUND),
];

impl Cone {
    /// A cone with a soft rim of the default width.
    pub fn new(cone_deg: f64, target_m: Option<[f64; 3]>) -> Self {
        Self {
            cone_deg,
            cone_softness: Self::CONE_SOFTNESS.initial(),
            target_m,
        }
    }

    fn check_at(&self, key: &str, kind: &LightKind) -> Check {
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
            Some(target_m) => aimed(key, kind.middle_m().into(), target_m),
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
            radiance: Self::RADIANCE.initial(),
            exposure_ev: Self::EXPOSURE_EV.initial(),
            temperature_k: None,
            color: Self::COLOR.initial(),
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
        self.check_keys("light")
    }

    fn check_companions(&self, key: &str) -> Check {
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
            ("radiance", self.radiance != Self::RADIANCE.initial::<f64>()),
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
        if self.barn_doors_deg.is_some() && !self.kind.takes_barn_doors() {
            return Err(Error::new(
                format!("{key}.barn_doors_deg"),
                format!("found barn doors of a {}", self.kind.title()),
                "must be those of a disk or a rectangle that shines to one side",
            ));
        }
        Ok(())
    }

    fn doors(&self) -> Option<scene::Doors> {
        Some(scene::Doors {
            across: self.kind.width_direction()?,
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

/// The cone of a light that has one.
fn cone(table: &Table) -> Result<Option<Cone>, Error> {
    let is_round = matches!(table.kind(), "sphere" | "tube");
    let own = match is_round {
        true => &[Cone::CONE_SOFTNESS, Cone::TARGET_M][..],
        false => &[Cone::CONE_SOFTNESS],
    };
    let Some(cone_deg) = table.value(Cone::CONE_DEG)? else {
        return match own.iter().find(|key| table.has(key.name)) {
            Some(key) => Err(Error::new(
                table.key_path(key.name),
                "found no cone that it belongs to",
                "give the light a `cone_deg`, or leave it out",
            )),
            None => Ok(None),
        };
    };
    Ok(Some(Cone {
        cone_deg,
        cone_softness: table.value(Cone::CONE_SOFTNESS)?,
        target_m: match is_round {
            true => table.value(Cone::TARGET_M)?,
            false => None,
        },
    }))
}
