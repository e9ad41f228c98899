//! Files that come from outside: good ones, and wrong ones, which are told of and change nothing.

use std::path::Path;
use std::sync::Arc;

use crate::common::{
    SMALL, click_on, description, viewer, viewer_with, wait_built, wait_for_text, wait_until,
};
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_image::{Display, Output, Picture};
use hairline_viewer::progressive::Backend;
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

pub fn drop_file(harness: &mut Harness<'static, Viewer>, path: &Path) {
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
    let read = hairline_document::Description::from_toml(&saved, &path).unwrap();
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
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
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
    let folder = tempfile::tempdir().unwrap();
    // Of one colour: it takes no time to blur.
    let map = Picture {
        size_px: [4, 2],
        rgb: vec![[1.0; 3]; 8],
    };
    let path = folder.path().join("sky.exr");
    let output = Output::check(&path).unwrap();
    output.write_picture(&map, &Display::default()).unwrap();
    are_added(&triangle(folder.path(), 2.0), &path);
}

#[test]
#[ignore = "long: cargo long"]
fn models_and_maps_of_others_are_added() {
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
    are_added(&model, &map);
}

fn are_added(model: &Path, map: &Path) {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    drop_file(&mut harness, model);
    // Two metres, in a scene of centimetres.
    wait_for_text(&mut harness, "Fit it to");
    harness.get_by_label_contains("Fit it to").click();
    wait_until(&mut harness, "the model", |viewer| {
        viewer.document().description().objects.len() == 2
    });
    drop_file(&mut harness, map);
    wait_until(&mut harness, "the map", |viewer| {
        viewer.document().description().environment.is_some()
    });
    wait_until(&mut harness, "the scene", |viewer| {
        let built = viewer.renderer().built();
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

/// A triangle `size_m` large as a model of one file.
fn triangle(folder: &Path, size_m: f64) -> std::path::PathBuf {
    let corner = |x: f32, z: f32| [x, 0.0, z].map(f32::to_le_bytes).concat();
    let size = size_m as f32;
    let buffer = [corner(0.0, 0.0), corner(size, 0.0), corner(0.0, size)].concat();
    std::fs::write(folder.join("it.bin"), buffer).unwrap();
    let model = format!(
        r#"{{
            "asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "buffers": [{{"uri": "it.bin", "byteLength": 36}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                "min": [0, 0, 0], "max": [{size_m}, 0, {size_m}]}}]
        }}"#
    );
    let path = folder.join("it.gltf");
    std::fs::write(&path, model).unwrap();
    path
}

/// The size that an added model has, after a button of the question was clicked.
fn added(answer: &'static str, size_m: f64) -> Option<Option<f64>> {
    let folder = tempfile::tempdir().unwrap();
    let model = triangle(folder.path(), size_m);
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness).objects.len();
    drop_file(&mut harness, &model);
    if !answer.is_empty() {
        wait_for_text(&mut harness, answer);
    }
    // Nothing is added before it is answered.
    assert!(answer.is_empty() || description(&harness).objects.len() == before);
    if answer.is_empty() {
        wait_until(&mut harness, "the model", |viewer| {
            viewer.document().description().objects.len() > before
        });
        assert!(
            harness
                .query_by_label("Fit the model to the scene?")
                .is_none()
        );
    } else {
        harness.get_by_label_contains(answer).click();
        harness.run_steps(3);
    }
    let description = description(&harness);
    let fit_m = (description.objects.len() > before)
        .then(|| description.objects.last().and_then(|it| it.fit_m));
    if fit_m.is_some() {
        crate::common::undo(&mut harness);
        assert_eq!(
            harness.state().document().description().objects.len(),
            before
        );
    }
    fit_m
}

#[test]
fn a_model_out_of_proportion_is_fitted_if_the_user_likes() {
    let fitted = added("Fit it to", 40.0).unwrap().unwrap();
    assert!((0.001..10.0).contains(&fitted), "{fitted}");
    assert_eq!(added("Keep its own size", 40.0), Some(None));
    assert_eq!(added("Cancel", 40.0), None);
    // One that suits the scene is not asked about.
    assert_eq!(added("", fitted), Some(None));
}

#[test]
fn a_models_axis_and_size_are_in_its_panel() {
    let folder = tempfile::tempdir().unwrap();
    let model = triangle(folder.path(), 0.05);
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    drop_file(&mut harness, &model);
    wait_until(&mut harness, "the model", |viewer| {
        viewer.document().description().objects.len() == 2
    });
    let object = |harness: &_| description(harness).objects[1].clone();
    harness
        .state_mut()
        .document_mut()
        .select(hairline_editor::Selection::Object(1));
    wait_built(&mut harness);
    harness.run_steps(3);
    let click = |harness: &mut Harness<'static, Viewer>, role, name| {
        harness.get_by_role_and_label(role, name).click();
        harness.run_steps(3);
    };
    click(&mut harness, Role::CheckBox, "Fit");
    assert!(object(&harness).fit_m.is_some());
    harness.get_by_role_and_label(Role::SpinButton, "Fitted size");
    click(&mut harness, Role::CheckBox, "Fit");
    assert_eq!(object(&harness).fit_m, None);
    click(&mut harness, Role::ComboBox, "Up");
    click_on(&mut harness, "z, as in CAD");
    assert_eq!(object(&harness).up, hairline_document::description::Up::Z);
}

/// Messages about the scene before mean nothing to the one that is opened.
#[test]
fn messages_about_a_scene_go_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.toml");
    std::fs::write(&path, SMALL).unwrap();
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    harness.key_press(egui::Key::L);
    harness.run_steps(2);
    let on_disk = crate::common::picture(&harness).center() + egui::vec2(40.0, 60.0);
    crate::common::click_at(&mut harness, on_disk);
    harness.run_steps(2);
    let told = harness.state().messages().concat();
    assert!(told.contains("Select a light first"), "{told:?}");
    drop_file(&mut harness, &folder.path().join("none.toml"));
    assert_eq!(harness.state().messages().len(), 2);
    drop_file(&mut harness, &path);
    assert_eq!(harness.state().document().path(), Some(path.as_path()));
    assert_eq!(harness.state().messages(), [""; 0]);
}
