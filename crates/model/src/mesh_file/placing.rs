//! Transform from a file's own frame to the object's: the axis that points up, and the size.

use glam::{DMat3, DMat4, DVec3};

use super::pose::Moment;
use super::shapes::Shapes;
use crate::flaw::Flaw;
use crate::mesh::LARGEST_M;

/// The keys `up`, `fit_m`, `time_s` and `animation` of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Placing {
    /// The axis of the file that points up.
    pub up: DVec3,
    /// The world's axis that points up.
    pub world_up: DVec3,
    /// The largest extent that the object is to have.
    pub fit_m: Option<f64>,
    /// The time of an animation of the file; without it the model is at rest.
    pub time_s: Option<f64>,
    /// Name or number of that animation; without it the first.
    pub animation: Option<String>,
    /// Whether its own place does not count, so that one that stands far off for its size may be moved: where it is as large as `fit_m` says,
    /// or alone.
    pub stands_alone: bool,
}

/// Largest distance of a model that stands alone, in its extents: single precision then leaves a millionth of a hundredth of its extent.
const FAR_EXTENTS: f64 = 1000.0;

/// Transform of an object before its own placement.
pub(super) struct FileTransform {
    pub object_from_file: DMat4,
    /// The middle of a file that stood too far off, in its own frame: it was put at the origin.
    pub moved_from: Option<DVec3>,
}

impl Placing {
    /// Placing of a file that is used unchanged.
    pub const NONE: Self = Self {
        up: DVec3::Z,
        world_up: DVec3::Z,
        fit_m: None,
        time_s: None,
        animation: None,
        stands_alone: true,
    };

    /// Time of the file's animation, unless the model is at rest.
    pub(super) fn moment(&self) -> Option<Moment<'_>> {
        let animation = self.animation.as_deref();
        self.time_s.map(|time_s| Moment { time_s, animation })
    }

    /// The turn, the factor and the move that the object begins with, all in double precision. A model that no camera of a scene could come
    /// near to, as those in coordinates of the Earth, begins at the origin.
    pub(super) fn start(
        &self,
        shapes: &Shapes,
        world_from_object: &DMat4,
    ) -> Result<FileTransform, Flaw> {
        let turn = DMat4::from_mat3(quarter_turn(self.up, self.world_up));
        let is_near = || {
            let world_from_file = *world_from_object * turn;
            !shapes.may_reach(&world_from_file, LARGEST_M)
        };
        if self.fit_m.is_none() && !self.stands_alone && is_near() {
            return Ok(FileTransform {
                object_from_file: turn,
                moved_from: None,
            });
        }
        let (least, most) = bounds(shapes)?;
        let extent_m = (most - least).max_element();
        let has_extent = extent_m.is_finite() && extent_m > 0.0;
        let factor = match self.fit_m {
            Some(_) if !has_extent => {
                let found = "it has no extent that `fit_m` could change";
                return Err(Flaw::new(found, "must have triangles that span an area"));
            }
            Some(fit_m) => fit_m / extent_m,
            None => 1.0,
        };
        let fitted = DMat4::from_scale(DVec3::splat(factor)) * turn;
        let middle = 0.5 * (least + most);
        let is_far = match self.stands_alone {
            true => nearest(least, most).length() > LARGEST_M.min(FAR_EXTENTS * extent_m),
            false => {
                let (least, most) = turned_box(&(*world_from_object * fitted), least, most);
                nearest(least, most).abs().max_element() > LARGEST_M
            }
        };
        let moved_from = (has_extent && is_far).then_some(middle);
        Ok(FileTransform {
            object_from_file: match moved_from {
                Some(middle) => fitted * DMat4::from_translation(-middle),
                None => fitted,
            },
            moved_from,
        })
    }
}

/// The point of a box that is nearest to the origin.
fn nearest(least: DVec3, most: DVec3) -> DVec3 {
    DVec3::ZERO.max(least).min(most)
}

/// The box around a box that was moved.
fn turned_box(to: &DMat4, least: DVec3, most: DVec3) -> (DVec3, DVec3) {
    let corner = |i: u32| {
        let pick = |axis: usize| {
            if i >> axis & 1 == 0 {
                least[axis]
            } else {
                most[axis]
            }
        };
        to.transform_point3(DVec3::new(pick(0), pick(1), pick(2)))
    };
    let corners = (0..8).map(corner);
    corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| {
        (a.min(p), b.max(p))
    })
}

/// The box around a file's vertices, in its own frame.
fn bounds(shapes: &Shapes) -> Result<(DVec3, DVec3), Flaw> {
    let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    shapes.visit(&mut |shape| {
        for file_from_place in &shape.places {
            for vertex in &shape.rough.surface.vertices {
                let point = file_from_place.transform_point3(vertex.position_m);
                (least, most) = (least.min(point), most.max(point));
            }
        }
        Ok(())
    })?;
    Ok((least, most))
}

/// Turns one axis to another, without rounding; both are of the frame's own, with either sign.
pub fn quarter_turn(from: DVec3, to: DVec3) -> DMat3 {
    let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    let cos = from.dot(to);
    if cos > 0.5 {
        return DMat3::IDENTITY;
    }
    if cos < -0.5 {
        // Half a turn about another axis.
        let about = if from.x == 0.0 { DVec3::X } else { DVec3::Y };
        return outer(about, about) * 2.0 - DMat3::IDENTITY;
    }
    let about = from.cross(to);
    outer(to, from) - outer(from, to) + outer(about, about)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for from in [DVec3::Y, DVec3::Z] {
            for to in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
                let turn = quarter_turn(from, to);
                assert_eq!(turn * from, to);
                assert_eq!(turn.determinant(), 1.0);
                assert_eq!(turn * turn.transpose(), DMat3::IDENTITY);
            }
        }
        // Same turn as `rotation_deg = [90, 0, 0]`.
        assert_eq!(quarter_turn(DVec3::Y, DVec3::Z) * DVec3::X, DVec3::X);
    }
}
