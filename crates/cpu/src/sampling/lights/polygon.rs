//! A planar polygon as seen from a point: spherical triangles, sampled uniformly in solid angle.
//!
//! A. Van Oosterom and J. Strackee, "The solid angle of a plane triangle" (1983). J. Arvo, "Stratified sampling of spherical
//! triangles" (1995): cut off a part of the wanted area with a great circle through one corner, then go along it. C. Peters,
//! "BRDF importance sampling for polygonal lights" (2021): how to do so without inverse cosines, which lose their digits for
//! small triangles.

use glam::{DVec2, DVec3};

use super::bound::widened;
#[cfg(test)]
use super::bound::{BOUND_SLACK, Cone};

/// Height over the plane, relative to the polygon's size and the distance, below which a point sees the polygon's edge and
/// no light. The light that is lost is as small.
const EDGE_ON: f64 = 1e-10;

#[derive(Clone, Debug)]
pub(super) struct PolygonLight {
    /// World space, moved onto the plane: scene files write few digits, and a polygon that is a little bent has no one side.
    vertices_m: Vec<DVec3>,
    /// Outline in the plane's coordinates.
    outline_m: Vec<DVec2>,
    /// Origin of the plane's coordinates.
    origin_m: DVec3,
    axes: [DVec3; 2],
    /// Unit vector on the lit side.
    normal: DVec3,
    /// Greatest distance of a vertex from the origin.
    extent_m: f64,
    two_sided: bool,
    triangles: Vec<Triangle>,
}

#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [usize; 3],
    /// Twice its area.
    area2_m2: f64,
}

/// A triangle projected onto the unit sphere around a point.
#[derive(Clone, Copy, Debug)]
struct SphericalTriangle {
    corners: [DVec3; 3],
    /// The determinant of the corners, positive.
    volume: f64,
    solid_angle: f64,
}

impl PolygonLight {
    pub fn new(vertices_m: &[DVec3], two_sided: bool) -> Self {
        let origin_m = vertices_m.iter().sum::<DVec3>() / vertices_m.len() as f64;
        let next = vertices_m.iter().cycle().skip(1);
        let area: DVec3 = vertices_m
            .iter()
            .zip(next)
            .map(|(a, b)| (a - origin_m).cross(b - origin_m))
            .sum();
        let normal = area.normalize_or(DVec3::Z);
        let (x, y) = normal.any_orthonormal_pair();
        // The pair's sense is not ours to know; x, y, normal must be right-handed to see the outline counter-clockwise.
        let y = if x.cross(y).dot(normal) < 0.0 { -y } else { y };
        let outline_m: Vec<DVec2> = vertices_m
            .iter()
            .map(|v| DVec2::new((v - origin_m).dot(x), (v - origin_m).dot(y)))
            .collect();
        let mut indices = Vec::<usize>::new();
        earcut::Earcut::new().earcut(outline_m.iter().map(|v| v.to_array()), &[], &mut indices);
        let triangles = indices
            .as_chunks::<3>()
            .0
            .iter()
            .map(|&corners| {
                let [a, b, c] = corners.map(|i| outline_m[i]);
                Triangle {
                    corners,
                    area2_m2: (b - a).perp_dot(c - a).abs(),
                }
            })
            .filter(|triangle| triangle.area2_m2 > 0.0)
            .collect();
        Self {
            vertices_m: outline_m
                .iter()
                .map(|v| origin_m + x * v.x + y * v.y)
                .collect(),
            extent_m: outline_m.iter().map(|v| v.length()).fold(0.0, f64::max),
            outline_m,
            origin_m,
            axes: [x, y],
            normal,
            two_sided,
            triangles,
        }
    }

    /// Cosine of the angle between a unit direction and the normal.
    pub fn cos(&self, direction: DVec3) -> f64 {
        direction.dot(self.normal)
    }

    /// Height of a point above the plane, positive on the side of the normal. 0 for points that see the polygon's edge.
    fn height_m(&self, from: DVec3) -> f64 {
        let to = from - self.origin_m;
        let height_m = to.dot(self.normal);
        if height_m.abs() > EDGE_ON * (self.extent_m + to.length()) {
            height_m
        } else {
            0.0
        }
    }

    /// [`PolygonLight::height_m`], and 0 for points that see the dark side too.
    fn lit_height_m(&self, from: DVec3) -> f64 {
        let height_m = self.height_m(from);
        if self.two_sided {
            height_m
        } else {
            height_m.max(0.0)
        }
    }

    fn spherical(&self, triangle: &Triangle, from: DVec3, height_m: f64) -> SphericalTriangle {
        let to = triangle.corners.map(|i| self.vertices_m[i] - from);
        let inverse = to.map(|v| v.length_recip());
        let [a, b, c] = [0, 1, 2].map(|i| to[i] * inverse[i]);
        // Base times height, as the triangle's own area does not cancel.
        let volume = triangle.area2_m2 * height_m.abs() * (inverse[0] * inverse[1] * inverse[2]);
        let solid_angle = 2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        SphericalTriangle {
            corners: [a, b, c],
            volume,
            solid_angle,
        }
    }

    /// Solid angle of all triangles from a point at the given height.
    fn solid_angle(&self, from: DVec3, height_m: f64) -> f64 {
        self.triangles
            .iter()
            .map(|triangle| self.spherical(triangle, from, height_m).solid_angle)
            .sum()
    }

    /// (direction, distance, density)
    pub fn sample(&self, from: DVec3, u: DVec2) -> Option<(DVec3, f64, f64)> {
        let height_m = self.lit_height_m(from);
        if height_m == 0.0 {
            return None;
        }
        // One pass: each triangle replaces the chosen one with the probability of its share of the sum until then, and the
        // remainder of the random number is stretched to [0, 1) again.
        let (mut whole, mut left, mut chosen) = (0.0, u.x, None);
        for triangle in &self.triangles {
            let spherical = self.spherical(triangle, from, height_m);
            whole += spherical.solid_angle;
            let share = spherical.solid_angle / whole;
            if left < share {
                left /= share;
                chosen = Some(spherical);
            } else {
                left = (left - share) / (1.0 - share);
            }
        }
        let chosen = chosen?;
        let direction = chosen.sample(left * chosen.solid_angle, u.y);
        let distance_m = height_m / -direction.dot(self.normal);
        // Fails where rounding turns a direction at grazing away from the plane.
        (distance_m > 0.0 && distance_m.is_finite()).then_some((direction, distance_m, 1.0 / whole))
    }

    pub fn hit(&self, from: DVec3, direction: DVec3) -> Option<f64> {
        self.cross(from, direction, self.lit_height_m(from))
    }

    /// The distance at which a ray passes through the plane; infinite where it does not.
    pub(crate) fn plane_m(&self, from: DVec3, direction: DVec3) -> f64 {
        let distance_m = self.height_m(from) / -direction.dot(self.normal);
        if distance_m > 0.0 {
            distance_m
        } else {
            f64::INFINITY
        }
    }

    /// The distance at which a ray passes through the polygon, from either side.
    fn cross(&self, from: DVec3, direction: DVec3, height_m: f64) -> Option<f64> {
        let distance_m = height_m / -direction.dot(self.normal);
        if !(distance_m > 0.0 && distance_m.is_finite()) {
            return None;
        }
        let at = from - self.origin_m + direction * distance_m;
        let [x, y] = self.axes;
        self.holds(DVec2::new(at.dot(x), at.dot(y)))
            .then_some(distance_m)
    }

    /// Whether a point of the plane is inside: whether a line to its right crosses the outline an odd number of times.
    fn holds(&self, p: DVec2) -> bool {
        let mut inside = false;
        let mut a = self.outline_m[self.outline_m.len() - 1];
        for &b in &self.outline_m {
            if (a.y > p.y) != (b.y > p.y) {
                let right_of_edge = (b - a).perp_dot(p - a) < 0.0;
                inside ^= right_of_edge != (b.y > a.y);
            }
            a = b;
        }
        inside
    }

    pub fn pdf(&self, from: DVec3) -> f64 {
        let height_m = self.lit_height_m(from);
        if height_m == 0.0 {
            return 0.0;
        }
        let whole = self.solid_angle(from, height_m);
        if whole > 0.0 { 1.0 / whole } else { 0.0 }
    }

    #[cfg(test)]
    pub fn bound(&self, from: DVec3) -> Cone {
        let directions = || {
            self.vertices_m
                .iter()
                .map(|v| (v - from).normalize_or_zero())
        };
        let axis = directions().sum::<DVec3>().normalize_or_zero();
        // A cone of less than a right angle is convex: it holds the polygon if it holds the vertices.
        let (mut cos, mut sin) = (1.0_f64, 0.0_f64);
        for direction in directions() {
            cos = cos.min(axis.dot(direction));
            sin = sin.max(axis.cross(direction).length());
        }
        if cos > 1e-6 {
            // The sine has the digits that the cosine of a narrow cone has not.
            let sin = (sin * (1.0 + BOUND_SLACK) + BOUND_SLACK).min(1.0);
            return Cone {
                axis,
                cos: (1.0 - sin * sin).max(0.0).sqrt() - BOUND_SLACK,
                sin,
            };
        }
        // The plane bounds it as well. The slack lets points on the plane see it along the plane.
        let side = (from - self.origin_m).dot(self.normal);
        Cone {
            axis: if side < 0.0 {
                self.normal
            } else {
                -self.normal
            },
            cos: -1e-6,
            sin: 1.0,
        }
    }

    pub fn extent(&self, from: DVec3, axis: DVec3) -> (f64, f64) {
        let height_m = self.height_m(from);
        // Within the outline the component has extremes at the axis and opposite to it only.
        let (mut low, mut high) = (1.0_f64, -1.0_f64);
        if self.cross(from, axis, height_m).is_some() {
            high = 1.0;
        }
        if self.cross(from, -axis, height_m).is_some() {
            low = -1.0;
        }
        let last = self.vertices_m[self.vertices_m.len() - 1] - from;
        let mut a = last.normalize_or_zero();
        for v in &self.vertices_m {
            let b = (v - from).normalize_or_zero();
            low = low.min(b.dot(axis));
            high = high.max(b.dot(axis));
            let n = a.cross(b);
            let n2 = n.length_squared();
            if a == DVec3::ZERO || b == DVec3::ZERO || (n2 < 1e-12 && a.dot(b) < 0.0) {
                // The point is on a vertex or an edge.
                return (-1.0, 1.0);
            }
            // Shorter arcs rise above their ends by less than the slack.
            if n2 > 1e-12 {
                // Point at which the arc's great circle is nearest to the axis.
                let on = n.dot(axis);
                let nearest = axis * n2 - n * on;
                let extreme = (1.0 - on * on / n2).max(0.0).sqrt();
                let (after_a, before_b) = (a.cross(nearest).dot(n), nearest.cross(b).dot(n));
                if after_a >= 0.0 && before_b >= 0.0 {
                    high = high.max(extreme);
                }
                if after_a <= 0.0 && before_b <= 0.0 {
                    low = low.min(-extreme);
                }
            }
            a = b;
        }
        widened(low, high)
    }
}

impl SphericalTriangle {
    /// Direction that has the share `part` (steradians) of the triangle on one side of the great circle through it and the
    /// second corner, and the share `u` of the rest of the way to that corner.
    fn sample(&self, part: f64, u: f64) -> DVec3 {
        let [a, b, c] = self.corners;
        // Let d on the arc from a to c cut off the triangle (a, b, d). With d the mirror image of a at o, the formula for its
        // solid angle becomes linear in o: tan(part / 2) = det(a, b, o) / ((a + b) o). Solved for o between a and c:
        let (sin, cos) = (0.5 * part).sin_cos();
        let toward_a = cos * self.volume - sin * (a.dot(c) + b.dot(c));
        let toward_c = sin * (1.0 + a.dot(b));
        let o = (a * toward_a + c * toward_c).normalize_or(a);
        let d = o * (2.0 * a.dot(o)) - a;
        // Uniform in the cosine from b to d; differences to one instead of cosines keep the digits of short arcs.
        let versine = 0.5 * (d - b).length_squared();
        let along = u * versine;
        let tangent = (d - b + b * versine).normalize_or_zero();
        (b * (1.0 - along) + tangent * (along * (2.0 - along)).max(0.0).sqrt()).normalize()
    }
}
