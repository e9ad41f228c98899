//! Files that come from outside: good ones, and wrong ones, which are told of and change nothing.

use std::path::Path;
use std::sync::Arc;

use crate::common::{SMALL, click_on, description, viewer, viewer_with, wait_built, wait_until};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_viewer::engine::Backend;
use hairline_viewer::{Options, Viewer};

#[derive(Debug)]
struct Dropped(std::path::PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn drop_file(harness: &mut Harness<'static, Viewer>, path: &Path) {
    let file = Arc::new(Dropped(path.to_owned()));
    harness.input_mut().dropped_files.push(file);
    harness.run_steps(3);
}

/// Drops a wrong file and waits for the message.
fn is_refused(harness: &mut Harness<'static, Viewer>, path: &Path, says: &[&str]) {
    let before = description(harness);
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    drop_file(harness, path);
    wait_until(harness, "a message", |viewer| {
        viewer.messages().iter().any(|text| text.contains(&name))
    });
    let messages = harness.state().messages().join("\n");
    for part in says {
        assert!(messages.contains(part), "{part:?} is not in {messages:?}");
    }
    assert_eq!(*description(harness), *before, "{name}");
    assert!(harness.state().document().undo_label().is_none(), "{name}");
    click_on(harness, "Dismiss");
    assert!(harness.state().messages().is_empty());
}

#[test]
fn wrong_files_are_told_of_and_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let text = write("text.glb", b"this is no model");
    is_refused(&mut harness, &text, &["text.glb"]);
    let cut = write(
        "cut.hdr",
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 64 +X 128\n\x02\x02",
    );
    is_refused(&mut harness, &cut, &["cut.hdr"]);
    let wrong = write(
        "wrong.toml",
        b"[camera]\nposition_m = [0, 0, 1]\ntarget_m = [0, 0, 0]\nfow_y_deg = 3\n",
    );
    is_refused(
        &mut harness,
        &wrong,
        &["wrong.toml:4", "fow_y_deg", "fov_y_deg"],
    );
    let other = write("letter.docx", b"");
    is_refused(
        &mut harness,
        &other,
        &["letter.docx", ".toml", ".glb", ".hdr"],
    );
    is_refused(
        &mut harness,
        &folder.path().join("missing.gltf"),
        &["missing.gltf"],
    );
}

#[test]
fn a_good_scene_opens_and_unsaved_changes_are_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.toml");
    std::fs::write(&path, SMALL.replace("fov_y_deg = 30.0", "fov_y_deg = 21.0")).unwrap();
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let document = harness.state_mut().document_mut();
    document.edit("Exposure", |d| d.camera.exposure_ev = 2.0);
    drop_file(&mut harness, &path);
    assert_eq!(
        description(&harness).camera.exposure_ev,
        2.0,
        "nobody was asked"
    );
    click_on(&mut harness, "Cancel");
    assert_eq!(description(&harness).camera.exposure_ev, 2.0);
    drop_file(&mut harness, &path);
    click_on(&mut harness, "Discard the changes");
    assert_eq!(description(&harness).camera.fov_y_deg, 21.0);
    assert_eq!(harness.state().document().path(), Some(path.as_path()));
    assert!(!harness.state().document().is_modified());
}

#[test]
fn saving_asks_for_a_place_first_and_then_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept.toml");
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let document = harness.state_mut().document_mut();
    document.edit("Exposure", |d| d.camera.exposure_ev = 1.0);
    let shown = description(&harness);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::S);
    harness.run_steps(4);
    let field = harness.get_by_label("Path");
    field.focus();
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.run_steps(2);
    harness
        .get_by_label("Path")
        .type_text(path.to_str().unwrap());
    harness.run_steps(2);
    click_on(&mut harness, "OK");
    assert!(!harness.state().document().is_modified());
    let saved = std::fs::read_to_string(&path).unwrap();
    let read = hairline_scene::Description::from_toml(&saved, &path).unwrap();
    assert_eq!(read, *shown);
}

#[test]
fn what_a_crash_left_is_offered_and_recovered() {
    let folder = tempfile::tempdir().unwrap();
    let options = || Options {
        scene: None,
        built_in: SMALL,
        backend: Backend::Cpu,
        state_dir: Some(folder.path().to_owned()),
        native_dialogs: false,
    };
    let mut harness = viewer_with(options());
    let document = harness.state_mut().document_mut();
    document.edit("Exposure", |d| d.camera.exposure_ev = 3.0);
    let lost = description(&harness);
    let kept = || {
        let entries = std::fs::read_dir(folder.path().join("autosave")).unwrap();
        entries
            .flatten()
            .any(|entry| entry.path().extension().is_some_and(|e| e == "toml"))
    };
    wait_until(&mut harness, "an autosave", |_| kept());
    // Dropped without being closed, as by a crash.
    drop(harness);
    assert!(kept());
    let mut harness = viewer_with(options());
    harness.run_steps(3);
    click_on(&mut harness, "Recover");
    assert_eq!(*description(&harness), *lost);
    assert!(harness.state().document().is_modified());
}

#[test]
fn models_and_maps_are_added() {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    let find = |ending: &str| {
        let entries = std::fs::read_dir(&model).ok()?;
        let mut paths = entries.flatten().map(|entry| entry.path());
        paths.find(|path| path.extension().is_some_and(|e| e == ending))
    };
    let (Some(model), Some(map)) = (find("glb"), find("hdr")) else {
        hairline_gpu::headless::skip("no model and no map beside the project");
        return;
    };
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    drop_file(&mut harness, &model);
    wait_until(&mut harness, "the model", |viewer| {
        viewer.document().description().objects.len() == 2
    });
    drop_file(&mut harness, &map);
    wait_until(&mut harness, "the map", |viewer| {
        viewer.document().description().environment.is_some()
    });
    wait_until(&mut harness, "the scene", |viewer| {
        let built = viewer.engine().built();
        built.is_some_and(|built| {
            built.scene.objects.len() == 2 && built.scene.environment.is_some()
        })
    });
    assert!(harness.state().messages().is_empty());
}

#[test]
fn a_key_without_effect_is_told_of() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("old.toml");
    let text = format!("render.gather = \"tally\"\n{SMALL}");
    std::fs::write(&path, text).unwrap();
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    drop_file(&mut harness, &path);
    let messages = harness.state().messages().join("\n");
    assert!(messages.contains("render.gather"), "{messages:?}");
}
