//! Handles in the picture: each does what its name says, in one step, which undo takes back.

use crate::common;
use egui::{Pos2, vec2};
use egui_kittest::{Harness, kittest::Queryable};
use glam::DVec3;
use hairline_document::description::{Cone, Light, LightKind};
use hairline_document::place_light;
use hairline_editor::Selection;
use hairline_viewer::Viewer;

const LAMP: usize = 0;
const SQUARE: usize = 1;

/// The small scene with a light selected.
fn with_selected(row: &str) -> Harness<'static, Viewer> {
    let mut harness = common::viewer(common::SMALL);
    common::wait_built(&mut harness);
    common::click_on(&mut harness, row);
    harness
}

fn handle(harness: &Harness<'static, Viewer>, label: &str) -> Pos2 {
    harness.get_by_label(label).rect().center()
}

fn corners(light: &Light) -> Vec<DVec3> {
    light.kind.corners_m()
}

/// Largest distance of a corner from the plane through the first three.
fn out_of_plane_m(light: &Light) -> f64 {
    let corners = corners(light);
    let normal = (corners[1] - corners[0])
        .cross(corners[2] - corners[0])
        .normalize();
    let off = corners.iter().map(|v| (*v - corners[0]).dot(normal).abs());
    off.fold(0.0, f64::max)
}

#[test]
fn an_arrow_moves_a_light_along_its_axis_and_one_undo_brings_it_back() {
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let mut harness = with_selected("lamp");
        let camera = common::description(&harness).camera.clone();
        let before = common::light(&harness, LAMP);
        let label = format!("Move light along {axis}");
        let from = handle(&harness, &label);
        // Not along any arrow.
        common::drag(&mut harness, from, from + vec2(33.0, -21.0), 7);
        let after = common::light(&harness, LAMP);
        let moved = place_light::center(&after) - place_light::center(&before);
        assert!(moved[i].abs() > 1e-3, "{axis}: moved by {moved} m");
        for other in (0..3).filter(|other| *other != i) {
            assert_eq!(moved[other], 0.0, "{axis}: moved by {moved} m");
        }
        // The handle follows the pointer as far as its axis lets it.
        assert_eq!(
            harness.state().document().undo_label(),
            Some(label.as_str())
        );
        assert_eq!(
            common::description(&harness).camera,
            camera,
            "the view has not turned"
        );
        assert_eq!(
            harness.state().document().selection(),
            Selection::Light(LAMP)
        );
        common::undo(&mut harness);
        assert_eq!(common::light(&harness, LAMP), before);
        assert_eq!(harness.state().document().undo_label(), None);
    }
}

#[test]
fn the_shaft_of_an_arrow_is_the_arrow() {
    let mut harness = with_selected("lamp");
    let tip = handle(&harness, "Move light along x");
    let middle = handle(&harness, "Move light across the view");
    let before = place_light::center(&common::light(&harness, LAMP));
    let shaft = middle.lerp(tip, 0.5);
    common::drag(&mut harness, shaft, shaft + (tip - middle) * 0.5, 5);
    let moved = place_light::center(&common::light(&harness, LAMP)) - before;
    assert!(
        moved.x > 1e-3 && moved.y == 0.0 && moved.z == 0.0,
        "moved by {moved} m"
    );
}

#[test]
fn the_middle_follows_the_pointer() {
    let mut harness = with_selected("lamp");
    let from = handle(&harness, "Move light across the view");
    let to = from + vec2(70.0, 35.0);
    common::drag(&mut harness, from, to, 5);
    harness.run_steps(2);
    let at = handle(&harness, "Move light across the view");
    // Rectangles of nodes are single precision.
    assert!((at - to).length() < 0.05, "{at} instead of {to}");
}

#[test]
fn escape_takes_a_drag_back_and_keeps_the_selection() {
    let mut harness = with_selected("lamp");
    let before = common::light(&harness, LAMP);
    let from = handle(&harness, "Move light along x");
    let to = from + vec2(50.0, 0.0);
    common::press(&mut harness, from);
    common::move_to(&mut harness, from, to, 5);
    assert_ne!(common::light(&harness, LAMP), before);
    common::key(&mut harness, egui::Key::Escape);
    assert_eq!(common::light(&harness, LAMP), before);
    // The button is still down.
    common::move_to(&mut harness, to, to + vec2(40.0, 10.0), 3);
    common::release(&mut harness, to);
    assert_eq!(common::light(&harness, LAMP), before);
    assert_eq!(
        harness.state().document().selection(),
        Selection::Light(LAMP)
    );
    assert_eq!(harness.state().document().undo_label(), None);
    // Then it means what it always does.
    common::key(&mut harness, egui::Key::Escape);
    assert_eq!(harness.state().document().selection(), Selection::None);
}

#[test]
fn two_drags_of_one_handle_are_two_steps() {
    let mut harness = with_selected("lamp");
    let mut steps = vec![common::light(&harness, LAMP)];
    for _ in 0..2 {
        let from = handle(&harness, "Move light along z");
        common::drag(&mut harness, from, from + vec2(0.0, -30.0), 4);
        harness.run_steps(2);
        steps.push(common::light(&harness, LAMP));
    }
    assert!(steps[0] != steps[1] && steps[1] != steps[2]);
    common::undo(&mut harness);
    assert_eq!(common::light(&harness, LAMP), steps[1]);
    common::undo(&mut harness);
    assert_eq!(common::light(&harness, LAMP), steps[0]);
}

#[test]
fn a_corner_moves_alone_and_in_its_plane() {
    let mut harness = with_selected("square");
    let before = common::light(&harness, SQUARE);
    let from = handle(&harness, "Move corner 3");
    let to = from + vec2(25.0, -30.0);
    common::drag(&mut harness, from, to, 6);
    harness.run_steps(2);
    let after = common::light(&harness, SQUARE);
    for i in 0..4 {
        let moved_m = corners(&after)[i].distance(corners(&before)[i]);
        assert_eq!(moved_m > 1e-6, i == 2, "corner {}: {moved_m} m", i + 1);
    }
    // A rounding, on coordinates of a tenth of a metre.
    assert!(
        out_of_plane_m(&after) < 1e-12,
        "{} m",
        out_of_plane_m(&after)
    );
    let at = handle(&harness, "Move corner 3");
    assert!((at - to).length() < 0.05, "{at} instead of {to}");
    common::undo(&mut harness);
    assert_eq!(common::light(&harness, SQUARE), before);
}

#[test]
fn a_corner_stays_where_the_polygon_would_cross_itself() {
    let mut harness = with_selected("square");
    let from = handle(&harness, "Move corner 3");
    // Far beyond the opposite edge.
    let to = handle(&harness, "Move corner 1") + vec2(-150.0, 120.0);
    common::drag(&mut harness, from, to, 20);
    let after = common::light(&harness, SQUARE);
    assert!(after.check().is_ok());
}

#[test]
fn a_ring_turns_a_polygon_about_its_middle() {
    let mut harness = with_selected("square");
    let before = common::light(&harness, SQUARE);
    let from = handle(&harness, "Turn light about z");
    let middle = handle(&harness, "Move light across the view");
    let along = (from - middle).rot90().normalized();
    common::drag(&mut harness, from, from + along * 30.0, 6);
    let after = common::light(&harness, SQUARE);
    let shift_m = place_light::center(&after).distance(place_light::center(&before));
    assert!(shift_m < 1e-12, "{shift_m} m");
    let (a, b) = (corners(&before), corners(&after));
    for i in 0..4 {
        assert!((a[i].z - b[i].z).abs() < 1e-12, "about z heights stay");
    }
    // The eye is above; the pointer went counter-clockwise.
    let (side, turned) = (a[1] - a[0], b[1] - b[0]);
    let angle_rad = side.cross(turned).z.atan2(side.dot(turned));
    assert!(angle_rad > 0.1, "turned by {angle_rad} rad");
}

#[test]
fn the_size_handle_scales_about_the_middle() {
    let mut harness = with_selected("lamp");
    let radius_m = |harness: &Harness<'static, Viewer>| match common::light(harness, LAMP).kind {
        LightKind::Sphere { radius_m, .. } => radius_m,
        _ => f64::NAN,
    };
    let before_m = radius_m(&harness);
    let from = handle(&harness, "Resize light");
    let middle = handle(&harness, "Move light across the view");
    common::drag(&mut harness, from, middle + (from - middle) * 1.5, 6);
    let factor = radius_m(&harness) / before_m;
    // Places on the screen are single precision.
    assert!((factor - 1.5).abs() < 1e-3, "by {factor}");
}

#[test]
fn the_rims_of_a_cone_follow_the_pointer() {
    let mut harness = with_selected("lamp");
    assert!(harness.query_by_label("Open the cone").is_none());
    harness.state_mut().document_mut().edit("by the test", |d| {
        d.lights[LAMP].cone = Some(Cone::new(40.0, Some([-0.06, 0.03, 0.0])));
    });
    harness.run_steps(3);
    let cone = |harness: &Harness<'static, Viewer>| common::light(harness, LAMP).cone.unwrap();
    let before = cone(&harness);
    let middle = handle(&harness, "Move light across the view");
    // The lamp shines down: what is right of it opens to the right.
    for (label, sign) in [("Open the cone", 1.0), ("Soften the cone", -1.0)] {
        let from = handle(&harness, label);
        let out = vec2((from.x - middle.x).signum(), 0.0);
        common::drag(&mut harness, from, from + out * 12.0 * sign, 6);
        let now = cone(&harness);
        let told = harness.state().document().undo_label();
        assert_eq!(told, Some(label));
        match sign > 0.0 {
            true => assert!(now.cone_deg > 43.0 && now.cone_deg < 80.0, "{now:?}"),
            false => assert!(
                now.cone_softness > 0.15 && now.cone_softness < 1.0,
                "{now:?}"
            ),
        }
        common::undo(&mut harness);
        assert_eq!(cone(&harness), before);
    }
}

#[test]
fn objects_are_moved_and_turned() {
    let mut harness = with_selected("disk");
    let before = common::description(&harness).objects[0].clone();
    let from = handle(&harness, "Move object along x");
    common::drag(&mut harness, from, from + vec2(40.0, 0.0), 4);
    let moved = common::description(&harness).objects[0].clone();
    assert!(moved.translation_m[0] > 1e-3);
    assert_eq!(moved.translation_m[1..], before.translation_m[1..]);
    harness.run_steps(2);
    let from = handle(&harness, "Turn object about z");
    common::drag(&mut harness, from, from + vec2(0.0, -25.0), 4);
    let turned = common::description(&harness).objects[0].clone();
    assert!(
        turned.rotation_deg[2].abs() > 5.0,
        "{:?}",
        turned.rotation_deg
    );
    assert_eq!(turned.rotation_deg[..2], [0.0, 0.0]);
    assert_eq!(turned.translation_m, moved.translation_m);
}

#[test]
fn a_click_on_the_outline_selects_a_light_and_hidden_ones_have_none() {
    let mut harness = with_selected("lamp");
    let middle = handle(&harness, "Move light across the view");
    common::click_on(&mut harness, "Camera");
    // The lamp's edge, over the disk.
    harness.run_steps(60);
    common::click_at(&mut harness, middle + vec2(4.0, 4.0));
    assert_eq!(
        harness.state().document().selection(),
        Selection::Light(LAMP)
    );
    common::key(&mut harness, egui::Key::H);
    assert!(common::light(&harness, LAMP).hidden);
    assert!(harness.query_by_label("Move light along x").is_none());
    common::click_on(&mut harness, "Camera");
    harness.run_steps(60);
    common::click_at(&mut harness, middle + vec2(4.0, 4.0));
    assert_ne!(
        harness.state().document().selection(),
        Selection::Light(LAMP)
    );
}

#[test]
fn a_sun_has_rings_about_what_the_camera_looks_at_and_is_met_by_its_sign() {
    let mut harness = common::viewer(common::SMALL);
    common::wait_built(&mut harness);
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| {
        d.lights[LAMP] = Light {
            name: Some("sun".to_owned()),
            ..Light::new(LightKind::sun([0.6, 0.0, -0.8]))
        };
    });
    common::wait_built(&mut harness);
    common::click_on(&mut harness, "sun");
    for label in [
        "Move light along x",
        "Move light across the view",
        "Resize light",
    ] {
        assert!(harness.query_by_label(label).is_none(), "{label}");
    }
    let direction =
        |harness: &Harness<'static, Viewer>| common::light(harness, LAMP).kind.sunbeam().unwrap();
    let before = direction(&harness);
    let from = handle(&harness, "Turn light about z");
    common::drag(&mut harness, from, from + vec2(40.0, -10.0), 7);
    let after = direction(&harness);
    assert!(before.distance(after) > 0.05, "{before} {after}");
    // About z: its height stays, up to the digits that a file has.
    assert!((before.z - after.z).abs() < 1e-5, "{before} {after}");
    assert!((after.length() - 1.0).abs() < 1e-5);
    common::undo(&mut harness);
    assert_eq!(direction(&harness), before);
}
