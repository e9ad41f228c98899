//! Strokes that show the directions of the scratches of a selected layer.

use crate::common;

use std::sync::LazyLock;
use std::time::{Duration, Instant};

use egui::{Color32, Pos2, Shape, vec2};
use egui_kittest::Harness;
use hairline_fixtures::SceneFile;
use hairline_viewer::Viewer;

/// A turned disk from above: its scratches are circles about the picture's middle.
static FROM_ABOVE: LazyLock<String> = LazyLock::new(|| {
    SceneFile::seen_from([0.0, 0.0, 0.5])
        .up([0.0, 1.0, 0.0])
        .metal("steel", "steel")
        .with_lines("roughness = 0.2")
        .object("disk", "steel", "disk = { radius_m = 0.1 }")
        .laid("disk", "circular", 3000)
        .with_lines("name = \"turned\"\nseed = 1\nlength_m = { mean = 0.05, spread = 0.3 }")
        .with_lines(
            "width_um = { mean = 5.0, spread = 0.1 }\ndepth_nm = { mean = 180.0, spread = 0.1 }",
        )
        .to_string()
});

/// The straight lines over the picture that are neither dark nor opaque.
fn lines(harness: &Harness<'static, Viewer>) -> Vec<[Pos2; 2]> {
    let picture = common::picture(harness);
    let shapes = harness.output().shapes.iter().map(|clipped| &clipped.shape);
    let lines = shapes.filter_map(|shape| match shape {
        Shape::LineSegment { points, stroke } => Some((*points, stroke.color)),
        _ => None,
    });
    let is_mark = |color: Color32| color.r() > 60 && color.a() < 255;
    lines
        .filter(|([a, b], color)| picture.contains(*a) && picture.contains(*b) && is_mark(*color))
        .map(|(points, _)| points)
        .collect()
}

#[test]
fn strokes_run_as_the_scratches_do_and_go_with_the_selection() {
    let mut harness = common::viewer(&FROM_ABOVE);
    common::wait_built(&mut harness);
    assert_eq!(lines(&harness).len(), 0);
    common::click_on(&mut harness, "turned");
    harness.run_steps(60);
    let middle = common::picture(&harness).center();
    let shown = lines(&harness);
    assert!((50..=400).contains(&shown.len()), "{}", shown.len());
    for [a, b] in shown {
        let (along, arm) = ((b - a).normalized(), a.lerp(b, 0.5) - middle);
        // Pieces of scratches are straight within a triangle, and near the middle triangles are narrow.
        let slant = along.dot(arm.normalized()).abs();
        assert!(arm.length() < 15.0 || slant < 0.15, "{slant} at {arm}");
        assert!(
            (6.0..20.0).contains(&a.distance(b)),
            "{} points",
            a.distance(b)
        );
    }
    common::click_on(&mut harness, "Camera");
    harness.run_steps(2);
    assert_eq!(lines(&harness).len(), 0);
}

#[test]
fn a_pass_with_strokes_stays_short_while_the_view_turns() {
    let mut harness = common::viewer(common::BUILT_IN);
    common::wait_built(&mut harness);
    let median = |harness: &mut Harness<'static, Viewer>| {
        let at = common::picture(harness).center();
        common::press(harness, at);
        let mut times: Vec<Duration> = (0..60_u8)
            .map(|i| {
                harness.hover_at(at + vec2(f32::from(i), 0.3 * f32::from(i)));
                let start = Instant::now();
                harness.step();
                start.elapsed()
            })
            .collect();
        common::release(harness, at);
        times.sort();
        times[times.len() / 2]
    };
    let without = median(&mut harness);
    common::click_on(&mut harness, "circular scratches");
    harness.run_steps(60);
    let with = median(&mut harness);
    println!("median of a pass while turning: {without:?} without strokes, {with:?} with them");
    // The strokes have a budget of 1.5 ms; a loaded machine is given fifty times that.
    assert!(with < without + Duration::from_millis(75));
}
