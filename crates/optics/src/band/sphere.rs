//! A sphere on the lines of the band.

use glam::DVec3;

use super::{BandFrame, BandLine, Chord};

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
