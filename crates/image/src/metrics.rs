//! Differences of one image from another, and tests whether noise explains them.
//!
//! Everywhere the second image is the reference. Values that are not finite in either image are left out, and counted
//! by [`Difference`].

mod blocks;
mod compare;
mod difference;
mod error_map;
mod estimate;
mod flip;
mod metric;
mod noise;
mod psnr;
mod relative;
mod silhouettes;
mod stability;
mod z_test;

pub use compare::{Comparison, LayerComparison, Problem, Side, compare};
pub use difference::{Difference, layer_difference};
pub use error_map::{ErrorMap, error_map, magma};
pub use estimate::Estimate;
pub use flip::{Flip, flip};
pub use metric::Metric;
pub use noise::BeyondNoise;
pub use psnr::{Psnr, psnr_displayed, psnr_of_values};
pub use relative::relative_mse;
pub use silhouettes::away_from_silhouettes;
pub use stability::Stability;
pub use z_test::{Verdict, ZTest};
