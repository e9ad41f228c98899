//! Files that another program writes while they are open here.

use std::path::Path;

use crate::common::{SMALL, click_on, description, viewer_of_file, wait_for_text, wait_until};
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use hairline_viewer::Viewer;

fn open(path: &Path) -> Harness<'static, Viewer> {
    let harness = viewer_of_file(path);
    // The files' first look.
    std::thread::sleep(std::time::Duration::from_millis(300));
    harness
}

/// Replaces a file as many editors do: another file takes the name.
fn replace(path: &Path, text: &str) {
    let other = path.with_extension("new");
    std::fs::write(&other, text).unwrap();
    std::fs::rename(&other, path).unwrap();
}

fn fov_y_deg(viewer: &Viewer) -> f64 {
    viewer.document().description().camera.fov_y_deg
}

fn expose(harness: &mut Harness<'static, Viewer>) {
    let document = harness.state_mut().document_mut();
    document.edit("Exposure", |d| d.camera.exposure_ev += 1.0);
    harness.run_steps(2);
}

fn save(harness: &mut Harness<'static, Viewer>) {
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(3);
}

#[test]
fn a_scene_that_another_program_wrote_is_loaded_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, SMALL).unwrap();
    let mut harness = open(&path);
    replace(
        &path,
        &SMALL.replace("fov_y_deg = 30.0", "fov_y_deg = 21.0"),
    );
    wait_until(&mut harness, "the other scene", |v| fov_y_deg(v) == 21.0);
    assert!(!harness.state().document().is_modified());
    assert!(harness.state().messages().join(" ").contains("a.toml"));
    // A mistake in the file is reported, and the scene stays.
    replace(&path, &SMALL.replace("fov_y_deg = 30.0", "fow_y_deg = 1.0"));
    wait_until(&mut harness, "a message", |viewer| {
        viewer
            .messages()
            .iter()
            .any(|text| text.contains("fow_y_deg"))
    });
    assert_eq!(fov_y_deg(harness.state()), 21.0);
    // And put right.
    replace(&path, SMALL);
    wait_until(&mut harness, "the first scene", |v| fov_y_deg(v) == 30.0);
    assert!(!harness.state().messages().join(" ").contains("fow_y_deg"));
}

#[test]
fn unsaved_changes_are_asked_about_and_kept_or_given_to_undo() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, SMALL).unwrap();
    let mut harness = open(&path);
    expose(&mut harness);
    let mine = description(&harness);
    let theirs = SMALL.replace("fov_y_deg = 30.0", "fov_y_deg = 21.0");
    replace(&path, &theirs);
    wait_for_text(&mut harness, "Keep the changes here");
    assert_eq!(*description(&harness), *mine);
    click_on(&mut harness, "Keep the changes here");
    // Chosen is chosen.
    save(&mut harness);
    assert!(!harness.state().document().is_modified());
    assert!(
        std::fs::read_to_string(&path)
            .unwrap()
            .contains("fov_y_deg = 30.0")
    );

    expose(&mut harness);
    let mine = description(&harness);
    replace(&path, &theirs);
    wait_for_text(&mut harness, "Load the file");
    click_on(&mut harness, "Load the file");
    assert_eq!(fov_y_deg(harness.state()), 21.0);
    crate::common::undo(&mut harness);
    assert_eq!(*description(&harness), *mine);
}

/// Saving also asks before the watch has seen the change: the text itself is compared.
#[test]
fn saving_over_what_another_program_wrote_asks_first() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, SMALL).unwrap();
    let mut harness = open(&path);
    expose(&mut harness);
    let theirs = SMALL.replace("fov_y_deg = 30.0", "fov_y_deg = 21.0");
    std::fs::write(&path, &theirs).unwrap();
    save(&mut harness);
    assert_eq!(
        std::fs::read_to_string(&path).unwrap(),
        theirs,
        "overwritten"
    );
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), theirs, "by a key");
    click_on(&mut harness, "Replace the file");
    assert!(!harness.state().document().is_modified());
    assert!(
        std::fs::read_to_string(&path)
            .unwrap()
            .contains("fov_y_deg = 30.0")
    );
}

#[test]
fn reload_and_revert_are_in_the_menu() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, SMALL).unwrap();
    let mut harness = open(&path);
    let saved = description(&harness);
    expose(&mut harness);
    click_on(&mut harness, "File");
    click_on(&mut harness, "Revert to what was saved");
    assert_eq!(*description(&harness), *saved);
    assert!(!harness.state().document().is_modified());
    expose(&mut harness);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::R);
    harness.run_steps(3);
    click_on(&mut harness, "Load the file");
    assert_eq!(*description(&harness), *saved);
}

/// A model or a map: the scene is built anew from it.
#[test]
fn what_the_scene_names_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    let csv = folder.path().join("list.csv");
    let head = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n";
    let row = "0,0,0,0.02,0,0,3,200\n";
    std::fs::write(&csv, format!("{head}{row}")).unwrap();
    let listed = "\n[[scratches]]\nobject = \"disk\"\npattern = \"file\"\nfile = \"list.csv\"\n";
    std::fs::write(&path, format!("{SMALL}{listed}")).unwrap();
    let mut harness = open(&path);
    let count = |viewer: &Viewer| {
        viewer
            .renderer()
            .built()
            .map_or(0, |b| b.scratch_counts().0)
    };
    let before = count(harness.state());
    assert!(before > 0, "{:?}", harness.state().messages());
    replace(&csv, &format!("{head}{row}0,0.01,0,0.02,0.01,0,3,200\n"));
    wait_until(&mut harness, "another scratch", |v| count(v) == before + 1);
    assert!(!harness.state().document().is_modified());
}

/// A buffer beside a model: neither the scene nor the model names anything else than before.
#[test]
fn what_a_model_names_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    let buffer = folder.path().join("it.bin");
    let corner = |far: f32| {
        let points = [[0.0, 0.0, 0.0], [far, 0.0, 0.0], [0.0, 0.0, far]];
        let values = points.as_flattened().iter();
        values.flat_map(|c| c.to_le_bytes()).collect::<Vec<u8>>()
    };
    std::fs::write(&buffer, corner(0.01)).unwrap();
    let model = r#"{
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"uri": "it.bin", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 1]}]
    }"#;
    std::fs::write(folder.path().join("it.gltf"), model).unwrap();
    // So many scratches on it that a note's time would be over before all are laid: passes are a quarter of a second each.
    let object = r#"
[[object]]
name = "it"
mesh = "it.gltf"

[[scratches]]
name = "dense"
object = "it"
pattern = "random"
count = 100000
seed = 2
length_m = 0.001
width_um = 3.0
depth_nm = 200.0
"#;
    std::fs::write(&path, format!("{SMALL}{object}")).unwrap();
    let mut harness = open(&path);
    let extent_m = |viewer: &Viewer| {
        let built = viewer.renderer().built()?;
        let points = &built.scene.objects.get(1)?.mesh.positions_m;
        Some(points.iter().fold(0.0_f32, |most, p| most.max(p.x)))
    };
    assert_eq!(
        extent_m(harness.state()),
        Some(0.01),
        "{:?}",
        harness.state().messages()
    );
    std::fs::write(&buffer, corner(0.02)).unwrap();
    wait_until(&mut harness, "another triangle", |v| {
        extent_m(v) == Some(0.02)
    });
    assert!(harness.state().messages().join(" ").contains("it.bin"));
}
