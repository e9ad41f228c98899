//! The outline of a tube with round ends, which is the hull of two spheres of one radius. Twin: tube.wgsl.
//!
//! A point sees it as a convex shape: two straight sides, which lie in the planes through the point that touch both spheres, and a part of
//! the outline of each sphere. As its radiance is the same everywhere, a polygon that is made anew for each point stands for it.

use glam::DVec3;

/// Edges for the outline of each end.
const CAP_EDGES: usize = 10;
/// Corners of the polygon.
pub const TUBE_CORNERS: usize = 2 * (CAP_EDGES + 1);

/// A tube from the origin.
#[derive(Clone, Copy, Debug)]
pub struct TubeOutline {
    ends: [TubeEnd; 2],
    /// A direction in front of all of the tube.
    pub away: DVec3,
}

/// An arc of the outline of a sphere: `center + cos phi x + sin phi y` for phi from -`half_angle` to `half_angle`.
#[derive(Clone, Copy, Debug)]
struct TubeEnd {
    center: DVec3,
    x: DVec3,
    y: DVec3,
    half_angle: f64,
    /// Distance of the corners between the sides over the radius, such that the polygon has the arc's area. Corners at the sides stay on
    /// the arc.
    out: f64,
}

/// The outline of the tube from `a` to `b`; none from within.
pub fn tube_outline(a: DVec3, b: DVec3, radius: f64) -> Option<TubeOutline> {
    let axis = (b - a).normalize_or_zero();
    let (along_a, along_b) = (a.dot(axis), b.dot(axis));
    let aside = a - along_a * axis;
    let height = aside.length();
    let nearest = aside + axis * 0.0_f64.clamp(along_a, along_b.max(along_a));
    if !(nearest.length() > radius) {
        return None;
    }
    let up = if height > 1e-9 * radius {
        aside / height
    } else {
        axis.any_orthonormal_vector()
    };
    let across = up.cross(axis);
    let sin2 = (1.0 - (radius / height).powi(2)).max(0.0);
    let end = |along: f64, sign: f64| {
        let distance = along.hypot(height);
        // The visible part of the sphere ends before its middle.
        let share = 1.0 - (radius / distance).powi(2);
        let rim = radius * share.sqrt();
        let cos = sign * radius * along / (height * distance);
        let half_angle = sin2.sqrt().atan2(cos);
        TubeEnd {
            center: (along * axis + height * up) * share,
            x: sign * rim / distance * (height * axis - along * up),
            y: -sign * rim * across,
            half_angle,
            out: tube_out(half_angle),
        }
    };
    let mut ends = [end(along_a, -1.0), end(along_b, 1.0)];
    if height <= radius {
        // Beyond an end, which hides the other one.
        let [near, far] = if along_a > 0.0 { [0, 1] } else { [1, 0] };
        ends[far] = TubeEnd {
            center: ends[near].center - ends[near].x,
            x: DVec3::ZERO,
            y: DVec3::ZERO,
            ..ends[far]
        };
    }
    Some(TubeOutline {
        ends,
        away: nearest,
    })
}

/// Two triangles at the ends of an arc have one corner out, the others two; together they have the area of the arc.
fn tube_out(half_angle: f64) -> f64 {
    let inner = CAP_EDGES as f64 - 2.0;
    let step = 2.0 * half_angle / CAP_EDGES as f64;
    // Steps of no length have corners where the arc is.
    let stretch = if step > 1e-4 {
        half_angle / step.sin()
    } else {
        0.5 * CAP_EDGES as f64
    };
    ((1.0 + 2.0 * inner * stretch).sqrt() - 1.0) / inner
}

impl TubeOutline {
    /// A corner, counter-clockwise as seen from the origin.
    pub fn tube_corner(&self, i: usize) -> DVec3 {
        let end = &self.ends[i / (CAP_EDGES + 1)];
        let i = i % (CAP_EDGES + 1);
        let out = if i == 0 || i == CAP_EDGES {
            1.0
        } else {
            end.out
        };
        let angle = end.half_angle * (2.0 * i as f64 / CAP_EDGES as f64 - 1.0);
        let (sin, cos) = angle.sin_cos();
        end.center + out * (cos * end.x + sin * end.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::band::{BandFrame, BandLine, Outline, OutlineEdge, OutlineRoots};
    use crate::irradiance::lambert_polygon;
    use glam::DVec2;
    use std::f64::consts::PI;

    fn corners(a: DVec3, b: DVec3, radius: f64) -> Vec<DVec3> {
        let outline = tube_outline(a, b, radius).unwrap();
        (0..TUBE_CORNERS).map(|i| outline.tube_corner(i)).collect()
    }

    /// Whether a ray from the origin meets a tube: how near it comes to the axis, by bisection.
    fn meets(w: DVec3, a: DVec3, b: DVec3, radius: f64) -> bool {
        let beside = |s: f64| {
            let p = a.lerp(b, s);
            p.distance(w * p.dot(w).max(0.0))
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let third = (high - low) / 3.0;
            if beside(low + third) < beside(high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        beside(low) < radius
    }

    /// Tubes that the point sees from aside, from nearby, from beyond an end and from on the axis.
    const TUBES: [(DVec3, DVec3, f64); 6] = [
        (DVec3::new(-1.0, 0.2, 1.0), DVec3::new(1.0, 0.1, 1.2), 0.1),
        (DVec3::new(0.5, 0.2, 0.4), DVec3::new(0.9, 0.1, 3.0), 0.2),
        (DVec3::new(-1.0, 0.0, 0.31), DVec3::new(2.0, 0.3, 0.4), 0.3),
        (DVec3::new(0.05, 0.0, 0.6), DVec3::new(0.0, 0.1, 2.0), 0.2),
        (DVec3::new(0.01, 0.0, 1.0), DVec3::new(0.02, 0.0, 2.0), 0.3),
        (DVec3::new(0.3, 0.3, 1.0), DVec3::new(0.31, 0.3, 1.0), 0.2),
    ];

    #[test]
    fn a_tube_sends_a_body_what_its_directions_do() {
        for (a, b, radius) in TUBES {
            const STEPS: u32 = 700;
            let mut sum = 0.0;
            // Equal parts of the projected hemisphere.
            for i in 0..STEPS {
                for j in 0..STEPS {
                    let r = ((f64::from(i) + 0.5) / f64::from(STEPS)).sqrt();
                    let (sin, cos) = (2.0 * PI * (f64::from(j) + 0.5) / f64::from(STEPS)).sin_cos();
                    let w = DVec3::new(r * cos, r * sin, (1.0 - r * r).sqrt());
                    sum += f64::from(u8::from(meets(w, a, b, radius)));
                }
            }
            let exact = sum / f64::from(STEPS * STEPS);
            let error = |radius: f64| lambert_polygon(&corners(a, b, radius)) / exact - 1.0;
            println!(
                "{a} {b} {radius}: {exact:.4}, {:.3} % off",
                100.0 * error(radius)
            );
            assert!(error(radius).abs() < 4e-3);
            assert!(error(1.02 * radius).abs() > 4e-3);
        }
    }

    #[test]
    fn sides_touch_and_corners_lie_at_the_rim() {
        for (a, b, radius) in TUBES {
            for corner in corners(a, b, radius) {
                let w = corner.normalize();
                assert!(meets(w, a, b, 1.06 * radius), "{corner}");
                assert!(!meets(w, a, b, 0.999 * radius), "{corner}");
            }
        }
    }

    #[test]
    fn nothing_is_seen_from_within() {
        let (a, b) = (DVec3::new(-1.0, 0.0, 0.1), DVec3::new(1.0, 0.0, 0.1));
        assert!(tube_outline(a, b, 0.2).is_none());
        assert!(tube_outline(a + DVec3::X * 1.15, b + DVec3::X * 1.15, 0.2).is_none());
        assert!(tube_outline(a, b, 0.05).is_some());
        assert!(tube_outline(a + DVec3::X * 1.3, b + DVec3::X * 1.3, 0.2).is_some());
    }

    /// The lines run through the tube and beside it.
    #[test]
    fn a_tube_sends_a_scratch_what_its_directions_do() {
        const STEPS: i32 = 20_000;
        let sinc2 = |q: f64| {
            let x = 17.0 * q;
            if x.abs() < 1e-6 {
                1.0
            } else {
                (x.sin() / x).powi(2)
            }
        };
        let antiderivative = |q: f64| -> f64 {
            let step = q / 1000.0;
            (0..1000)
                .map(|i| sinc2((f64::from(i) + 0.5) * step) * step)
                .sum()
        };
        let (mut error, mut whole, mut thicker) = (0.0, 0.0, 0.0);
        for (a, b, radius) in TUBES {
            // Mirrored at the middle, so that the light matters.
            let middle = a.midpoint(b).normalize();
            let wo = DVec3::new(-middle.x, -middle.y, middle.z);
            for i in -20..=20 {
                let line = BandLine::new(wo, 0.02 * f64::from(i));
                let on_line = |radius: f64| {
                    let corners = corners(a, b, radius);
                    let directions: Vec<_> = corners.iter().map(|v| v.normalize()).collect();
                    let edges: Vec<_> = OutlineEdge::of_outline(&directions).collect();
                    let outline = Outline {
                        edges: &edges,
                        away: tube_outline(a, b, radius).unwrap().away,
                        facing: 1.0,
                        sets: directions.iter().any(|v| v.z < 0.0),
                    };
                    let mut roots = OutlineRoots::default();
                    outline.roots(BandFrame { tangent: DVec2::X }, line, &mut roots);
                    let roots = roots.signed().iter();
                    roots
                        .map(|(sign, q)| sign * antiderivative(*q))
                        .sum::<f64>()
                };
                let at = |i: i32| {
                    let (sin, cos) = (PI * (f64::from(i) + 0.5) / f64::from(STEPS)).sin_cos();
                    let w = DVec3::new(line.along, line.radius * cos, line.radius * sin);
                    let lit = meets(w, a, b, radius);
                    f64::from(u8::from(lit)) * sinc2(wo.y + w.y) * line.radius * sin
                };
                let exact = (0..STEPS).map(at).sum::<f64>() * PI / f64::from(STEPS);
                error += (on_line(radius) - exact).powi(2);
                thicker += (on_line(1.02 * radius) - exact).powi(2);
                whole += exact * exact;
            }
        }
        let [error, thicker] = [error, thicker].map(|sum: f64| (sum / whole).sqrt());
        println!(
            "{:.3} % rms, of a tube 2 % thicker {:.3} %",
            100.0 * error,
            100.0 * thicker
        );
        // Most of it on lines at the rim of an end that is seen from the front, where ten edges are a circle.
        assert!(error < 0.03, "{error}");
        assert!(thicker > 0.03, "{thicker}");
    }

    /// A scratch sees lights in front of `away` alone.
    #[test]
    fn all_lies_in_front() {
        for (a, b, radius) in TUBES {
            let away = tube_outline(a, b, radius).unwrap().away;
            assert!(corners(a, b, radius).iter().all(|v| v.dot(away) > 0.0));
        }
    }
}
