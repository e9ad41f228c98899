//! Direction fields: where a scratch goes from a point of a facet.
//!
//! Turning about an axis, projected into a facet's plane, is turning about the point where the axis meets the plane. So a
//! circle of the pattern is a true circle within each facet, known in closed form, and it closes on any faceted surface
//! of revolution.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use hairline_scene::Bearing;

use crate::facet::Facet;

/// Nearer than this to its axis, or to its end, a field has no direction.
const NO_DIRECTION_M: f64 = 1e-8;

/// The longest chord for an arc: it turns by half a degree, or is as long as two coherence widths of 20 um (the model sees
/// nothing finer) if that turns by less than 5 degrees.
pub(crate) fn chord_length_m(curvature_per_m: f64) -> f64 {
    const HALF_DEGREE_RAD: f64 = std::f64::consts::PI / 360.0;
    const COHERENT_M: f64 = 40e-6;
    let curvature = curvature_per_m.abs();
    (HALF_DEGREE_RAD / curvature).max(COHERENT_M.min(10.0 * HALF_DEGREE_RAD / curvature))
}

/// Direction field that one scratch follows.
#[derive(Clone, Copy, Debug)]
pub enum Guide {
    /// A direction of the scratch's own, straight or bending by a constant curvature in the surface.
    Free {
        /// Unit, in the plane of the seed's facet.
        seed_direction: DVec3,
        /// Positive to the left.
        curvature_per_m: f64,
    },
    /// The projection of one direction.
    Parallel {
        /// World space.
        direction: DVec3,
        /// Angle from its projection to the scratch, to the left.
        jitter_rad: f64,
    },
    /// A fixed bearing to the circles about an axis.
    Around {
        /// Unit.
        axis: DVec3,
        /// A point on the axis.
        center_m: DVec3,
        /// Direction relative to the circles.
        bearing: Bearing,
        /// Angle from that direction to the scratch, to the left.
        jitter_rad: f64,
    },
    /// Straight to a point.
    Towards {
        /// World space.
        end_m: DVec3,
    },
}

/// Next step of a scratch: straight or along an arc, and how far before asking again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// Unit, in the facet's plane.
    pub direction: DVec3,
    /// Positive to the left.
    pub curvature_per_m: f64,
    pub reach_m: f64,
}

impl Aim {
    pub(crate) fn straight(direction: DVec3) -> Self {
        Self {
            direction,
            curvature_per_m: 0.0,
            reach_m: f64::INFINITY,
        }
    }
}

impl Guide {
    /// The way from a point of a facet; `None` where the field has no direction. `heading` is the way until here, in the
    /// facet's plane; `reversed` goes the other way.
    pub(crate) fn aim(
        &self,
        facet: &Facet,
        point_m: DVec3,
        heading: Option<DVec3>,
        reversed: bool,
    ) -> Option<Aim> {
        let sign = if reversed { -1.0 } else { 1.0 };
        match *self {
            Guide::Free {
                seed_direction,
                curvature_per_m,
            } => Some(Aim {
                curvature_per_m: sign * curvature_per_m,
                ..Aim::straight(heading.unwrap_or(sign * seed_direction))
            }),
            Guide::Parallel {
                direction,
                jitter_rad,
            } => {
                // The projection is noise where the surface stands across the direction.
                const LEAST_PART: f64 = 1e-3;
                let along = facet.in_plane(direction);
                (along.length() > LEAST_PART * direction.length())
                    .then(|| turned(facet, along.normalize(), jitter_rad))
                    .map(|direction| Aim::straight(sign * direction))
            }
            Guide::Around {
                axis,
                center_m,
                bearing,
                jitter_rad,
            } => direction_around_axis(
                facet,
                axis,
                point_m - center_m,
                bearing,
                jitter_rad,
                reversed,
            ),
            Guide::Towards { end_m } => {
                let offset = facet.in_plane(end_m - point_m);
                (offset.length() > NO_DIRECTION_M).then(|| Aim {
                    reach_m: offset.length(),
                    ..Aim::straight(offset.normalize())
                })
            }
        }
    }

    /// Least length of a scratch that can come back to its start.
    pub(crate) fn shortest_ring_m(&self, seed_m: DVec3) -> f64 {
        let radius_m = match *self {
            Guide::Free {
                curvature_per_m, ..
            } => 1.0 / curvature_per_m.abs(),
            Guide::Around {
                axis,
                center_m,
                bearing: Bearing::Circular,
                jitter_rad: 0.0,
            } => axis.cross(seed_m - center_m).length(),
            _ => f64::INFINITY,
        };
        // On a curved surface a ring can be shorter than in the plane; the shortfall is a guess, a ring that it misses
        // overlaps itself instead.
        0.5 * std::f64::consts::TAU * radius_m
    }
}

/// A direction in the facet's plane turned to the left.
fn turned(facet: &Facet, direction: DVec3, angle_rad: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(angle_rad);
    direction * cos + facet.normal.cross(direction) * sin
}

/// Direction around the axis. `arm_m` leads from a point of the axis to the point.
fn direction_around_axis(
    facet: &Facet,
    axis: DVec3,
    arm_m: DVec3,
    bearing: Bearing,
    jitter_rad: f64,
    reversed: bool,
) -> Option<Aim> {
    // Counter-clockwise seen from outside, so that a pattern looks the same on both sides of a sheet.
    let tilt = axis.dot(facet.normal);
    let spin = axis.cross(arm_m) * if tilt < 0.0 { -1.0 } else { 1.0 };
    let circle = facet.in_plane(spin);
    let speed_m = circle.length();
    if speed_m < NO_DIRECTION_M {
        return None;
    }
    let circle = circle / speed_m;
    // Reciprocal of the distance, in the plane, to its intersection with the axis, which lies to the left.
    let circle_curvature = tilt.abs() / speed_m;

    // The bearing is the angle from the circle to the scratch, to the left; outwards is to the right.
    let (bearing_rad, curvature, exact) = match bearing {
        Bearing::Circular => (0.0, circle_curvature, true),
        Bearing::Radial => (-FRAC_PI_2, 0.0, true),
        Bearing::Spun { curvature_per_m } => {
            // A chord from the axis meets its circle at the angle asin(chord curvature / 2). Beyond the far side of the
            // tool's circle there is nothing to follow but the circle about the axis.
            let sine = (spin.length() * curvature_per_m / 2.0).clamp(-1.0, 1.0);
            let curvature = match sine.abs() < 1.0 {
                true => curvature_per_m,
                false => circle_curvature * sine,
            };
            (libm::asin(sine) - FRAC_PI_2, curvature, false)
        }
    };
    let direction = turned(facet, circle, bearing_rad + jitter_rad);
    let sign = if reversed { -1.0 } else { 1.0 };

    // Off the circle and the ray the arc is but the curve's best fit, so it is asked for anew after each chord.
    let (curvature, mut reach_m) = match (jitter_rad == 0.0, exact) {
        (true, true) => (curvature, f64::INFINITY),
        (true, false) => (curvature, chord_length_m(circle_curvature)),
        // A spiral that keeps its bearing.
        (false, _) => {
            let along = direction.dot(circle);
            (circle_curvature * along, chord_length_m(circle_curvature))
        }
    };
    let inwards = facet.normal.cross(circle).dot(direction * sign);
    if inwards > 0.999 && circle_curvature > 0.0 {
        reach_m = reach_m.min(1.0 / circle_curvature);
    }
    Some(Aim {
        direction: direction * sign,
        curvature_per_m: curvature * sign,
        reach_m,
    })
}
