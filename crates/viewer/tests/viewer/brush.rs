//! Strokes drawn with the mouse.

use crate::common;

use std::sync::LazyLock;

use egui::{Pos2, vec2};
use egui_kittest::Harness;
use glam::DVec3;
use hairline_document::description::{Brush, Stroke};
use hairline_fixtures::{BALL, SceneFile};
use hairline_viewer::Viewer;

/// A ball, whose surface bends away between two places of the pointer.
static STEEL_BALL: LazyLock<String> = LazyLock::new(|| {
    SceneFile::seen_from([0.0, -0.5, 0.0])
        .metal("steel", "steel")
        .with_lines("roughness = 0.2")
        .object("ball", "steel", BALL)
        .sphere([0.1, -0.3, 0.3], 0.02, 10.0)
        .to_string()
});

const BALL_RADIUS_M: f64 = 0.05;

fn with_brush(scene: &'static str) -> Harness<'static, Viewer> {
    let mut harness = common::viewer(scene);
    common::wait_built(&mut harness);
    common::key(&mut harness, egui::Key::B);
    harness
}

fn strokes(harness: &Harness<'static, Viewer>) -> Vec<Stroke> {
    let description = common::description(harness);
    let layers = description.scratches.iter();
    layers.flat_map(|layer| layer.strokes.clone()).collect()
}

fn middle(harness: &Harness<'static, Viewer>) -> Pos2 {
    common::picture(harness).center()
}

#[test]
fn a_drag_is_one_stroke_and_one_undo_takes_it_away() {
    let mut harness = with_brush(common::SMALL);
    let before = common::description(&harness);
    let from = middle(&harness) + vec2(-60.0, 60.0);
    common::drag(&mut harness, from, from + vec2(120.0, 10.0), 12);
    let drawn = strokes(&harness);
    assert_eq!(drawn.len(), 1);
    assert!(matches!(drawn[0].brush, Brush::Paint { .. }));
    assert_eq!(common::description(&harness).camera, before.camera);
    common::undo(&mut harness);
    assert_eq!(common::description(&harness), before);
}

#[test]
fn a_fast_drag_stays_on_a_bent_surface() {
    let mut harness = with_brush(&STEEL_BALL);
    let from = middle(&harness) + vec2(-90.0, 0.0);
    // Over the ball from beside it in one move.
    common::drag(&mut harness, from, from + vec2(180.0, 0.0), 1);
    let drawn = strokes(&harness);
    assert_eq!(drawn.len(), 1);
    let path: Vec<DVec3> = drawn[0].points_m.iter().map(|&p| p.into()).collect();
    assert!(path.len() > 4, "{} points", path.len());
    // Straight pieces stray from the sphere by the brush's own tolerance, a twentieth of its radius; one straight line
    // would stray by half of the ball's.
    for pair in path.windows(2) {
        let height_m = (0.5 * (pair[0] + pair[1])).length();
        let low_m = BALL_RADIUS_M - height_m;
        assert!(
            low_m.abs() < 0.1 * drawn[0].radius_m,
            "{low_m} m below the surface"
        );
    }
}

#[test]
fn leaving_the_object_ends_a_stroke_but_not_the_step() {
    let mut harness = with_brush(&STEEL_BALL);
    let before = common::description(&harness);
    let at = middle(&harness);
    let far = common::picture(&harness).right_center() - vec2(8.0, 0.0);
    common::press(&mut harness, at + vec2(-40.0, -40.0));
    common::move_to(&mut harness, at + vec2(-40.0, -40.0), far, 6);
    common::move_to(&mut harness, far, at + vec2(-40.0, 40.0), 6);
    common::release(&mut harness, at + vec2(-40.0, 40.0));
    assert_eq!(strokes(&harness).len(), 2);
    // Nothing was drawn across the gap.
    for stroke in strokes(&harness) {
        for point in stroke.points_m {
            assert!((DVec3::from(point).length() - BALL_RADIUS_M).abs() < 1e-3);
        }
    }
    common::undo(&mut harness);
    assert_eq!(common::description(&harness), before);
}

#[test]
fn escape_forgets_a_stroke() {
    let mut harness = with_brush(common::SMALL);
    let before = common::description(&harness);
    let from = middle(&harness) + vec2(-60.0, 60.0);
    let to = from + vec2(80.0, 0.0);
    common::press(&mut harness, from);
    common::move_to(&mut harness, from, to, 4);
    common::key(&mut harness, egui::Key::Escape);
    common::move_to(&mut harness, to, to + vec2(30.0, 0.0), 4);
    common::release(&mut harness, to + vec2(30.0, 0.0));
    assert_eq!(common::description(&harness), before);
    // The brush is still in the hand.
    common::drag(&mut harness, from, to, 4);
    assert_eq!(strokes(&harness).len(), 1);
}

#[test]
fn a_thousand_places_of_the_pointer_are_taken_up_at_once() {
    let mut harness = with_brush(&STEEL_BALL);
    let at = middle(&harness);
    common::press(&mut harness, at);
    let start = std::time::Instant::now();
    for i in 0..1000_u16 {
        let (sin, cos) = (f32::from(i) * 0.02).sin_cos();
        let place = at + vec2(cos, sin) * (10.0 + 0.05 * f32::from(i));
        // All in one pass.
        let events = &mut harness.input_mut().events;
        events.push(egui::Event::PointerMoved(place));
    }
    harness.step();
    let took = start.elapsed();
    common::release(&mut harness, at);
    assert_eq!(strokes(&harness).len(), 1);
    // A pass has some ms; a machine that stands still now and then is given a thousand times that. A stroke that is laid anew for each
    // place would take as long.
    assert!(took.as_secs() < 5, "{took:?}");
    println!("a pass with 1000 places of the pointer: {took:?}");
}

/// The stroke is shown until the picture has it. What is drawn in a free view is seen from there.
#[test]
fn a_stroke_that_the_picture_waits_for_lies_where_the_pointer_was() {
    let mut harness = common::viewer(common::BUILT_IN);
    common::wait_built(&mut harness);
    let beside = middle(&harness) + vec2(0.0, 250.0);
    common::drag(&mut harness, beside, beside + vec2(90.0, 20.0), 6);
    assert_ne!(
        harness.state().camera(),
        common::description(&harness).camera
    );
    common::key(&mut harness, egui::Key::B);
    let from = middle(&harness) + vec2(-30.0, 30.0);
    common::drag(&mut harness, from, from + vec2(60.0, 0.0), 6);
    assert_eq!(strokes(&harness).len(), 1);
    harness.step();
    let viewer = harness.state();
    let frame = viewer.renderer().latest().unwrap();
    if frame.built.revision == viewer.document().revision() {
        return;
    }
    let lies_there = |clipped: &egui::epaint::ClippedShape| match &clipped.shape {
        egui::Shape::Path(path) => {
            let is_near = |at: f32, wanted: f32| (at - wanted).abs() < 3.0;
            let ends = (path.points.first(), path.points.last());
            path.stroke.width == 3.0
                && matches!(ends, (Some(a), Some(b)) if is_near(a.x, from.x) && is_near(b.x, from.x + 60.0)
                    && is_near(a.y, from.y) && is_near(b.y, from.y))
        }
        _ => false,
    };
    assert!(harness.output().shapes.iter().any(lies_there));
}

/// Half of the brush's width on the screen, in parts of the picture's height.
fn share_of_view(harness: &Harness<'static, Viewer>, stroke: &Stroke) -> f64 {
    let camera = &common::description(harness).camera;
    let point_m = stroke.points_m[0].into();
    stroke.radius_m / hairline_document::navigate::view_height_m(camera, point_m)
}

#[test]
fn the_first_brush_fits_the_object_and_the_view_and_not_the_table() {
    let mut harness = with_brush(common::BUILT_IN);
    let from = middle(&harness) + vec2(-60.0, 30.0);
    common::drag(&mut harness, from, from + vec2(120.0, 10.0), 6);
    let [far] = &strokes(&harness)[..] else {
        panic!("one stroke")
    };
    // On a pan of 20 cm under a table of 2 m.
    assert!(
        (0.5e-3..10e-3).contains(&far.radius_m),
        "{} m",
        far.radius_m
    );
    let share = share_of_view(&harness, far);
    assert!((0.01..0.06).contains(&share), "{share}");
    // Nearer, it is as large on the screen.
    let document = harness.state_mut().document_mut();
    document.edit("nearer", |d| {
        hairline_document::navigate::dolly(&mut d.camera, 8.0)
    });
    harness.run_steps(3);
    common::drag(&mut harness, from, from + vec2(120.0, 10.0), 6);
    let near = strokes(&harness)[1].clone();
    assert!(near.radius_m < 0.6 * far.radius_m);
    assert!((share_of_view(&harness, &near) / share - 1.0).abs() < 0.2);
    // Settings made by hand stay.
    common::key(&mut harness, egui::Key::CloseBracket);
    common::drag(&mut harness, from, from + vec2(120.0, 10.0), 6);
    let larger = strokes(&harness)[2].radius_m;
    assert!(larger > 1.1 * near.radius_m && larger < 1.5 * near.radius_m);
}

#[test]
fn a_stroke_beside_a_layer_that_is_solo_is_seen() {
    let mut harness = with_brush(common::SMALL);
    let document = harness.state_mut().document_mut();
    document.edit("solo", |d| d.scratches[0].solo = true);
    harness.run_steps(2);
    let from = middle(&harness) + vec2(-60.0, 60.0);
    common::drag(&mut harness, from, from + vec2(120.0, 10.0), 6);
    let description = common::description(&harness);
    let drawn = description
        .scratches
        .iter()
        .position(|l| !l.strokes.is_empty())
        .unwrap();
    assert!(hairline_editor::actions::layers::is_shown(
        &description,
        drawn
    ));
}

#[test]
fn a_drag_of_the_eraser_is_one_step() {
    let mut harness = with_brush(&STEEL_BALL);
    let at = middle(&harness);
    common::drag(&mut harness, at + vec2(-40.0, 0.0), at + vec2(40.0, 0.0), 6);
    let before = common::description(&harness);
    common::key(&mut harness, egui::Key::E);
    let far = common::picture(&harness).right_center() - vec2(8.0, 0.0);
    common::press(&mut harness, at + vec2(-20.0, -40.0));
    common::move_to(&mut harness, at + vec2(-20.0, -40.0), far, 6);
    common::move_to(&mut harness, far, at + vec2(-20.0, 40.0), 6);
    common::release(&mut harness, at + vec2(-20.0, 40.0));
    assert!(strokes(&harness).len() > 1);
    common::undo(&mut harness);
    assert_eq!(common::description(&harness), before);
}

/// Bright enough to be seen where it runs, whatever its direction: pictures before and after differ there.
fn the_first_stroke_is_seen(scene: &'static str) {
    let options = hairline_viewer::Options {
        scene: None,
        built_in: scene,
        backend: hairline_viewer::progressive::Backend::Cpu,
        state_dir: None,
        native_dialogs: false,
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
    };
    // A small picture, without the panels.
    let mut harness = common::viewer_of(options, [300.0, 220.0]);
    common::key(&mut harness, egui::Key::F9);
    common::key(&mut harness, egui::Key::F10);
    common::wait_built(&mut harness);
    common::key(&mut harness, egui::Key::B);
    let before = full_size(&mut harness);
    let at = middle(&harness);
    common::drag(
        &mut harness,
        at + vec2(-30.0, 10.0),
        at + vec2(30.0, 10.0),
        6,
    );
    common::drag(
        &mut harness,
        at + vec2(40.0, -15.0),
        at + vec2(46.0, 20.0),
        6,
    );
    let after = full_size(&mut harness);
    let differs = |(a, b): (&egui::Color32, &egui::Color32)| {
        std::iter::zip(a.to_array(), b.to_array()).any(|(a, b)| a.abs_diff(b) > 12)
    };
    let seen = std::iter::zip(&before.pixels, &after.pixels)
        .filter(|p| differs(*p))
        .count();
    // Two strokes of 60 and 35 by 8 points, or so; a third of them.
    assert!(seen > 250, "{seen} pixels differ");
}

#[test]
fn the_first_stroke_is_seen_at_once() {
    the_first_stroke_is_seen(common::thinned(340));
}

#[test]
#[ignore = "long: cargo long"]
fn the_first_stroke_is_seen_among_many_scratches() {
    the_first_stroke_is_seen(common::BUILT_IN);
}

/// The first picture in its full size with every stroke that was drawn; samples of edges may come later.
fn full_size(harness: &mut Harness<'static, Viewer>) -> std::sync::Arc<egui::ColorImage> {
    common::wait_until(harness, "a picture in full size", |viewer| {
        let renderer = viewer.renderer();
        let revision = viewer.document().revision();
        !renderer.is_building()
            && renderer.latest().is_some_and(|frame| {
                let is_full = frame.painted.size_px == frame.view.size_px;
                is_full && frame.built.revision == revision
            })
    });
    let frame = harness.state().renderer().latest().unwrap();
    match &frame.picture {
        hairline_viewer::progressive::Picture::Pixels(image) => image.clone(),
        hairline_viewer::progressive::Picture::Texture(_) => panic!("the CPU paints pixels"),
    }
}

/// A dark polished plate whose lamp has its mirror image there on the plate's plane.
fn plate_with_highlight_at(x_m: f64) -> &'static str {
    let scene = SceneFile::seen_from([0.0, -0.3, 0.3])
        .fov_y_deg(30.0)
        .mirror("m")
        .object("plate", "m", "plane = { size_m = [0.2, 0.2] }")
        .sphere([2.0 * x_m, 0.3, 0.3], 0.01, 500.0);
    scene.to_string().leak()
}

/// The stroke that the brush has drawn, over the picture.
fn marks(harness: &Harness<'static, Viewer>) -> usize {
    let shapes = harness.output().shapes.iter().map(|clipped| &clipped.shape);
    let is_mark =
        |shape: &&egui::Shape| matches!(shape, egui::Shape::Path(path) if path.stroke.width == 3.0);
    shapes.filter(is_mark).count()
}

#[test]
fn a_stroke_that_hardly_shows_is_marked_and_told_of() {
    let is_told = |viewer: &Viewer| {
        let said = viewer.messages().concat();
        said.contains("The stroke hardly shows")
    };
    let mut harness = with_brush(plate_with_highlight_at(40.0));
    let wait_whole = |harness: &mut Harness<'static, Viewer>| {
        let revision = harness.state().document().revision();
        common::wait_until(harness, "a whole picture", |viewer| {
            let frame = viewer.renderer().latest();
            frame.is_some_and(|it| it.built.revision >= revision && it.painted.is_final)
        });
        harness.run_steps(2);
    };
    let draw = |harness: &mut Harness<'static, Viewer>| {
        wait_whole(harness);
        assert!(!is_told(harness.state()));
        let from = middle(harness) + vec2(-30.0, 5.0);
        common::drag(harness, from, from + vec2(60.0, 0.0), 12);
        assert_eq!(marks(harness), 1, "nothing shows it yet");
        // The message is waited for, and not the picture: on a busy machine it may be gone before the picture is whole.
        common::wait_until(harness, "the message", is_told);
        assert_eq!(marks(harness), 1);
    };
    draw(&mut harness);
    // The message goes with its stroke.
    harness.state_mut().document_mut().undo();
    harness.run_steps(2);
    assert_eq!(marks(&harness), 0);
    assert!(!is_told(harness.state()));

    draw(&mut harness);
    wait_whole(&mut harness);
    assert_eq!(marks(&harness), 1);
    common::key(&mut harness, egui::Key::V);
    assert_eq!(marks(&harness), 0);
}
