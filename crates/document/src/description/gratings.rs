//! The `[[grating]]` tables of a scene file.

use std::path::PathBuf;

use hairline_keys::Keyed;
use hairline_optics::scratch::DEPTH_MAX_NM;
use toml::de::DeValue;

use super::distribution::Distribution;
use super::keyed::Keyed;
use super::laid::{Pattern, PatternAxis};
use super::place::{MIDDLE, RADII, TILE};
use super::ranges::{Check, check_radii};
use super::table::Table;
use super::toml_value::{Read, Value};
use super::values::named;
use crate::error::Error;
use crate::schema::{Bounds, Entry};

/// `[[grating]]`: grooves side by side, nearer to one another than a pixel can show. They interfere, as those of a compact disc do.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(own_reader, kinds = GroovePattern, of_kinds = OF_KINDS, check = Grating::check_companions)]
pub struct Grating {
    /// What they cover.
    #[key(range_words("name of an object"))]
    pub object: String,
    /// For you to know it by.
    #[key(none().range_words("any text"))]
    pub name: Option<String>,
    /// As if it were not there.
    #[key(flag(false).omitted().labelled("Hidden", "As if the grating were not there at all."))]
    pub hidden: bool,
    /// `pattern` and the keys that belong to it.
    #[flat]
    pub pattern: GroovePattern,
    /// From one groove to the next: how far apart the orders are. 1.6 is a compact disc, 0.74 a DVD, 30 turned steel.
    #[key(unit("µm").in_range(0.3, 50.0)
        .control("Pitch", log(0.4, 50.0), "From one groove to the next. Fine rows throw wide rainbows far out, coarse ones narrow rainbows close to the highlight. Disc 1.6, DVD 0.74, turned steel 30."))]
    pub pitch_um: f64,
    /// Width of each groove: how bright the further orders are.
    #[key(unit("µm").words("0.4 of the pitch").above_0(50.0).range_words("above 0, up to the pitch")
        .control("Groove width", log(0.1, 20.0), "How much of the pitch is groove. Half of it gives the brightest first order and no second one; narrow grooves send more light to far orders."))]
    #[read(width_um)]
    pub width_um: f64,
    /// Depth: how much light goes into orders, and which colours. Normal; the spread is a share of the mean.
    #[key(unit("nm").number(120.0).in_range(0.0, DEPTH_MAX_NM).range_words("mean 0 to 2000, spread 0 to 1")
        .control("Depth", linear(20.0, 600.0), "Picks the overall tint, also close to the highlight: each depth favours some wavelengths and cancels others. Very shallow scratches are faint and bluish. Seen or lit aslant they act shallower, so tints shift as things turn.")
        .second("Depth spread", linear(0.0, 0.5), Bounds::Within(0.0, 1.0), "", "How much the depths of grooves differ, as a share of the mean. It weakens the rainbows and adds a white sheen that single grooves send."))]
    pub depth_nm: Distribution,
    /// Standard deviation of how far a groove is off its place. A tenth of the pitch leaves the first order two thirds of its light; a quarter turns
    /// rows into so many single scratches.
    #[key(unit("µm").number(0.0).in_range(0.0, 50.0).range_words("0 to the pitch")
        .control("Displacement", linear(0.0, 5.0), "How far grooves are off their places. A tenth of the pitch keeps two thirds of the first rainbow; at a quarter all grooves shine for themselves."))]
    pub jitter_um: f64,
    /// How bright the orders of a pitch below 4 µm are. `"rigorous"` solves Maxwell's equations in the grooves for both polarisations, by the
    /// refractive index of the metal (of aluminium where a colour stands for one) or of the plastic. That takes about ten seconds for a grating,
    /// once: the result is kept in the user's folder for caches. `"scalar"` is the simpler theory that wider grooves have, to compare with. Mirrors
    /// and what lies in a clear coat are scalar always.
    #[key(text("rigorous").omitted())]
    pub theory: GratingTheory,
    /// Which groove is off its place by how much, where grooves are seen one by one.
    #[key(number(1.0).at_least_0().range_words("whole, below 2^63")
        .control("Seed", linear(0.0, 1000.0), "Another number lays other scratches of the same kind, or puts the grooves of a grating in other places, as seen from nearby. Layers with different numbers do not repeat one another."))]
    pub seed: u64,
    /// The share of the surface that the grooves cover.
    #[key(number(1.0).in_range(0.0, 1.0)
        .control("Coverage", linear(0.0, 1.0), "The share of the surface that the grooves cover. The rest mirrors as the material does."))]
    pub coverage: f64,
    /// A picture whose values, from 0 (black) to 1 (white), are factors on the coverage: a motif in foil. From afar it is its mean over a pixel.
    #[key(none().range_words("as `directions`"))]
    pub mask: Option<PathBuf>,
    /// The mask is laid on the object along its own three axes, repeated, so wide; as in [`where`](#where) of scratches.
    #[key(like(&TILE).range_words("1e-5 to 1000; with `mask`"))]
    pub tile_m: Option<f64>,
    /// The least and the greatest distance from the axis: grooves inside of a circle, outside of one, or in a ring. For `"parallel"` and `"uv"`, from
    /// `center_m`.
    #[key(like(&RADII)
        .control("Inner radius", linear(0.0, 1.0).sized(), "There are no grooves nearer to the middle than this.")
        .second("Outer radius", linear(0.0, 1.0).sized(), Bounds::Within(0.0, LARGEST_M), "m", "There are no grooves farther from the middle than this."))]
    pub radius_m: Option<[f64; 2]>,
    /// For `"parallel"` and `"uv"`, with `radius_m`: the middle of the ball that holds them. The other patterns have theirs.
    #[key(like(&MIDDLE).words("origin"))]
    #[of_kinds]
    #[read(center_m)]
    pub center_m: Option<[f64; 3]>,
}

/// `pattern` of a `[[grating]]`: those of scratches whose rows do not cross one another.
#[derive(Clone, Debug, PartialEq, Keyed)]
#[keyed(tag = "pattern")]
pub enum GroovePattern {
    /// All along one direction.
    #[kind("parallel")]
    Parallel {
        /// As of scratches.
        #[key(= Pattern::DIRECTION)]
        direction: [f64; 3],
        /// Standard deviation of a groove's angle to the pattern: streaks become fans.
        #[key(unit("°").number(0.0).in_range(0.0, 90.0)
            .control("Angles", linear(0.0, 10.0), "How far grooves stray from the pattern's direction. 0 gives lines of light with hard edges; a degree or more makes soft fans of them."))]
        jitter_deg: f64,
    },
    /// Around an axis.
    #[kind("circular")]
    Circular(#[flat(AROUND)] PatternAxis),
    /// Away from an axis.
    #[kind("radial")]
    Radial(#[flat(AROUND)] PatternAxis),
    /// Arcs of one curvature that leave the axis in all directions.
    #[kind("spun")]
    Spun {
        /// The axis.
        #[flat(AROUND)]
        around: PatternAxis,
        /// One over the radius of the arcs; its sign is the sense of the spiral.
        #[key(unit("1/m").number(20.0).in_range(-1e4, 1e4)
            .control("Curvature", linear(-50.0, 50.0).sized_by(-1), "One over the radius of the arcs. 0 is straight. Bent scratches turn through many directions, so each lights up over a shorter piece, and more of them light up at once."))]
        curvature_per_m: f64,
    },
    /// Around the middles of spots in rows, each over those before it: engine turning. The axis is that along which they are pressed into the surface.
    #[kind("swirl")]
    Swirl {
        /// The axis. It passes through the middle of one of the spots.
        #[flat(AROUND)]
        around: PatternAxis,
        /// From spot to spot, and from row to row. Metres of the world, whatever the object's `scale`. The radius of a spot is 0.75 of it. Where
        /// spots are smaller than a pixel, it shows the mean of all their directions.
        #[key(unit("m").number(0.004).size()
            .control("Spacing", log(0.01, 0.5).sized(), "From one spot of grooves to the next. Each spot lies over those before it, so rows look like scales; lamps draw a line through each."))]
        spacing_m: f64,
    },
    /// Along the texture coordinates of the surface.
    #[kind("uv")]
    Uv {
        /// Along which texture coordinate they run.
        #[key(text("u").omitted())]
        along: UvAxis,
        /// A picture, relative to the scene file, that turns them, as anisotropy textures of glTF do: red is the part along the coordinate, green
        /// that up across it, from -1 (code 0) to 1 (code 255). Middle grey of both is no direction: no grooves.
        #[key(none().range_words("`.png`, `.jpg`, `.webp`"))]
        directions: Option<PathBuf>,
        /// As along one direction.
        jitter_deg: f64,
    },
}

/// The key of patterns without an axis.
const OF_KINDS: &[(&str, &[Entry])] = &[
    ("parallel", &[Entry::Key(Grating::CENTER_M)]),
    ("uv", &[Entry::Key(Grating::CENTER_M)]),
];

/// The keys of an axis, of which a grating's angle says its own.
const AROUND: &[Entry] = &[
    Entry::Key(PatternAxis::AXIS),
    Entry::Key(PatternAxis::CENTER_M),
    Entry::Key(GroovePattern::JITTER_DEG),
];

/// Theory of the brightness of orders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GratingTheory {
    /// `"rigorous"`: the whole field of both polarisations in the grooves, by the material's refractive index.
    #[default]
    Rigorous,
    /// `"scalar"`: floors that shift the phase of one wave, as of wide grooves.
    Scalar,
}

named! { GratingTheory {
    "rigorous" => Rigorous,
    "scalar" => Scalar,
} }

/// A texture coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UvAxis {
    /// The first.
    #[default]
    U,
    /// The second.
    V,
}

named! { UvAxis {
    "u" => U,
    "v" => V,
} }

impl GroovePattern {
    /// The axis, if it has one.
    pub fn axis(&self) -> Option<&PatternAxis> {
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
            depth_nm: Self::DEPTH_NM.initial(),
            jitter_um: Self::JITTER_UM.initial(),
            theory: GratingTheory::default(),
            seed: Self::SEED.initial(),
            coverage: Self::COVERAGE.initial(),
            mask: None,
            tile_m: None,
            radius_m: None,
            center_m: None,
        }
    }

    /// Refuses grooves wider than their pitch, and keys without what they belong to.
    fn check_companions(&self, key: &str) -> Check {
        let up_to_the_pitch = |name: &str, value: f64| {
            Bounds::Within(0.0, self.pitch_um).check(&format!("{key}.{name}"), value)
        };
        up_to_the_pitch(Self::WIDTH_UM.name, self.width_um)?;
        up_to_the_pitch(Self::JITTER_UM.name, self.jitter_um)?;
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
        check_radii(Self::RADIUS_M, key, self.radius_m)
    }
}

/// The width of grooves that do not say it depends on their pitch.
fn width_um(table: &Table) -> Result<f64, Error> {
    let pitch_um: f64 = table.value(Grating::PITCH_UM)?;
    table.or(Grating::WIDTH_UM.name, DEFAULT_FILL * pitch_um)
}

/// The middle of a pattern without an axis; the others have one in `pattern`.
fn center_m(table: &Table) -> Result<Option<[f64; 3]>, Error> {
    match table.kind() {
        "parallel" | "uv" => table.value(Grating::CENTER_M),
        _ => Ok(None),
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
        Self::read_keys(&Table::of_kind(Self::KEYS, &Self::KINDS, value, key)?)
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
        let disc = Grating::new("o", GroovePattern::Circular(PatternAxis::default()), 1.6);
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
                "test:8: grating[0].spacing_m: found 0; must be from 1e-5 to 1000",
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
