//! Figures of a benchmark, as they go into the JSON file. The document is made of this alone.

use hairline_cpu::closed_form::Counts;
use serde::Serialize;

use super::machine::Machine;
use super::methods::BenchMethod;

/// All figures of a benchmark.
#[derive(Serialize)]
pub struct Figures {
    pub hairline: &'static str,
    pub machine: Machine,
    /// Name of the scene: that of its file, or "bench scene".
    pub scene: String,
    pub size_px: [u32; 2],
    pub scratches: u32,
    pub quick: bool,
    /// Source of `talk_ms`.
    pub talk: &'static str,
    pub table: Vec<Cell>,
    pub curves: Vec<Curve>,
}

hairline_image::listed! {
    /// A row of the table.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "lowercase")]
    pub enum TableRow {
        /// No light.
        Intersection = "Intersection only";
        Sphere = "Sphere";
        Triangle = "Triangle";
        /// A scene that somebody else made.
        Scene = "Scene";
    }
    fn name;
}

impl TableRow {
    /// The rows of the talk.
    pub const TALK: [Self; 3] = [Self::Intersection, Self::Sphere, Self::Triangle];
}

/// One cell of the table by one method.
#[derive(Serialize)]
pub struct Cell {
    pub row: TableRow,
    pub zoom: f64,
    pub way: BenchMethod,
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Error of the picture; none where nothing is lit.
    pub error: Option<CellError>,
    /// Figure of the talk for the published method.
    pub talk_ms: Option<f64>,
    /// Counts of the work for the picture; of our method alone.
    pub counts: Option<Counts>,
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

/// Time of a picture, in milliseconds.
#[derive(Clone, Debug, Serialize)]
pub struct Timing {
    /// Time from the call to the end of the wait.
    pub wall_ms: Spread,
    /// Time of all passes by the device's own clock; None where it has none.
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
    /// Spread of at least one value.
    pub fn from_values(values: &[f64]) -> Self {
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

/// Error of the scratches of a crop against the separable Monte Carlo reference.
#[derive(Clone, Debug, Serialize)]
pub struct CellError {
    /// Root of the mean squared difference beyond the noise, over the reference's root mean square.
    pub relative_rms: f64,
    /// Standard error from the reference's noise.
    pub standard_error: f64,
    /// Mean of the picture over mean of the reference.
    pub mean_ratio: f64,
    pub crop_px: [u32; 2],
    /// Samples a pixel of the reference.
    pub samples: u32,
}

/// A series of measurements along one quantity.
#[derive(Serialize)]
pub struct Curve {
    /// "scratches", "zoom", "lights" or "pixels".
    pub along: &'static str,
    pub points: Vec<Point>,
}

/// A point of a curve.
#[derive(Serialize)]
pub struct Point {
    /// Scratches, zoom, lights, or pixels.
    pub x: f64,
    pub way: BenchMethod,
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Counts of the work for the picture; of our method alone.
    pub counts: Option<Counts>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_median_and_quartiles() {
        let spread = Spread::from_values(&[5.0, 1.0, 2.0, 4.0, 3.0]);
        assert_eq!((spread.median, spread.quartiles), (3.0, [2.0, 4.0]));
        let even = Spread::from_values(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!((even.median, even.quartiles), (2.5, [1.75, 3.25]));
        let one = Spread::from_values(&[7.0]);
        assert_eq!((one.median, one.quartiles), (7.0, [7.0; 2]));
    }
}
