//! Area lights.

use glam::DVec3;

/// An area light. `radiance` is linear Rec.709, W sr^-1 m^-2 in effect: (1, 1, 1) has the spectrum of D65.
#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// A sphere.
    Sphere {
        /// World space.
        center_m: DVec3,
        /// Radius, positive.
        radius_m: f64,
        /// Emitted radiance.
        radiance: [f64; 3],
    },
    /// A planar polygon, simple, convex or not; it shines to the side that sees the vertices counter-clockwise.
    Polygon {
        /// World space, at least three.
        vertices_m: Vec<DVec3>,
        /// Emitted radiance.
        radiance: [f64; 3],
        /// Whether the other side shines too.
        two_sided: bool,
    },
}

impl Light {
    /// Emitted radiance.
    pub fn radiance(&self) -> [f64; 3] {
        match self {
            Light::Sphere { radiance, .. } | Light::Polygon { radiance, .. } => *radiance,
        }
    }

    /// Centre and radius of a sphere around the light, for culling; not the smallest one.
    pub fn bounding_sphere(&self) -> (DVec3, f64) {
        match self {
            Light::Sphere {
                center_m, radius_m, ..
            } => (*center_m, *radius_m),
            Light::Polygon { vertices_m, .. } => {
                let (low, high) = vertices_m
                    .iter()
                    .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), v| {
                        (low.min(*v), high.max(*v))
                    });
                let center = 0.5 * (low + high);
                let radius = vertices_m
                    .iter()
                    .map(|v| v.distance(center))
                    .fold(0.0, f64::max);
                (center, radius)
            }
        }
    }
}
