//! The table of the talk (Z. Velinov, S. Werner, M. Hullin, *Real-Time Rendering of Wave-Optical Effects on Scratched Surfaces*,
//! Eurographics 2018, slide "Data Structure (Benchmark)"): milliseconds on an NVIDIA GTX 970M.

use super::figures::Row;
use super::way::Way;

/// Source of the figures.
pub const SOURCE: &str = "Velinov, Werner, Hullin, Eurographics 2018, slide \"Data Structure (Benchmark)\", NVIDIA GTX 970M";

/// The zooms of the columns.
pub const ZOOMS: [f64; 3] = [0.5, 1.0, 2.0];

/// Figure of the talk, in milliseconds; none where it gives nothing.
pub fn talk_ms(row: Row, zoom: f64, way: Way) -> Option<f64> {
    let at = ZOOMS.iter().position(|z| *z == zoom)?;
    let [bvh, lists, filtered] = match row {
        Row::Intersection => [[4.1, 4.4, 5.5], [2.9, 3.5, 3.8], [18.1, 17.5, 15.5]],
        Row::Sphere => [[4.5, 6.3, 12.8], [3.9, 4.7, 8.0], [27.3, 31.7, 36.3]],
        Row::Triangle => [[13.9, 26.5, 60.6], [12.5, 21.1, 43.4], [48.5, 60.3, 94.1]],
        Row::Scene => return None,
    };
    match way {
        Way::PointBvh => Some(bvh[at]),
        Way::PointLists => Some(lists[at]),
        Way::Filtered => Some(filtered[at]),
        Way::FilteredExact | Way::Ours => None,
    }
}
