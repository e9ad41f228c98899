//! The table of the talk (Z. Velinov, S. Werner, M. Hullin, *Real-Time Rendering of Wave-Optical Effects on Scratched Surfaces*,
//! Eurographics 2018, slide "Data Structure (Benchmark)"): milliseconds on an NVIDIA GTX 970M.

use super::figures::TableRow;
use super::methods::BenchMethod;

/// Source of the figures.
pub const SOURCE: &str = "Velinov, Werner, Hullin, Eurographics 2018, slide \"Data Structure (Benchmark)\", NVIDIA GTX 970M";

/// The zooms of the columns.
pub const ZOOMS: [f64; 3] = [0.5, 1.0, 2.0];

/// Figure of the talk, in milliseconds; none where it gives nothing.
pub fn talk_ms(row: TableRow, zoom: f64, method: BenchMethod) -> Option<f64> {
    let at = ZOOMS.iter().position(|z| *z == zoom)?;
    let [bvh, lists, filtered] = match row {
        TableRow::Intersection => [[4.1, 4.4, 5.5], [2.9, 3.5, 3.8], [18.1, 17.5, 15.5]],
        TableRow::Sphere => [[4.5, 6.3, 12.8], [3.9, 4.7, 8.0], [27.3, 31.7, 36.3]],
        TableRow::Triangle => [[13.9, 26.5, 60.6], [12.5, 21.1, 43.4], [48.5, 60.3, 94.1]],
        TableRow::Scene => return None,
    };
    match method {
        BenchMethod::PointBvh => Some(bvh[at]),
        BenchMethod::PointLists => Some(lists[at]),
        BenchMethod::Filtered => Some(filtered[at]),
        BenchMethod::FilteredExact | BenchMethod::Ours => None,
    }
}
