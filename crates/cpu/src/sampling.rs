//! Random directions towards lights and into an environment, for shadow rays and for the Monte Carlo renderer.

pub mod environment;
pub mod lights;

use glam::DVec3;

/// Rec.709 luminance.
#[inline]
pub(crate) fn luminance(rgb: DVec3) -> f64 {
    rgb.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}
