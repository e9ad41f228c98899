//! Changes and choices in the panels for a model's file.

use crate::common::{self, click_on, description, undo, wait_until};
use crate::picking::{LAMP, two_squares};
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_document::description::Override;
use hairline_editor::Selection;
use hairline_viewer::Viewer;

/// A scene of two squares, and a selection in it.
fn opened(selection: Selection) -> (Harness<'static, Viewer>, tempfile::TempDir) {
    let dir = tempfile::tempdir().unwrap();
    two_squares(dir.path());
    let scene = dir.path().join("a.toml");
    let text = "[camera]\nposition_m = [0, 0, 0.4]\ntarget_m = [0, 0, 0]\n\
        [[object]]\nname = \"it\"\nmesh = \"a.gltf\"\n";
    std::fs::write(&scene, format!("{text}{LAMP}")).unwrap();
    let mut harness = common::viewer_of_file(&scene);
    harness.state_mut().document_mut().select(selection);
    harness.run_steps(3);
    (harness, dir)
}

/// Waits until a material of the built scene has this roughness, and the other one its own.
fn wait_for_roughness(harness: &mut Harness<'static, Viewer>, gold: f64) {
    wait_until(harness, "the roughness of gold", |viewer| {
        viewer.renderer().built().is_some_and(|built| {
            let of = |name: &str| {
                let mut materials = built.scene.materials.iter();
                materials.find(|it| it.name == name).map(|it| it.roughness)
            };
            of("gold") == Some(gold) && of("steel") == Some(1.0)
        })
    });
}

#[test]
fn a_material_of_a_file_gets_another_roughness_and_its_own_again() {
    let (mut harness, _dir) = opened(Selection::Object(0));
    click_on(&mut harness, "gold");
    harness.run_steps(30);
    let set = |harness: &mut Harness<'static, Viewer>| {
        let number = harness.get_by_role_and_label(Role::SpinButton, "Roughness");
        number.set_value_accesskit(0.25);
        harness.run_steps(3);
    };
    set(&mut harness);
    let expected = Override {
        roughness: Some(0.25),
        ..Override::new("gold")
    };
    assert_eq!(description(&harness).objects[0].overrides, [expected]);
    wait_for_roughness(&mut harness, 0.25);
    undo(&mut harness);
    assert_eq!(description(&harness).objects[0].overrides, []);
    wait_for_roughness(&mut harness, 1.0);
    set(&mut harness);
    wait_for_roughness(&mut harness, 0.25);
    click_on(&mut harness, "As in the file");
    assert_eq!(description(&harness).objects[0].overrides, []);
}

#[test]
fn the_scene_is_seen_by_a_camera_of_its_models_file() {
    let (mut harness, _dir) = opened(Selection::Camera);
    let before = description(&harness).camera.clone();
    click_on(&mut harness, "front");
    let camera = description(&harness).camera.clone();
    assert_eq!(camera.position_m, [0.0, 0.0, 0.5]);
    assert!((camera.fov_y_deg - 0.5_f64.to_degrees()).abs() < 1e-5);
    undo(&mut harness);
    assert_eq!(description(&harness).camera, before);
}

/// Contents of a model that are not in the picture are reported when the model is opened, and once.
#[test]
fn what_of_a_model_is_left_out_is_told() {
    let (plain, dir) = opened(Selection::None);
    assert!(plain.state().messages().is_empty());
    let path = dir.path().join("a.gltf");
    let text = std::fs::read_to_string(&path).unwrap();
    let richer = text
        .replace(
            r#""name":"gold""#,
            r#""name":"gold","extensions":{"KHR_materials_sheen":{}}"#,
        )
        .replace(
            r#""scenes""#,
            r#""extensionsUsed":["KHR_materials_sheen"],"scenes""#,
        );
    std::fs::write(&path, richer).unwrap();
    let mut harness = common::viewer_of_file(&dir.path().join("a.toml"));
    let expected = "a.gltf: KHR_materials_sheen (1) left out; cloth misses its sheen";
    wait_until(&mut harness, "the note", |viewer| {
        viewer
            .messages()
            .iter()
            .any(|text| text.contains("left out"))
    });
    assert_eq!(harness.state().messages(), [expected]);
    harness.get_by_label(expected);
}
