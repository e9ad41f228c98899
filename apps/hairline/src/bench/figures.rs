//! What was measured, as it goes into the JSON file. Table, report and plots are made of this alone.

use hairline_optics::method::{Lookup, Method, PixelFilter};
use serde::Serialize;

use super::counts::Counts;
use super::machine::Machine;
use crate::method_flags::flags_of;

/// All of a benchmark.
#[derive(Serialize)]
pub struct Figures {
    pub hairline: &'static str,
    pub machine: Machine,
    /// The flags of what is held against the published method; empty for the default.
    pub ours: String,
    /// What was measured: the scene file's name, or "bench scene".
    pub scene: String,
    pub size_px: [u32; 2],
    pub scratches: u32,
    pub quick: bool,
    /// Where `talk_ms` is from.
    pub talk: &'static str,
    pub table: Vec<Cell>,
    pub scaling: Vec<Curve>,
    pub counts: Vec<Counts>,
    /// None where it was not asked for.
    pub off: Option<Off>,
}

/// The disk without scratches, and with one that cannot be seen.
#[derive(Serialize)]
pub struct Off {
    pub none: Outcome,
    /// The same once more.
    pub again: Outcome,
    pub one: Outcome,
    /// Turn by turn; None where one of them was refused.
    pub again_over_none: Option<Spread>,
    pub one_over_none: Option<Spread>,
}

impl Off {
    /// Each with its name and its time over that without scratches.
    pub fn lines(&self) -> [(&'static str, &Outcome, Option<Spread>); 3] {
        [
            ("without scratches", &self.none, None),
            (
                "without scratches, again",
                &self.again,
                self.again_over_none,
            ),
            ("with one of no depth", &self.one, self.one_over_none),
        ]
    }
}

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Row {
    /// No light.
    Intersection,
    Sphere,
    Triangle,
    /// A scene that somebody else made.
    Scene,
}

impl Row {
    /// The rows of the talk.
    pub const TALK: [Self; 3] = [Self::Intersection, Self::Sphere, Self::Triangle];

    pub fn name(self) -> &'static str {
        match self {
            Self::Intersection => "intersection only",
            Self::Sphere => "sphere",
            Self::Triangle => "triangle",
            Self::Scene => "scene",
        }
    }
}

/// Three columns of the talk's table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// Without anti-aliasing, by the hierarchy.
    PointBvh,
    /// Without anti-aliasing, by lists for each triangle.
    PointTriangles,
    /// With anti-aliasing, by the hierarchy.
    Filtered,
}

impl Columns {
    pub const ALL: [Self; 3] = [Self::PointBvh, Self::PointTriangles, Self::Filtered];

    pub fn name(self) -> &'static str {
        match self {
            Self::PointBvh => "AA off, BVH",
            Self::PointTriangles => "AA off, per triangle",
            Self::Filtered => "AA on, BVH",
        }
    }

    pub fn antialiasing(self) -> bool {
        self == Self::Filtered
    }

    pub fn published_lookup(self) -> Lookup {
        match self {
            Self::PointTriangles => Lookup::Triangles,
            Self::PointBvh | Self::Filtered => Lookup::Bvh,
        }
    }
}

/// Whose method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Whose {
    Published,
    Ours,
    /// Ours, with each scratch's light worked out at each pixel.
    AtPixels,
    /// Ours, with grids for what many scratches add up to.
    Grids,
}

impl Whose {
    /// In tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Published => "published",
            Self::Ours => "ours",
            Self::AtPixels => "ours at pixels",
            Self::Grids => "grids",
        }
    }
}

/// One method's way through one cell of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    pub whose: Whose,
    pub method: Method,
}

impl Way {
    pub fn antialiasing(&self) -> bool {
        self.method.footprint != PixelFilter::Off
    }

    pub fn lookup(&self) -> &'static str {
        match self.method.lookup {
            Lookup::Tiles => "tiles",
            Lookup::Bvh => "bvh",
            Lookup::Triangles => "triangles",
        }
    }
}

/// One cell of the table by one method.
#[derive(Serialize)]
pub struct Cell {
    pub row: Row,
    pub zoom: f64,
    pub antialiasing: bool,
    /// "tiles", "bvh" or "triangles".
    pub lookup: &'static str,
    pub method: Whose,
    /// That `hairline render` would be given.
    pub flags: String,
    #[serde(flatten)]
    pub outcome: Outcome,
    /// None where nothing is lit, and where it was not asked for.
    pub error: Option<CellError>,
    /// What the talk gives for the published method.
    pub talk_ms: Option<f64>,
}

impl Cell {
    pub fn new(row: Row, zoom: f64, way: &Way, outcome: Outcome, talk_ms: Option<f64>) -> Self {
        Self {
            row,
            zoom,
            antialiasing: way.antialiasing(),
            lookup: way.lookup(),
            method: way.whose,
            flags: flags_of(&way.method),
            outcome,
            error: None,
            talk_ms,
        }
    }
}

/// A time, or why there is none.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    Timing(Timing),
    Refused(String),
}

impl Outcome {
    /// Milliseconds a picture: the device's own clock's where it has one.
    pub fn ms(&self) -> Option<Spread> {
        match self {
            Self::Timing(timing) => Some(timing.device_ms.unwrap_or(timing.wall_ms)),
            Self::Refused(_) => None,
        }
    }

    /// Whether the time is that of some rows, scaled.
    pub fn scaled(&self) -> bool {
        matches!(self, Self::Timing(timing) if timing.rows < timing.of_rows)
    }
}

/// How long a picture takes, in milliseconds.
#[derive(Clone, Debug, Serialize)]
pub struct Timing {
    /// From the call to the end of the wait.
    pub wall_ms: Spread,
    /// By the device's own clock, all passes; None where it has none.
    pub device_ms: Option<Spread>,
    /// The median of each pass.
    pub passes_ms: Vec<(&'static str, f64)>,
    pub repetitions: usize,
    /// Rows that were rendered, in strips spread evenly over the picture; where they are fewer than it has, the times are
    /// scaled to all.
    pub rows: u32,
    pub of_rows: u32,
}

/// A median and the quartiles around it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    pub median: f64,
    pub quartiles: [f64; 2],
}

impl Spread {
    /// Of at least one value.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = share * sorted.len().saturating_sub(1) as f64;
            let (low, part) = (place.floor() as usize, place.fract());
            let value = |i: usize| sorted.get(i).or(sorted.last()).copied().unwrap_or(0.0);
            value(low) + part * (value(low + 1) - value(low))
        };
        Self {
            median: at(0.5),
            quartiles: [at(0.25), at(0.75)],
        }
    }
}

/// How far the scratches of a crop are from the separable Monte Carlo reference.
#[derive(Clone, Debug, Serialize)]
pub struct CellError {
    /// Root of the mean squared difference beyond the noise, over the reference's root mean square.
    pub relative_rms: f64,
    /// What the reference's noise leaves open of it.
    pub standard_error: f64,
    /// Mean of the picture over mean of the reference.
    pub mean_ratio: f64,
    pub crop_px: [u32; 2],
    /// Samples a pixel of the reference.
    pub samples: u32,
}

/// A series of measurements along one quantity, for both methods.
#[derive(Serialize)]
pub struct Curve {
    /// "scratches", "zoom", "lights" or "resolution".
    pub along: &'static str,
    pub points: Vec<Point>,
}

/// One of them.
#[derive(Serialize)]
pub struct Point {
    /// Scratches, zoom, lights, or pixels.
    pub x: f64,
    pub method: Whose,
    pub antialiasing: bool,
    #[serde(flatten)]
    pub outcome: Outcome,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_median_and_quartiles() {
        let spread = Spread::of(&[5.0, 1.0, 2.0, 4.0, 3.0]);
        assert_eq!((spread.median, spread.quartiles), (3.0, [2.0, 4.0]));
        let even = Spread::of(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!((even.median, even.quartiles), (2.5, [1.75, 3.25]));
        let one = Spread::of(&[7.0]);
        assert_eq!((one.median, one.quartiles), (7.0, [7.0; 2]));
    }
}
