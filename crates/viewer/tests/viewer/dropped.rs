//! Presets that are dragged from their cards onto objects and parts, and objects and gratings in the list.

use crate::common::{
    self, SMALL, click_on, description, move_to, picture, press, release, undo, viewer, wait_built,
    wait_until,
};
use crate::picking::{LAMP, two_squares};
use egui::accesskit::Role;
use egui::{Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_document::description::{MaterialKind, MetalColor, Override, Shape, Surface};
use hairline_document::wear::{self, Wear};
use hairline_editor::Selection;
use hairline_optics::metal::Metal;
use hairline_viewer::Viewer;

fn select(harness: &mut Harness<'static, Viewer>, selection: Selection) {
    harness.state_mut().document_mut().select(selection);
    harness.run_steps(3);
}

/// Drags the card of this name to a place; `look` sees the window before the button goes up.
fn drag_card(
    harness: &mut Harness<'static, Viewer>,
    card: &str,
    to: Pos2,
    look: impl FnOnce(&Harness<'static, Viewer>),
) {
    harness.run_steps(5);
    let from = harness.get_by_role_and_label(Role::Button, card).rect();
    let from = from.center();
    press(harness, from);
    move_to(harness, from, to, 12);
    harness.run_steps(2);
    look(harness);
    release(harness, to);
    harness.run_steps(3);
}

#[test]
fn a_metal_is_dropped_onto_an_object_as_one_step() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    select(&mut harness, Selection::Object(0));
    click_on(&mut harness, "Make it of…");
    let on_disk = picture(&harness).center() + vec2(40.0, 60.0);
    drag_card(&mut harness, "Gold", on_disk, |harness| {
        // The menu has made room for the object.
        assert!(!egui::Popup::is_any_open(&harness.ctx));
    });
    let after = description(&harness);
    let given = after.objects[0].material.clone().unwrap();
    let material = after.materials.iter().find(|it| it.name == given).unwrap();
    let gold = MaterialKind::Metal(MetalColor::Measured(Metal::Gold));
    assert_eq!(material.kind, gold);
    undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn an_stl_file_is_dropped_as_an_object() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("plate.stl");
    let text = "solid plate\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 90 0 0\nvertex 0 90 0\nendloop\nendfacet\nendsolid\n";
    std::fs::write(&path, text).unwrap();
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    crate::files::drop_file(&mut harness, &path);
    wait_until(&mut harness, "the object", |viewer| {
        viewer.document().description().objects.len() == 2
    });
    wait_built(&mut harness);
    let built = harness.state().renderer().built().unwrap();
    let (low, high) = built.scene.objects[1].mesh.bounds_m();
    assert!((high - low).max_element() < 0.0901);
    undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn wear_is_dropped_in_the_picture_and_beside_objects_nothing_happens() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    select(&mut harness, Selection::Object(0));
    let beside = picture(&harness).left_bottom() + vec2(20.0, -20.0);
    drag_card(&mut harness, "Worn", beside, |_| {});
    assert_eq!(*description(&harness), *before);
    let on_disk = picture(&harness).center() + vec2(40.0, 60.0);
    drag_card(&mut harness, "Worn", on_disk, |_| {});
    let name = &before.objects[0].name;
    assert_eq!(
        wear::wear_of(&description(&harness), name),
        Some(Wear::Worn)
    );
    undo(&mut harness);
    assert_eq!(*description(&harness), *before);
    // A line of the list takes it too.
    let line = harness.get_by_label("disk").rect().center();
    drag_card(&mut harness, "Used", line, |_| {});
    assert_eq!(
        wear::wear_of(&description(&harness), name),
        Some(Wear::Used)
    );
}

#[test]
fn a_metal_is_dropped_onto_a_part_of_a_model() {
    let dir = tempfile::tempdir().unwrap();
    two_squares(dir.path());
    let scene = dir.path().join("a.toml");
    let text = "[camera]\nposition_m = [0, 0, 0.4]\ntarget_m = [0, 0, 0]\nup = [0, 1, 0]\n\
        [[object]]\nname = \"it\"\nmesh = \"a.gltf\"\n";
    std::fs::write(&scene, format!("{text}{LAMP}")).unwrap();
    let mut harness = common::viewer_of_file(&scene);
    select(&mut harness, Selection::Object(0));
    click_on(&mut harness, "Make it of…");
    let right = picture(&harness).center() + vec2(40.0, 10.0);
    drag_card(&mut harness, "Brass", right, |_| {});
    let expected = Override {
        metal: Some(Metal::Brass),
        ..Override::new("gold")
    };
    let object = description(&harness).objects[0].clone();
    assert_eq!((object.material, object.overrides), (None, vec![expected]));
    wait_until(&mut harness, "the metal", |viewer| {
        let built = viewer.renderer().built();
        built.is_some_and(|it| it.description.objects[0].overrides.len() == 1)
    });
    // A click means all of the object, and a file's materials with what was changed in them give way.
    click_on(&mut harness, "Make it of…");
    click_on(&mut harness, "Silver");
    let object = description(&harness).objects[0].clone();
    assert_eq!(object.material.as_deref(), Some("silver"));
    assert!(object.overrides.is_empty());
    description(&harness).check_references().unwrap();
}

#[test]
fn a_material_of_a_file_is_made_a_metal_in_its_panel() {
    let dir = tempfile::tempdir().unwrap();
    two_squares(dir.path());
    let scene = dir.path().join("a.toml");
    let text = "[camera]\nposition_m = [0, 0, 0.4]\ntarget_m = [0, 0, 0]\nup = [0, 1, 0]\n\
        [[object]]\nname = \"it\"\nmesh = \"a.gltf\"\n";
    std::fs::write(&scene, format!("{text}{LAMP}")).unwrap();
    let mut harness = common::viewer_of_file(&scene);
    select(&mut harness, Selection::Object(0));
    click_on(&mut harness, "steel");
    harness.run_steps(30);
    crate::panels::choose(&mut harness, "Metal", "Iron");
    let overrides = description(&harness).objects[0].overrides.clone();
    let iron = Override {
        metal: Some(Metal::Iron),
        ..Override::new("steel")
    };
    assert_eq!(overrides, [iron]);
}

#[test]
fn objects_are_hidden_by_their_box_with_all_that_lies_on_them() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    click_on(&mut harness, "Show object 1");
    assert!(description(&harness).objects[0].hidden);
    wait_until(&mut harness, "an empty scene", |viewer| {
        let built = viewer.renderer().built();
        built.is_some_and(|built| {
            let object = &built.scene.objects[0];
            object.mesh.triangles.is_empty() && object.scratches.is_empty()
        })
    });
    // Nothing is there to be picked, and nothing is framed out of sight.
    let middle = picture(&harness).center() + vec2(40.0, 60.0);
    common::click_at(&mut harness, middle);
    assert_eq!(harness.state().document().selection(), Selection::None);
    common::key(&mut harness, egui::Key::A);
    let camera = harness.state().camera();
    assert!(camera.position_m.iter().all(|m| m.is_finite()));
    click_on(&mut harness, "Show object 1");
    assert_eq!(*description(&harness), *before);
}

#[test]
fn gratings_are_in_the_list() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    click_on(&mut harness, "+ grating");
    click_on(&mut harness, "DVD");
    assert_eq!(
        harness.state().document().selection(),
        Selection::Grating(0)
    );
    click_on(&mut harness, "Show grating 1");
    assert!(description(&harness).gratings[0].hidden);
    select(&mut harness, Selection::None);
    click_on(&mut harness, "dvd, 0.74 µm");
    assert_eq!(
        harness.state().document().selection(),
        Selection::Grating(0)
    );
    common::key(&mut harness, egui::Key::Delete);
    assert!(description(&harness).gratings.is_empty());
    assert_eq!(harness.state().document().selection(), Selection::Object(0));
}

#[test]
fn a_text_is_as_wide_as_the_selected_object_and_lies_on_it() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    select(&mut harness, Selection::Object(0));
    let (low_m, high_m) = {
        let built = harness.state().renderer().built().unwrap();
        built.scene.objects[0].mesh.bounds_m()
    };
    click_on(&mut harness, "Add to objects");
    click_on(&mut harness, "Text");
    wait_built(&mut harness);
    let text = description(&harness).objects.last().unwrap().clone();
    assert!(matches!(text.surface, Surface::Shape(Shape::Text { .. })));
    let built = harness.state().renderer().built().unwrap();
    let made = built.scene.objects.iter().find(|it| it.name == text.name);
    let (low, high) = made.unwrap().mesh.bounds_m();
    let share = (high.x - low.x) / (high_m.x - low_m.x);
    assert!((0.5..1.0).contains(&share), "{share}");
    assert!((low.z - high_m.z).abs() < 1e-5, "on top");
    // Read from the camera, which looks along +y.
    assert_eq!(text.rotation_deg, [0.0; 3]);
}
