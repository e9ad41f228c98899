//! The `[[grating]]` tables of a scene file.

use serde::Serialize;

use super::limits;
use super::ranges::{Check, check_seed, positive, within};
use super::read::around;
use super::scratches::{Around, DEFAULT_SEED, Distribution, Pattern};
use super::table::{Read, Table, Value};
use super::values::is_false;
use crate::error::Error;

/// `[[grating]]`: grooves side by side, nearer to one another than a pixel can show. They interfere, as those of a compact disc do.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Grating {
    /// The name of the object that they cover. Required.
    pub object: String,
    /// Free text, for lists that people read. Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Laid nowhere. Default: false.
    #[serde(skip_serializing_if = "is_false")]
    pub hidden: bool,
    /// `pattern` and the keys that belong to it: `"parallel"`, `"circular"`, `"radial"` or `"spun"`. `jitter_deg` is the standard deviation
    /// of a groove's angle to the pattern.
    #[serde(flatten)]
    pub pattern: Pattern,
    /// From one groove to the next. From 0.3 to 50. Required.
    pub pitch_um: f64,
    /// Width of a groove, at most the pitch. Default: 0.4 of the pitch.
    pub width_um: f64,
    /// Normal; the spread is a share of the mean. Default: mean 120, spread 0.
    pub depth_nm: Distribution,
    /// Standard deviation of how far a groove is off its place. At most the pitch. Default: 0.
    pub jitter_um: f64,
    /// Which grooves are off their places by how much, where they are seen one by one. Default: 1.
    pub seed: u64,
    /// The share of the surface that the grooves cover. In [0, 1]. Default: 1.
    pub coverage: f64,
    /// The least and the greatest distance from the pattern's axis; for `"parallel"`, from `center_m`. Default: everywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<[f64; 2]>,
    /// For `"parallel"` what `radius_m` is counted from, in the object's frame. Default: its origin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center_m: Option<[f64; 3]>,
}

/// Depths where a grating does not say them.
const DEFAULT_DEPTH_NM: Distribution = Distribution {
    mean: 120.0,
    spread: 0.0,
};

/// Widths where a grating does not say them, as shares of the pitch.
const DEFAULT_FILL: f64 = 0.4;

impl Grating {
    /// Grooves everywhere on an object, all alike, of the default width and depth.
    pub fn new(object: impl Into<String>, pattern: Pattern, pitch_um: f64) -> Self {
        Self {
            object: object.into(),
            name: None,
            hidden: false,
            pattern,
            pitch_um,
            width_um: DEFAULT_FILL * pitch_um,
            depth_nm: DEFAULT_DEPTH_NM,
            jitter_um: 0.0,
            seed: DEFAULT_SEED,
            coverage: 1.0,
            radius_m: None,
            center_m: None,
        }
    }

    /// The pattern's axis, if it has one.
    pub fn around(&self) -> Option<&Around> {
        match &self.pattern {
            Pattern::Circular(around) | Pattern::Radial(around) | Pattern::Spun { around, .. } => {
                Some(around)
            }
            Pattern::Parallel { .. } | Pattern::Random { .. } | Pattern::Swirl { .. } => None,
        }
    }

    /// Refuses values out of range.
    pub(super) fn check_at(&self, key: &str) -> Check {
        self.pattern.check_at(key)?;
        if let Pattern::Random { .. } | Pattern::Swirl { .. } = self.pattern {
            return Err(Error::new(
                format!("{key}.pattern"),
                "found a pattern whose scratches cross one another",
                "must be `parallel`, `circular`, `radial` or `spun`",
            ));
        }
        if let Pattern::Spun {
            curvature_per_m, ..
        } = &self.pattern
            && curvature_per_m.spread != 0.0
        {
            return Err(Error::new(
                format!("{key}.curvature_per_m.spread"),
                "found arcs that cross one another",
                "must be 0: the grooves of a grating run side by side",
            ));
        }
        within(&format!("{key}.pitch_um"), self.pitch_um, limits::PITCH_UM)?;
        let width = format!("{key}.width_um");
        positive(&width, self.width_um)?;
        within(&width, self.width_um, 0.0..=self.pitch_um)?;
        let Distribution { mean, spread } = self.depth_nm;
        let depth = format!("{key}.depth_nm");
        within(&depth, mean, limits::SCRATCH_DEPTH_NM)?;
        within(
            &format!("{depth}.spread"),
            spread,
            limits::GRATING_DEPTH_SPREAD,
        )?;
        within(
            &format!("{key}.jitter_um"),
            self.jitter_um,
            0.0..=self.pitch_um,
        )?;
        check_seed(self.seed, key)?;
        within(&format!("{key}.coverage"), self.coverage, limits::COVERAGE)?;
        let radius = format!("{key}.radius_m");
        let Some([least, most]) = self.radius_m else {
            let Some(_) = self.center_m else {
                return Ok(());
            };
            return Err(Error::new(
                format!("{key}.center_m"),
                "found a middle for distances that are not there",
                "belongs to `radius_m`",
            ));
        };
        if let Some(center_m) = self.center_m {
            for (i, value) in center_m.into_iter().enumerate() {
                within(&format!("{key}.center_m[{i}]"), value, limits::COORDINATE_M)?;
            }
        }
        within(&format!("{radius}[0]"), least, limits::PROFILE_RADIUS_M)?;
        within(&format!("{radius}[1]"), most, limits::PROFILE_RADIUS_M)?;
        if least >= most {
            return Err(Error::new(
                radius,
                format!("found {least} and {most}"),
                "the second must be the greater one",
            ));
        }
        Ok(())
    }
}

impl Read for Grating {
    fn read(value: &Value, key: &str) -> Result<Self, Error> {
        const AROUND: [&str; 3] = ["axis", "center_m", "jitter_deg"];
        let (pattern, table) = Table::read_kind(
            value,
            key,
            "pattern",
            &[
                "object",
                "pattern",
                "name",
                "hidden",
                "pitch_um",
                "width_um",
                "depth_nm",
                "jitter_um",
                "seed",
                "coverage",
                "radius_m",
            ],
            &[
                ("parallel", &["direction", "jitter_deg", "center_m"]),
                ("circular", &AROUND),
                ("radial", &AROUND),
                ("spun", &[&AROUND[..], &["curvature_per_m"]].concat()),
            ],
        )?;
        let pattern = match pattern {
            "parallel" => Pattern::Parallel {
                direction: table.or("direction", [1.0, 0.0, 0.0])?,
                jitter_deg: table.or("jitter_deg", 0.0)?,
            },
            "circular" => Pattern::Circular(around(&table)?),
            "radial" => Pattern::Radial(around(&table)?),
            _ => Pattern::Spun {
                around: around(&table)?,
                curvature_per_m: table.or(
                    "curvature_per_m",
                    Distribution {
                        mean: 20.0,
                        spread: 0.0,
                    },
                )?,
            },
        };
        let is_parallel = matches!(pattern, Pattern::Parallel { .. });
        let default = Self::new(
            table.required::<String>("object")?,
            pattern,
            table.required("pitch_um")?,
        );
        Ok(Self {
            name: table.optional("name")?,
            hidden: table.or("hidden", false)?,
            width_um: table.or("width_um", default.width_um)?,
            depth_nm: table.or("depth_nm", default.depth_nm)?,
            jitter_um: table.or("jitter_um", default.jitter_um)?,
            seed: table.or("seed", default.seed)?,
            coverage: table.or("coverage", default.coverage)?,
            radius_m: table.optional("radius_m")?,
            center_m: match is_parallel {
                true => table.optional("center_m")?,
                false => None,
            },
            ..default
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Description, Scene};

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
        let disc = Grating::new("o", Pattern::Circular(Around::default()), 1.6);
        assert_eq!(described.gratings, [disc]);
        let all = "object = \"o\"\nname = \"n\"\nhidden = true\npattern = \"spun\"\naxis = [0, 1, 0]\n\
            center_m = [0, 0, 0.1]\njitter_deg = 2.0\ncurvature_per_m = 10.0\npitch_um = 3.0\nwidth_um = 1.0\n\
            depth_nm = { mean = 200.0, spread = 0.2 }\njitter_um = 0.1\nseed = 9\ncoverage = 0.5\nradius_m = [0.01, 0.05]\n";
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
                format!("{DISC}direction = [1, 0, 0]"),
                "test:8: grating[0].direction: pattern `circular` has no such key; it belongs to `parallel`",
            ),
        ] {
            let error = Scene::from_toml(&text(&grating), "test", ".").unwrap_err();
            assert_eq!(error.to_string(), expected, "{grating}");
        }
    }
}
