//! Where an area light meets the band of a scratch (docs/model.md, section 4; after Velinov, Werner, Hullin, *Real-Time
//! Rendering of Wave-Optical Effects on Scratched Surfaces*, 2018; the signed boundary sum is Hairline's own).
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

use glam::{DVec2, DVec3};
use spec_math::cephes64::{ndtr, ndtri};
use std::f64::consts::PI;

/// The band is cut off at this many standard deviations; 6e-5 of its energy lies beyond.
pub const BAND_REACH_STD: f64 = 4.0;

/// One line of the band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandLine {
    /// Component of its directions along the tangent, xi_t - wo_t.
    pub along: f64,
    /// Radius of the cone's circle, sqrt(1 - along^2).
    pub radius: f64,
    /// wo_n: q = wo_n + w_n.
    pub offset: f64,
}

impl BandLine {
    /// The line at `xi_t` seen from `wo`.
    pub fn new(wo: DVec3, xi_t: f64) -> Self {
        let along = xi_t - wo.x;
        Self {
            along,
            radius: (1.0 - along * along).max(0.0).sqrt(),
            offset: wo.y,
        }
    }

    /// q at phi = 0.
    pub fn q_start(self) -> f64 {
        self.offset + self.radius
    }

    /// q at phi = pi.
    pub fn q_end(self) -> f64 {
        self.offset - self.radius
    }

    /// q of a direction on the line with components (across, up); roots below the horizon move to the nearer end.
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

/// The lines that stand for the part of the band which a light covers, given the extent of the light's xi_t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandLines {
    /// Number of lines: 0 (dark), 1, 3 or 5.
    pub count: usize,
    /// The band's share below the light's extent.
    pub share_below: f64,
    /// The band's share within the light's extent.
    pub share: f64,
    /// Standard deviation of the band.
    pub std_xi: f64,
}

/// Standard deviation of the band as a pixel sees it on a curved surface: the surface's normal turns under the footprint, and
/// with it xi_t = (wi + wo).t by minus the normal's turn along t, times (wi + wo).N. `turn_t` is the turn of the normal along
/// t over one standard deviation of the pixel's filter to the right and down; `cos_sum` is (wi + wo).N.
pub fn curved_band_std(std_xi: f64, turn_t: [f64; 2], cos_sum: f64) -> f64 {
    let turn2 = turn_t[0] * turn_t[0] + turn_t[1] * turn_t[1];
    (std_xi * std_xi + cos_sum * cos_sum * turn2)
        .sqrt()
        .min(BAND_STD_MAX)
}

/// Beyond this a pixel sees light from all around, and the small-angle picture of a turning normal is void.
pub const BAND_STD_MAX: f64 = 0.3;

/// Whether a light of the given extent in xi_t meets the band at all.
pub fn band_reaches(lowest: f64, highest: f64, std_xi: f64) -> bool {
    lowest < BAND_REACH_STD * std_xi && highest > -BAND_REACH_STD * std_xi && highest > lowest
}

/// Chooses the lines; `wo_t` is the component of `wo` along the tangent. Large lights cover the whole band evenly and one
/// line is enough; small ones need the band's shape, and so does a viewer who looks along the scratch, where neighbouring
/// lines are arcs of very different radius.
pub fn band_lines(wo_t: f64, lowest: f64, highest: f64, std_xi: f64) -> BandLines {
    if !band_reaches(lowest, highest, std_xi) {
        return BandLines {
            count: 0,
            share_below: 0.0,
            share: 0.0,
            std_xi,
        };
    }
    let half_extent = 0.5 * (highest - lowest) / std_xi;
    let steep = 1.0 - wo_t * wo_t < 32.0 * std_xi * wo_t.abs();
    // The tests print the errors against 2-D quadrature: below 0.7 % everywhere.
    let count = if half_extent < 3.0 || steep {
        5
    } else if half_extent < 16.0 {
        3
    } else {
        1
    };
    let share_below = ndtr(lowest / std_xi);
    BandLines {
        count,
        share_below,
        share: ndtr(highest / std_xi) - share_below,
        std_xi,
    }
}

/// Gauss-Legendre nodes on [0, 1] and weights, for 1, 3 and 5 points.
const NODES: [[(f64, f64); 5]; 3] = [
    [(0.5, 1.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)],
    [
        (0.112_701_665_379_258, 0.277_777_777_777_778),
        (0.5, 0.444_444_444_444_444),
        (0.887_298_334_620_742, 0.277_777_777_777_778),
        (0.0, 0.0),
        (0.0, 0.0),
    ],
    [
        (0.046_910_077_030_668, 0.118_463_442_528_095),
        (0.230_765_344_947_158, 0.239_314_335_249_683),
        (0.5, 0.284_444_444_444_444),
        (0.769_234_655_052_842, 0.239_314_335_249_683),
        (0.953_089_922_969_332, 0.118_463_442_528_095),
    ],
];

impl BandLines {
    /// xi_t and weight of line `i`: Gauss-Legendre in the band's cumulative share, which follows the band where the light is
    /// wide and the light where it is narrow. The weights sum to the band's share within the light's extent.
    pub fn band_line(&self, i: usize) -> (f64, f64) {
        let (node, weight) = NODES[self.count / 2][i];
        // The quantile is cut where single precision loses it; the band's reach ends before.
        let quantile = (self.share_below + self.share * node).clamp(1e-6, 1.0 - 1e-6);
        (self.std_xi * ndtri(quantile), self.share * weight)
    }
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
    /// The light integral, given the antiderivative over q.
    pub fn integral<const C: usize>(
        &self,
        line: BandLine,
        antiderivative: impl Fn(f64) -> [f64; C],
    ) -> [f64; C] {
        let (enter, leave) = (antiderivative(self.enter), antiderivative(self.leave));
        let mut sum: [f64; C] = std::array::from_fn(|c| enter[c] - leave[c]);
        if self.wraps {
            let (start, end) = (antiderivative(line.q_start()), antiderivative(line.q_end()));
            sum = std::array::from_fn(|c| sum[c] + start[c] - end[c]);
        }
        sum
    }
}

/// A spherical light as a cap of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cap {
    /// Unit direction of its centre.
    pub axis: DVec3,
    /// Sine of its angular radius; 1 if the point lies inside the sphere.
    pub sin_radius: f64,
    /// Cosine of its angular radius; -1 if the point lies inside the sphere, which lights every direction.
    pub cos_radius: f64,
}

impl Cap {
    /// A cap of the surface's frame in the frame of a scratch.
    pub fn turned(self, frame: BandFrame) -> Self {
        Self {
            axis: frame.band_from_surface(self.axis),
            ..self
        }
    }
}

/// The cap of a sphere whose centre lies at `center` from the point (any unit of length, the radius's too).
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
pub struct EdgeRoots {
    /// q where the edge, walked from a to b, crosses the line towards +t; phi enters the polygon there.
    pub rising: Option<f64>,
    /// q where it crosses towards -t; phi leaves the polygon there.
    pub falling: Option<f64>,
}

/// The roots of the edge from direction `a` to direction `b` (unit vectors) on a line. Whether a vertex lies beyond the
/// line is decided from that vertex alone, so that the edges that share it agree and every closed polygon has as many
/// rising roots as falling ones. For a polygon seen counter-clockwise; clockwise ones take the opposite sign.
pub fn edge_roots(line: BandLine, a: DVec3, b: DVec3) -> EdgeRoots {
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
pub fn edge_band_extent(a: DVec3, b: DVec3) -> (f64, f64) {
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

/// The angle by which the edge from `a` to `b` (unit vectors) turns about the unit direction `about`. Summed over a
/// polygon's edges: 2 pi or -2 pi if the polygon encloses that direction or its opposite, else 0.
pub fn edge_winding(about: DVec3, a: DVec3, b: DVec3) -> f64 {
    let sin = about.dot(a.cross(b));
    let cos = a.dot(b) - a.dot(about) * b.dot(about);
    sin.atan2(cos)
}

/// The direction straight down on the line.
pub fn line_down(line: BandLine) -> DVec3 {
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
    pub fn band_from_surface(self, v: DVec3) -> DVec3 {
        let t = self.tangent;
        DVec3::new(v.x * t.x + v.y * t.y, v.y * t.x - v.x * t.y, v.z)
    }

    /// The inverse of [`Self::band_from_surface`].
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
    /// Its plane's normal (of any length), turned away from the point.
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

/// How a planar polygon faces a point: its normal turned away from the point, and [`PolygonView::facing`]. `vertices` are
/// relative to the point.
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
mod tests {
    use super::*;
    use crate::diffraction::chord_integral;
    use crate::scratch::band_std;

    const SIGMA_UM: f64 = 20.0;
    const NM: f64 = 555.0;

    /// A deterministic sequence of numbers in [0, 1).
    struct Sequence(u64);
    impl Sequence {
        fn next(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }
        fn between(&mut self, a: f64, b: f64) -> f64 {
            a + (b - a) * self.next()
        }
        fn direction(&mut self, lowest_z: f64) -> DVec3 {
            let z = self.between(lowest_z, 1.0);
            let (sin, cos) = self.between(0.0, 2.0 * PI).sin_cos();
            let r = (1.0 - z * z).sqrt();
            DVec3::new(r * cos, r * sin, z)
        }
    }

    /// The integral of the band's Gaussian times sinc^2 over the directions above the horizon that a light covers:
    /// over the plane of (w_t, w_n), with the indicator function of the light. Shares no formula with the roots.
    fn quadrature(
        wo: DVec3,
        width_um: f64,
        covers: impl Fn(DVec3) -> bool,
        lines: usize,
        steps: usize,
        single_line: bool,
    ) -> f64 {
        let std_xi = band_std(SIGMA_UM, NM);
        let mut sum = 0.0;
        let line_count = if single_line { 1 } else { lines };
        for i in 0..line_count {
            let z = if single_line {
                0.0
            } else {
                -4.5 + 9.0 * (i as f64 + 0.5) / lines as f64
            };
            let weight = if single_line {
                1.0
            } else {
                (-0.5 * z * z).exp() / (2.0 * PI).sqrt() * 9.0 / lines as f64
            };
            let w_t = z * std_xi - wo.x;
            if w_t.abs() >= 1.0 {
                continue;
            }
            let r = (1.0 - w_t * w_t).sqrt();
            // Midpoints in phi; bisection would be a chord finder, so plain indicator sampling it is.
            for j in 0..steps {
                let phi = PI * (j as f64 + 0.5) / steps as f64;
                let w = DVec3::new(w_t, r * phi.cos(), r * phi.sin());
                if covers(w) {
                    let x = 2.0 * PI / (NM * 1e-3) * width_um * (wo.y + w.y) / 2.0;
                    let sinc = if x == 0.0 { 1.0 } else { x.sin() / x };
                    sum += weight * sinc * sinc * r * phi.sin() * PI / steps as f64;
                }
            }
        }
        sum
    }

    fn sphere_integral(wo: DVec3, cap: Cap, width_um: f64) -> f64 {
        let (lowest, highest) = sphere_band_extent(wo, cap);
        lines_integral(wo, lowest, highest, |line| {
            sphere_chord(line, cap).integral(line, |q| [chord_integral(q, width_um, NM * 1e-3)])[0]
        })
    }

    /// The scratch's frame is the surface's where a test needs no other.
    const ALONG_X: BandFrame = BandFrame { tangent: DVec2::X };

    fn with_view<R>(vertices: &[DVec3], two_sided: bool, f: impl Fn(&PolygonView) -> R) -> R {
        let directions: Vec<DVec3> = vertices.iter().map(|v| v.normalize_or_zero()).collect();
        let (away, facing) = polygon_facing(vertices.iter().copied(), two_sided);
        f(&PolygonView {
            directions: &directions,
            away,
            facing,
        })
    }

    fn one_line(vertices: &[DVec3], line: BandLine, antiderivative: impl Fn(f64) -> f64) -> f64 {
        with_view(vertices, true, |view| {
            view.integral(ALONG_X, line, |q| [antiderivative(q)])[0]
        })
    }

    fn polygon_integral(wo: DVec3, vertices: &[DVec3], width_um: f64) -> f64 {
        let (lowest, highest) = with_view(vertices, true, |view| view.band_extent(ALONG_X, wo));
        lines_integral(wo, lowest, highest, |line| {
            one_line(vertices, line, |q| chord_integral(q, width_um, NM * 1e-3))
        })
    }

    fn lines_integral(
        wo: DVec3,
        lowest: f64,
        highest: f64,
        on_line: impl Fn(BandLine) -> f64,
    ) -> f64 {
        let lines = band_lines(wo.x, lowest, highest, band_std(SIGMA_UM, NM));
        (0..lines.count)
            .map(|i| {
                let (xi_t, weight) = lines.band_line(i);
                weight * on_line(BandLine::new(wo, xi_t))
            })
            .sum()
    }

    fn relative_rms(pairs: &[(f64, f64)]) -> f64 {
        let (error2, value2) = pairs.iter().fold((0.0, 0.0), |(e, v), (value, expected)| {
            (e + (value - expected).powi(2), v + expected * expected)
        });
        (error2 / value2).sqrt()
    }

    #[test]
    fn sphere_lights_equal_two_dimensional_quadrature() {
        let std_xi = band_std(SIGMA_UM, NM);
        for (radius, bound) in [
            (0.001, 0.01),
            (0.005, 0.01),
            (0.02, 0.01),
            (0.049, 0.01),
            (0.05, 0.01),
            (0.15, 0.005),
            (0.6, 0.005),
        ] {
            let mut random = Sequence(7);
            let mut pairs = Vec::new();
            while pairs.len() < 24 {
                let wo = random.direction(0.2);
                // Near the band, or there is nothing to compare.
                let (offset, turn) = (
                    random.between(-1.5, 1.5) * (radius + std_xi),
                    random.between(0.0, PI),
                );
                let w_t = -wo.x + offset;
                if w_t.abs() > 0.9 {
                    continue;
                }
                let r = (1.0 - w_t * w_t).sqrt();
                let axis = DVec3::new(w_t, r * turn.cos(), r * turn.sin());
                let cap = Cap {
                    axis,
                    sin_radius: f64::sin(radius),
                    cos_radius: f64::cos(radius),
                };
                let steps = (2000.0 / radius.min(0.2)) as usize;
                // A chord much shorter than the arc needs fine steps only near the light.
                let expected = quadrature(
                    wo,
                    2.0,
                    |w| (w - axis).length() < 2.0 * (radius / 2.0).sin(),
                    if radius < 0.01 { 401 } else { 121 },
                    steps.min(40_000),
                    false,
                );
                pairs.push((sphere_integral(wo, cap, 2.0), expected));
            }
            let rms = relative_rms(&pairs);
            println!(
                "sphere of {radius} rad: relative rms error {:.3} %",
                100.0 * rms
            );
            assert!(rms < bound, "{radius}: {rms}");
        }
    }

    #[test]
    fn one_line_through_a_sphere_is_exact_wherever_it_lies() {
        // On the line itself there is nothing to approximate: horizon, point under the light, huge lights.
        let mut random = Sequence(3);
        let mut pairs = Vec::new();
        for _ in 0..200 {
            let (wo, axis, radius) = (
                random.direction(0.0),
                random.direction(-1.0),
                random.between(0.05, 3.0),
            );
            let cap = Cap {
                axis,
                sin_radius: f64::sin(radius),
                cos_radius: f64::cos(radius),
            };
            let line = BandLine::new(wo, 0.0);
            let value =
                sphere_chord(line, cap).integral(line, |q| [chord_integral(q, 2.0, NM * 1e-3)])[0];
            pairs.push((
                value,
                quadrature(wo, 2.0, |w| w.dot(axis) > f64::cos(radius), 1, 20_000, true),
            ));
        }
        let rms = relative_rms(&pairs);
        println!("sphere, one line: relative rms error {:.4} %", 100.0 * rms);
        assert!(rms < 1e-3);
    }

    /// A random planar polygon, star-shaped about its centre and seldom convex, with its plane's normal.
    fn random_polygon(random: &mut Sequence, size: f64) -> Vec<DVec3> {
        let center = random.direction(-0.4) * random.between(0.5, 2.0);
        let normal = random.direction(-1.0);
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let count = 3 + (random.next() * 6.0) as usize;
        (0..count)
            .map(|i| {
                let (sin, cos) =
                    (2.0 * PI * (i as f64 + 0.8 * random.next()) / count as f64).sin_cos();
                center + size * random.between(0.2, 1.0) * (u * cos + v * sin)
            })
            .collect()
    }

    /// Whether the ray from the origin hits the polygon: planar crossing number.
    fn hits(vertices: &[DVec3], w: DVec3) -> bool {
        let normal: DVec3 = (1..vertices.len() - 1)
            .map(|i| (vertices[i] - vertices[0]).cross(vertices[i + 1] - vertices[0]))
            .sum();
        let t = normal.dot(vertices[0]) / normal.dot(w);
        if !(t > 0.0) {
            return false;
        }
        let u = normal.any_orthonormal_vector();
        let v = normal.normalize().cross(u);
        let flat = |p: DVec3| (p.dot(u), p.dot(v));
        let (px, py) = flat(w * t);
        let mut inside = false;
        for i in 0..vertices.len() {
            let ((ax, ay), (bx, by)) =
                (flat(vertices[i]), flat(vertices[(i + 1) % vertices.len()]));
            if (ay > py) != (by > py) && px < ax + (py - ay) / (by - ay) * (bx - ax) {
                inside = !inside;
            }
        }
        inside
    }

    #[test]
    fn one_line_through_any_polygon_is_exact() {
        let mut random = Sequence(11);
        let (mut pairs, mut crossing, mut covering_down) = (Vec::new(), 0, 0);
        while pairs.len() < 174 {
            let size = random.between(0.1, 6.0);
            let vertices = random_polygon(&mut random, size);
            let wo = random.direction(0.0);
            let line = BandLine::new(wo, 0.0);
            let expected = quadrature(wo, 2.0, |w| hits(&vertices, w), 1, 20_000, true);
            if expected == 0.0 && random.next() < 0.9 {
                continue;
            }
            crossing += vertices.iter().any(|v| v.z < 0.0) as u32;
            covering_down += hits(&vertices, line_down(line)) as u32;
            pairs.push((
                one_line(&vertices, line, |q| chord_integral(q, 2.0, NM * 1e-3)),
                expected,
            ));
        }
        let rms = relative_rms(&pairs);
        println!(
            "polygon, one line: relative rms error {:.4} % on {} polygons, {crossing} across the horizon, {covering_down} over the nadir",
            100.0 * rms,
            pairs.len()
        );
        assert!(
            crossing > 40 && covering_down > 4,
            "the set must hold the hard cases"
        );
        // 20,000 steps place each root within 1.6e-4 rad.
        assert!(rms < 1e-3, "{rms}");
    }

    #[test]
    fn polygon_lights_equal_two_dimensional_quadrature() {
        let mut random = Sequence(5);
        for size in [0.01, 0.05, 0.3] {
            let mut pairs = Vec::new();
            while pairs.len() < 24 {
                let mut vertices = random_polygon(&mut random, size);
                let wo = random.direction(0.3);
                // Moved onto the band.
                let center: DVec3 = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
                let w_t = -wo.x + random.between(-1.0, 1.0) * 0.3 * size;
                if w_t.abs() > 0.8 {
                    continue;
                }
                let (sin, cos) = random.between(0.3, PI - 0.3).sin_cos();
                let r = (1.0 - w_t * w_t).sqrt();
                let target = DVec3::new(w_t, r * cos, r * sin);
                vertices.iter_mut().for_each(|v| *v += target - center);
                let expected = quadrature(wo, 2.0, |w| hits(&vertices, w), 121, 20_000, false);
                if expected > 0.0 {
                    pairs.push((polygon_integral(wo, &vertices, 2.0), expected));
                }
            }
            let rms = relative_rms(&pairs);
            println!("polygon of {size}: relative rms error {:.3} %", 100.0 * rms);
            assert!(rms < 0.015, "{size}: {rms}");
        }
    }

    /// A panel beyond the far end of the scratch, looked at along it: the band's arcs are small circles about the tangent,
    /// which the panel may hold whole, and its outline never meets them.
    #[test]
    fn panels_around_the_tangent_equal_two_dimensional_quadrature() {
        let mut pairs = Vec::new();
        for bottom in [-0.3, -0.05, 0.0, 0.01] {
            for elevation in [0.05f64, 0.1, 0.2] {
                let wo = DVec3::new(elevation.cos(), 0.0, elevation.sin());
                let corner = |y: f64, z: f64| DVec3::new(-1.0, y, z);
                let vertices = [
                    corner(-0.3, bottom),
                    corner(0.3, bottom),
                    corner(0.3, bottom + 0.6),
                    corner(-0.3, bottom + 0.6),
                ];
                let expected = quadrature(wo, 2.0, |w| hits(&vertices, w), 241, 20_000, false);
                let value = polygon_integral(wo, &vertices, 2.0);
                println!(
                    "panel from {bottom} seen at {elevation} rad: {value:.4}, quadrature {expected:.4}"
                );
                pairs.push((value, expected));
            }
        }
        let rms = relative_rms(&pairs);
        println!(
            "panels around the tangent: relative rms error {:.3} %",
            100.0 * rms
        );
        assert!(rms < 5e-3, "{rms}");
    }

    #[test]
    fn a_one_sided_polygon_is_dark_from_behind() {
        let front = [
            DVec3::new(-1.0, -1.0, 2.0),
            DVec3::new(-1.0, 1.0, 2.0),
            DVec3::new(1.0, 1.0, 2.0),
            DVec3::new(1.0, -1.0, 2.0),
        ];
        let line = BandLine::new(DVec3::Z, 0.0);
        let seen = |vertices: &[DVec3], two_sided| {
            with_view(vertices, two_sided, |view| {
                view.integral(ALONG_X, line, |q| [q])[0]
            })
        };
        let back: Vec<DVec3> = front.iter().rev().copied().collect();
        assert!(
            seen(&front, false) > 0.1,
            "counter-clockwise seen from below faces down"
        );
        assert_eq!(seen(&back, false), 0.0);
        assert!((seen(&back, true) - seen(&front, true)).abs() < 1e-12);
    }

    #[test]
    fn no_input_yields_nan() {
        let mut random = Sequence(1);
        let awkward = [0.0, 1.0, -1.0, 1e-12, 1e-6];
        for i in 0..20_000 {
            let mut pick = || {
                if random.next() < 0.3 {
                    awkward[(random.next() * 5.0) as usize]
                } else {
                    random.between(-1.0, 1.0)
                }
            };
            let wo = DVec3::new(pick(), pick(), pick().abs()).normalize_or(DVec3::Z);
            let vertices: Vec<DVec3> = (0..3 + i % 4)
                .map(|_| DVec3::new(pick(), pick(), pick()))
                .collect();
            let value = polygon_integral(wo, &vertices, 2.0)
                + sphere_integral(wo, sphere_cap(vertices[0], vertices[1].x.abs()), 2.0);
            assert!(value.is_finite(), "{wo} {vertices:?}");
        }
    }
}
