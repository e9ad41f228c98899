//! Looks of the scene: kept, taken by a click and by a key, renamed, changed and deleted, each as one step of undo.

use crate::common::{self, SMALL, click_on, description, undo};
use egui::accesskit::Role;
use egui::{Key, Modifiers, Shape, TextureId};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_document::Description;
use hairline_editor::Selection;
use hairline_viewer::Viewer;

fn keep(harness: &mut Harness<'static, Viewer>) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::L);
    harness.run_steps(3);
}

fn edit(harness: &mut Harness<'static, Viewer>, change: impl FnOnce(&mut Description)) {
    harness.state_mut().document_mut().edit("Change", change);
    harness.run_steps(2);
}

#[test]
fn a_look_is_kept_and_taken_as_one_step_each() {
    let mut harness = common::viewer(SMALL);
    common::wait_built(&mut harness);
    let before = description(&harness);
    keep(&mut harness);
    assert_eq!(description(&harness).looks[0].name, "Look 1");
    edit(&mut harness, |d| {
        d.camera.exposure_ev += 1.0;
        d.lights.remove(0);
    });
    keep(&mut harness);
    let changed = description(&harness);
    click_on(&mut harness, "Take Look 1");
    let taken = description(&harness);
    assert_eq!(
        (&taken.camera, &taken.lights),
        (&before.camera, &before.lights)
    );
    assert_eq!(taken.objects, before.objects);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::PageDown);
    harness.run_steps(3);
    assert_eq!(*description(&harness), *changed);
    undo(&mut harness);
    undo(&mut harness);
    assert_eq!(*description(&harness), *changed);
    for _ in 0..3 {
        undo(&mut harness);
    }
    assert_eq!(*description(&harness), *before);
    assert!(harness.query_by_label("Take Look 1").is_none());
}

/// Whichever was taken before, a look stays what it was, and what no look had is kept as one more.
#[test]
fn no_light_is_lost_by_a_look_that_is_taken() {
    let looks = "[[look]]\nname = \"a\"\nstudio = { rotation_deg = 40 }\n\
                 [[look]]\nname = \"b\"\nexposure_ev = 2\n";
    let mut harness = common::viewer(format!("{SMALL}\n{looks}").leak());
    common::wait_built(&mut harness);
    let before = description(&harness);
    assert!(!before.lights.is_empty());
    click_on(&mut harness, "Take a");
    assert!(description(&harness).lights.is_empty());
    click_on(&mut harness, "Take b");
    let taken = description(&harness);
    assert_eq!(taken.lights, before.lights);
    assert_eq!(taken.studio, before.studio);
    assert_eq!(taken.camera.exposure_ev, 2.0);
    let names: Vec<_> = taken.looks.iter().map(|look| &*look.name).collect();
    assert_eq!(names, ["a", "b", "Scene"]);
    click_on(&mut harness, "Take Scene");
    let scene = description(&harness);
    assert_eq!(
        (&scene.camera, &scene.lights),
        (&before.camera, &before.lights)
    );
    for _ in 0..3 {
        undo(&mut harness);
    }
    assert_eq!(*description(&harness), *before);
}

#[test]
fn a_look_is_renamed_set_and_deleted_in_its_panel() {
    let mut harness = common::viewer(SMALL);
    common::wait_built(&mut harness);
    keep(&mut harness);
    common::key(&mut harness, Key::F2);
    harness.event(egui::Event::Text("dark".to_owned()));
    common::key(&mut harness, Key::Enter);
    harness.run_steps(2);
    assert_eq!(description(&harness).looks[0].name, "dark");
    click_on(&mut harness, "Camera of the look");
    assert!(description(&harness).looks[0].camera.is_none());
    undo(&mut harness);
    edit(&mut harness, |d| d.camera.exposure_ev = 2.0);
    click_on(&mut harness, "Set it to the scene of now");
    let set = description(&harness).looks[0].clone();
    assert_eq!((&*set.name, set.camera.unwrap().exposure_ev), ("dark", 2.0));
    assert_eq!(harness.state().document().selection(), Selection::Look(0));
    common::key(&mut harness, Key::Delete);
    assert!(description(&harness).looks.is_empty());
    undo(&mut harness);
    assert_eq!(description(&harness).looks[0].name, "dark");
}

#[test]
fn the_strip_has_a_picture_of_each_look() {
    let looks = "[[look]]\nname = \"a\"\n[[look]]\nname = \"b\"\nexposure_ev = 2\n";
    let mut harness = common::viewer(format!("{SMALL}\n{looks}").leak());
    let is_drawn = |harness: &Harness<'static, Viewer>, name: &str| {
        let label = format!("Take {name}");
        let Some(button) = harness.query_by_role_and_label(Role::Button, &label) else {
            return false;
        };
        let at = button.rect().center();
        let mut shapes = harness.output().shapes.iter().map(|clipped| &clipped.shape);
        shapes.any(|shape| {
            let rect = shape.visual_bounding_rect();
            let is_picture = match shape {
                Shape::Mesh(mesh) => mesh.texture_id != TextureId::default(),
                Shape::Rect(rect) => rect.brush.is_some(),
                _ => false,
            };
            is_picture && rect.contains(at) && rect.height() < 100.0
        })
    };
    while !["a", "b"].iter().all(|name| is_drawn(&harness, name)) {
        harness.step();
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
}
