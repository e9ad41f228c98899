//! Convex polygons: their cuts, and trapezoids that tile them.

use super::cell::Trapezoid;
use glam::DVec2;

/// Corners in order, either way round; empty, or three and more.
#[derive(Clone, Debug)]
pub(super) struct Polygon {
    corners: Vec<DVec2>,
}

/// The places x with normal . x <= limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfPlane {
    pub normal: DVec2,
    pub limit: f64,
}

impl HalfPlane {
    fn signed_distance(&self, at: DVec2) -> f64 {
        self.normal.dot(at) - self.limit
    }

    fn complement(&self) -> Self {
        Self {
            normal: -self.normal,
            limit: -self.limit,
        }
    }
}

impl Polygon {
    pub(crate) fn new(corners: Vec<DVec2>) -> Self {
        Self { corners }
    }

    pub(crate) fn area(&self) -> f64 {
        let Some(&first) = self.corners.first() else {
            return 0.0;
        };
        let twice = |edge: &[DVec2]| (edge[0] - first).perp_dot(edge[1] - first);
        0.5 * self.corners.windows(2).map(twice).sum::<f64>().abs()
    }

    /// Returns the part of the polygon in the half-plane.
    pub(crate) fn cut(&self, half_plane: &HalfPlane) -> Self {
        let mut corners = Vec::with_capacity(self.corners.len() + 1);
        for (i, &to) in self.corners.iter().enumerate() {
            let from = self.corners[(i + self.corners.len() - 1) % self.corners.len()];
            let (a, b) = (
                half_plane.signed_distance(from),
                half_plane.signed_distance(to),
            );
            if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
                corners.push(from.lerp(to, a / (a - b)));
            }
            if b <= 0.0 {
                corners.push(to);
            }
        }
        if corners.len() < 3 {
            corners.clear();
        }
        Self { corners }
    }

    /// Returns the part of the polygon in all half-planes.
    pub(crate) fn clipped(&self, half_planes: &[HalfPlane]) -> Self {
        let mut rest = self.clone();
        for half_plane in half_planes {
            if rest.corners.is_empty() {
                break;
            }
            rest = rest.cut(half_plane);
        }
        rest
    }

    /// Returns the part of the polygon outside the intersection of the half-planes, as convex polygons.
    pub(crate) fn without(&self, half_planes: &[HalfPlane], least_area: f64) -> Vec<Self> {
        let mut rest = self.clone();
        let mut outside = Vec::new();
        for half_plane in half_planes {
            let part = rest.cut(&half_plane.complement());
            if part.area() > least_area {
                outside.push(part);
            }
            rest = rest.cut(half_plane);
        }
        outside
    }

    /// Tiles it: one parallelogram, if it is one, else slices along its longest edge from corner to corner.
    pub(crate) fn trapezoids(&self, tolerance_um: f64) -> Vec<Trapezoid> {
        if let [a, b, c, d] = self.corners[..]
            && (a + c).distance(b + d) < tolerance_um
        {
            return vec![Trapezoid {
                edges: [[a, b], [d, c]],
            }];
        }
        let edge = |i: usize| self.corners[(i + 1) % self.corners.len()] - self.corners[i];
        let longest = (0..self.corners.len())
            .map(edge)
            .fold(DVec2::ZERO, |long, e| {
                if e.length_squared() > long.length_squared() {
                    e
                } else {
                    long
                }
            });
        let Some(along) = longest.try_normalize() else {
            return Vec::new();
        };
        let across = along.perp();
        let mut places: Vec<f64> = self.corners.iter().map(|c| c.dot(across)).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|b, a| *b - *a < tolerance_um);
        let chord = |v: f64| self.chord(along, v, tolerance_um);
        places
            .windows(2)
            .map(|v| Trapezoid {
                edges: [chord(v[0]), chord(v[1])],
            })
            .collect()
    }

    /// Returns the two points at which a line enters and leaves the polygon; the line has the coordinate v
    /// along the normal of `along`.
    fn chord(&self, along: DVec2, v: f64, tolerance_um: f64) -> [DVec2; 2] {
        let across = along.perp();
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut hold = |at: DVec2| {
            low = low.min(at.dot(along));
            high = high.max(at.dot(along));
        };
        for (i, &from) in self.corners.iter().enumerate() {
            let to = self.corners[(i + 1) % self.corners.len()];
            let (a, b) = (from.dot(across) - v, to.dot(across) - v);
            if a.abs() <= tolerance_um {
                hold(from);
            } else if b.abs() > tolerance_um && (a < 0.0) != (b < 0.0) {
                hold(from.lerp(to, a / (a - b)));
            }
        }
        [low, high].map(|u| u * along + v * across)
    }
}
