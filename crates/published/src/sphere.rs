//! Spherical lights on the band's middle line, in the talk's six steps (the sixth, to evaluate, is
//! [`crate::spectrum::published_radiance`]).
//!
//! Seen from above, in direction cosines, the hemisphere is the unit disk, the line xi_t = 0 is straight, x = -wo_t, and the
//! rim of a spherical light is an ellipse. The disk's edge is the horizon.

use glam::DVec3;

use crate::segments::BandSegments;
use hairline_optics::band::Cap;

/// Finds the segments of the line xi_t = 0 that a sphere covers; `wo` and `cap` are in the frame of the scratch.
pub fn sphere_segments(wo: DVec3, cap: Cap) -> BandSegments {
    let mut segments = BandSegments::default();
    let (c, sin, cos) = (cap.axis, cap.sin_radius, cap.cos_radius);
    let x = -wo.x;
    let r2 = 1.0 - x * x;

    // 1 Check: below the horizon?
    if r2 <= 0.0 || (cos > 0.0 && c.z <= -sin) {
        return segments;
    }

    // 2 Project: the rim is an ellipse with the centre (c_x, c_y) cos(a). Its semi-axes are sin(a), and sin(a) c_z towards
    // the disk's centre; its half extent in x is sin(a) sqrt(1 - c_x^2).
    let extent2 = c.y * c.y + c.z * c.z;
    let from_centre = x - c.x * cos;

    // 3 Horizon: the line ends there, at y = -r and r.
    let r = r2.sqrt();

    // 4 Intersect the ellipse. Of each point's height the sign counts: the ellipse is the shadow of the whole rim.
    let s2 = extent2 * sin * sin - from_centre * from_centre;
    let (mut up_a, mut up_b) = (false, false);
    let (mut y_a, mut y_b) = (0.0, 0.0);
    if s2 > 0.0 {
        let s = s2.sqrt() / extent2;
        let middle = cos - c.x * from_centre / extent2;
        (y_a, y_b) = (c.y * middle - c.z * s, c.y * middle + c.z * s);
        (up_a, up_b) = (c.z * middle + c.y * s >= 0.0, c.z * middle - c.y * s >= 0.0);
        (y_a, y_b) = (y_a.clamp(-r, r), y_b.clamp(-r, r));
    }

    // 5 Assemble.
    let mut push = |low: f64, high: f64| segments.push_segment(wo.y + low, wo.y + high);
    match (up_a, up_b) {
        (true, true) if c.z >= 0.0 => push(y_a, y_b),
        // A centre below the horizon: the rim's upper part bounds what is dark.
        (true, true) => {
            push(-r, y_b);
            push(y_a, r);
        }
        (false, false) => {
            // The line's upper half lies within the cap or outside of it; so does its mean.
            if c.x * x > cos {
                push(-r, r);
            }
        }
        _ => {
            let y = if up_a { y_a } else { y_b };
            if c.y > 0.0 {
                push(y, r);
            } else {
                push(-r, y);
            }
        }
    }
    segments
}
