//! A sphere as seen from a point: a cone of directions, or all of them from inside.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::bound::{BOUND_SLACK, Cone};

#[derive(Clone, Copy, Debug)]
pub(super) struct SphereLight {
    center_m: DVec3,
    radius_m: f64,
}

impl SphereLight {
    pub fn new(center_m: DVec3, radius_m: f64) -> Self {
        Self { center_m, radius_m }
    }

    /// 1 - cos of the cone's half angle; `None` from inside. Written so that small cones keep their digits.
    fn versine(&self, from: DVec3) -> Option<f64> {
        let sin = self.radius_m / self.center_m.distance(from);
        // Points at the surface and inside, also at the distance 0.
        if !(sin < 1.0) {
            return None;
        }
        let sin2 = sin * sin;
        Some(sin2 / (1.0 + (1.0 - sin2).sqrt()))
    }

    /// (direction, distance, density)
    pub fn sample(&self, from: DVec3, u: DVec2) -> Option<(DVec3, f64, f64)> {
        // The sphere of all directions is the cone whose half angle is pi.
        let versine = self.versine(from);
        let range = versine.unwrap_or(2.0);
        let axis = match versine {
            Some(_) => (self.center_m - from).normalize(),
            None => DVec3::Z,
        };
        let v = u.x * range;
        let sin = (v * (2.0 - v)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
        let (x, y) = axis.any_orthonormal_pair();
        let direction = axis * (1.0 - v) + (x * cos_phi + y * sin_phi) * sin;
        Some((
            direction,
            // Rounding may take a direction at the limb past it; there the ray touches.
            self.distance_m(from, direction).1,
            1.0 / (2.0 * PI * range),
        ))
    }

    pub fn hit(&self, from: DVec3, direction: DVec3) -> Option<f64> {
        let (meets, distance_m) = self.distance_m(from, direction);
        meets.then_some(distance_m)
    }

    /// Whether a ray meets the sphere, and where it does first, or where it passes nearest.
    pub fn distance_m(&self, from: DVec3, direction: DVec3) -> (bool, f64) {
        let to_center = self.center_m - from;
        let along = to_center.dot(direction);
        // The cross product, and not the difference of squares, which cancels for far spheres.
        let beside2 = to_center.cross(direction).length_squared();
        let half_chord2 = self.radius_m * self.radius_m - beside2;
        let half_chord = half_chord2.max(0.0).sqrt();
        let distance = to_center.length();
        if distance <= self.radius_m {
            return (true, (along + half_chord).max(0.0));
        }
        let tangent2 = (distance - self.radius_m) * (distance + self.radius_m);
        let first = tangent2 / (along + half_chord).max(f64::MIN_POSITIVE);
        (half_chord2 >= 0.0 && along > 0.0, first)
    }

    pub fn pdf(&self, from: DVec3) -> f64 {
        1.0 / (2.0 * PI * self.versine(from).unwrap_or(2.0))
    }

    pub fn bound(&self, from: DVec3) -> Cone {
        match self.versine(from) {
            Some(versine) => Cone {
                axis: (self.center_m - from).normalize(),
                cos: 1.0 - versine - BOUND_SLACK,
                sin: (self.radius_m / self.center_m.distance(from) + BOUND_SLACK).min(1.0),
            },
            None => Cone::WHOLE,
        }
    }
}
