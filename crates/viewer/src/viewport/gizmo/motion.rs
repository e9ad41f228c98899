//! Motion of a body by a drag of the pointer. Everything counts from where the button went down.

use std::f64::consts::PI;

use egui::Pos2;
use glam::DVec3;

use super::body::Body;
use super::cone::Rim;
use super::handles::{self, Handle};
use crate::viewport::lens::Lens;

/// Effect of a drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Motion {
    /// Movement by this vector, in metres.
    Move(DVec3),
    /// About an axis of the world through the middle, by radians.
    Turn(DVec3, f64),
    /// Scaling by a factor.
    Resize(f64),
    /// A corner to this place.
    Corner(usize, DVec3),
    /// A cone to this angle, degrees.
    Open(f64),
    /// A cone to this softness.
    Soften(f64),
}

/// Longest movement, over the distance to the eye: an axis that runs to the horizon has no end.
const FARTHEST: f64 = 10.0;
/// A turn snaps to this.
const SNAP_RAD: f64 = PI / 12.0;
/// Step of a cone's angle.
const SNAP_DEG: f64 = 5.0;
/// Least factor of a drag on the size.
const SMALLEST: f64 = 0.02;
/// Below this cosine between the view and a ring's axis the ring is seen from its edge.
const EDGE_ON: f64 = 0.3;

/// A place on the screen, and the camera at that moment.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Aim {
    pub lens: Lens,
    pub pos: Pos2,
}

impl Aim {
    /// Point where the ray meets a plane.
    fn on_plane(&self, through_m: DVec3, normal: DVec3) -> Option<DVec3> {
        self.lens.on_plane(self.pos, through_m, normal)
    }
}

/// Motion by a drag of the handle from one place to another, for the body in its state at the first; none if
/// the pointer's ray gives no motion.
pub(super) fn drag_motion(
    body: &Body,
    handle: Handle,
    from: &Aim,
    to: &Aim,
    snaps: bool,
) -> Option<Motion> {
    let center_m = body.center_m;
    let eye_m = from.lens.eye_m();
    let motion = match handle {
        Handle::Axis(i) => {
            let axis = DVec3::AXES[i];
            // The plane through the axis that faces the eye.
            let normal = axis.cross(axis.cross(center_m - eye_m)).try_normalize()?;
            let along = |aim: &Aim| Some((aim.on_plane(center_m, normal)? - center_m).dot(axis));
            let most_m = FARTHEST * center_m.distance(eye_m);
            Motion::Move(axis * (along(to)? - along(from)?).clamp(-most_m, most_m))
        }
        Handle::Middle => {
            let on = |aim: &Aim| aim.on_plane(center_m, aim.lens.forward());
            Motion::Move(on(to)? - on(from)?)
        }
        Handle::Ring(i) => {
            let axis = DVec3::AXES[i];
            let angle_rad = turn_rad(center_m, axis, from, to)?;
            let steps = (angle_rad / SNAP_RAD).round();
            Motion::Turn(axis, if snaps { steps * SNAP_RAD } else { angle_rad })
        }
        Handle::Size => {
            let reach = |aim: &Aim| Some(f64::from(aim.pos.distance(aim.lens.project(center_m)?)));
            Motion::Resize((reach(to)? / reach(from)?.max(1.0)).max(SMALLEST))
        }
        Handle::Corner(i) => {
            let corner_m = *body.corners_m.get(i)?;
            let normal = body.normal?;
            Motion::Corner(
                i,
                corner_m + (to.on_plane(corner_m, normal)? - from.on_plane(corner_m, normal)?),
            )
        }
        Handle::Rim(rim) => {
            let (spot, lens) = (body.spot?, &from.lens);
            match rim {
                Rim::Outer => {
                    let deg = spot.opened_deg(lens, from.pos, to.pos)?;
                    let steps = (deg / SNAP_DEG).round().max(1.0);
                    Motion::Open(if snaps { steps * SNAP_DEG } else { deg })
                }
                Rim::Inner => Motion::Soften(spot.softened(lens, from.pos, to.pos)?),
            }
        }
    };
    Some(motion)
}

fn turn_rad(center_m: DVec3, axis: DVec3, from: &Aim, to: &Aim) -> Option<f64> {
    let lens = &from.lens;
    let to_eye = (lens.eye_m() - center_m).try_normalize()?;
    if to_eye.dot(axis).abs() > EDGE_ON {
        // Angle between the two arms in the ring's plane.
        let (a, b) = (
            from.on_plane(center_m, axis)? - center_m,
            to.on_plane(center_m, axis)? - center_m,
        );
        return Some(a.cross(b).dot(axis).atan2(a.dot(b)));
    }
    // Seen from its edge a ring is a line: so far along it, so far around.
    let radius_m = lens.m_per_point(center_m) * f64::from(handles::RING);
    let nearest = (to_eye - axis * to_eye.dot(axis)).try_normalize()?;
    let place_m = center_m + nearest * radius_m;
    const STEP_RAD: f64 = 0.05;
    let next_m = place_m + axis.cross(nearest) * (radius_m * STEP_RAD);
    let (a, b) = (lens.project(place_m)?, lens.project(next_m)?);
    let points_per_rad = (b - a) / STEP_RAD as f32;
    let offset = |aim: &Aim| Some(aim.pos - aim.lens.project(center_m)?);
    let moved = offset(to)? - offset(from)?;
    Some(f64::from(
        moved.dot(points_per_rad) / points_per_rad.length_sq().max(1e-6),
    ))
}

impl Motion {
    /// Text of the motion's length, shown beside the pointer.
    pub fn words(&self, handle: Handle) -> Option<String> {
        Some(match (*self, handle) {
            (Self::Move(delta_m), Handle::Axis(i)) => {
                let name = handles::AXIS_NAMES[i];
                format!("{name} {}", length(delta_m[i], true))
            }
            (Self::Move(delta_m), _) => length(delta_m.length(), false),
            (Self::Turn(_, angle_rad), _) => format!("{:+.1}°", angle_rad.to_degrees()),
            (Self::Resize(factor), _) => format!("× {factor:.2}"),
            (Self::Open(deg), _) => format!("cone {deg:.1}°"),
            (Self::Soften(softness), _) => format!("softness {softness:.2}"),
            (Self::Corner(..), _) => return None,
        })
    }
}

fn length(metres: f64, signed: bool) -> String {
    let (number, unit) = match metres.abs() < 1.0 {
        true => (metres * 1e3, "mm"),
        false => (metres, "m"),
    };
    match signed {
        true => format!("{number:+.1} {unit}"),
        false => format!("{number:.1} {unit}"),
    }
}
