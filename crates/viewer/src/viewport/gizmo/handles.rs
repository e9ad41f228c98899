//! Positions of handles on the screen, and the one under the pointer. They are as large on the screen whatever the
//! distance.

use std::f64::consts::TAU;

use egui::{Pos2, Vec2};
use glam::DVec3;

use super::body::Body;
use super::cone::{LightCone, Rim};
use crate::viewport::lens::Lens;

/// Length of an arrow across the view, points.
const ARROW: f32 = 84.0;
/// Start of an arrow: the middle has a handle of its own.
const GAP: f32 = 12.0;
/// An arrow that is seen shorter than this, from its tip, cannot be dragged.
const SHORTEST: f32 = 26.0;
/// Radius of a ring.
pub(super) const RING: f32 = 58.0;
/// Distance of the handle of the size.
const SIZE: f32 = 74.0;
/// Nearer to the middle than this a corner would hide it.
const CORNER_GAP: f32 = 14.0;
/// Largest distance at which the pointer meets a line, points.
const LINE_REACH: f32 = 6.0;
/// Largest distance at which the pointer meets a knob, points.
const KNOB_REACH: f32 = 9.0;

/// Names of the axes.
pub(super) const AXIS_NAMES: [&str; 3] = ["x", "y", "z"];

/// One thing to drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Handle {
    /// Moves along an axis of the world.
    Axis(usize),
    /// Moves across the view.
    Middle,
    /// Turns about an axis of the world.
    Ring(usize),
    /// Scales.
    Size,
    /// Moves a corner of a polygon in its plane.
    Corner(usize),
    /// Opens the cone of a spot, or softens it.
    Rim(Rim),
}

impl Handle {
    /// Name for a screen reader and the history.
    pub fn name(self, body: &Body) -> String {
        let noun = body.noun;
        match self {
            Self::Axis(i) => format!("Move {noun} along {}", AXIS_NAMES[i]),
            Self::Middle => format!("Move {noun} across the view"),
            Self::Ring(i) => format!("Turn {noun} about {}", AXIS_NAMES[i]),
            Self::Size => format!("Resize {noun}"),
            Self::Corner(i) => format!("Move corner {}", i + 1),
            Self::Rim(Rim::Outer) => "Open the cone".to_owned(),
            Self::Rim(Rim::Inner) => "Soften the cone".to_owned(),
        }
    }

    /// Whether it is met all along its line and has no knob to be seen.
    fn is_line(self) -> bool {
        matches!(self, Self::Ring(_) | Self::Rim(_))
    }
}

/// A handle on the screen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placed {
    pub handle: Handle,
    /// Line that is to be met besides the knob.
    pub line: Vec<Pos2>,
    /// The tip of an arrow, the corner; of a ring, the place that is farthest from all others.
    pub knob: Pos2,
}

/// All handles of a body; none if it is behind the eye.
pub(super) fn place(body: &Body, lens: &Lens) -> Option<Vec<Placed>> {
    let center_m = body.center_m;
    let middle = lens.project(center_m)?;
    let to_eye = (lens.eye_m() - center_m).try_normalize()?;
    let m_per_point = lens.m_per_point(center_m);
    let mut placed = Vec::new();
    if body.turns {
        for i in 0..3 {
            placed.extend(ring(i, center_m, to_eye, m_per_point, lens));
        }
    }
    let arrows = arrows(body, lens, middle, m_per_point);
    let directions: Vec<Vec2> = arrows.iter().map(|(direction, _)| *direction).collect();
    placed.extend(arrows.into_iter().map(|(_, arrow)| arrow));
    if body.resizes {
        let direction = freest(&directions);
        let knob = middle + direction * SIZE;
        placed.push(Placed {
            handle: Handle::Size,
            line: vec![middle + direction * GAP, knob],
            knob,
        });
    }
    for (i, corner_m) in body.corners_m.iter().enumerate() {
        if let Some(knob) = lens.project(*corner_m)
            && knob.distance(middle) > CORNER_GAP
        {
            placed.push(Placed {
                handle: Handle::Corner(i),
                line: Vec::new(),
                knob,
            });
        }
    }
    for rim in [Rim::Outer, Rim::Inner] {
        let rim_of = |spot: LightCone| Some((spot.rim(lens, rim)?, spot.knob(lens, rim)?));
        placed.extend(body.spot.and_then(rim_of).map(|(line, knob)| Placed {
            handle: Handle::Rim(rim),
            line,
            knob,
        }));
    }
    if body.moves {
        placed.push(Placed {
            handle: Handle::Middle,
            line: Vec::new(),
            knob: middle,
        });
    }
    clear_knobs_of_rings(&mut placed);
    Some(placed)
}

/// Handles along the axes that are long enough on the screen, with their directions there.
fn arrows(body: &Body, lens: &Lens, middle: Pos2, m_per_point: f64) -> Vec<(Vec2, Placed)> {
    let axes = body.moves.then_some(DVec3::AXES).into_iter().flatten();
    let arrow = |(i, axis): (usize, DVec3)| {
        let tip = lens.project(body.center_m + axis * (m_per_point * f64::from(ARROW)))?;
        let arm = tip - middle;
        if arm.length() < SHORTEST {
            return None;
        }
        let placed = Placed {
            handle: Handle::Axis(i),
            line: vec![middle + arm.normalized() * GAP, tip],
            knob: tip,
        };
        Some((arm.normalized(), placed))
    };
    axes.enumerate().filter_map(arrow).collect()
}

/// Moves apart the positions of rings' handles for screen readers, so that none lies on another handle. With a
/// mouse a ring can be dragged anywhere.
fn clear_knobs_of_rings(placed: &mut [Placed]) {
    for i in 0..placed.len() {
        if !matches!(placed[i].handle, Handle::Ring(_)) {
            continue;
        }
        let others = || placed.iter().enumerate().filter(|(other, _)| *other != i);
        let room = |pos: &Pos2| {
            let gaps = others().map(|(_, other)| match other.handle.is_line() {
                true => distance_to_line(&other.line, *pos),
                false => distance_to_line(&other.line, *pos).min(other.knob.distance(*pos)),
            });
            gaps.fold(f32::INFINITY, f32::min)
        };
        let best = placed[i]
            .line
            .iter()
            .copied()
            .max_by(|a, b| room(a).total_cmp(&room(b)));
        placed[i].knob = best.unwrap_or(placed[i].knob);
    }
}

/// The half of a ring that is on the side of the eye.
fn ring(i: usize, center_m: DVec3, to_eye: DVec3, m_per_point: f64, lens: &Lens) -> Option<Placed> {
    let axis = DVec3::AXES[i];
    let nearest = (to_eye - axis * to_eye.dot(axis))
        .try_normalize()
        .unwrap_or_else(|| axis.any_orthonormal_vector());
    let aside = axis.cross(nearest);
    let at = |turn: f64| {
        let (sin, cos) = (turn * TAU).sin_cos();
        lens.project(center_m + (nearest * cos + aside * sin) * (m_per_point * f64::from(RING)))
    };
    const STEPS: i32 = 48;
    let quarter = STEPS / 4;
    let points = (-quarter..=quarter).map(|step| at(f64::from(step) / f64::from(STEPS)));
    Some(Placed {
        handle: Handle::Ring(i),
        line: points.collect::<Option<_>>()?,
        knob: at(0.0)?,
    })
}

/// The direction, of eight, that is farthest from all others, above rather than below.
fn freest(directions: &[Vec2]) -> Vec2 {
    let candidates = [1_u8, 3, 7, 5, 0, 2, 4, 6].map(|eighth| {
        let angle = -std::f32::consts::FRAC_PI_4 * f32::from(eighth);
        Vec2::angled(angle)
    });
    let nearness = |candidate: &Vec2| {
        let dots = directions.iter().map(|direction| direction.dot(*candidate));
        dots.fold(-1.0_f32, f32::max)
    };
    let best = candidates.into_iter().reduce(|best, next| {
        // Only if it is clearly freer, so that the handle does not jump about as the view turns.
        match nearness(&next) < nearness(&best) - 0.1 {
            true => next,
            false => best,
        }
    });
    best.unwrap_or(Vec2::RIGHT)
}

/// The handle that a pointer means: knobs before lines, the nearest of each.
pub(super) fn handle_at(placed: &[Placed], pos: Pos2) -> Option<Handle> {
    let distances = |measure: fn(&Placed, Pos2) -> f32, reach: f32| {
        let near = placed
            .iter()
            .map(move |placed| (measure(placed, pos), placed.handle));
        near.filter(|(distance, _)| *distance <= reach)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, handle)| handle)
    };
    let to_knob = |placed: &Placed, pos: Pos2| match placed.handle.is_line() {
        true => f32::INFINITY,
        false => placed.knob.distance(pos),
    };
    let to_line = |placed: &Placed, pos: Pos2| distance_to_line(&placed.line, pos);
    distances(to_knob, KNOB_REACH).or_else(|| distances(to_line, LINE_REACH))
}

/// Infinite for a line without a piece.
pub(super) fn distance_to_line(line: &[Pos2], pos: Pos2) -> f32 {
    line.windows(2)
        .map(|ends| distance_to_segment([ends[0], ends[1]], pos))
        .fold(f32::INFINITY, f32::min)
}

pub(super) fn distance_to_segment([a, b]: [Pos2; 2], pos: Pos2) -> f32 {
    let along = b - a;
    let t = ((pos - a).dot(along) / along.length_sq().max(1e-12)).clamp(0.0, 1.0);
    pos.distance(a + along * t)
}
