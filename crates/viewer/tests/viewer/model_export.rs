//! The scene as one glTF file, which opens as the same scene.

use std::path::Path;

use crate::common::{self, SMALL, click_on, description, viewer, wait_built, wait_until};
use egui::{Event, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_viewer::Viewer;

fn export_to(harness: &mut Harness<'static, Viewer>, path: &Path) {
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::E);
    harness.run_steps(4);
    harness.get_by_label("Path").focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(path.display().to_string()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
}

/// Exports a scene to a file that is not there.
fn export_new(path: &Path) {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    export_to(&mut harness, path);
    wait_until(&mut harness, "the file", |_| path.exists());
}

#[test]
fn a_model_is_exported_and_opens_as_the_same_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("worn.glb");
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    // The ending is added.
    export_to(&mut harness, &folder.path().join("worn"));
    wait_until(&mut harness, "the file", |_| path.exists());
    let before = description(&harness);
    let opened = common::viewer_of_file(&path);
    assert_eq!(*description(&opened), *before);

    // A file that is there is replaced after a question alone.
    std::fs::write(&path, "mine").unwrap();
    export_to(&mut harness, &path);
    harness.run_steps(3);
    assert_eq!(std::fs::read(&path).unwrap(), b"mine");
    click_on(&mut harness, "Replace the file");
    wait_until(&mut harness, "the file", |_| {
        std::fs::read(&path).unwrap().starts_with(b"glTF")
    });
}

#[test]
fn a_file_that_the_scene_is_made_of_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("worn.glb");
    export_new(&path);
    let text = "[camera]\nposition_m = [0, 0, 0.4]\ntarget_m = [0, 0, 0]\n\
        [[object]]\nname = \"it\"\nmesh = \"worn.glb\"\n";
    let scene = folder.path().join("a.toml");
    std::fs::write(&scene, text).unwrap();
    let before = std::fs::read(&path).unwrap();
    let mut harness = common::viewer_of_any_file(&scene);
    harness.run_steps(3);
    export_to(&mut harness, &path);
    harness.run_steps(3);
    harness.get_by_label_contains("the scene is made of it");
    assert!(std::fs::read(&path).unwrap() == before);
}

#[test]
fn the_ending_makes_a_model_for_phones() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.usdz");
    export_new(&path);
    assert!(std::fs::read(&path).unwrap().starts_with(b"PK"));
}
