//! The brush: even spacing, the object's frame, small strokes that follow the pointer, and the layer that they go to.

use crate::seeded;
use glam::{DMat4, DVec3, dvec3};
use hairline_document::Description;
use hairline_document::description::{Brush, Layer, Object, Stroke};
use hairline_editor::brush::{BrushSettings, Recorder, apply_stroke};
use hairline_editor::{ActionError, Selection};
use hairline_fixtures::SceneFile;
use proptest::prelude::*;

const RADIUS_M: f64 = 0.01;

fn settings(erase: bool) -> BrushSettings {
    BrushSettings {
        radius_m: RADIUS_M,
        density_per_m: 500.0,
        width: 1.5,
        depth: 1.0,
        erase,
    }
}

fn scene() -> Description {
    let disk = "disk = { radius_m = 0.1 }";
    SceneFile::seen_from([0.0, 0.0, 1.0])
        .mirror("m")
        .object("a", "m", disk)
        .with_lines(
            "translation_m = [0.1, 0.2, 0.3]\nrotation_deg = [10, 20, 30]\nscale = [2, 1, 0.5]",
        )
        .object("b", "m", disk)
        .random("a", 10)
        .random("b", 10)
        .with_lines("hidden = true")
        .description()
}

fn object() -> Object {
    scene().objects.remove(0)
}

/// Distance of a point from a path of straight pieces.
fn distance_to_path(point: DVec3, path: &[DVec3]) -> f64 {
    let to_piece = |a: DVec3, b: DVec3| {
        let t = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        let t = if t.is_nan() { 0.0 } else { t };
        point.distance(a + (b - a) * t)
    };
    let pieces = path.windows(2).map(|p| to_piece(p[0], p[1]));
    pieces.fold(point.distance(path[0]), f64::min)
}

proptest! {
    #![proptest_config(seeded(200))]

    #[test]
    fn spacing_is_even_and_strokes_follow_the_pointer(
        steps in prop::collection::vec((-0.02..0.02, -0.02..0.02), 1..80),
        fine in 0.05..1.0,
    ) {
        let world_from_object = object().world_from_object();
        let mut recorder = Recorder::new(settings(false), world_from_object);
        let mut at = dvec3(0.1, 0.2, 0.3);
        let mut pointer = vec![at];
        recorder.add(at);
        for (x, y) in steps {
            at += dvec3(x, y, 0.3 * x) * fine;
            pointer.push(at);
            let before = recorder.path_m().len();
            prop_assert_eq!(recorder.add(at), recorder.path_m().len() > before);
        }
        let path = recorder.path_m().to_vec();
        for pair in path.windows(2) {
            let spacing = pair[0].distance(pair[1]) / RADIUS_M;
            prop_assert!((0.1249..0.5001).contains(&spacing), "{}", spacing);
        }
        let stroke = recorder.finish().unwrap();
        prop_assert!(stroke.points_m.len() <= path.len());
        let drawn: Vec<_> = stroke.points_m.iter().map(|&p| world_from_object.transform_point3(p.into())).collect();
        // 1/20 of the radius for the thinning and a little for the rounding.
        for point in &path {
            prop_assert!(distance_to_path(*point, &drawn) < 0.053 * RADIUS_M);
        }
        // Movements of the pointer within an eighth of the radius may be left out.
        for point in &pointer {
            prop_assert!(distance_to_path(*point, &drawn) < 0.18 * RADIUS_M);
        }
        // The bound means something: another stroke breaks it.
        let far: Vec<_> = drawn.iter().map(|p| *p + dvec3(0.0, 0.0, 0.06 * RADIUS_M + 0.1)).collect();
        prop_assert!(distance_to_path(path[0], &far) > 0.053 * RADIUS_M);
    }
}

#[test]
fn a_straight_drag_is_two_short_points_and_a_dab_is_one() {
    let mut recorder = Recorder::new(settings(false), DMat4::IDENTITY);
    assert_eq!(recorder.clone().finish(), None);
    recorder.add(dvec3(0.1 / 3.0, 0.0, 0.0));
    assert!(!recorder.add(DVec3::NAN));
    assert!(!recorder.add(dvec3(0.1 / 3.0 + 1e-4, 0.0, 0.0)), "too near");
    let dab = recorder.clone().finish().unwrap();
    // Rounded to 10 um, the power of ten below a five-hundredth of the radius.
    assert_eq!(dab.points_m, [[0.03333, 0.0, 0.0]]);
    for i in 1..=100 {
        recorder.add(dvec3(0.1 / 3.0 + 0.001 * f64::from(i) * 1.3, 0.0, 0.0));
    }
    let stroke = recorder.finish().unwrap();
    assert_eq!(stroke.points_m, [[0.03333, 0.0, 0.0], [0.16333, 0.0, 0.0]]);
    assert_eq!(
        stroke.brush,
        Brush::Paint {
            density_per_m: 500.0,
            width: 1.5,
            depth: 1.0
        }
    );
}

#[test]
fn a_leap_and_a_long_scribble_stay_within_what_a_scene_takes() {
    let mut recorder = Recorder::new(settings(true), DMat4::IDENTITY);
    recorder.add(DVec3::ZERO);
    recorder.add(dvec3(900.0, 0.0, 0.0));
    for i in 0..200_000 {
        // A zigzag of which no point can be left out at first.
        recorder.add(dvec3(
            900.0 - 0.004 * f64::from(i),
            f64::from(i % 2) * 0.004,
            0.0,
        ));
    }
    let stroke = recorder.finish().unwrap();
    assert_eq!(stroke.brush, Brush::Erase);
    let mut description = scene();
    apply_stroke(&mut description, Selection::Layer(0), stroke).unwrap();
    assert_eq!(description.check(), Ok(()));
}

fn stroke(erase: bool) -> Stroke {
    let mut recorder = Recorder::new(settings(erase), object().world_from_object());
    recorder.add(dvec3(0.1, 0.2, 0.3));
    recorder.add(dvec3(0.15, 0.2, 0.3));
    recorder.finish().unwrap()
}

#[test]
fn paint_finds_its_layer() {
    let mut description = scene();
    let paint = |description: &mut Description, selection| {
        let selection = apply_stroke(description, selection, stroke(false));
        assert_eq!(
            description.check().and(description.check_references()),
            Ok(())
        );
        selection
    };
    // A pattern takes no paint: a drawn layer is made behind it.
    assert_eq!(
        paint(&mut description, Selection::Layer(0)),
        Ok(Selection::Layer(1))
    );
    assert!(matches!(description.scratches[1].layer, Layer::Brushed(_)));
    assert_eq!(description.scratches[1].object, "a");
    assert_eq!(description.scratches[1].strokes.len(), 1);
    assert!(description.scratches[0].strokes.is_empty());
    // The next stroke goes to the new layer, whether that or its object is selected. A pattern that is selected takes no paint again.
    for selection in [Selection::Layer(1), Selection::Object(0)] {
        assert_eq!(paint(&mut description, selection), Ok(Selection::Layer(1)));
    }
    assert_eq!(description.scratches[1].strokes.len(), 3);
    let mut again = description.clone();
    let place = paint(&mut again, Selection::Layer(0)).unwrap();
    assert_eq!(again.scratches.len(), description.scratches.len() + 1);
    assert!(matches!(place, Selection::Layer(i) if again.scratches[i].strokes.len() == 1));
    // But not where it is hidden, unless it is selected itself: then it is shown, as what is drawn is to be seen.
    description.scratches[1].hidden = true;
    assert_eq!(
        paint(&mut description, Selection::Layer(1)),
        Ok(Selection::Layer(1))
    );
    assert!(!description.scratches[1].hidden);
    description.scratches[1].hidden = true;
    assert_eq!(
        paint(&mut description, Selection::Object(0)),
        Ok(Selection::Layer(2))
    );
    let seeds: Vec<_> = description
        .scratches
        .iter()
        .filter_map(|l| l.layer.seed())
        .collect();
    assert_eq!(seeds, [1, 2, 3, 1]);
    assert_eq!(
        paint(&mut description, Selection::Camera),
        Err(ActionError::Missing("object"))
    );
}

#[test]
fn the_eraser_works_on_what_is_selected_and_seen() {
    let mut description = scene();
    apply_stroke(&mut description, Selection::Object(0), stroke(false)).unwrap();
    let strokes = |d: &Description| {
        d.scratches
            .iter()
            .map(|l| l.strokes.len())
            .collect::<Vec<_>>()
    };
    assert_eq!(strokes(&description), [0, 1, 0]);
    apply_stroke(&mut description, Selection::Layer(0), stroke(true)).unwrap();
    assert_eq!(strokes(&description), [1, 1, 0]);
    let selection = apply_stroke(&mut description, Selection::Object(0), stroke(true));
    assert_eq!(selection, Ok(Selection::Object(0)));
    assert_eq!(strokes(&description), [2, 2, 0]);
    apply_stroke(&mut description, Selection::Object(1), stroke(true)).unwrap();
    assert_eq!(
        strokes(&description),
        [2, 2, 0],
        "a hidden layer is left alone"
    );
    assert_eq!(description.check(), Ok(()));
}
