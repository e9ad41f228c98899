//! Intersects an area light with the band of a scratch (docs/model.md, section 4; after Velinov, Werner, Hullin, *Real-Time Rendering of
//! Wave-Optical Effects on Scratched Surfaces*, 2018; the signed boundary sum is Hairline's own).
//!
//! A scratch lights the directions with xi_t = 0, a Gaussian band around them in truth. Directions of one line of the band
//! form a cone about the tangent: w(phi) = w_t t + r (cos phi n + sin phi N), phi in [0, pi] above the horizon. A light
//! cuts chords out of it, bounded by roots; the integral over the chords is a SIGNED SUM over roots, each alone: where phi
//! enters the light the antiderivative at q = wo_n + w_n counts plus, where it leaves minus. No clip, no sort, no pairing.
//!
//! Below the horizon nothing is lit, so the antiderivative is constant there: a root under the horizon counts with the q
//! of the nearer end of the arc. That moves its jump to the direction straight down, and a light that covers that
//! direction adds the whole arc once ([`Chord::wraps`]). Crossing the horizon is continuous by construction.
//!
//! All vectors are in the scratch's frame: x along the tangent t, y across it along n, z along the surface normal N.

mod drawn;
mod lines;
mod outline;
mod tube;

pub use drawn::DrawnChord;
pub use lines::{
    Along, BAND_REACH_STD, BAND_STD_MAX, BandLines, BandMotion, BandPlace, BandStds, MovedBand,
    band_is_whole, band_lines, band_moves, band_stds, band_stds_seen_by, moved_band,
};
pub use outline::{Outline, OutlineEdge, OutlineRoots};
pub use tube::{TUBE_CORNERS, TubeOutline, tube_outline};

use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// One line of the band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandLine {
    /// Component along the tangent of all directions on the line, xi_t - wo_t.
    pub along: f64,
    /// Radius of the cone's circle, sqrt(1 - along^2).
    pub radius: f64,
    /// wo_n: q = wo_n + w_n.
    pub offset: f64,
}

impl BandLine {
    /// The line at `xi_t` seen from `wo`.
    #[inline]
    pub fn new(wo: DVec3, xi_t: f64) -> Self {
        let along = xi_t - wo.x;
        Self {
            along,
            radius: (1.0 - along * along).max(0.0).sqrt(),
            offset: wo.y,
        }
    }

    /// q at phi = 0.
    #[inline]
    pub fn q_start(self) -> f64 {
        self.offset + self.radius
    }

    /// q at phi = pi.
    #[inline]
    pub fn q_end(self) -> f64 {
        self.offset - self.radius
    }

    /// The direction above the horizon at `q`.
    #[inline]
    pub fn direction_at(self, q: f64) -> DVec3 {
        DVec3::new(self.along, q - self.offset, self.cos_at(q))
    }

    /// Cosine to the normal of the direction above the horizon at `q`.
    #[inline]
    pub(crate) fn cos_at(self, q: f64) -> f64 {
        let across = q - self.offset;
        ((self.radius - across) * (self.radius + across))
            .max(0.0)
            .sqrt()
    }

    /// q of a direction on the line with components (across, up); roots below the horizon move to the nearer end.
    #[inline]
    fn q(self, across: f64, up: f64) -> f64 {
        let inside = across.clamp(-self.radius, self.radius);
        self.offset
            + if up >= 0.0 {
                inside
            } else {
                self.radius.copysign(across)
            }
    }
}

/// Scale of the weight that stands for sinc^2 in [`chord_cos`], as u = W q. From 0.15 to 0.25 um the errors change little.
const CHORD_WEIGHT_UM: f64 = 0.2;

/// Cosine to the normal of the directions of a line from `low` to `high` in q, as a scratch of width `width_um` weighs them:
/// the mean at two Gauss nodes in x = q / (|q| + h), that is with the density h / (|q| + h)^2 in the place of sinc^2.
#[inline]
pub fn chord_cos(line: BandLine, low: f64, high: f64, width_um: f64) -> f64 {
    let h = CHORD_WEIGHT_UM / width_um.max(1e-3);
    let (x_low, x_high) = (low / (low.abs() + h), high / (high.abs() + h));
    let cos_at = |node: f64| {
        let x = x_low + (x_high - x_low) * node;
        line.cos_at((h * x / (1.0 - x.abs()).max(1e-9)).clamp(low, high))
    };
    0.5 * (cos_at(0.211_324_865_405_187) + cos_at(0.788_675_134_594_813))
}

/// A light's chord on one line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord {
    /// q where phi enters the light.
    pub enter: f64,
    /// q where phi leaves it.
    pub leave: f64,
    /// Whether the light covers the direction straight down, so that the whole arc counts once more.
    pub wraps: bool,
}

impl Chord {
    /// Least and greatest q that the light covers; the whole arc where it goes around the nadir.
    #[inline]
    pub fn range(&self, line: BandLine) -> (f64, f64) {
        if self.wraps {
            (line.q_end(), line.q_start())
        } else {
            (self.leave, self.enter)
        }
    }

    /// The sign with which the antiderivative counts at each root, and q; those of the whole arc where the light covers the direction straight down.
    pub fn signed(&self, line: BandLine) -> impl Iterator<Item = (f64, f64)> {
        let arc = [(1.0, line.q_start()), (-1.0, line.q_end())];
        let wraps = arc.into_iter().take(if self.wraps { 2 } else { 0 });
        [(1.0, self.enter), (-1.0, self.leave)]
            .into_iter()
            .chain(wraps)
    }

    /// The light integral, given the antiderivative over q.
    pub fn integral<const C: usize>(
        &self,
        line: BandLine,
        antiderivative: impl Fn(f64) -> [f64; C],
    ) -> [f64; C] {
        let mut sum = [0.0; C];
        let mut add = |high: f64, low: f64| {
            let (high, low) = (antiderivative(high), antiderivative(low));
            (0..C).for_each(|c| sum[c] += high[c] - low[c]);
        };
        add(self.enter, self.leave);
        if self.wraps {
            add(line.q_start(), line.q_end());
        }
        sum
    }
}

/// A spherical light as a cap of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cap {
    /// Unit direction of the cap's centre.
    pub axis: DVec3,
    /// Sine of the cap's angular radius; 1 if the point lies inside the sphere.
    pub sin_radius: f64,
    /// Cosine of the cap's angular radius; -1 if the point lies inside the sphere, which lights every direction.
    pub cos_radius: f64,
}

impl Cap {
    /// A cap of the surface's frame in the frame of a scratch.
    #[inline]
    pub fn turned(self, frame: BandFrame) -> Self {
        Self {
            axis: frame.band_from_surface(self.axis),
            ..self
        }
    }
}

/// Cap that a sphere covers as seen from a point; `center` is relative to the point, in any unit of length, which is the radius's too.
pub fn sphere_cap(center: DVec3, radius: f64) -> Cap {
    let distance2 = center.length_squared();
    let sin2 = radius * radius / distance2;
    if sin2 < 1.0 {
        Cap {
            axis: center / distance2.sqrt(),
            sin_radius: sin2.sqrt(),
            cos_radius: (1.0 - sin2).sqrt(),
        }
    } else {
        Cap {
            axis: DVec3::Z,
            sin_radius: 0.0,
            cos_radius: -1.0,
        }
    }
}

/// The least and greatest xi_t of a cap.
#[inline]
pub fn sphere_band_extent(wo: DVec3, cap: Cap) -> (f64, f64) {
    let (along, rest) = (cap.axis.x, (1.0 - cap.axis.x * cap.axis.x).max(0.0).sqrt());
    let (middle, reach) = (along * cap.cos_radius, rest * cap.sin_radius);
    // A cap that holds the pole of the tangent reaches all the way to it.
    let lowest = if -along >= cap.cos_radius {
        -1.0
    } else {
        middle - reach
    };
    let highest = if along >= cap.cos_radius {
        1.0
    } else {
        middle + reach
    };
    (wo.x + lowest, wo.x + highest)
}

/// The chord that a cap cuts out of a line. Half-angle (haversine) forms, since caps may be tiny:
/// sin^2(Delta/2) = (sin^2(alpha/2) - sin^2((gamma_c - gamma_w)/2)) / (cos gamma_c cos gamma_w), gamma the elevations
/// of the cap's axis and of the line over the plane across the tangent.
#[inline]
pub fn sphere_chord(line: BandLine, cap: Cap) -> Chord {
    let none = Chord {
        enter: line.offset,
        leave: line.offset,
        wraps: false,
    };
    let rest = (1.0 - cap.axis.x * cap.axis.x).max(0.0).sqrt();
    let sin_gap = cap.axis.x * line.radius - line.along * rest;
    let cos_gap = rest * line.radius + cap.axis.x * line.along;
    // sin^2(x/2) = sin^2 x / (2 (1 + cos x)) does not cancel for small x; 1 - cos x does not for large.
    let half = |sin: f64, cos: f64| {
        if cos > 0.0 {
            0.5 * sin * sin / (1.0 + cos)
        } else {
            0.5 * (1.0 - cos)
        }
    };
    let s2 = (half(cap.sin_radius, cap.cos_radius) - half(sin_gap, cos_gap))
        / (rest * line.radius).max(1e-12);
    if s2 <= 0.0 {
        return none;
    }
    if s2 >= 1.0 {
        return Chord {
            wraps: true,
            ..none
        };
    }
    let (cos_delta, sin_delta) = (1.0 - 2.0 * s2, 2.0 * (s2 * (1.0 - s2)).sqrt());
    let (across, up) = (cap.axis.y / rest.max(1e-12), cap.axis.z / rest.max(1e-12));
    let point = |sin: f64| {
        (
            line.radius * (across * cos_delta + up * sin),
            line.radius * (up * cos_delta - across * sin),
        )
    };
    let (enter, leave) = (point(sin_delta), point(-sin_delta));
    Chord {
        enter: line.q(enter.0, enter.1),
        leave: line.q(leave.0, leave.1),
        wraps: -up > cos_delta,
    }
}

/// Roots of one polygon edge on a line. Edges are independent; their roots may be summed in any order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EdgeRoots {
    /// q where the edge, walked from a to b, crosses the line towards +t; phi enters the polygon there.
    pub rising: Option<f64>,
    /// q where it crosses towards -t; phi leaves the polygon there.
    pub falling: Option<f64>,
}

/// The roots of the edge from direction `a` to direction `b` (unit vectors) on a line. Whether a vertex lies beyond the
/// line is decided from that vertex alone, so that the edges that share it agree and every closed polygon has as many
/// rising roots as falling ones. For a polygon seen counter-clockwise; clockwise ones take the opposite sign.
pub(crate) fn edge_roots(line: BandLine, a: DVec3, b: DVec3) -> EdgeRoots {
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
pub(crate) fn edge_band_extent(a: DVec3, b: DVec3) -> (f64, f64) {
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
pub(crate) fn edge_winding(about: DVec3, a: DVec3, b: DVec3) -> f64 {
    let sin = about.dot(a.cross(b));
    let cos = a.dot(b) - a.dot(about) * b.dot(about);
    sin.atan2(cos)
}

/// The direction straight down on the line.
pub(crate) fn line_down(line: BandLine) -> DVec3 {
    DVec3::new(line.along, 0.0, -line.radius)
}

/// The axes of a scratch within the frame of the surface: vectors with z along N turn about it until x lies along t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandFrame {
    /// The unit tangent t in the surface's x and y.
    pub tangent: DVec2,
}

impl BandFrame {
    /// A vector of the surface's frame in the frame of the scratch.
    #[inline]
    pub fn band_from_surface(self, v: DVec3) -> DVec3 {
        let t = self.tangent;
        DVec3::new(v.x * t.x + v.y * t.y, v.y * t.x - v.x * t.y, v.z)
    }

    /// The inverse of [`Self::band_from_surface`].
    #[inline]
    pub fn surface_from_band(self, v: DVec3) -> DVec3 {
        let t = self.tangent;
        DVec3::new(v.x * t.x - v.y * t.y, v.x * t.y + v.y * t.x, v.z)
    }
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

#[cfg(test)]
mod tests;
