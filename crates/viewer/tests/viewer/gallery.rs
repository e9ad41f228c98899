//! Presets with their pictures, grades of wear, and maps in the box.

use crate::common::{self, SMALL, click_on, description, viewer, viewer_with, wait_built};
use egui::accesskit::{Role, Toggled};
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use hairline_document::description::{Map, MaterialKind, MetalColor};
use hairline_document::wear::Wear;
use hairline_editor::Selection;
use hairline_editor::presets::ShapePreset;
use hairline_optics::metal::Metal;
use hairline_sky::BuiltInMap;
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Options, Viewer};

fn select(harness: &mut Harness<'static, Viewer>, selection: Selection) {
    harness.state_mut().document_mut().select(selection);
    harness.run_steps(3);
}

/// Whether the card of a grade is the chosen one.
fn is_chosen(harness: &Harness<'static, Viewer>, name: &str) -> bool {
    let card = harness.get_by_role_and_label(Role::Button, name);
    card.accesskit_node().toggled() == Some(Toggled::True)
}

#[test]
fn wear_is_one_choice_over_the_layers_of_an_object() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    select(&mut harness, Selection::Object(0));
    assert!(is_chosen(&harness, "New"));
    click_on(&mut harness, "Worn");
    let worn = description(&harness);
    let layers = Wear::Worn.layers("disk", 1.0).len();
    assert_eq!(worn.scratches.len(), before.scratches.len() + layers);
    assert!(is_chosen(&harness, "Worn") && !is_chosen(&harness, "New"));
    assert_eq!(harness.state().document().undo_label(), Some("Wear"));
    wait_built(&mut harness);
    // The size of the object is as it was, and so is the grade.
    assert!(is_chosen(&harness, "Worn"));
    click_on(&mut harness, "New");
    assert_eq!(*description(&harness), *before);
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *worn);
}

#[test]
fn pictures_of_presets_are_there_at_once_and_are_chosen_by_name() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let textured = |harness: &Harness<'static, Viewer>| {
        let shapes = harness.output().shapes.iter().map(|clipped| &clipped.shape);
        let pictures = shapes.filter(|shape| match shape {
            egui::Shape::Mesh(mesh) => mesh.texture_id != egui::TextureId::default(),
            egui::Shape::Rect(rect) => rect.brush.is_some(),
            _ => false,
        });
        pictures.count()
    };
    let before = textured(&harness);
    harness.get_by_label("Add to objects").click();
    harness.run_steps(3);
    assert_eq!(textured(&harness), before + ShapePreset::ALL.len());
    let objects = description(&harness).objects.len();
    click_on(&mut harness, "Sphere");
    assert_eq!(description(&harness).objects.len(), objects + 1);
}

#[test]
fn metals_are_chosen_by_their_swatches() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    select(&mut harness, Selection::Material(0));
    click_on(&mut harness, "Make it gold");
    let kind = &description(&harness).materials[0].kind;
    let gold = MaterialKind::Metal(MetalColor::Measured(Metal::Gold));
    assert_eq!(*kind, gold);
    common::undo(&mut harness);
    assert_ne!(description(&harness).materials[0].kind, gold);
}

/// The map is known by its name alone: no file is written, whether the scene has one or not.
#[test]
fn a_map_in_the_box_is_named_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, SMALL).unwrap();
    for file in [Some(scene.clone()), None] {
        let mut harness = viewer_with(Options {
            scene: file.clone(),
            built_in: SMALL,
            backend: Backend::Cpu,
            state_dir: None,
            native_dialogs: false,
            transport: hairline_scene::Transport::DIRECT,
            examples: &hairline_viewer::examples::Examples::NONE,
        });
        wait_built(&mut harness);
        select(&mut harness, Selection::Environment);
        click_on(&mut harness, "Overcast sky");
        let environment = description(&harness).environment.clone().unwrap();
        assert_eq!(environment.map, Map::BuiltIn(BuiltInMap::Overcast));
        harness.get_by_label("Overcast sky, in the box");
        assert!(harness.state().messages().is_empty());
        if file.is_some() {
            common::wait_until(&mut harness, "the map", |viewer| {
                let built = viewer.renderer().built();
                built.is_some_and(|built| built.scene.environment.is_some())
            });
            harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
            harness.run_steps(3);
        }
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let saved = std::fs::read_to_string(&scene).unwrap();
    let read = hairline_document::Description::from_toml(&saved, &scene).unwrap();
    let environment = read.environment.unwrap();
    assert_eq!(environment.map, Map::BuiltIn(BuiltInMap::Overcast));
}
