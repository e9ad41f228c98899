//! Area lights.

use glam::DVec3;

/// An area light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// What it is.
    pub shape: LightShape,
    /// Emitted radiance: linear Rec.709, W sr^-1 m^-2 in effect; (1, 1, 1) has the spectrum of D65.
    pub radiance: [f64; 3],
    /// The directions that light leaves in; all, if none.
    pub cone: Option<Cone>,
}

/// A cone of directions with a soft rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Unit vector, away from the light.
    pub axis: DVec3,
    /// Of the half angle of the rim, where all light ends.
    pub cos_outer: f64,
    /// Of the half angle at which light begins to fall; no less than `cos_outer`.
    pub cos_inner: f64,
}

impl Cone {
    /// What is left of the light that leaves in a unit direction: the fall-off of KHR_lights_punctual.
    pub fn share(&self, direction: DVec3) -> f64 {
        let past = self.axis.dot(direction) - self.cos_outer;
        (past * self.per_cos()).clamp(0.0, 1.0).powi(2)
    }

    /// Over the fall-off, of one; finite at a hard rim.
    pub fn per_cos(&self) -> f64 {
        1.0 / (self.cos_inner - self.cos_outer).max(1e-6)
    }
}

/// The shape of a light.
#[derive(Clone, Debug, PartialEq)]
pub enum LightShape {
    /// A sphere.
    Sphere {
        /// World space.
        center_m: DVec3,
        /// Radius, positive.
        radius_m: f64,
    },
    /// A planar polygon, simple, convex or not; it shines to the side that sees the vertices counter-clockwise.
    Polygon {
        /// World space, at least three.
        vertices_m: Vec<DVec3>,
        /// Whether the other side shines too.
        two_sided: bool,
    },
    /// All that is within a radius of a line: a tube with round ends. It lights nothing that is within.
    Tube {
        /// The ends of the line, world space; not the same.
        ends_m: [DVec3; 2],
        /// Radius, positive.
        radius_m: f64,
    },
}

impl Light {
    /// A sphere.
    pub fn sphere(center_m: DVec3, radius_m: f64, radiance: [f64; 3]) -> Self {
        Self {
            shape: LightShape::Sphere { center_m, radius_m },
            radiance,
            cone: None,
        }
    }

    /// A polygon.
    pub fn polygon(vertices_m: Vec<DVec3>, radiance: [f64; 3], two_sided: bool) -> Self {
        Self {
            shape: LightShape::Polygon {
                vertices_m,
                two_sided,
            },
            radiance,
            cone: None,
        }
    }

    /// A tube.
    pub fn tube(ends_m: [DVec3; 2], radius_m: f64, radiance: [f64; 3]) -> Self {
        Self {
            shape: LightShape::Tube { ends_m, radius_m },
            radiance,
            cone: None,
        }
    }

    /// Centre and radius of a sphere around the light, for culling; not the smallest one.
    pub fn bounding_sphere(&self) -> (DVec3, f64) {
        match &self.shape {
            LightShape::Sphere { center_m, radius_m } => (*center_m, *radius_m),
            LightShape::Tube {
                ends_m: [a, b],
                radius_m,
            } => (a.midpoint(*b), 0.5 * a.distance(*b) + radius_m),
            LightShape::Polygon { vertices_m, .. } => {
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
