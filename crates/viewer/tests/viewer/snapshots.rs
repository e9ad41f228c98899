//! Snapshots of the look: taken, seen in three ways, restored as one step of undo, deleted.

use crate::common;

use egui::accesskit::{Role, Toggled};
use egui::{Color32, Key, Shape, TextureId};
use egui_kittest::{Harness, kittest::NodeT, kittest::Queryable};
use hairline_viewer::Viewer;

fn opened() -> Harness<'static, Viewer> {
    let mut harness = common::viewer(common::SMALL);
    common::wait_built(&mut harness);
    finish(&mut harness);
    harness
}

fn finish(harness: &mut Harness<'static, Viewer>) {
    common::wait_until(harness, "a finished picture", |viewer| {
        let frame = viewer.renderer().latest();
        frame.is_some_and(|frame| {
            frame.painted.is_final && Some(frame.view) == viewer.renderer().view()
        })
    });
}

fn click(harness: &mut Harness<'static, Viewer>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

fn is_shown(harness: &Harness<'static, Viewer>, name: &str) -> bool {
    let node = harness.get_by_role_and_label(Role::Button, name);
    node.accesskit_node().toggled() == Some(Toggled::True)
}

fn turn(harness: &mut Harness<'static, Viewer>) {
    let document = harness.state_mut().document_mut();
    document.edit("Turn", |d| d.camera.position_m[0] += 0.05);
    document.edit("Brighten", |d| d.camera.exposure_ev += 1.0);
    harness.run_steps(2);
    finish(harness);
}

#[test]
fn a_snapshot_is_flipped_to_and_restored_as_one_step() {
    let mut harness = opened();
    let before = harness.state().document().description().clone();
    common::key(&mut harness, Key::S);
    harness.run_steps(2);
    assert!(!is_shown(&harness, "Snapshot 1"));
    turn(&mut harness);
    let turned = harness.state().document().description().clone();
    common::key(&mut harness, Key::J);
    harness.run_steps(2);
    assert!(is_shown(&harness, "Snapshot 1"));
    // The current look stays what it is.
    assert_eq!(*harness.state().document().description(), turned);
    click(&mut harness, "Snapshot 1");
    assert!(!is_shown(&harness, "Snapshot 1"));
    click(&mut harness, "Restore");
    assert_eq!(*harness.state().document().description(), before);
    let document = harness.state_mut().document_mut();
    assert_eq!(document.undo().as_deref(), Some("Restore Snapshot 1"));
    assert_eq!(*harness.state().document().description(), turned);
}

/// The surroundings of the scene's own picture are dimmed, as in the current look.
#[test]
fn a_snapshot_that_is_flipped_to_has_the_frame_of_the_picture() {
    let mut harness = opened();
    let dims = |harness: &Harness<'static, Viewer>| {
        let shapes = harness.output().shapes.iter().map(|clipped| &clipped.shape);
        let middle = common::picture(harness).center();
        let is_picture = |shape: &Shape| match shape {
            Shape::Mesh(mesh) => mesh.texture_id != TextureId::default(),
            Shape::Rect(rect) => rect.brush.is_some(),
            _ => false,
        } && shape.visual_bounding_rect().contains(middle);
        // Shapes over the last picture there.
        let mut count = 0;
        for shape in shapes {
            match shape {
                shape if is_picture(shape) => count = 0,
                Shape::Rect(rect) if rect.fill == Color32::from_black_alpha(110) => count += 1,
                _ => {}
            }
        }
        count
    };
    let now = dims(&harness);
    assert!(now > 0);
    click(&mut harness, "Snapshot");
    click(&mut harness, "Snapshot 1");
    assert!(is_shown(&harness, "Snapshot 1"));
    assert_eq!(dims(&harness), now);
}

/// They are beside the file, as scenes of their own, and go with it under another name.
#[test]
fn snapshots_belong_to_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("a.toml");
    std::fs::write(&scene, common::SMALL).unwrap();
    let looks = folder.path().join("a.snapshots");
    let mut harness = common::viewer_of_file(&scene);
    finish(&mut harness);
    common::key(&mut harness, Key::S);
    common::wait_until(&mut harness, "its picture", |_| {
        looks.join("Snapshot 1.png").exists()
    });
    let taken = harness.state().document().description().clone();
    turn(&mut harness);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::S);
    harness.run_steps(3);
    drop(harness);

    let mut harness = common::viewer_of_file(&scene);
    finish(&mut harness);
    let is_drawn = |harness: &Harness<'static, Viewer>| {
        let at = harness
            .get_by_role_and_label(Role::Button, "Snapshot 1")
            .rect()
            .center();
        let shapes = harness.output().shapes.iter().map(|clipped| &clipped.shape);
        let mut pictures = shapes.filter(|shape| match shape {
            Shape::Mesh(mesh) => mesh.texture_id != TextureId::default(),
            Shape::Rect(rect) => rect.brush.is_some(),
            _ => false,
        });
        pictures.any(|shape| {
            let rect = shape.visual_bounding_rect();
            rect.contains(at) && rect.height() < 100.0
        })
    };
    while !is_drawn(&harness) {
        harness.step();
    }
    assert_ne!(*harness.state().document().description(), taken);
    click(&mut harness, "Snapshot 1");
    assert!(is_shown(&harness, "Snapshot 1"));
    click(&mut harness, "Restore");
    assert_eq!(*harness.state().document().description(), taken);
    click(&mut harness, "Snapshot");
    assert!(looks.join("Snapshot 2.toml").exists());
    for _ in 0..2 {
        click(&mut harness, "Delete the snapshot");
        if let Some(look) = harness.query_by_label("Snapshot 1") {
            look.click();
            harness.run_steps(3);
        }
    }
    common::wait_until(&mut harness, "an empty folder", |_| !looks.exists());
}

#[test]
fn looks_are_compared_side_by_side_and_under_a_slider_and_deleted() {
    let mut harness = opened();
    click(&mut harness, "Snapshot");
    turn(&mut harness);
    common::key(&mut harness, Key::S);
    harness.run_steps(2);
    click(&mut harness, "Snapshot 1");
    click(&mut harness, "Side by side");
    assert!(is_shown(&harness, "Snapshot 1"));
    click(&mut harness, "Slider");
    let divider = "Divider between now and the snapshot";
    assert!(harness.query_by_label(divider).is_some());
    click(&mut harness, "Slider");
    assert!(harness.query_by_label(divider).is_none());
    click(&mut harness, "Delete the snapshot");
    assert!(harness.query_by_label("Snapshot 1").is_none());
    assert!(harness.query_by_label("Snapshot 2").is_some());
}
