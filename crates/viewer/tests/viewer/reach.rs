//! Things that are within reach: files chosen by a button, paths completed, menus by Alt, hints and messages where they are looked for.

use crate::common::{
    self, SMALL, click_on, description, key, picture, viewer, viewer_of_file, viewer_with,
    wait_built,
};
use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use hairline_editor::Selection;
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Options, Viewer};
use std::path::Path;

fn select(harness: &mut Harness<'static, Viewer>, selection: Selection) {
    harness.state_mut().document_mut().select(selection);
    harness.run_steps(3);
}

/// Types into the line for a path.
fn type_path(harness: &mut Harness<'static, Viewer>, path: &str) {
    harness.run_steps(2);
    harness.event(egui::Event::Text(path.to_owned()));
    harness.run_steps(2);
}

#[test]
fn a_mask_is_chosen_by_its_button_and_named_relative_to_the_scene() {
    let dir = tempfile::tempdir().unwrap();
    let [here, masks] = ["scene", "masks"].map(|name| dir.path().join(name));
    for folder in [&here, &masks] {
        std::fs::create_dir(folder).unwrap();
    }
    let asset = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/hairline.png");
    std::fs::copy(asset, masks.join("leaf.png")).unwrap();
    let scene = here.join("a.toml");
    std::fs::write(&scene, SMALL).unwrap();
    let mut harness = viewer_of_file(&scene);
    select(&mut harness, Selection::Layer(0));
    let before = description(&harness);
    click_on(&mut harness, "Choose density map");
    type_path(&mut harness, &format!("{}/l", masks.display()));
    // The rest by Tab.
    key(&mut harness, Key::Tab);
    let line = harness.get_by_role_and_label(Role::TextInput, "Path");
    let typed = line.accesskit_node().value().unwrap_or_default();
    assert!(typed.ends_with("masks/leaf.png"), "{typed}");
    key(&mut harness, Key::Enter);
    harness.run_steps(3);
    let file = description(&harness).scratches[0].place.density.clone();
    assert_eq!(file.as_deref(), Some(Path::new("../masks/leaf.png")));
    common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn alt_and_a_letter_open_a_menu_and_run_no_command() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = harness.state().camera();
    harness.key_press_modifiers(Modifiers::ALT, Key::F);
    harness.run_steps(3);
    harness.get_by_label_contains("Save as…");
    assert_eq!(harness.state().camera(), before);
}

#[test]
fn high_contrast_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let open = || {
        viewer_with(Options {
            scene: None,
            built_in: SMALL,
            backend: Backend::Cpu,
            state_dir: Some(folder.path().to_owned()),
            native_dialogs: false,
            transport: hairline_scene::Transport::DIRECT,
            examples: &hairline_viewer::examples::Examples::NONE,
        })
    };
    let is_black = |harness: &Harness<'static, Viewer>| {
        let style = harness.ctx.style_of(egui::Theme::Dark);
        style.visuals.panel_fill == egui::Color32::BLACK
    };
    let mut harness = open();
    wait_built(&mut harness);
    assert!(!is_black(&harness));
    click_on(&mut harness, "View");
    click_on(&mut harness, "High contrast");
    assert!(is_black(&harness));
    drop(harness);
    assert!(is_black(&open()));
}

#[test]
fn picking_a_part_of_a_model_of_one_part_says_so() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    select(&mut harness, Selection::Layer(0));
    key(&mut harness, Key::P);
    let on_disk = picture(&harness).center() + vec2(40.0, 60.0);
    common::click_at(&mut harness, on_disk);
    harness.run_steps(2);
    let said = harness.state().messages().concat();
    assert!(said.contains("\"disk\" is one part"), "{said}");
}

#[test]
fn the_brush_is_set_above_the_panel_of_what_is_selected() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    select(&mut harness, Selection::Layer(0));
    key(&mut harness, Key::B);
    let top = |harness: &Harness<'static, Viewer>, name: &str| {
        let numbers = harness.query_all_by_role_and_label(Role::SpinButton, name);
        numbers.map(|it| it.rect().top()).fold(f32::MAX, f32::min)
    };
    assert!(top(&harness, "Brush radius") < top(&harness, "Count"));
}

#[test]
fn messages_stand_above_the_snapshots() {
    let mut harness = viewer(SMALL);
    common::wait_until(&mut harness, "a picture", |viewer| {
        viewer.renderer().latest().is_some()
    });
    key(&mut harness, Key::S);
    harness.run_steps(3);
    let strip = harness.get_by_label("Restore").rect();
    select(&mut harness, Selection::None);
    key(&mut harness, Key::L);
    let on_disk = picture(&harness).center() + vec2(40.0, 60.0);
    common::click_at(&mut harness, on_disk);
    harness.run_steps(3);
    let message = harness.get_by_label_contains("Select a light first").rect();
    assert!(message.bottom() <= strip.top(), "{message:?} {strip:?}");
}

/// A line is drawn around what has the keyboard, and the first press in a menu comes to its first item.
#[test]
fn the_keyboard_is_seen_and_the_first_press_in_a_menu_marks_its_first_item() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    for by_mouse in [false, true] {
        match by_mouse {
            false => harness.key_press_modifiers(Modifiers::ALT, Key::F),
            true => harness.get_by_label("File").click(),
        }
        harness.run_steps(3);
        key(&mut harness, Key::ArrowDown);
        harness.run_steps(2);
        let item = harness.get_by_label_contains("New empty studio").rect();
        let color = harness
            .ctx
            .style_of(egui::Theme::Dark)
            .visuals
            .selection
            .stroke
            .color;
        let shapes = harness.output().shapes.iter();
        let mut lines = shapes.filter(|clipped| match &clipped.shape {
            egui::Shape::Rect(rect) => rect.stroke.color == color && rect.stroke.width > 1.0,
            _ => false,
        });
        let is_around = lines.any(|clipped| {
            let around = clipped.shape.visual_bounding_rect();
            around.contains_rect(item) && around.height() < item.height() + 8.0
        });
        assert!(is_around, "{by_mouse}");
        key(&mut harness, Key::Escape);
        harness.run_steps(2);
    }
}

#[test]
fn enter_runs_a_command_and_closes_its_menu() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    common::wait_until(&mut harness, "a picture", |viewer| {
        viewer.renderer().latest().is_some()
    });
    harness.key_press_modifiers(Modifiers::ALT, Key::I);
    harness.run_steps(3);
    for name in [Key::ArrowDown, Key::ArrowDown, Key::Enter] {
        key(&mut harness, name);
    }
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("Next layer view").is_none());
    assert!(harness.query_all_by_label("Histogram").count() > 0);
}

/// In a small window list and panel stand one above the other, and all of a row is in sight.
#[test]
fn a_small_window_leaves_two_thirds_to_the_picture() {
    let options = crate::common::built_in(SMALL);
    let mut harness = common::viewer_in(options, [800.0, 500.0], 0.25);
    wait_built(&mut harness);
    for selection in [Selection::None, Selection::Camera, Selection::Layer(0)] {
        select(&mut harness, selection);
        let picture = picture(&harness);
        assert!(picture.width() >= 800.0 * 2.0 / 3.0, "{picture:?}");
        for node in harness.query_all_by_role(Role::SpinButton) {
            assert!(node.rect().right() <= picture.left(), "{:?}", node.rect());
        }
    }
    harness.get_by_label("Camera");
}

/// At 640 x 400 tools that have no room are in a menu, the strip of snapshots is a line, and the status ends with an ellipsis.
#[test]
fn a_very_small_window_cuts_nothing_off() {
    let options = crate::common::built_in(SMALL);
    let mut harness = common::viewer_in(options, [640.0, 400.0], 0.25);
    wait_built(&mut harness);
    common::wait_until(&mut harness, "a picture", |viewer| {
        viewer.renderer().latest().is_some()
    });
    key(&mut harness, Key::S);
    harness.run_steps(3);
    for name in ["Select", "Brush", "More"] {
        let rect = harness.get_by_role_and_label(Role::Button, name).rect();
        assert!(rect.right() <= 640.0, "{name} {rect:?}");
    }
    assert!(harness.query_by_label("Compare").is_none());
    click_on(&mut harness, "More");
    click_on(&mut harness, "Compare");
    let look = harness
        .get_by_role_and_label(Role::Button, "Snapshot 1")
        .rect();
    let above = picture(&harness).bottom() - look.top();
    assert!(above < 50.0, "{above} points");
    // Between parts of the line.
    let status = harness.get_by_label_contains(" ms    ").rect();
    assert!(
        status.height() < 26.0 && status.right() < 640.0,
        "{status:?}"
    );
    // With room for all there is no such menu.
    let harness = viewer(SMALL);
    assert!(
        harness.query_by_label("More").is_none() && harness.query_by_label("Compare").is_some()
    );
}
