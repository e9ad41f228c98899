//! One triangle in double precision, and the way of an arc through it.

use glam::DVec3;

use hairline_scene::Mesh;

/// A triangle with the values for walking across it. Edge i runs from corner i to corner i + 1.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// Corners of the triangle.
    pub corners_m: [DVec3; 3],
    /// Unit, to the side that sees the corners counter-clockwise.
    pub normal: DVec3,
    /// Unit directions in the plane, perpendicular to the edges, inwards.
    inward: [DVec3; 3],
    /// Unit directions of the edges.
    along: [DVec3; 3],
}

/// A piece of a circle, or a straight line, in the plane of a facet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc {
    pub start_m: DVec3,
    /// Unit tangent at the start, in the facet's plane.
    pub direction: DVec3,
    /// Unit, to the left of the direction: `normal x direction`.
    pub left: DVec3,
    /// Positive to the left.
    pub curvature_per_m: f64,
}

impl Facet {
    /// The triangle of a mesh.
    pub fn new(mesh: &Mesh, triangle: u32) -> Self {
        let corners_m = mesh.corners_m(triangle as usize);
        let [a, b, c] = corners_m;
        let normal = normal(corners_m);
        let along = [b - a, c - b, a - c].map(DVec3::normalize_or_zero);
        Self {
            corners_m,
            normal,
            inward: along.map(|edge| normal.cross(edge)),
            along,
        }
    }

    /// The part of a direction in the facet's plane; not a unit vector.
    pub fn in_plane(&self, direction: DVec3) -> DVec3 {
        direction - self.normal * direction.dot(self.normal)
    }

    /// A unit direction in the plane, by its angle from the first edge.
    pub fn direction(&self, angle_rad: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(angle_rad);
        self.along[0] * cos + self.inward[0] * sin
    }

    pub(crate) fn arc(&self, start_m: DVec3, direction: DVec3, curvature_per_m: f64) -> Arc {
        Arc {
            start_m,
            direction,
            left: self.normal.cross(direction),
            curvature_per_m,
        }
    }

    /// Whether a direction at a point of `edge` leads into the facet, by more than rounding.
    pub(crate) fn is_inward(&self, direction: DVec3, edge: usize) -> bool {
        direction.dot(self.inward[edge]) > 1e-9
    }

    /// Finds the point where an arc leaves the facet: the length until then and the edge. `entry` is the edge on which it
    /// starts, if it does and leads inwards there. `None` if it stays inside for half a turn.
    ///
    /// With v = tan(curvature s / 2) / curvature, the height above an edge is zero where
    /// (h c + 2 b) c v^2 + 2 a v + h = 0; h the height at the start, a and b the inward parts of direction and left, c the
    /// curvature. It stays a quadratic as c goes to 0, when v becomes s / 2.
    pub(crate) fn exit(&self, arc: &Arc, entry: Option<usize>) -> Option<(f64, usize)> {
        let c = arc.curvature_per_m;
        let mut first: Option<(f64, usize)> = None;
        for edge in 0..3 {
            let inward = self.inward[edge];
            let height = match entry == Some(edge) {
                true => 0.0,
                false => (arc.start_m - self.corners_m[edge]).dot(inward).max(0.0),
            };
            let (a, b) = (arc.direction.dot(inward), arc.left.dot(inward));
            let quadratic = (height * c + 2.0 * b) * c;
            let discriminant = a * a - quadratic * height;
            let v = if a < 0.0 && discriminant >= 0.0 {
                height / (libm::sqrt(discriminant) - a)
            } else if a >= 0.0 && quadratic < 0.0 {
                // Rises at first; the other root is where it comes back.
                -(a + libm::sqrt(discriminant)) / quadratic
            } else {
                continue;
            };
            if first.is_none_or(|(least, _)| v < least) {
                first = Some((v, edge));
            }
        }
        first.map(|(v, edge)| {
            let half_turn = c * v;
            let s = match half_turn.abs() < 1e-9 {
                true => 2.0 * v,
                false => 2.0 * libm::atan(half_turn) / c,
            };
            (s, edge)
        })
    }

    /// Place of a point on an edge, as a share of the edge's length, kept off the corners, so that a walk always knows its
    /// next triangle. The shift of 1e-6 of an edge is far below a wavelength for edges up to decimetres.
    pub(crate) fn share_of_edge(&self, edge: usize, point_m: DVec3) -> f64 {
        const OFF_CORNER: f64 = 1e-6;
        let from = self.corners_m[edge];
        let to = self.corners_m[(edge + 1) % 3];
        let share = (point_m - from).dot(to - from) / (to - from).length_squared();
        share.clamp(OFF_CORNER, 1.0 - OFF_CORNER)
    }

    pub(crate) fn point_on_edge(&self, edge: usize, share: f64) -> DVec3 {
        self.corners_m[edge].lerp(self.corners_m[(edge + 1) % 3], share)
    }

    /// Carries a direction over the edge `edge` into the `next` facet, whose edge `next_edge` is the same: as a straight
    /// line goes on if both facets are unfolded into one plane.
    pub(crate) fn unfold(
        &self,
        direction: DVec3,
        edge: usize,
        next: &Facet,
        next_edge: usize,
    ) -> DVec3 {
        let along = direction.dot(self.along[edge]);
        let outward = -direction.dot(self.inward[edge]);
        // Both facets are counter-clockwise, so they run along the edge in opposite ways.
        (next.inward[next_edge] * outward - next.along[next_edge] * along).normalize_or_zero()
    }

    /// Distance of a point from the facet: 0 within it.
    pub(crate) fn distance_m(&self, point_m: DVec3) -> f64 {
        let offset = point_m - self.corners_m[0];
        let below = (0..3).map(|e| -(point_m - self.corners_m[e]).dot(self.inward[e]));
        below.fold(offset.dot(self.normal).abs(), f64::max)
    }
}

/// Unit, to the side that sees the corners counter-clockwise.
pub fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// Barycentric coordinates of a point in the plane of a triangle, clamped to the triangle.
pub fn barycentric([a, b, c]: [DVec3; 3], normal: DVec3, point_m: DVec3) -> [f64; 3] {
    let area = (b - a).cross(c - a).dot(normal);
    let at_b = (c - a).cross(a - point_m).dot(normal) / area;
    let at_c = (b - a).cross(point_m - a).dot(normal) / area;
    let weights = [1.0 - at_b - at_c, at_b, at_c].map(|w| w.max(0.0));
    let sum: f64 = weights.iter().sum();
    weights.map(|w| w / sum)
}

impl Arc {
    /// The point after a length `s_m`, and the tangent there.
    pub(crate) fn point_and_tangent(&self, s_m: f64) -> (DVec3, DVec3) {
        let half_turn = self.curvature_per_m * s_m / 2.0;
        let (sin, cos) = libm::sincos(half_turn);
        let sinc = match half_turn.abs() < 1e-9 {
            true => 1.0,
            false => sin / half_turn,
        };
        let chord = self.direction * cos + self.left * sin;
        let (sin_turn, cos_turn) = (2.0 * sin * cos, 1.0 - 2.0 * sin * sin);
        let tangent = self.direction * cos_turn + self.left * sin_turn;
        (self.start_m + chord * (s_m * sinc), tangent)
    }

    /// The length after which the arc passes nearest to a point, less than half a turn ahead or behind, and by how much it
    /// misses.
    pub(crate) fn nearest(&self, point_m: DVec3) -> (f64, f64) {
        let offset = point_m - self.start_m;
        let (x, y) = (offset.dot(self.direction), offset.dot(self.left));
        let c = self.curvature_per_m;
        if c == 0.0 {
            return (x, y.abs());
        }
        let turn = libm::atan2(x * c, 1.0 - y * c);
        let miss = (libm::hypot(x, y - 1.0 / c) - 1.0 / c.abs()).abs();
        (turn / c, miss)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn facet() -> Facet {
        let mesh = Mesh {
            positions_m: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        Facet::new(&mesh, 0)
    }

    /// Exits are compared with small steps along the arc until it is outside.
    #[test]
    fn exits_agree_with_small_steps() {
        let facet = facet();
        let start = DVec3::new(0.2, 0.3, 0.0);
        for i in 0..64 {
            let (sin, cos) = (f64::from(i) * 0.1).sin_cos();
            for curvature in [-9.0, -3.0, -0.5, -1e-9, 0.0, 1e-4, 1.0, 4.0, 20.0] {
                let arc = facet.arc(start, DVec3::new(cos, sin, 0.0), curvature);
                let half_turn = std::f64::consts::PI / curvature.abs();
                let stepped = (1..20_000)
                    .map(|k| f64::from(k) * 1e-4)
                    .take_while(|s| *s < half_turn)
                    .find(|&s| facet.distance_m(arc.point_and_tangent(s).0) > 1e-12);
                match (facet.exit(&arc, None), stepped) {
                    (Some((s, _)), Some(stepped)) => {
                        assert!((0.0..1.01e-4).contains(&(stepped - s)), "{i} {curvature}")
                    }
                    (Some((s, _)), None) => assert!(s > half_turn - 2e-4, "{i} {curvature}"),
                    (None, None) => {}
                    (None, Some(_)) => panic!("misses the exit: {i} {curvature}"),
                }
            }
        }
    }

    #[test]
    fn an_arc_comes_back_through_the_edge_it_came_in() {
        let facet = facet();
        let start = DVec3::new(0.4, 0.0, 0.0);
        let arc = facet.arc(start, DVec3::new(-0.6, 0.8, 0.0), 10.0);
        let (s, edge) = facet.exit(&arc, Some(0)).unwrap();
        assert_eq!(edge, 0);
        // It meets the edge at the same angle on both sides, atan(4 / 3); the chord is 2 sin(angle) / curvature.
        assert!((s - 2.0 * (4.0f64 / 3.0).atan() / 10.0).abs() < 1e-12);
        assert!(
            arc.point_and_tangent(s)
                .0
                .abs_diff_eq(DVec3::new(0.24, 0.0, 0.0), 1e-12)
        );
        let (ahead, miss) = arc.nearest(DVec3::new(0.31, 0.05, 0.0));
        assert!(
            (arc.point_and_tangent(ahead)
                .0
                .distance(DVec3::new(0.31, 0.05, 0.0))
                - miss)
                .abs()
                < 1e-12
        );
    }
}
