//! Area lights.

use glam::DVec3;

/// Distance of suns: a scene of some metres is a point beside it, and single precision tells directions to a ten millionth.
const SUN_DISTANCE_M: f64 = 1e5;

/// An area light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Shape of the light.
    pub shape: LightShape,
    /// Emitted radiance: linear Rec.709, W sr^-1 m^-2 in effect; (1, 1, 1) has the spectrum of D65.
    pub radiance: [f64; 3],
    /// Cone into which the light shines; all directions, if none.
    pub cone: Option<Cone>,
    /// A picture on it: an index into [`Scene::textures`](crate::scene::Scene::textures), whose values are factors on the radiance. Of a
    /// rectangle alone: the picture's left lower corner is at its first vertex, the right lower one at its second.
    pub picture: Option<usize>,
    /// Temperature of the black body whose colour the radiance has, times a grey or a colour.
    pub temperature_k: Option<f64>,
}

/// A cone of directions with a soft rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Unit vector, away from the light.
    pub axis: DVec3,
    /// Cosine of the half angle of the rim, where all light ends.
    pub cos_outer: f64,
    /// Cosine of the half angle at which light begins to fall; no less than `cos_outer`.
    pub cos_inner: f64,
    /// Flaps beside the light, if it has any.
    pub doors: Option<Doors>,
}

/// Barn doors: four planes that light does not pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doors {
    /// Unit vector across the axis, to the right as seen from before the light.
    pub across: DVec3,
    /// Tangents of the angles between the axis and each door: left, right, above and below as seen from before the light.
    pub tans: [f64; 4],
}

impl Doors {
    /// The part of a door's angle in which light falls off.
    const SOFTNESS: f64 = 0.1;

    /// Reciprocal widths of the fall-off at each door; finite where a door is shut.
    pub fn per_tan(&self) -> [f64; 4] {
        self.tans.map(|tan| {
            let inner = ((1.0 - Self::SOFTNESS) * tan.atan()).tan();
            1.0 / (tan - inner).max(1e-3)
        })
    }

    /// Share of the light in a unit direction that passes the doors of a light along an axis.
    fn share(&self, axis: DVec3, direction: DVec3) -> f64 {
        let ahead = axis.dot(direction);
        if ahead <= 0.0 {
            return 0.0;
        }
        let right = self.across.dot(direction) / ahead;
        let up = axis.cross(self.across).dot(direction) / ahead;
        let beside = [-right, right, up, -up];
        let doors = self.tans.into_iter().zip(self.per_tan()).zip(beside);
        let shares =
            doors.map(|((tan, per_tan), beside)| ((tan - beside) * per_tan).clamp(0.0, 1.0));
        shares.product::<f64>().powi(2)
    }
}

impl Cone {
    /// A cone of all directions.
    pub fn open(axis: DVec3) -> Self {
        Self {
            axis,
            cos_outer: -2.0,
            cos_inner: -1.0,
            doors: None,
        }
    }

    /// Share of the light in a unit direction that the cone passes: the fall-off of KHR_lights_punctual, times the doors' share.
    pub fn share(&self, direction: DVec3) -> f64 {
        let past = self.axis.dot(direction) - self.cos_outer;
        let of_cone = (past * self.per_cos()).clamp(0.0, 1.0).powi(2);
        of_cone
            * self
                .doors
                .map_or(1.0, |doors| doors.share(self.axis, direction))
    }

    /// Reciprocal width of the fall-off; finite at a hard rim.
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
    /// A tube with round ends: all points within a radius of a line. It lights nothing inside itself.
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
            picture: None,
            temperature_k: None,
        }
    }

    /// Makes a sphere so far away that its direction is the same over the whole scene.
    ///
    /// `towards_it` is a unit vector, `radius_rad` half of the angle that it spans.
    pub fn sun(towards_it: DVec3, radius_rad: f64, radiance: [f64; 3]) -> Self {
        Self::sphere(
            towards_it * SUN_DISTANCE_M,
            SUN_DISTANCE_M * radius_rad.sin(),
            radiance,
        )
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
            picture: None,
            temperature_k: None,
        }
    }

    /// A tube.
    pub fn tube(ends_m: [DVec3; 2], radius_m: f64, radiance: [f64; 3]) -> Self {
        Self {
            shape: LightShape::Tube { ends_m, radius_m },
            radiance,
            cone: None,
            picture: None,
            temperature_k: None,
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

/// The vector area: half the sum of cross products; its direction is the side that sees the vertices counter-clockwise.
pub fn vector_area_m2(vertices_m: &[DVec3]) -> DVec3 {
    let Some(&origin) = vertices_m.first() else {
        return DVec3::ZERO;
    };
    vertices_m
        .windows(2)
        .map(|edge| (edge[0] - origin).cross(edge[1] - origin) / 2.0)
        .sum()
}
