//! Every control of every panel: named, live, and undone in one step.

use std::sync::Arc;

use crate::common::{
    self, BUILT_IN, SMALL, click_on, description, viewer, viewer_with, wait_built,
};
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use hairline_document::Description;
use hairline_document::description::Amount;
use hairline_document::description::{Environment, Layer, Map, Pattern};
use hairline_editor::Selection;
use hairline_editor::presets::{LayerPreset, MaterialPreset};
use hairline_image::{Display, Output, Picture};
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Options, Viewer};

/// Names of the controls of a kind in the panel on the right, but for those that are grey.
pub fn controls(harness: &Harness<'static, Viewer>, role: Role) -> Vec<String> {
    let picture = common::picture(harness);
    let mut names: Vec<String> = harness
        .query_all_by_role(role)
        .filter(|node| node.rect().min.x >= picture.max.x && !node.accesskit_node().is_disabled())
        .map(|node| {
            let name = node.accesskit_node().label();
            name.unwrap_or_else(|| panic!("a control without a name at {}", node.rect()))
        })
        .collect();
    names.dedup();
    names
}

pub fn select(harness: &mut Harness<'static, Viewer>, selection: Selection) {
    harness.state_mut().document_mut().select(selection);
    harness.run_steps(3);
}

/// Changes this number of the open panel by its box, and sees the scene change, stay good, and come back by one undo.
pub fn is_live(harness: &mut Harness<'static, Viewer>, name: &str) {
    let before = description(harness);
    let node = harness.get_by_role_and_label(Role::SpinButton, name);
    let value = node.accesskit_node().numeric_value().expect("a number");
    let wanted = match value {
        0.0 => 0.5,
        // No smaller one is allowed.
        other if name == "Refractive index" => other + 0.2,
        // Whole numbers are rounded.
        1.0 if name == "Seed" => 2.0,
        other => 0.75 * other,
    };
    node.set_value_accesskit(wanted);
    harness.run_steps(3);
    let after = description(harness);
    assert!(
        *after != *before,
        "{name}: {value} -> {wanted} changed nothing"
    );
    after
        .check()
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    harness.state_mut().document_mut().undo();
    harness.run_steps(2);
    let undone = description(harness);
    assert!(
        *undone == *before,
        "{name}: one undo is not enough, or too much"
    );
}

/// Checks each number.
fn every_number_is_live(harness: &mut Harness<'static, Viewer>) -> usize {
    let names = controls(harness, Role::SpinButton);
    for name in &names {
        is_live(harness, name);
    }
    names.len()
}

fn edit(harness: &mut Harness<'static, Viewer>, change: impl FnOnce(&mut Description)) {
    harness
        .state_mut()
        .document_mut()
        .edit("by the test", change);
    harness.run_steps(3);
}

#[test]
fn the_camera_and_the_picture() {
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    click_on(&mut harness, "Camera");
    // Exposure, field of view, focal length, film width, three vectors, filter, size.
    assert_eq!(every_number_is_live(&mut harness), 4 + 9 + 1 + 2);
    let before = description(&harness);
    click_on(&mut harness, "Top");
    // The view is another one, and the camera stands where it stood.
    assert_ne!(
        harness.state().camera().position_m,
        before.camera.position_m
    );
    assert_eq!(*description(&harness), *before);
}

#[test]
fn an_object_of_every_shape() {
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    for i in 0..description(&harness).objects.len() {
        select(&mut harness, Selection::Object(i));
        assert!(every_number_is_live(&mut harness) >= 8, "object {i}");
    }
}

#[test]
fn a_layer_of_every_pattern() {
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    for preset in LayerPreset::ALL {
        edit(&mut harness, |d| d.scratches[0] = preset.layer("pan", 0.2));
        select(&mut harness, Selection::Layer(0));
        let count = every_number_is_live(&mut harness);
        assert!(count >= 8, "{}: {count} numbers", preset.name());
    }
    edit(&mut harness, |d| {
        d.scratches[0] = hairline_editor::presets::drawn_layer("pan", 0.01);
    });
    select(&mut harness, Selection::Layer(0));
    assert_eq!(every_number_is_live(&mut harness), 9);
}

#[test]
fn a_material_of_every_kind_and_lights() {
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    for preset in MaterialPreset::all() {
        edit(&mut harness, |d| {
            d.materials[0] = hairline_document::description::Material {
                name: d.materials[0].name.clone(),
                ..preset.material()
            };
        });
        select(&mut harness, Selection::Material(0));
        assert!(every_number_is_live(&mut harness) >= 2, "{}", preset.name());
    }
    // Brushed ones have a degree and a direction more.
    select(&mut harness, Selection::Material(0));
    let plain = controls(&harness, Role::SpinButton).len();
    harness
        .get_by_role_and_label(Role::CheckBox, "Brushed")
        .click();
    harness.run_steps(3);
    assert_eq!(every_number_is_live(&mut harness), plain + 2);
    // A sphere: radiance, stops, centre, radius.
    select(&mut harness, Selection::Light(0));
    assert_eq!(every_number_is_live(&mut harness), 2 + 3 + 1);
    // A polygon's corners move in its plane: along some axes not at all. Its radiance and stops are numbers like others.
    select(&mut harness, Selection::Light(1));
    assert_eq!(controls(&harness, Role::SpinButton).len(), 2 + 4 * 3);
}

#[test]
fn the_studio_and_the_ground() {
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    edit(&mut harness, |d| {
        d.studio.hidden = false;
        d.ground.get_or_insert_default().height_m = Some(-0.01);
    });
    for selection in [Selection::Studio, Selection::Ground] {
        select(&mut harness, selection);
        assert_eq!(every_number_is_live(&mut harness), 2, "{selection:?}");
    }
}

#[test]
fn the_environment() {
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    edit(&mut harness, |d| {
        d.environment = Some(Environment {
            map: Map::File("there is none.hdr".into()),
            rotation_deg: 10.0,
            intensity: 1.0,
            visible: true,
        });
    });
    select(&mut harness, Selection::Environment);
    assert_eq!(every_number_is_live(&mut harness), 2);
    // A missing file is reported, and the picture stays.
    common::wait_until(&mut harness, "the scene is looked at", |viewer| {
        viewer.renderer().has_failed()
    });
    harness.run_steps(2);
    harness.get_by_label("The environment map there is none.hdr is not there.");
    assert!(harness.state().renderer().built().is_some());
    click_on(&mut harness, "Remove the map");
    assert_eq!(description(&harness).environment, None);
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("is not there").is_none());
}

/// A scene that is corrected before its builder has found its error: nothing is told of the error.
#[test]
fn errors_of_scenes_that_are_gone_are_not_told() {
    let mut harness = viewer(common::SMALL);
    wait_built(&mut harness);
    for i in 0..100 {
        for file in [Some(format!("there is none {i}.hdr")), None] {
            let document = harness.state_mut().document_mut();
            document.edit("by the test", |d| {
                d.environment = file.map(|file| Environment {
                    map: Map::File(file.into()),
                    rotation_deg: 0.0,
                    intensity: 1.0,
                    visible: true,
                });
            });
            harness.step();
        }
        common::wait_until(&mut harness, "the scene without", |viewer| {
            let built = viewer.renderer().built();
            built.is_some_and(|built| built.revision == viewer.document().revision())
        });
        harness.run_steps(2);
        assert!(harness.state().messages().is_empty(), "{i}");
    }
}

/// The panel mentions the sun that was taken out of a map.
#[test]
fn a_sun_in_the_environment() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sunny.exr");
    let mut map = Picture {
        size_px: [256, 128],
        rgb: vec![[0.2, 0.4, 0.8]; 256 * 128],
    };
    // Two texels, of 1.4 degrees and less: together as large as a disc of 2.05.
    map.rgb[40 * 256 + 100..][..2].fill([1e4; 3]);
    let output = Output::check(&file).unwrap();
    output.write_picture(&map, &Display::default()).unwrap();
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    let lights = harness.state().document().description().lights.len();
    edit(&mut harness, |d| {
        d.environment = Some(Environment {
            map: Map::File(file),
            rotation_deg: 0.0,
            intensity: 1.0,
            visible: true,
        });
    });
    common::wait_until(&mut harness, "the map", |viewer| {
        let built = viewer.renderer().built();
        built.is_some_and(|built| built.scene.environment.is_some())
    });
    select(&mut harness, Selection::Environment);
    harness.get_by_label("One sun in it, 2.05° across");
    // The sun belongs to the map, so it is no light that could be moved.
    assert_eq!(description(&harness).lights.len(), lights);
    assert_eq!(every_number_is_live(&mut harness), 2);
}

#[test]
fn choices_and_switches_of_a_layer() {
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    select(&mut harness, Selection::Layer(1));
    for (name, is_on) in [
        (
            "Hidden",
            (|d: &Description| d.scratches[1].hidden) as fn(&Description) -> bool,
        ),
        ("Solo", |d| d.scratches[1].solo),
    ] {
        harness.get_by_role_and_label(Role::CheckBox, name).click();
        harness.run_steps(3);
        assert!(is_on(&description(&harness)), "{name}");
        harness.state_mut().document_mut().undo();
        harness.run_steps(2);
        assert!(!is_on(&description(&harness)), "{name}");
    }
    choose(&mut harness, "Pattern", "radial");
    let radial = description(&harness);
    let Layer::Laid(laid) = &radial.scratches[1].layer else {
        panic!("{:?}", radial.scratches[1]);
    };
    assert!(matches!(laid.pattern, Pattern::Radial(_)));
    choose(&mut harness, "How many", "per area");
    let dense = description(&harness);
    let Layer::Laid(laid) = &dense.scratches[1].layer else {
        panic!("{:?}", dense.scratches[1]);
    };
    assert!(matches!(laid.amount, Amount::DensityPerM2(_)));
}

pub fn choose(harness: &mut Harness<'static, Viewer>, name: &str, option: &str) {
    harness.get_by_role_and_label(Role::ComboBox, name).click();
    harness.run_steps(3);
    harness.get_by_label(option).click();
    harness.run_steps(3);
}

#[test]
fn the_outliner_hides_adds_and_solos() {
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    for (name, is_so) in [
        (
            "Show layer 1",
            (|d: &Description| d.scratches[0].hidden) as fn(&Description) -> bool,
        ),
        ("Solo layer 2", |d| d.scratches[1].solo),
        ("Show light 1", |d| d.lights[0].hidden),
    ] {
        click_on(&mut harness, name);
        assert!(is_so(&description(&harness)), "{name}");
        harness.state_mut().document_mut().undo();
        harness.run_steps(2);
        assert!(!is_so(&description(&harness)), "{name}");
    }
    let before = description(&harness);
    click_on(&mut harness, "Add to lights");
    click_on(&mut harness, "Softbox");
    assert_eq!(description(&harness).lights.len(), before.lights.len() + 1);
    click_on(&mut harness, "Add to materials");
    click_on(&mut harness, "Gold");
    assert_eq!(
        description(&harness).materials.len(),
        before.materials.len() + 1
    );
    click_on(&mut harness, "Add to objects");
    click_on(&mut harness, "Sphere");
    assert_eq!(
        description(&harness).objects.len(),
        before.objects.len() + 1
    );
    description(&harness).check_references().unwrap();
    while harness.state_mut().document_mut().undo().is_some() {}
    assert_eq!(*description(&harness), *before);
}

#[test]
fn names_are_typed_and_followed() {
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    select(&mut harness, Selection::Object(0));
    let field = harness.get_by_role_and_label(Role::TextInput, "Name");
    field.focus();
    harness.run_steps(2);
    harness
        .get_by_role_and_label(Role::TextInput, "Name")
        .type_text("ny");
    harness.run_steps(2);
    // Half a name is no name.
    assert_eq!(description(&harness).objects[0].name, "pan");
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
    let after = description(&harness);
    assert_ne!(after.objects[0].name, "pan");
    // Layers follow their object's new name.
    assert_eq!(after.scratches[0].object, after.objects[0].name);
    after.check_references().unwrap();
}

/// Undo all and redo all by the interface's own commands, after edits by its own widgets; then through the file.
#[test]
fn undo_all_redo_all_save_and_open() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = viewer(BUILT_IN);
    wait_built(&mut harness);
    let first = description(&harness);
    select(&mut harness, Selection::Layer(0));
    for (name, value) in [("Width", 3.25), ("Depth", 312.0), ("Count", 50.0)] {
        let node = harness.get_by_role_and_label(Role::SpinButton, name);
        node.set_value_accesskit(value);
        harness.run_steps(3);
    }
    click_on(&mut harness, "Duplicate");
    let last = description(&harness);
    for _ in 0..4 {
        click_on(&mut harness, "Undo");
    }
    assert_eq!(*description(&harness), *first);
    for _ in 0..4 {
        click_on(&mut harness, "Redo");
    }
    assert_eq!(*description(&harness), *last);

    let path = folder.path().join("saved.toml");
    harness.state_mut().document_mut().save_as(&path).unwrap();
    let saved = std::fs::read_to_string(&path).unwrap();
    let read = Description::from_toml(&saved, &path).unwrap();
    assert_eq!(read, *last);
    assert!(Arc::strong_count(&last) > 0);
}

/// Neither before it is built nor after: its box is measured anew by whoever asks.
#[test]
fn wear_that_was_laid_for_an_opened_model_is_its_grade() {
    let folder = tempfile::tempdir().unwrap();
    crate::picking::two_squares(folder.path());
    let path = folder.path().join("a.gltf");
    let mut harness = viewer_with(Options {
        scene: Some(path),
        built_in: SMALL,
        backend: Backend::Cpu,
        state_dir: None,
        native_dialogs: false,
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
    });
    let document = harness.state_mut().document_mut();
    // Its surroundings take seconds to blur, for each size of the model anew.
    document.edit("by the test", |d| d.studio.hidden = true);
    document.select(Selection::Object(0));
    let by_hand = |harness: &Harness<'static, Viewer>| {
        harness.query_by_label_contains("changed by hand").is_some()
    };
    harness.step();
    assert!(!by_hand(&harness), "before it is built");
    wait_built(&mut harness);
    assert!(!by_hand(&harness), "once it is built");
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| d.objects[0].scale = [2.0; 3]);
    wait_built(&mut harness);
    assert!(!by_hand(&harness), "of another size");
}

/// Whatever is selected: else the picture would be painted anew.
#[test]
fn the_picture_keeps_its_width() {
    let mut harness = viewer(common::FULL);
    wait_built(&mut harness);
    let d = description(&harness);
    let width = |harness: &Harness<'static, Viewer>| {
        let view = harness.state().view();
        view.map(|view| view.size_px)
    };
    let before = width(&harness);
    let lights = (0..d.lights.len()).map(Selection::Light);
    let objects = (0..d.objects.len()).map(Selection::Object);
    let layers = (0..d.scratches.len()).map(Selection::Layer);
    let materials = (0..d.materials.len()).map(Selection::Material);
    let others = [
        Selection::Camera,
        Selection::Environment,
        Selection::Studio,
        Selection::Ground,
        Selection::None,
    ];
    for selection in lights
        .chain(objects)
        .chain(layers)
        .chain(materials)
        .chain(others)
    {
        harness.state_mut().document_mut().select(selection);
        for _ in 0..4 {
            harness.step();
            assert_eq!(width(&harness), before, "{selection:?}");
        }
    }
}
