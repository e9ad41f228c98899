//! A polygon on the lobe of [`BrushedLobe`].
//!
//! Slices lie across the polygon: in slopes over their alphas, in which the lobe is round, they are perpendicular to its outline where most facets
//! are. The part of a slice that sees the polygon then changes slowly from slice to slice, however long and thin the polygon is and whichever way it
//! runs: slices along a fixed axis would see a thin one, which crosses the lobe obliquely, for a moment between two nodes.

use glam::{DVec2, DVec3, Vec2Swizzles};

use super::slice::FAR;
use super::{BrushedLobe, turned};
use crate::fresnel::FresnelRgb;

/// Newton's steps: each doubles the digits.
const NEWTON_ROUNDS: usize = 5;
/// Chords that stand for an edge of a unit's length as seen from the point, in [`OutlineAxis`].
const CHORDS: f64 = 6.0;

/// Which way an outline runs where most facets are, and how near it gets to them; in slopes over their alphas.
struct OutlineAxis {
    /// Sum over chords of the facets' density times the length: cosine and sine of twice the angle.
    doubled: DVec2,
    /// Square of the outline's distance from the middle.
    nearest_squared: f64,
    /// Whether the outline is around the middle.
    is_around: bool,
}

impl OutlineAxis {
    const NONE: Self = Self {
        doubled: DVec2::ZERO,
        nearest_squared: FAR,
        is_around: false,
    };

    fn add_chord(&mut self, from: DVec2, to: DVec2) {
        let length = (to - from).length();
        if length <= 0.0 {
            return;
        }
        let along = (to - from) / length;
        let (start, off) = (from.dot(along), from.perp_dot(along));
        let end = start + length;
        // The integral of (1 + r^2)^(-3/2).
        let wide2 = 1.0 + off * off;
        let up_to = |l: f64| l / (wide2 * (wide2 + l * l).sqrt());
        let doubled = DVec2::new(
            (along.x - along.y) * (along.x + along.y),
            2.0 * along.x * along.y,
        );
        self.doubled += (up_to(end) - up_to(start)) * doubled;
        let beside = start.max(-end).max(0.0);
        self.nearest_squared = self.nearest_squared.min(off * off + beside * beside);
        if (from.y > 0.0) != (to.y > 0.0) && (from.x * to.y - to.x * from.y > 0.0) == (to.y > 0.0) {
            self.is_around = !self.is_around;
        }
    }

    /// The unit vector along the outline.
    fn direction(&self) -> DVec2 {
        DVec2::from_angle(0.5 * self.doubled.y.atan2(self.doubled.x))
    }

    /// Scale on which the facets' density changes along the outline.
    fn scale(&self) -> f64 {
        if self.is_around {
            1.0
        } else {
            (1.0 + self.nearest_squared).sqrt()
        }
    }
}

impl BrushedLobe {
    /// Computes what [`BrushedLobe::sphere`] does for a plane polygon, convex or not, in either orientation. The vertices are relative to the point, in
    /// the local frame.
    pub fn polygon(&self, vertices: &[DVec3], of: &FresnelRgb) -> [f64; 3] {
        if vertices.iter().all(|vertex| vertex.z <= 0.0) {
            return [0.0; 3];
        }
        let mut area = DVec3::ZERO;
        for (i, &a) in vertices.iter().enumerate() {
            area += a.cross(vertices[(i + 1) % vertices.len()]);
        }
        let orientation = if area.dot(vertices[0]) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let mut axis = OutlineAxis::NONE;
        self.for_each_edge(vertices, &mut |a, b| self.add_to_axis(&mut axis, a, b));
        let sliced = self.sliced(axis.direction(), axis.scale());
        let mut range = [1.0_f64, -1.0_f64];
        sliced.for_each_edge(vertices, &mut |a, b| sliced.add_range(&mut range, a, b));
        let range = range.map(|place| place.clamp(-1.0, 1.0));
        sliced.sum_of_slices(range, of, |x, add| {
            sliced.for_each_edge(vertices, &mut |a, b| {
                sliced.crossings(x, a, b, &mut |y, sign| add(y, sign * orientation));
            });
        })
    }

    fn for_each_edge(&self, vertices: &[DVec3], visit: &mut dyn FnMut(DVec3, DVec3)) {
        for (i, &a) in vertices.iter().enumerate() {
            let b = vertices[(i + 1) % vertices.len()];
            for_each_raised(self.turned(a), self.turned(b), visit);
        }
    }

    /// Slope that reflects the viewer to a unit vector, over the alphas.
    fn stretched(&self, w: DVec3) -> DVec2 {
        let h = w + self.wo;
        -h.truncate() / (h.z.max(1e-12) * self.facets[0].alphas)
    }

    fn add_to_axis(&self, axis: &mut OutlineAxis, a: DVec3, b: DVec3) {
        let (a, b) = (a.normalize_or(DVec3::Z), b.normalize_or(DVec3::Z));
        let chords = 1.0 + (CHORDS * (b - a).length()).floor();
        let mut from = self.stretched(a);
        for i in 1..=chords as usize {
            let to = self.stretched(a.lerp(b, i as f64 / chords).normalize_or(DVec3::Z));
            axis.add_chord(from, to);
            from = to;
        }
    }

    /// The lobe in slices across `along`, a unit vector in slopes over their alphas, with places that spread `scale` times as wide as facets. `self` has
    /// its slices across the longer axis.
    fn sliced(&self, along: DVec2, scale: f64) -> Self {
        let wide = along * self.facets[0].alphas.yx();
        let axis = wide / wide.length();
        let facets = self.facets.map(|facets| facets.turned(axis));
        Self {
            wo: turned(axis, self.wo.truncate()).extend(self.wo.z),
            along: self.along * axis.x + self.along.perp() * axis.y,
            unit: scale * facets[0].alphas.x,
            facets,
            ..*self
        }
    }

    /// Widens a range of places to those of an edge: of its ends, and of where slices touch it. There (1, 0, x) has a part in the plane of the edge as
    /// long as [`Self::crossings`]' `k`.
    fn add_range(&self, range: &mut [f64; 2], a: DVec3, b: DVec3) {
        let mut add = |place: f64| *range = [range[0].min(place), range[1].max(place)];
        add(self.place(a));
        add(self.place(b));
        let m = a.cross(b).normalize_or(DVec3::ZERO);
        let wo = self.wo;
        let second = 1.0 - m.z * m.z - wo.z * wo.z;
        let half_first = -(m.x * m.z + wo.x * wo.z);
        let zeroth = 1.0 - m.x * m.x - wo.x * wo.x;
        let inside = half_first * half_first - second * zeroth;
        if inside <= 0.0 {
            return;
        }
        let q = -(half_first + inside.sqrt().copysign(half_first));
        for x in [q / second, zeroth / q] {
            let c = DVec3::new(1.0, 0.0, x);
            let touching = -(wo.x + x * wo.z) * (c - c.dot(m) * m);
            if a.cross(touching).dot(m) > 0.0 && touching.cross(b).dot(m) > 0.0 {
                add(self.place_of_slope(x));
            }
        }
    }

    /// Finds the points where an edge crosses the circle of a slope: zeros of w.x + x w.z + k |w|, which along the edge is convex for k above zero and
    /// concave below.
    fn crossings(&self, x: f64, a: DVec3, b: DVec3, add: &mut dyn FnMut(f64, f64)) {
        let wo = self.wo;
        let k = wo.x + x * wo.z;
        let d = b - a;
        let (at_a, step) = (a.x + x * a.z, d.x + x * d.z);
        let value = |s: f64| at_a + s * step + k * (a + s * d).length();
        let (value_a, value_b) = (value(0.0), value(1.0));
        let mut crossed = |mut s: f64, sign: f64| {
            for _ in 0..NEWTON_ROUNDS {
                let w = a + s * d;
                let length = w.length().max(1e-30);
                let slope = step + k * w.dot(d) / length;
                let moved = (at_a + s * step + k * length) / slope;
                s = if moved.is_finite() {
                    (s - moved).clamp(0.0, 1.0)
                } else {
                    s
                };
            }
            let w = a + s * d;
            let length = w.length();
            let y = -(w.y + wo.y * length) / (w.z + wo.z * length).max(1e-30);
            add(y.clamp(-FAR, FAR), sign);
        };
        let curved = if k > 0.0 { 1.0 } else { -1.0 };
        if (value_a > 0.0) != (value_b > 0.0) {
            // Newton's steps start on the side where they do not overshoot.
            let from = if value_a * curved > 0.0 { 0.0 } else { 1.0 };
            crossed(from, if value_b > value_a { 1.0 } else { -1.0 });
        } else if value_a * curved > 0.0 {
            // The edge may cross twice, on both sides of its turning point.
            let d2 = d.length_squared().max(1e-30);
            let sine = -step / (k * d2.sqrt());
            if sine * sine >= 1.0 {
                return;
            }
            let foot = a.cross(d).length() / d2.sqrt();
            let turn =
                (foot * sine / (1.0 - sine * sine).sqrt() - a.dot(d) / d2.sqrt()) / d2.sqrt();
            if turn > 0.0 && turn < 1.0 && value(turn) * curved < 0.0 {
                crossed(0.0, -curved);
                crossed(1.0, curved);
            }
        }
    }
}

/// Visits an edge in two parts, with the points below the horizon raised to it.
fn for_each_raised(a: DVec3, b: DVec3, visit: &mut dyn FnMut(DVec3, DVec3)) {
    let raised = |w: DVec3| DVec3::new(w.x, w.y, w.z.max(0.0));
    if (a.z > 0.0) == (b.z > 0.0) {
        visit(raised(a), raised(b));
        return;
    }
    let cut = a + a.z / (a.z - b.z) * (b - a);
    let cut = DVec3::new(cut.x, cut.y, 0.0);
    visit(raised(a), cut);
    visit(cut, raised(b));
}
