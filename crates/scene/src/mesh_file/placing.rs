//! How a file's own frame becomes the object's: which way is up, and how large it is.

use glam::{DMat3, DMat4, DVec3};

use super::flaw::Flaw;
use super::pose::Moment;
use super::shapes::Shapes;
use crate::description::{Object, Up};

/// The keys `up`, `fit_m`, `time_s` and `animation` of an object.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Placing {
    /// The axis of the file that points up.
    pub up: Up,
    /// The world's axis that points up.
    pub world_up: DVec3,
    /// The largest extent that the object is to have.
    pub fit_m: Option<f64>,
    /// The time of an animation of the file; without it the model is at rest.
    pub time_s: Option<f64>,
    /// Which one, by its name or its number; without it the first.
    pub animation: Option<String>,
}

impl Placing {
    /// As the file is.
    pub(crate) const NONE: Self = Self {
        up: Up::Z,
        world_up: DVec3::Z,
        fit_m: None,
        time_s: None,
        animation: None,
    };

    /// What an object says of its file.
    pub(crate) fn of(object: &Object, world_up: DVec3) -> Self {
        Self {
            up: object.up,
            world_up,
            fit_m: object.fit_m,
            time_s: object.time_s,
            animation: object.animation.clone(),
        }
    }

    /// Of the file's animation, unless it is at rest.
    pub(super) fn moment(&self) -> Option<Moment<'_>> {
        let animation = self.animation.as_deref();
        self.time_s.map(|time_s| Moment { time_s, animation })
    }

    /// The turn and the factor that the object begins with.
    pub(super) fn object_from_file(&self, shapes: &Shapes) -> Result<DMat4, Flaw> {
        let turn = DMat4::from_mat3(quarter_turn(self.up.axis(), self.world_up));
        let Some(fit_m) = self.fit_m else {
            return Ok(turn);
        };
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
        let extent_m = (most - least).max_element();
        if !(extent_m.is_finite() && extent_m > 0.0) {
            let found = "it has no extent that `fit_m` could change";
            return Err(Flaw::new(found, "must have triangles that span an area"));
        }
        Ok(DMat4::from_scale(DVec3::splat(fit_m / extent_m)) * turn)
    }
}

/// Turns one axis to another, without rounding; both are of the frame's own, with either sign.
fn quarter_turn(from: DVec3, to: DVec3) -> DMat3 {
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
        // As `rotation_deg = [90, 0, 0]` did.
        assert_eq!(quarter_turn(DVec3::Y, DVec3::Z) * DVec3::X, DVec3::X);
    }
}
