//! Bounds on the directions to a light.

use glam::DVec3;

/// Directions within an angle of an axis: `cos` and `sin` are that angle's, from 0 (one direction) to pi (all).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    /// Unit vector.
    pub axis: DVec3,
    pub cos: f64,
    pub sin: f64,
}

/// Bounds are widened by this much (of a cosine or a component), which covers the rounding of unit vectors many times over.
pub(super) const BOUND_SLACK: f64 = 1e-12;

impl Cone {
    /// Every direction.
    pub const WHOLE: Self = Self {
        axis: DVec3::Z,
        cos: -1.0,
        sin: 0.0,
    };

    /// The least and the greatest component along a unit `axis` of the directions in the cone.
    pub fn extent(&self, axis: DVec3) -> (f64, f64) {
        // The axes' angle; its sine by the cross product, which keeps its digits where the axes nearly agree.
        let cos = self.axis.dot(axis);
        let sin = self.axis.cross(axis).length();
        let low = if cos <= -self.cos {
            -1.0
        } else {
            cos * self.cos - sin * self.sin
        };
        let high = if cos >= self.cos {
            1.0
        } else {
            cos * self.cos + sin * self.sin
        };
        widened(low, high)
    }
}

/// Bounds of a component, widened by [`BOUND_SLACK`].
pub(super) fn widened(low: f64, high: f64) -> (f64, f64) {
    ((low - BOUND_SLACK).max(-1.0), (high + BOUND_SLACK).min(1.0))
}
