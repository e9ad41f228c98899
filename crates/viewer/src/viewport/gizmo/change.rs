//! Changes of the scene by the motion of a handle.

use glam::{DMat3, DVec3};
use hairline_document::Description;
use hairline_document::description::{Light, Object};
use hairline_document::place_light;
use hairline_editor::{Selection, light_corners};

use super::motion::Motion;

/// Applies a motion to the body in its state at the `start`.
pub(super) fn change(
    description: &mut Description,
    start: &Description,
    selection: Selection,
    motion: &Motion,
) {
    match selection {
        Selection::Light(i) => {
            if let (Some(light), Some(before)) =
                (description.lights.get_mut(i), start.lights.get(i))
            {
                change_light(light, before, motion);
            }
        }
        Selection::Object(i) => {
            if let (Some(object), Some(before)) =
                (description.objects.get_mut(i), start.objects.get(i))
            {
                change_object(object, before, motion);
            }
        }
        _ => {}
    }
}

fn change_light(light: &mut Light, before: &Light, motion: &Motion) {
    let mut changed = before.clone();
    match *motion {
        Motion::Move(delta_m) => place_light::translate(&mut changed, delta_m),
        Motion::Turn(axis, angle_rad) => place_light::rotate(&mut changed, axis, angle_rad),
        Motion::Resize(factor) => place_light::resize(&mut changed, factor),
        Motion::Corner(i, to_m) => {
            // If the polygon would cross itself, the corner stays at the last good place.
            if light_corners::move_vertex(&mut changed, i, to_m).is_err() {
                return;
            }
        }
        Motion::Open(deg) => {
            if let Some(cone) = &mut changed.cone {
                cone.cone_deg = deg;
            }
        }
        Motion::Soften(softness) => {
            if let Some(cone) = &mut changed.cone {
                cone.cone_softness = softness;
            }
        }
    }
    *light = changed;
}

fn change_object(object: &mut Object, before: &Object, motion: &Motion) {
    match *motion {
        Motion::Move(delta_m) => {
            object.translation_m = (DVec3::from(before.translation_m) + delta_m).into();
        }
        Motion::Turn(axis, angle_rad) => {
            object.rotation_deg = turned(before, axis, angle_rad);
        }
        Motion::Resize(_) | Motion::Corner(..) | Motion::Open(_) | Motion::Soften(_) => {}
    }
}

/// `rotation_deg` of an object after a further turn about an axis of the world.
fn turned(object: &Object, axis: DVec3, angle_rad: f64) -> [f64; 3] {
    let unplaced = Object {
        translation_m: [0.0; 3],
        scale: [1.0; 3],
        ..object.clone()
    };
    let before = DMat3::from_mat4(unplaced.world_from_object());
    hairline_editor::rotation_deg(DMat3::from_axis_angle(axis, angle_rad) * before)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_document::description::{Shape, Surface};

    fn object(rotation_deg: [f64; 3]) -> Object {
        Object {
            name: "disk".into(),
            surface: Surface::Shape(Shape::Disk { radius_m: 0.1 }),
            material: None,
            up: Default::default(),
            fit_m: None,
            time_s: None,
            animation: None,
            overrides: Vec::new(),
            translation_m: [0.0; 3],
            rotation_deg,
            scale: [1.0; 3],
            hidden: false,
        }
    }

    #[test]
    fn a_turn_about_the_worlds_axes_comes_after_what_was_there() {
        for before in [
            [0.0, 0.0, 0.0],
            [30.0, -50.0, 110.0],
            [90.0, 90.0, 0.0],
            [10.0, 90.0, 20.0],
        ] {
            for axis in DVec3::AXES {
                let old = object(before);
                let new = object(turned(&old, axis, 0.7));
                let wanted =
                    DMat3::from_axis_angle(axis, 0.7) * DMat3::from_mat4(old.world_from_object());
                let got = DMat3::from_mat4(new.world_from_object());
                // Angles are rounded to a millionth of a degree.
                assert!(
                    got.abs_diff_eq(wanted, 1e-7),
                    "{before:?} about {axis}: {got} instead of {wanted}"
                );
            }
        }
    }
}
