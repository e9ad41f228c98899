//! The free view beside the scene's camera, kept views, the turntable, and the overlays.

use crate::common::{
    self, SMALL, click_on, description, viewer, viewer_with, wait_built, wait_until,
};
use egui::{Key, Modifiers, Shape, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_document::navigate;
use hairline_editor::Selection;
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Options, Viewer};

fn key(harness: &mut Harness<'static, Viewer>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(2);
}

fn orbit(harness: &mut Harness<'static, Viewer>) {
    let at = common::picture(harness).center() + vec2(0.0, 150.0);
    common::drag(harness, at, at + vec2(60.0, 15.0), 6);
    harness.run_steps(2);
}

#[test]
fn orbiting_leaves_the_scene_alone_until_the_camera_is_set() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    assert!(harness.query_by_label("Free view").is_none());
    orbit(&mut harness);
    let seen = harness.state().camera();
    assert_ne!(seen, before.camera);
    assert_eq!(*description(&harness), *before);
    assert!(!harness.state().document().is_modified());
    // The picture is that of the free view.
    let view = harness.state().view().unwrap();
    assert_eq!(view.camera.position_m, glam::DVec3::from(seen.position_m));
    harness.get_by_label("Free view");
    click_on(&mut harness, "Look through camera");
    assert_eq!(harness.state().camera(), before.camera);
    assert!(harness.query_by_label("Free view").is_none());
    orbit(&mut harness);
    let seen = harness.state().camera();
    key(&mut harness, Modifiers::NONE, Key::K);
    assert_eq!(description(&harness).camera, seen);
    assert!(harness.query_by_label("Free view").is_none());
    assert!(harness.state().document().is_modified());
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
    assert_eq!(harness.state().camera(), before.camera);
}

#[test]
fn navigation_moves_the_camera_where_that_is_switched_on() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    click_on(&mut harness, "Camera");
    click_on(&mut harness, "Move the camera with the view");
    let before = description(&harness);
    orbit(&mut harness);
    assert_ne!(description(&harness).camera, before.camera);
    assert_eq!(harness.state().document().undo_label(), Some("Orbit"));
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn views_are_kept_and_found_again() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, SMALL).unwrap();
    let open = || {
        let mut harness = viewer_with(Options {
            scene: Some(scene.clone()),
            built_in: SMALL,
            backend: Backend::Cpu,
            state_dir: Some(folder.path().join("state")),
            native_dialogs: false,
            transport: hairline_scene::Transport::DIRECT,
            examples: &hairline_viewer::examples::Examples::NONE,
        });
        wait_built(&mut harness);
        harness
    };
    let mut harness = open();
    let camera = harness.state().camera();
    orbit(&mut harness);
    let kept = harness.state().camera();
    key(&mut harness, Modifiers::COMMAND, Key::B);
    key(&mut harness, Modifiers::NONE, Key::Num0);
    assert_eq!(harness.state().camera(), camera);
    click_on(&mut harness, "Camera");
    click_on(&mut harness, "View 1");
    assert_eq!(harness.state().camera(), kept);
    assert!(!harness.state().document().is_modified());
    drop(harness);
    let mut harness = open();
    assert_eq!(harness.state().camera(), camera);
    key(&mut harness, Modifiers::NONE, Key::PageDown);
    assert_eq!(harness.state().camera(), kept);
    click_on(&mut harness, "Camera");
    click_on(&mut harness, "Forget View 1");
    assert!(harness.query_by_label("View 1").is_none());
    // The scene file is as it was.
    assert_eq!(std::fs::read_to_string(&scene).unwrap(), SMALL);
}

#[test]
fn the_turntable_turns_the_view_until_it_is_stopped() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    key(&mut harness, Modifiers::NONE, Key::T);
    harness.run_steps(5);
    let first = harness.state().camera();
    harness.run_steps(5);
    let second = harness.state().camera();
    assert!(first != before.camera && second != first);
    let height_m = before.camera.position_m[2];
    assert!((first.position_m[2] - height_m).abs() < 1e-9);
    let number = harness.state().renderer().latest().map_or(0, |f| f.number);
    wait_until(&mut harness, "a picture on the way", |viewer| {
        let frame = viewer.renderer().latest();
        frame.is_some_and(|frame| frame.number > number)
    });
    key(&mut harness, Modifiers::NONE, Key::Escape);
    let stopped = harness.state().camera();
    harness.run_steps(5);
    assert_eq!(harness.state().camera(), stopped);
    assert_eq!(*description(&harness), *before);
}

/// Lines over the picture, and words there.
fn drawn(harness: &Harness<'static, Viewer>) -> (usize, String) {
    let picture = common::picture(harness);
    let (mut lines, mut words) = (0, String::new());
    for clipped in &harness.output().shapes {
        match &clipped.shape {
            Shape::LineSegment { points, .. } if picture.contains(points[0]) => lines += 1,
            Shape::Text(text) if picture.contains(text.pos) => {
                words += text.galley.text();
                words += "\n";
            }
            _ => {}
        }
    }
    (lines, words)
}

fn choose_in_view_menu(harness: &mut Harness<'static, Viewer>, label: &str) {
    click_on(harness, "View");
    harness.get_by_label_contains(label).click();
    harness.run_steps(4);
}

#[test]
fn each_kind_of_overlay_has_its_switch() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let (outlines, words) = drawn(&harness);
    assert!(outlines > 20 && !words.contains("disk"), "{words}");
    choose_in_view_menu(&mut harness, "Outlines of lights");
    assert_eq!(drawn(&harness).0, 0);
    choose_in_view_menu(&mut harness, "Names");
    let words = drawn(&harness).1;
    for name in ["disk", "lamp", "square"] {
        assert!(words.contains(name), "{name} in {words}");
    }
    assert!(!words.contains("199"), "{words}");
    click_on(&mut harness, "Inspect");
    click_on(&mut harness, "Numbers of scratches");
    choose_in_view_menu(&mut harness, "Directions of all layers");
    harness.run_steps(60);
    assert_eq!(harness.state().document().selection(), Selection::None);
    let (lines, words) = drawn(&harness);
    assert!(lines > 50, "{lines}");
    let numbers = words
        .split_whitespace()
        .filter(|it| it.parse::<u32>().is_ok_and(|it| it < 200));
    assert!(numbers.count() > 5, "{words}");
    // One key for all of them.
    key(&mut harness, Modifiers::NONE, Key::O);
    let (lines, words) = drawn(&harness);
    assert!(lines == 0 && !words.contains("lamp"), "{lines} {words}");
    key(&mut harness, Modifiers::NONE, Key::O);
    assert!(drawn(&harness).1.contains("lamp"));
}

/// A disk on the ground, with depth of field.
const ON_GROUND: &str = concat!(include_str!("../common/small_scene.toml"), "\n[ground]\n");

fn wheel(harness: &mut Harness<'static, Viewer>, at: egui::Pos2) {
    harness.hover_at(at);
    harness.run_steps(2);
    for _ in 0..4 {
        harness.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Line,
            delta: vec2(0.0, 1.0),
            source: egui::MouseWheelSource::Wheel,
            phase: egui::TouchPhase::Move,
            modifiers: Modifiers::NONE,
        });
        harness.run_steps(6);
    }
}

/// Zooming beside the object leaves target and focus at the object's depth, and K takes both over.
#[test]
fn a_zoom_at_the_ground_leaves_target_and_focus_where_they_are() {
    for focus_m in [None, Some(0.5)] {
        let mut harness = viewer(ON_GROUND);
        let document = harness.state_mut().document_mut();
        document.edit("by the test", |d| {
            d.camera.aperture_mm = Some(2.0);
            d.camera.focus_distance_m = focus_m;
        });
        wait_built(&mut harness);
        let before = description(&harness).camera.clone();
        let sharp_m = navigate::focused_m(&before);
        let beside = common::picture(&harness).center() + vec2(250.0, 200.0);
        wheel(&mut harness, beside);
        key(&mut harness, Modifiers::NONE, Key::K);
        let camera = description(&harness).camera.clone();
        assert_ne!(camera, before);
        let depth_m = |point_m| navigate::depth_m(&camera, point_m).unwrap();
        let close = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(close(camera.lens().focus_m, depth_m(sharp_m)), "{camera:?}");
        let target_m = glam::DVec3::from(camera.target_m);
        let kept_m = depth_m(before.target_m.into());
        assert!(close(depth_m(target_m), kept_m), "{camera:?}");
    }
}

#[test]
fn focus_here_makes_what_is_under_the_pointer_sharp() {
    let mut harness = viewer(ON_GROUND);
    wait_built(&mut harness);
    let at = common::picture(&harness).center() + vec2(40.0, 60.0);
    let menu = |harness: &mut Harness<'static, Viewer>| {
        // Without handles, which would take the mouse.
        harness.state_mut().document_mut().select(Selection::None);
        common::right_click(harness, at);
        let entry = harness.get_by_label_contains("Focus here").rect();
        common::click_at(harness, entry.center());
        harness.run_steps(3);
    };
    let before = description(&harness);
    menu(&mut harness);
    assert_eq!(*description(&harness), *before);
    let told = harness.state().messages().concat();
    assert!(told.contains("Depth of field is off"), "{told:?}");
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| d.camera.aperture_mm = Some(2.0));
    menu(&mut harness);
    // The disk lies in the plane z = 0, below the target, so it is nearer there.
    let focus_m = description(&harness).camera.focus_distance_m.unwrap();
    let target_m = description(&harness).camera.lens().focus_m;
    assert_eq!(focus_m, target_m);
    let at_target_m = before.camera.lens().focus_m;
    assert!(focus_m < at_target_m - 0.01 && focus_m > 0.4, "{focus_m}");
    assert!(harness.state().messages().is_empty());
    // Focus by the key at another place, which is farther away.
    harness.hover_at(at - vec2(0.0, 90.0));
    harness.run_steps(2);
    key(&mut harness, Modifiers::SHIFT, Key::F);
    assert!(description(&harness).camera.focus_distance_m.unwrap() > focus_m + 0.01);
}
