//! The `[[grating]]` tables of a scene file.

use std::path::PathBuf;

use serde::Serialize;
use toml::de::DeValue;

use super::distribution::Distribution;
use super::keyed::kinds;
use super::ranges::{Check, Numbers, check_radii, check_seed, within};
use super::scratches::Around;
use super::table::{Read, Table, Value};
use super::values::{Named, is_default, is_false, serialize_named};
use crate::error::Error;
use crate::schema::{grating, scratches};

/// `[[grating]]`: grooves side by side, nearer to one another than a pixel can show. They interfere, as those of a compact disc do.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Grating {
    /// The name of the object that they cover. Required.
    pub object: String,
    /// Free text, for lists that people read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Laid nowhere.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// `pattern` and the keys that belong to it.
    #[serde(flatten)]
    pub pattern: GroovePattern,
    /// Distance from one groove to the next. From 0.3 to 50. Required.
    pub pitch_um: f64,
    /// Width of a groove, at most the pitch.
    pub width_um: f64,
    /// Normal; the spread is a share of the mean.
    pub depth_nm: Distribution,
    /// Standard deviation of how far a groove is off its place. At most the pitch.
    pub jitter_um: f64,
    /// How bright the orders of a pitch below 4 um are.
    #[serde(serialize_with = "serialize_named", skip_serializing_if = "is_default")]
    pub theory: GratingTheory,
    /// Seed of the displacements of single grooves from their places.
    pub seed: u64,
    /// The share of the surface that the grooves cover. In [0, 1].
    pub coverage: f64,
    /// A picture whose values, from 0 (black) to 1 (white), are factors on the coverage. `.png`, `.jpg` or `.webp`, relative to the
    /// scene file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mask: Option<PathBuf>,
    /// The mask is laid on the object from its three sides, so wide, in its own frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tile_m: Option<f64>,
    /// The least and the greatest distance from the pattern's axis; for patterns without one, from `center_m`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<[f64; 2]>,
    /// For patterns without an axis the point from which `radius_m` is measured, in the object's frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center_m: Option<[f64; 3]>,
}

/// `pattern` of a `[[grating]]`: those of scratches whose rows do not cross one another. `jitter_deg` is the standard deviation of a groove's
/// angle to the pattern.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "pattern", rename_all = "lowercase")]
pub enum GroovePattern {
    /// `"parallel"`: all along one direction.
    Parallel {
        /// Direction of the grooves, in the frame of the object.
        direction: [f64; 3],
        /// Standard deviation of a groove's angle to the pattern.
        jitter_deg: f64,
    },
    /// `"circular"`: around an axis.
    Circular(Around),
    /// `"radial"`: away from an axis.
    Radial(Around),
    /// `"spun"`: arcs of one curvature that leave the axis in all directions.
    Spun {
        /// The axis.
        #[serde(flatten)]
        around: Around,
        /// One over their radius.
        curvature_per_m: f64,
    },
    /// `"swirl"`: around the middles of spots in rows, each over those before it, as a spinning peg leaves them: engine turning, perlage.
    Swirl {
        /// Axis along which the spots are pressed into the surface. It passes through the middle of one of them.
        #[serde(flatten)]
        around: Around,
        /// Distance of neighbouring spots in a row, and of neighbouring rows.
        spacing_m: f64,
    },
    /// `"uv"`: along the texture coordinates of the surface.
    Uv {
        /// Texture coordinate along which the grooves run.
        #[serde(serialize_with = "serialize_named", skip_serializing_if = "is_default")]
        along: UvAxis,
        /// A picture that turns them, as anisotropy textures of glTF do: red and green are the parts along u and up across it, from
        /// -1 (black) to 1. `.png`, `.jpg` or `.webp`, relative to the scene file.
        #[serde(skip_serializing_if = "Option::is_none")]
        directions: Option<PathBuf>,
        /// Standard deviation of a groove's angle to the pattern.
        jitter_deg: f64,
    },
}

/// Theory of the brightness of orders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GratingTheory {
    /// `"rigorous"`: the whole field of both polarisations in the grooves, by the material's refractive index.
    #[default]
    Rigorous,
    /// `"scalar"`: floors that shift the phase of one wave, as of wide grooves.
    Scalar,
}

impl Named for GratingTheory {
    const NAMES: &'static [(&'static str, Self)] =
        &[("rigorous", Self::Rigorous), ("scalar", Self::Scalar)];
}

/// A texture coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UvAxis {
    /// The first.
    #[default]
    U,
    /// The second.
    V,
}

impl Numbers for UvAxis {}

impl Named for UvAxis {
    const NAMES: &'static [(&'static str, Self)] = &[("u", Self::U), ("v", Self::V)];
}

kinds! { GroovePattern,
    /// Value of `pattern` for it.
    name {
        "parallel" => Parallel { direction: scratches::DIRECTION, jitter_deg: grating::JITTER_DEG },
        "circular" => Circular(around),
        "radial" => Radial(around),
        "spun" => Spun { around: Flat, curvature_per_m: grating::CURVATURE_PER_M },
        "swirl" => Swirl { around: Flat, spacing_m: grating::SPACING_M },
        "uv" => Uv { along: grating::ALONG, directions: grating::DIRECTIONS, jitter_deg: grating::JITTER_DEG },
    }
}

impl GroovePattern {
    /// The axis, if it has one.
    pub fn around(&self) -> Option<&Around> {
        match self {
            Self::Circular(around)
            | Self::Radial(around)
            | Self::Spun { around, .. }
            | Self::Swirl { around, .. } => Some(around),
            Self::Parallel { .. } | Self::Uv { .. } => None,
        }
    }
}

/// Widths where a grating does not say them, as shares of the pitch.
const DEFAULT_FILL: f64 = 0.4;

impl Grating {
    /// Grooves everywhere on an object, all alike, of the default width and depth.
    pub fn new(object: impl Into<String>, pattern: GroovePattern, pitch_um: f64) -> Self {
        Self {
            object: object.into(),
            name: None,
            hidden: false,
            pattern,
            pitch_um,
            width_um: DEFAULT_FILL * pitch_um,
            depth_nm: grating::DEPTH_NM.initial(),
            jitter_um: grating::JITTER_UM.initial(),
            theory: GratingTheory::default(),
            seed: grating::SEED.initial(),
            coverage: grating::COVERAGE.initial(),
            mask: None,
            tile_m: None,
            radius_m: None,
            center_m: None,
        }
    }

    /// Refuses values out of range.
    pub(super) fn check_at(&self, key: &str) -> Check {
        self.pattern.check_keys(key)?;
        grating::PITCH_UM.check(key, &self.pitch_um)?;
        grating::WIDTH_UM.check(key, &self.width_um)?;
        let width = format!("{key}.{}", grating::WIDTH_UM.name);
        within(&width, self.width_um, 0.0..=self.pitch_um)?;
        grating::DEPTH_NM.check(key, &self.depth_nm)?;
        let jitter = format!("{key}.{}", grating::JITTER_UM.name);
        within(&jitter, self.jitter_um, 0.0..=self.pitch_um)?;
        check_seed(self.seed, key)?;
        grating::COVERAGE.check(key, &self.coverage)?;
        grating::TILE_M.check(key, &self.tile_m)?;
        if self.tile_m.is_some() && self.mask.is_none() {
            return Err(Error::new(
                format!("{key}.tile_m"),
                "found a width without a picture",
                "belongs to `mask`",
            ));
        }
        if self.center_m.is_some() && self.radius_m.is_none() {
            return Err(Error::new(
                format!("{key}.center_m"),
                "found a middle for distances that are not there",
                "belongs to `radius_m`",
            ));
        }
        grating::CENTER_M.check(key, &self.center_m)?;
        check_radii(&grating::RADIUS_M, key, self.radius_m)
    }
}

/// Refuses the pattern of scratches that is none of gratings.
fn refuse_crossings(value: &Value, key: &str) -> Result<(), Error> {
    let pattern = match value.get_ref() {
        DeValue::Table(entries) => entries.get("pattern").map(|pattern| pattern.get_ref()),
        _ => None,
    };
    match pattern {
        Some(DeValue::String(name)) if name.as_ref() == "random" => Err(Error::new(
            format!("{key}.pattern"),
            format!("found \"{name}\", whose scratches cross one another"),
            "must be `parallel`, `circular`, `radial`, `spun`, `swirl` or `uv`",
        )),
        _ => Ok(()),
    }
}

impl Read for Grating {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        refuse_crossings(value, key)?;
        let (pattern, table) = Table::of_kind(&grating::GRATING, value, key)?;
        let pattern = GroovePattern::read_kind(pattern, &table)?;
        let has_axis = pattern.around().is_some();
        let default = Self::new(
            table.value::<String>(&grating::OBJECT)?,
            pattern,
            table.value(&grating::PITCH_UM)?,
        );
        Ok(Self {
            name: table.value(&grating::NAME)?,
            hidden: table.value(&grating::HIDDEN)?,
            width_um: table.or(grating::WIDTH_UM.name, default.width_um)?,
            depth_nm: table.value(&grating::DEPTH_NM)?,
            jitter_um: table.value(&grating::JITTER_UM)?,
            theory: table.value(&grating::THEORY)?,
            seed: table.value(&grating::SEED)?,
            coverage: table.value(&grating::COVERAGE)?,
            mask: table.value(&grating::MASK)?,
            tile_m: table.value(&grating::TILE_M)?,
            radius_m: table.value(&grating::RADIUS_M)?,
            center_m: match has_axis {
                true => None,
                false => table.value(&grating::CENTER_M)?,
            },
            ..default
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Description;

    fn text(grating: &str) -> String {
        format!(
            "camera = {{ position_m = [0, -0.2, 0.2], target_m = [0, 0, 0], up = [0, 0, 1] }}\n\
             material = [{{ name = \"m\", kind = \"mirror\" }}]\n\
             object = [{{ name = \"o\", material = \"m\", shape = {{ disk = {{ radius_m = 0.06 }} }} }}]\n\
             [[grating]]\n{grating}"
        )
    }

    const DISC: &str = "object = \"o\"\npattern = \"circular\"\npitch_um = 1.6\n";

    #[test]
    fn what_is_left_out_has_defaults_and_what_is_saved_loads_again() {
        let described = Description::from_toml(&text(DISC), "test".as_ref()).unwrap();
        let disc = Grating::new("o", GroovePattern::Circular(Around::default()), 1.6);
        assert_eq!(described.gratings, [disc]);
        let all = "object = \"o\"\nname = \"n\"\nhidden = true\npattern = \"spun\"\naxis = [0, 1, 0]\n\
            center_m = [0, 0, 0.1]\njitter_deg = 2.0\ncurvature_per_m = 10.0\npitch_um = 3.0\nwidth_um = 1.0\n\
            depth_nm = { mean = 200.0, spread = 0.2 }\njitter_um = 0.1\ntheory = \"scalar\"\nseed = 9\ncoverage = 0.5\nradius_m = [0.01, 0.05]\n";
        let described = Description::from_toml(&text(all), "test".as_ref()).unwrap();
        let saved = described.to_toml().unwrap();
        let loaded = Description::from_toml(&saved, "test".as_ref()).unwrap();
        assert_eq!(loaded.gratings, described.gratings);
        assert_eq!(described.gratings[0].radius_m, Some([0.01, 0.05]));
        let parallel = "object = \"o\"\npattern = \"parallel\"\npitch_um = 3.0\nradius_m = [0.0, 0.05]\ncenter_m = [0.1, 0, 0]\n";
        let described = Description::from_toml(&text(parallel), "test".as_ref()).unwrap();
        let saved = described.to_toml().unwrap();
        let loaded = Description::from_toml(&saved, "test".as_ref()).unwrap();
        assert_eq!(loaded.gratings, described.gratings);
        assert_eq!(described.gratings[0].center_m, Some([0.1, 0.0, 0.0]));
        let swirl = "object = \"o\"\npattern = \"swirl\"\njitter_deg = 3.0\nspacing_m = 0.007\npitch_um = 3.0\n";
        let described = Description::from_toml(&text(swirl), "test".as_ref()).unwrap();
        let saved = described.to_toml().unwrap();
        let loaded = Description::from_toml(&saved, "test".as_ref()).unwrap();
        assert_eq!(loaded.gratings, described.gratings);
        let swirl = |pattern: &GroovePattern| match pattern {
            GroovePattern::Swirl { spacing_m, .. } => Some(*spacing_m),
            _ => None,
        };
        assert_eq!(swirl(&described.gratings[0].pattern), Some(0.007));
        let uv = "object = \"o\"\npattern = \"uv\"\nalong = \"v\"\ndirections = \"d.png\"\npitch_um = 3.0\nmask = \"m.png\"\ntile_m = 0.02\n";
        let described = Description::from_toml(&text(uv), "test".as_ref()).unwrap();
        let saved = described.to_toml().unwrap();
        let loaded = Description::from_toml(&saved, "test".as_ref()).unwrap();
        assert_eq!(loaded.gratings, described.gratings);
        assert_eq!(described.files().len(), 2);
    }

    #[test]
    fn what_is_wrong_is_named_by_its_line_and_key() {
        for (grating, expected) in [
            (
                DISC.replace("\"o\"", "\"oo\""),
                "test:5: grating[0].object: found no object called \"oo\"; did you mean \"o\"?",
            ),
            (
                DISC.replace("1.6", "80.0"),
                "test:7: grating[0].pitch_um: found 80; must be from 0.3 to 50",
            ),
            (
                format!("{DISC}width_um = 2.0"),
                "test:8: grating[0].width_um: found 2; must be from 0 to 1.6",
            ),
            (
                format!("{DISC}radius_m = [0.05, 0.02]"),
                "test:8: grating[0].radius_m: found 0.05 and 0.02; the second must be the greater one",
            ),
            (
                format!("{DISC}center_m = [0, 0, 0.1]").replace("circular", "parallel"),
                "test:8: grating[0].center_m: found a middle for distances that are not there; belongs to `radius_m`",
            ),
            (
                format!("{DISC}tile_m = 0.01"),
                "test:8: grating[0].tile_m: found a width without a picture; belongs to `mask`",
            ),
            (
                format!("{DISC}mask = \"nowhere.png\"").replace("circular", "uv"),
                "test:8: grating[0].mask: ./nowhere.png: No such file or directory (os error 2); must be a .png, .jpg or .webp, relative to the scene file",
            ),
            (
                format!("{DISC}along = \"w\"").replace("circular", "uv"),
                "test:8: grating[0].along: found the text \"w\"; must be one of `u` and `v`",
            ),
            (
                format!("{DISC}theory = \"vector\""),
                "test:8: grating[0].theory: found the text \"vector\"; must be one of `rigorous` and `scalar`",
            ),
            (
                DISC.replace("circular", "random"),
                "test:6: grating[0].pattern: found \"random\", whose scratches cross one another; must be `parallel`, `circular`, `radial`, `spun`, `swirl` or `uv`",
            ),
            (
                format!("{DISC}spacing_m = 0").replace("circular", "swirl"),
                "test:8: grating[0].spacing_m: found 0; must be greater than 0",
            ),
            (
                format!("{DISC}spacing_m = 0.01"),
                "test:8: grating[0].spacing_m: pattern `circular` has no such key; it belongs to `swirl`",
            ),
            (
                format!("{DISC}direction = [1, 0, 0]"),
                "test:8: grating[0].direction: pattern `circular` has no such key; it belongs to `parallel`",
            ),
        ] {
            let error = crate::from_toml(&text(&grating), "test", ".").unwrap_err();
            assert_eq!(error.to_string(), expected, "{grating}");
        }
    }
}
