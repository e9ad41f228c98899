//! Strokes drawn with the mouse.

mod common;

use egui::{Pos2, vec2};
use egui_kittest::Harness;
use glam::DVec3;
use hairline_scene::description::{Brush, Stroke};
use hairline_viewer::Viewer;

/// A ball, whose surface bends away between two places of the pointer.
const BALL: &str = r#"
[camera]
position_m = [0.0, -0.5, 0.0]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = 30.0

[[material]]
name = "steel"
kind = "metal"
metal = "steel"
roughness = 0.2

[[object]]
name = "ball"
shape = { sphere = { radius_m = 0.05 } }
material = "steel"

[[light]]
kind = "sphere"
center_m = [0.1, -0.3, 0.3]
radius_m = 0.02
radiance = 10.0
"#;

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
    let mut harness = with_brush(BALL);
    let from = middle(&harness) + vec2(-90.0, 0.0);
    // Over the ball from beside it in one move.
    common::drag(&mut harness, from, from + vec2(180.0, 0.0), 1);
    let drawn = strokes(&harness);
    assert_eq!(drawn.len(), 1);
    let way: Vec<DVec3> = drawn[0].points_m.iter().map(|&p| p.into()).collect();
    assert!(way.len() > 4, "{} points", way.len());
    // Straight pieces stray from the sphere by the brush's own tolerance, a twentieth of its radius; one straight line
    // would stray by half of the ball's.
    for pair in way.windows(2) {
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
    let mut harness = with_brush(BALL);
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
    let mut harness = with_brush(BALL);
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
