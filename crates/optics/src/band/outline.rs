//! A polygon light made ready for many scratches at one point. What of its edges does not depend on the scratch is found once;
//! a turn of the frame then costs a few products for each edge, and only edges that the line crosses cost more. The results
//! are those of [`super::PolygonView`], which says it plainly.

use super::{BandFrame, BandLine};
use glam::{DVec2, DVec3};

/// One edge, in the frame of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineEdge {
    /// Unit direction to where it starts.
    start: DVec3,
    /// Unit direction across it on the edge's great circle, towards the end; zero for an edge of no length.
    across: DVec3,
    /// Cosine of the angle that the edge spans.
    cos: f64,
    /// Sine of the angle that the edge spans.
    sin: f64,
}

impl OutlineEdge {
    /// The edge between two unit directions.
    pub fn new(start: DVec3, end: DVec3) -> Self {
        let chord = end - start;
        let across = chord - start * start.dot(chord);
        let sin2 = across.length_squared();
        let long = sin2 >= 1e-18;
        Self {
            start,
            across: if long {
                across / sin2.sqrt()
            } else {
                DVec3::ZERO
            },
            cos: start.dot(end),
            sin: sin2.sqrt(),
        }
    }

    /// The edges of a polygon, from direction to direction and back to the first one.
    pub fn of_outline(directions: &[DVec3]) -> impl Iterator<Item = Self> {
        // The number of edges is known, so that a vector can reserve room for them.
        let end = |i: usize| directions[if i + 1 < directions.len() { i + 1 } else { 0 }];
        (0..directions.len()).map(move |i| Self::new(directions[i], end(i)))
    }
}

/// A polygon as seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct Outline<'a> {
    /// Edges of the polygon in order.
    pub edges: &'a [OutlineEdge],
    /// See [`super::PolygonView::away`].
    pub away: DVec3,
    /// See [`super::PolygonView::facing`].
    pub facing: f64,
    /// Whether at least one corner lies below the horizon.
    pub sets: bool,
}

/// Values of q at which a line crosses an outline, where it enters or leaves the light.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutlineRoots {
    /// The sign with which the antiderivative counts there, and q. The ends of the arc are among them where the light covers the
    /// direction straight down.
    roots: Vec<(f64, f64)>,
    /// Least and greatest q of the outline's own roots; the whole arc where there are none.
    pub range: (f64, f64),
}

impl OutlineRoots {
    /// The sign with which the antiderivative counts at each root, and q.
    pub fn signed(&self) -> &[(f64, f64)] {
        &self.roots
    }

    /// The light integral on the line, given the antiderivative over q.
    #[inline]
    pub fn integral(&self, antiderivative: impl Fn(f64) -> [f64; 3]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for &(sign, q) in &self.roots {
            let t = antiderivative(q);
            (0..3).for_each(|c| sum[c] += sign * t[c]);
        }
        sum
    }
}

/// The component of a vector of the surface's frame across the tangent.
#[inline]
fn along_normal(tangent: DVec2, v: DVec3) -> f64 {
    v.y * tangent.x - v.x * tangent.y
}

#[inline]
fn along_tangent(tangent: DVec2, v: DVec3) -> f64 {
    v.x * tangent.x + v.y * tangent.y
}

impl Outline<'_> {
    /// Least and greatest component of the corners along the tangent.
    #[inline]
    pub fn corner_extent(&self, frame: BandFrame) -> (f64, f64) {
        let components = self
            .edges
            .iter()
            .map(|e| along_tangent(frame.tangent, e.start));
        components.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), a| {
            (
                if a < low { a } else { low },
                if a > high { a } else { high },
            )
        })
    }

    /// Least and greatest xi_t of the light, `wo_t` being the tangent's component of `wo`: [`super::PolygonView::band_extent`].
    pub fn band_extent(&self, frame: BandFrame, wo_t: f64) -> (f64, f64) {
        let t = frame.tangent;
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        for edge in self.edges {
            let (a, e) = (along_tangent(t, edge.start), along_tangent(t, edge.across));
            (lowest, highest) = (lowest.min(a), highest.max(a));
            // The extreme lies beyond both ends if the edge turns back between them.
            if turns_back(a, e, edge, e) {
                let extreme = (a * a + e * e).sqrt().min(1.0).copysign(e);
                (lowest, highest) = (lowest.min(extreme), highest.max(extreme));
            }
        }
        // A light around the tangent's own direction reaches further than its outline.
        if self.sets && self.holds_pole(t) {
            if along_tangent(t, self.away) > 0.0 {
                highest = 1.0;
            } else {
                lowest = -1.0;
            }
        }
        (wo_t + lowest, wo_t + highest)
    }

    /// Finds the roots of all edges: the points where a line crosses the outline.
    pub fn roots(&self, frame: BandFrame, line: BandLine, found: &mut OutlineRoots) {
        let t = frame.tangent;
        found.roots.clear();
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let Some(first) = self.edges.first() else {
            found.range = (line.q_end(), line.q_start());
            return;
        };
        let mut a = along_tangent(t, first.start);
        for (i, edge) in self.edges.iter().enumerate() {
            let next = self.edges.get(i + 1).unwrap_or(first);
            let b = along_tangent(t, next.start);
            let (beyond_a, beyond_b) = (a >= line.along, b >= line.along);
            let e = along_tangent(t, edge.across);
            let h2 = a * a + e * e;
            let s2 = h2 - line.along * line.along;
            let crosses = if beyond_a != beyond_b {
                edge.sin >= 1e-9
            } else {
                // Both ends on one side: two roots if the edge turns back between them on the other side of the line.
                s2 > 0.0 && turns_back(a, e, edge, if beyond_a { -1.0 } else { 1.0 })
            };
            if crosses {
                let s = s2.max(0.0).sqrt();
                let per_h2 = 1.0 / h2.max(1e-24);
                let mut add = |sign: f64, s: f64| {
                    let (cos, sin) = (
                        (line.along * a + s * e) * per_h2,
                        (line.along * e - s * a) * per_h2,
                    );
                    let w = edge.start * cos + edge.across * sin;
                    let q = line.q(along_normal(t, w), w.z);
                    (low, high) = (low.min(q), high.max(q));
                    found.roots.push((sign * self.facing, q));
                };
                // Towards +t phi enters the polygon, towards -t it leaves it.
                if beyond_b || !beyond_a {
                    add(1.0, s);
                }
                if beyond_a || !beyond_b {
                    add(-1.0, -s);
                }
            }
            a = b;
        }
        found.range = if low <= high {
            (low, high)
        } else {
            (line.q_end(), line.q_start())
        };
        if self.sets && self.holds_down(t, line) {
            found.roots.push((self.facing.abs(), line.q_start()));
            found.roots.push((-self.facing.abs(), line.q_end()));
        }
    }

    /// Whether the polygon holds the direction straight down on a line. A great half circle from there to the opposite direction
    /// meets the outline an odd number of times if one of the two lies within; it is that through n, across the scratch.
    fn holds_down(&self, t: DVec2, line: BandLine) -> bool {
        // In front of the ray down the line; n is as far off as the horizon.
        let front = along_tangent(t, self.away) * line.along - self.away.z * line.radius;
        let side = |v: DVec3| along_tangent(t, v) * line.radius + v.z * line.along;
        front > 0.0 && self.odd_crossings(t, side)
    }

    /// Whether the polygon holds the tangent's direction or the opposite one, as [`Self::holds_down`].
    fn holds_pole(&self, t: DVec2) -> bool {
        self.odd_crossings(t, |v| v.z)
    }

    /// Whether half of a great circle through n meets the outline an odd number of times. `side` is the distance of a vertex to
    /// the circle's plane: two edges that share a vertex get the same sign for it.
    fn odd_crossings(&self, t: DVec2, side: impl Fn(DVec3) -> f64) -> bool {
        let Some(last) = self.edges.last() else {
            return false;
        };
        let mut odd = false;
        let mut a = (side(last.start), last.start);
        for edge in self.edges {
            let b = (side(edge.start), edge.start);
            if (a.0 < 0.0) != (b.0 < 0.0) {
                let (across_a, across_b) = (along_normal(t, a.1), along_normal(t, b.1));
                odd ^= (across_a * b.0 - across_b * a.0) * (b.0 - a.0) > 0.0;
            }
            a = b;
        }
        odd
    }
}

/// Whether the tangent component has its greatest value (`sign` above 0) or its least (below) between an edge's ends: `a` is that
/// of its start and `e` that of the direction across.
#[inline]
fn turns_back(a: f64, e: f64, edge: &OutlineEdge, sign: f64) -> bool {
    (sign > 0.0 && e > 0.0 && e * edge.cos < a * edge.sin)
        || (sign < 0.0 && e < 0.0 && e * edge.cos > a * edge.sin)
}

#[cfg(test)]
mod tests;
