//! Smooth curves in space, in pieces that are cubic.
//!
//! A curve through points is the cubic spline whose second derivative is continuous: a scratch turns without jumps. Its parameter is
//! centripetal: E. T. Y. Lee, "Choosing nodes in parametric curve interpolation", Computer-Aided Design 21, 1989.

use glam::DVec3;

use crate::guide::chord_length_m;

/// Sweeps after which the derivatives of a spline are exact: each halves their error at least.
const SWEEPS: usize = 50;
/// A piece is halved so often at most.
const MOST_HALVINGS: u32 = 16;

/// A cubic Bezier curve.
#[derive(Clone, Copy, Debug)]
pub struct Cubic(pub [DVec3; 4]);

impl Cubic {
    pub(crate) fn middle(&self) -> DVec3 {
        let [a, b, c, d] = self.0;
        (a + 3.0 * (b + c) + d) / 8.0
    }

    /// Adds points that are joined by straight pieces like those of an arc, and no longer than `longest_m`. The first one is left out.
    pub(crate) fn flatten(&self, longest_m: f64, points_m: &mut Vec<DVec3>) {
        self.halve(longest_m, MOST_HALVINGS, points_m);
    }

    fn halve(&self, longest_m: f64, halvings: u32, points_m: &mut Vec<DVec3>) {
        let [start, .., end] = self.0;
        let middle = self.middle();
        let length_m = start.distance(middle) + middle.distance(end);
        let [from, at, to] = [0.0, 0.5, 1.0].map(|t| self.direction(t));
        let turn_rad = from.angle_between(at) + at.angle_between(to);
        let most_m = chord_length_m(turn_rad / length_m).min(longest_m);
        // Written so that a piece without length or direction is not halved.
        if halvings == 0 || !(length_m > most_m) {
            points_m.push(end);
            return;
        }
        for half in self.halves() {
            half.halve(longest_m, halvings - 1, points_m);
        }
    }

    /// Direction at a place; where control points coincide, that of the whole.
    fn direction(&self, t: f64) -> DVec3 {
        let [a, b, c, d] = self.0;
        let derivative = (b - a).lerp(c - b, t).lerp((c - b).lerp(d - c, t), t);
        derivative
            .try_normalize()
            .unwrap_or((d - a).normalize_or_zero())
    }

    fn halves(&self) -> [Self; 2] {
        let [a, b, c, d] = self.0;
        let [ab, bc, cd] = [(a, b), (b, c), (c, d)].map(|(from, to)| from.midpoint(to));
        let (abc, bcd) = (ab.midpoint(bc), bc.midpoint(cd));
        let middle = abc.midpoint(bcd);
        [Self([a, ab, abc, middle]), Self([middle, bcd, cd, d])]
    }
}

/// The spline through points, of which no two in a row are alike; closed, it leads from the last one to the first.
pub(crate) fn spline(points_m: &[DVec3], is_closed: bool) -> Vec<Cubic> {
    let count = points_m.len();
    let spans = if is_closed { count } else { count - 1 };
    let ends = |i: usize| (points_m[i], points_m[(i + 1) % count]);
    let times: Vec<f64> = (0..spans)
        .map(|i| libm::sqrt(ends(i).0.distance(ends(i).1)))
        .collect();
    let slope = |i: usize| (ends(i).1 - ends(i).0) / times[i];
    let mut derivatives: Vec<DVec3> = (0..count).map(|i| slope(i.min(spans - 1))).collect();
    for _ in 0..SWEEPS {
        for i in 0..count {
            let (last, next) = ((i + count - 1) % count, (i + 1) % count);
            // An open curve does not bend at its ends.
            derivatives[i] = match i {
                0 if !is_closed => 1.5 * slope(0) - 0.5 * derivatives[next],
                _ if i == spans => 1.5 * slope(last) - 0.5 * derivatives[last],
                _ => {
                    let (before, after) = (times[last], times[i]);
                    let pull = 3.0 * (after * slope(last) + before * slope(i));
                    let rest = after * derivatives[last] + before * derivatives[next];
                    (pull - rest) / (2.0 * (before + after))
                }
            };
        }
    }
    (0..spans)
        .map(|i| {
            let (start, end) = ends(i);
            let handle = |at: usize| derivatives[at % count] * (times[i] / 3.0);
            Cubic([start, start + handle(i), end - handle(i + 1), end])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(count: u32) -> Vec<DVec3> {
        let at = |i: u32| f64::from(i) * std::f64::consts::TAU / f64::from(count);
        (0..count)
            .map(|i| DVec3::new(at(i).cos(), at(i).sin(), 0.0))
            .collect()
    }

    #[test]
    fn a_closed_spline_through_points_of_a_circle_is_nearly_that_circle() {
        let mut points = Vec::new();
        for cubic in spline(&ring(12), true) {
            cubic.flatten(1.0, &mut points);
        }
        assert!(points.iter().all(|p| (p.length() - 1.0).abs() < 5e-4));
        // Half a degree each, or up to twice as many.
        assert!((720..1440).contains(&points.len()), "{}", points.len());
    }

    #[test]
    fn a_spline_bends_alike_on_both_sides_of_its_points() {
        let points = [[0.0, 0.0], [1.0, 0.2], [1.5, 1.4], [3.0, 1.0], [3.2, -1.0]];
        let points = points.map(|[x, y]| DVec3::new(x, y, 0.3 * x * y));
        let curvature = |[a, b, c]: [DVec3; 3]| {
            let (first, second) = (b - a, c - 2.0 * b + a);
            first.cross(second) / first.length().powi(3)
        };
        let cubics = spline(&points, false);
        for pair in cubics.windows(2) {
            let [_, b, c, d] = pair[0].0;
            let before = -curvature([d, c, b]);
            let after = curvature([pair[1].0[0], pair[1].0[1], pair[1].0[2]]);
            assert!(before.distance(after) < 1e-9, "{before} {after}");
        }
        let [a, b, c, _] = cubics[0].0;
        assert!((c - 2.0 * b + a).length() < 1e-9);
    }
}
