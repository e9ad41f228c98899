//! A polygon on the lines of the band, edge by edge.

use std::f64::consts::PI;

use glam::DVec3;

use super::{BandFrame, BandLine};

/// Roots of one polygon edge on a line. Edges are independent; their roots may be summed in any order.
#[derive(Clone, Copy, Debug, PartialEq)]
struct EdgeRoots {
    /// q where the edge, walked from a to b, crosses the line towards +t; phi enters the polygon there.
    pub rising: Option<f64>,
    /// q where it crosses towards -t; phi leaves the polygon there.
    pub falling: Option<f64>,
}

/// The roots of the edge from direction `a` to direction `b` (unit vectors) on a line. Whether a vertex lies beyond the
/// line is decided from that vertex alone, so that the edges that share it agree and every closed polygon has as many
/// rising roots as falling ones. For a polygon seen counter-clockwise; clockwise ones take the opposite sign.
fn edge_roots(line: BandLine, a: DVec3, b: DVec3) -> EdgeRoots {
    let mut roots = EdgeRoots {
        rising: None,
        falling: None,
    };
    let (beyond_a, beyond_b) = (a.x >= line.along, b.x >= line.along);
    let (mut rises, mut falls) = (beyond_b && !beyond_a, beyond_a && !beyond_b);
    let edge = EdgeCircle::new(a, b);
    if beyond_a == beyond_b {
        // Both ends on one side: two roots if the edge turns back between them, on the other side of the line; else none.
        let turns = edge.turns(a, if beyond_a { -1.0 } else { 1.0 });
        (rises, falls) = (turns, turns);
    }
    if !(rises || falls) || edge.sin2 < 1e-18 {
        return roots;
    }
    // The edge's great circle is a cos psi + e2 sin psi; its tangent component is t1 cos psi + t2 sin psi.
    let e2 = edge.across / edge.sin2.sqrt();
    let (t1, t2) = (a.x, e2.x);
    let h2 = t1 * t1 + t2 * t2;
    let s2 = h2 - line.along * line.along;
    if rises && falls && s2 <= 0.0 {
        return roots;
    }
    let s = s2.max(0.0).sqrt();
    let h2 = h2.max(1e-24);
    let q = |cos_psi: f64, sin_psi: f64| {
        let w = (a * cos_psi + e2 * sin_psi) / h2;
        line.q(w.y, w.z)
    };
    if rises {
        roots.rising = Some(q(line.along * t1 + s * t2, line.along * t2 - s * t1));
    }
    if falls {
        roots.falling = Some(q(line.along * t1 - s * t2, line.along * t2 + s * t1));
    }
    roots
}

/// The great circle of an edge.
struct EdgeCircle {
    /// Part of b - a across a; as long as the sine of the edge's angle.
    across: DVec3,
    cos: f64,
    sin2: f64,
}

impl EdgeCircle {
    fn new(a: DVec3, b: DVec3) -> Self {
        let chord = b - a;
        let across = chord - a * a.dot(chord);
        Self {
            across,
            cos: a.dot(b),
            sin2: across.length_squared(),
        }
    }

    /// Whether the tangent component has its greatest value (`sign` 1) or its least (-1) between the ends.
    fn turns(&self, a: DVec3, sign: f64) -> bool {
        sign * self.across.x > 0.0 && sign * (self.across.x * self.cos - a.x * self.sin2) < 0.0
    }
}

/// Least and greatest tangent component along the edge from `a` to `b` (unit vectors): at its ends, or where it turns.
fn edge_band_extent(a: DVec3, b: DVec3) -> (f64, f64) {
    let edge = EdgeCircle::new(a, b);
    let (mut lowest, mut highest) = (a.x.min(b.x), a.x.max(b.x));
    let extreme = || {
        (a.x * a.x + edge.across.x * edge.across.x / edge.sin2.max(1e-18))
            .sqrt()
            .min(1.0)
    };
    if edge.turns(a, 1.0) {
        highest = extreme();
    } else if edge.turns(a, -1.0) {
        lowest = -extreme();
    }
    (lowest, highest)
}

/// Angle by which the edge from `a` to `b` (unit vectors) turns about the unit direction `about`. Summed over a polygon's edges: 2 pi or -2 pi if
/// the polygon encloses that direction or its opposite, else 0.
fn edge_winding(about: DVec3, a: DVec3, b: DVec3) -> f64 {
    let sin = about.dot(a.cross(b));
    let cos = a.dot(b) - a.dot(about) * b.dot(about);
    sin.atan2(cos)
}

/// The direction straight down on the line.
pub(super) fn line_down(line: BandLine) -> DVec3 {
    DVec3::new(line.along, 0.0, -line.radius)
}

/// A planar polygon light as seen from a point, in the frame of the surface.
#[derive(Clone, Copy, Debug)]
pub struct PolygonView<'a> {
    /// Unit directions to its vertices, in order.
    pub directions: &'a [DVec3],
    /// Normal of the polygon's plane, of any length, turned away from the point.
    pub away: DVec3,
    /// 1 if the vertices are seen counter-clockwise, -1 if clockwise, 0 if the polygon shines to the other side or is
    /// seen edge-on.
    pub facing: f64,
}

impl PolygonView<'_> {
    /// Edges from vertex to vertex in the frame of a scratch.
    fn edges(&self, frame: BandFrame) -> impl Iterator<Item = (DVec3, DVec3)> {
        let count = self.directions.len();
        (0..count).map(move |i| {
            let b = self.directions[if i + 1 < count { i + 1 } else { 0 }];
            (
                frame.band_from_surface(self.directions[i]),
                frame.band_from_surface(b),
            )
        })
    }

    /// Least and greatest xi_t of the light, `wo` in the frame of the scratch.
    pub fn band_extent(&self, frame: BandFrame, wo: DVec3) -> (f64, f64) {
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut corner_min, mut corner_max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (a, b) in self.edges(frame) {
            let (low, high) = edge_band_extent(a, b);
            (lowest, highest) = (lowest.min(low), highest.max(high));
            (corner_min, corner_max) = (corner_min.min(a), corner_max.max(a));
        }
        // A light around the tangent's own direction reaches further than its outline. It has corners on all sides of it.
        let around =
            corner_min.y < 0.0 && corner_max.y > 0.0 && corner_min.z < 0.0 && corner_max.z > 0.0;
        if around
            && self
                .edges(frame)
                .map(|(a, b)| edge_winding(DVec3::X, a, b))
                .sum::<f64>()
                .abs()
                > PI
        {
            if frame.band_from_surface(self.away).x > 0.0 {
                highest = 1.0;
            } else {
                lowest = -1.0;
            }
        }
        (wo.x + lowest, wo.x + highest)
    }

    /// Least and greatest q of the outline's roots on a line; the whole arc where there are none.
    pub fn range(&self, frame: BandFrame, line: BandLine) -> (f64, f64) {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (a, b) in self.edges(frame) {
            let roots = edge_roots(line, a, b);
            for q in [roots.rising, roots.falling].into_iter().flatten() {
                (low, high) = (low.min(q), high.max(q));
            }
        }
        if low <= high {
            (low, high)
        } else {
            (line.q_end(), line.q_start())
        }
    }

    /// The light integral on one line, given the antiderivative over q.
    pub fn integral<const C: usize>(
        &self,
        frame: BandFrame,
        line: BandLine,
        antiderivative: impl Fn(f64) -> [f64; C],
    ) -> [f64; C] {
        let mut sum = [0.0; C];
        let mut add = |sign: f64, q: f64| {
            let t = antiderivative(q);
            (0..C).for_each(|c| sum[c] += sign * t[c]);
        };
        let (mut corner_min, mut corner_max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (a, b) in self.edges(frame) {
            let roots = edge_roots(line, a, b);
            if let Some(q) = roots.rising {
                add(self.facing, q);
            }
            if let Some(q) = roots.falling {
                add(-self.facing, q);
            }
            (corner_min, corner_max) = (corner_min.min(a), corner_max.max(a));
        }
        // Straight down may lie in a light with corners below the horizon and on both sides of the scratch.
        if corner_min.z < 0.0 && corner_min.y < 0.0 && corner_max.y > 0.0 {
            let down = line_down(line);
            let winding: f64 = self
                .edges(frame)
                .map(|(a, b)| edge_winding(down, a, b))
                .sum();
            // The opposite direction winds as well; only a polygon in front of the ray counts.
            if winding.abs() > PI && down.dot(frame.band_from_surface(self.away)) > 0.0 {
                add(self.facing.abs(), line.q_start());
                add(-self.facing.abs(), line.q_end());
            }
        }
        sum
    }
}

/// Returns the normal of a planar polygon turned away from the point, and [`PolygonView::facing`]. `vertices` are relative to the point.
pub fn polygon_facing(
    vertices: impl Iterator<Item = DVec3> + Clone,
    two_sided: bool,
) -> (DVec3, f64) {
    let Some(first) = vertices.clone().next() else {
        return (DVec3::ZERO, 0.0);
    };
    // Twice the area vector; exact for any planar polygon. The closing edge adds nothing, as it ends at `first`.
    let normal: DVec3 = vertices
        .clone()
        .zip(vertices.skip(1))
        .map(|(a, b)| (a - first).cross(b - first))
        .sum();
    let distance = normal.dot(first);
    // Counter-clockwise seen from the side that its normal points to.
    let facing = if distance < 0.0 {
        1.0
    } else if distance > 0.0 && two_sided {
        -1.0
    } else {
        0.0
    };
    (normal * distance.signum(), facing)
}
