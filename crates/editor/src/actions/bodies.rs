//! New bodies: as large as what is there, on the ground, beside all else.

use glam::{DMat3, DQuat, DVec3};
use hairline_document::Description;
use hairline_document::description::Shape;
use hairline_document::probe;

use super::{ActionError, objects};
use crate::presets::ShapePreset;
use hairline_document::navigate;

use crate::{Selection, rotation_deg};

/// A box: its least and its largest corner, metres.
pub type Bounds = (DVec3, DVec3);

/// Distance from what is there, over the size of the body.
const GAP: f64 = 0.05;
/// Places are tried in steps of this share of the body's size, up to so many steps away.
const STEP: f64 = 0.25;
const MOST_STEPS: i32 = 40;
/// Height of a flat body over the level that it lies on, over its size: two surfaces in one plane would show in patches.
const LIFT: f64 = 4e-4;

/// Adds a shape whose box has the diagonal of the largest of these boxes. It stands on the ground, at the place nearest to their
/// middle where it meets none of them. In an empty scene it stands before the camera.
///
/// # Errors
/// As of [`objects::add_shape`].
pub fn add(
    description: &mut Description,
    preset: ShapePreset,
    there_m: &[Bounds],
) -> Result<Selection, ActionError> {
    let all_m = there_m.iter().copied().reduce(joined);
    let all_m = all_m.unwrap_or_else(|| probe::empty_bounds_m(description));
    let sizes_m = there_m.iter().map(diagonal_m).reduce(f64::max);
    let size_m = sizes_m.unwrap_or_else(|| diagonal_m(&all_m));
    let shape = sized(preset, size_m);
    let up = description.camera.world_up();
    let turn = DQuat::from_rotation_arc(DVec3::Z, up);
    let body_m = turned(shape.bounds_m(), turn);
    let first_m = standing_m(body_m, middle_of_floor_m(description, all_m), up, size_m);
    let moves_m = steps(description, up).into_iter();
    let is_free = |move_m: &DVec3| {
        let (low_m, high_m) = moved(body_m, first_m + *move_m);
        let gap_m = DVec3::splat(GAP * size_m);
        let here_m = (low_m - gap_m, high_m + gap_m);
        !there_m.iter().any(|other_m| meet(here_m, *other_m))
    };
    let move_m = moves_m.map(|step| STEP * size_m * step).find(is_free);
    // Where all is full, it stands in what is there.
    let move_m = move_m.unwrap_or_default();
    let selection = objects::add_shape(description, shape, None)?;
    if let Some(body) = description.objects.last_mut() {
        // Digits that nobody sees, in a file that people read.
        let place_m = (first_m + move_m).to_array();
        body.translation_m = place_m.map(|m| (m * 1e6).round() / 1e6);
        body.rotation_deg = rotation_deg(DMat3::from_quat(turn));
    }
    Ok(selection)
}

/// The shape whose box has this diagonal, in two digits of its width.
fn sized(preset: ShapePreset, size_m: f64) -> Shape {
    let width_m = size_m / diagonal_m(&preset.shape(1.0).bounds_m());
    let digit_m = 10_f64.powf(width_m.log10().floor() - 1.0);
    preset.shape((width_m / digit_m).round() * digit_m)
}

/// The middle of a box, on the level that things stand on: the ground's, where it has one of its own, or the lowest of the box.
fn middle_of_floor_m(description: &Description, all_m: Bounds) -> DVec3 {
    let up = description.camera.world_up();
    let ground = description.ground.as_ref().filter(|ground| !ground.hidden);
    let level_m = ground.and_then(|ground| ground.height_m);
    let level_m = level_m.unwrap_or_else(|| lowest_m(all_m, up));
    let middle_m = all_m.0.midpoint(all_m.1);
    middle_m + (level_m - middle_m.dot(up)) * up
}

/// The translation by which a body about the origin stands with its middle over a point.
fn standing_m(body_m: Bounds, point_m: DVec3, up: DVec3, size_m: f64) -> DVec3 {
    let is_flat = (body_m.1 - body_m.0).dot(up).abs() < LIFT * size_m;
    let lift_m = if is_flat { LIFT * size_m } else { 0.0 };
    let middle_m = body_m.0.midpoint(body_m.1);
    let foot_m = middle_m + (lowest_m(body_m, up) - middle_m.dot(up)) * up;
    point_m + lift_m * up - foot_m
}

/// Steps over the floor, the nearest first; of those that are as near, those to the camera's right.
fn steps(description: &Description, up: DVec3) -> Vec<DVec3> {
    let camera = &description.camera;
    let [eye_m, target_m] = [camera.position_m, camera.target_m].map(DVec3::from);
    let view = target_m - eye_m;
    let flat = view - view.dot(up) * up;
    let ahead = match flat.length() > 1e-6 * view.length() {
        true => objects::nearest_axis(flat),
        // It looks straight down.
        false => up.any_orthonormal_vector(),
    };
    let right = ahead.cross(up);
    let line = -MOST_STEPS..=MOST_STEPS;
    let mut all: Vec<(i32, i32)> = line
        .clone()
        .flat_map(|x| line.clone().map(move |y| (x, y)))
        .collect();
    all.sort_by_key(|(x, y)| (x * x + y * y, -x));
    let along = |(x, y): (i32, i32)| f64::from(x) * right + f64::from(y) * ahead;
    all.into_iter().map(along).collect()
}

fn turned(bounds_m: Bounds, turn: DQuat) -> Bounds {
    let corners_m = navigate::corners(bounds_m.0, bounds_m.1).map(|corner_m| turn * corner_m);
    let points_m = corners_m.into_iter().map(|corner_m| (corner_m, corner_m));
    points_m.reduce(joined).unwrap_or(bounds_m)
}

fn moved((low_m, high_m): Bounds, by_m: DVec3) -> Bounds {
    (low_m + by_m, high_m + by_m)
}

fn joined(a: Bounds, b: Bounds) -> Bounds {
    (a.0.min(b.0), a.1.max(b.1))
}

fn meet(a: Bounds, b: Bounds) -> bool {
    a.0.cmple(b.1).all() && b.0.cmple(a.1).all()
}

fn diagonal_m((low_m, high_m): &Bounds) -> f64 {
    low_m.distance(*high_m)
}

fn lowest_m((low_m, high_m): Bounds, up: DVec3) -> f64 {
    low_m.dot(up).min(high_m.dot(up))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn empty(up: &str) -> Description {
        let text = format!(
            "[camera]\nposition_m = [0.2, -0.3, 0.3]\ntarget_m = [0, 0, 0]\nup = {up}\n[ground]\n"
        );
        Description::from_toml(&text, Path::new("empty")).unwrap()
    }

    /// The box of the newest object, in the world.
    fn newest_m(description: &Description) -> Bounds {
        let scene = hairline_document::build(description, Path::new("")).unwrap();
        let mesh = &scene.objects[description.objects.len() - 1].mesh;
        let (low_m, high_m) = mesh.bounds_m();
        (low_m.as_dvec3(), high_m.as_dvec3())
    }

    #[test]
    fn bodies_stand_side_by_side_and_are_of_one_size() {
        for (up, axis) in [("[0, 0, 1]", DVec3::Z), ("[0, 1, 0]", DVec3::Y)] {
            let mut description = empty(up);
            let mut there_m = Vec::new();
            let wanted = ShapePreset::ALL
                .into_iter()
                .filter(|it| *it != ShapePreset::Text);
            for preset in wanted {
                add(&mut description, preset, &there_m).unwrap();
                let body_m = newest_m(&description);
                let first_m = there_m.first().unwrap_or(&body_m);
                let ratio = diagonal_m(&body_m) / diagonal_m(first_m);
                assert!((0.85..1.15).contains(&ratio), "{preset:?}: {ratio}");
                let height_m = lowest_m(body_m, axis);
                assert!(
                    (-1e-5..1e-3).contains(&height_m),
                    "{preset:?} at {height_m} m"
                );
                let met = there_m.iter().find(|other_m| meet(body_m, **other_m));
                assert_eq!(met, None, "{preset:?} meets it");
                there_m.push(body_m);
            }
        }
    }

    #[test]
    fn a_body_stands_on_a_ground_of_its_own_height() {
        let mut description = empty("[0, 0, 1]");
        description.ground.get_or_insert_default().height_m = Some(0.05);
        add(&mut description, ShapePreset::Cylinder, &[]).unwrap();
        let height_m = lowest_m(newest_m(&description), DVec3::Z);
        assert!((height_m - 0.05).abs() < 1e-5, "{height_m}");
    }
}
