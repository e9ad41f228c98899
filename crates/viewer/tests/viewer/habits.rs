//! Habits of all programs: wheels, keys, menus, names of files.

use std::path::Path;

use crate::common::{
    SMALL, click_at, click_on, description, key, picture, right_click, viewer, viewer_of,
    viewer_with, wait_built, wait_until,
};
use egui::{Event, Key, Modifiers, MouseWheelUnit, Pos2, Rect, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::{DVec2, DVec3};
use hairline_editor::Selection;
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Options, Viewer};

fn distance_m(harness: &Harness<'static, Viewer>) -> f64 {
    let camera = harness.state().camera();
    DVec3::from(camera.position_m).distance(camera.target_m.into())
}

#[test]
fn a_wheel_turned_forward_and_fingers_apart_come_nearer() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let middle = picture(&harness).center();
    harness.hover_at(middle);
    harness.run_steps(2);
    let before = distance_m(&harness);
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, 1.0),
        source: egui::MouseWheelSource::Wheel,
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(6);
    let nearer = distance_m(&harness);
    assert!(nearer < 0.97 * before, "{nearer} after {before}");
    harness.event(Event::Zoom(1.2));
    harness.run_steps(3);
    assert!(distance_m(&harness) < 0.97 * nearer);
    let near = distance_m(&harness);
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, -1.0),
        source: egui::MouseWheelSource::Wheel,
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(6);
    assert!(distance_m(&harness) > 1.03 * near);
}

fn save_as(harness: &mut Harness<'static, Viewer>, typed: &str) {
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    harness.run_steps(4);
    harness.get_by_label("Path").focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(typed.to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
}

#[test]
fn save_as_asks_before_it_replaces_a_file_and_takes_enter() {
    let folder = tempfile::tempdir().unwrap();
    let taken = folder.path().join("taken.toml");
    std::fs::write(&taken, "somebody's work").unwrap();
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    save_as(&mut harness, taken.with_extension("").to_str().unwrap());
    assert_eq!(std::fs::read_to_string(&taken).unwrap(), "somebody's work");
    click_on(&mut harness, "Cancel");
    // Back where the name is typed.
    click_on(&mut harness, "Cancel");
    let free = folder.path().join("free.toml");
    save_as(&mut harness, free.to_str().unwrap());
    assert!(free.exists(), "Enter does nothing");
    save_as(&mut harness, taken.to_str().unwrap());
    click_on(&mut harness, "Replace the file");
    assert!(
        std::fs::read_to_string(&taken)
            .unwrap()
            .contains("[camera]")
    );
    assert_eq!(harness.state().document().path(), Some(taken.as_path()));
}

#[test]
fn a_tilde_is_the_users_folder() {
    let home = std::env::home_dir().unwrap();
    let folder = tempfile::tempdir_in(&home).unwrap();
    let name = folder.path().file_name().unwrap().to_str().unwrap();
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    save_as(&mut harness, &format!("~/{name}/a.toml"));
    assert!(folder.path().join("a.toml").exists());
}

/// All corners of the object's box are in the picture, with a margin, and it is no dot.
fn is_framed(scene: &str, object: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(scene);
    let mut harness = viewer_of(
        Options {
            scene: Some(path),
            built_in: SMALL,
            backend: Backend::Cpu,
            state_dir: None,
            native_dialogs: false,
            transport: hairline_scene::Transport::DIRECT,
            examples: &hairline_viewer::examples::Examples::NONE,
        },
        [1440.0, 860.0],
    );
    wait_built(&mut harness);
    key(&mut harness, Key::A);
    let d = description(&harness);
    let i = d.objects.iter().position(|o| o.name == object).unwrap();
    let built = harness.state().renderer().built().unwrap();
    let vertices = &built.scene.objects[i].mesh.positions_m;
    let camera = harness.state().camera();
    let size = DVec2::from(d.render.size_px.map(f64::from));
    let frame = camera.in_scene().frame(d.render.size_px);
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for vertex in vertices {
        let at = frame.pixel_of(vertex.as_dvec3()).unwrap() / size;
        (low, high) = (low.min(at), high.max(at));
    }
    assert!(
        low.min_element() >= 0.05 && high.max_element() <= 0.95,
        "{scene}: {low} {high}"
    );
    assert!((high - low).max_element() >= 0.5, "{scene}: {low} {high}");
}

#[test]
fn frame_all_shows_the_pan_and_not_the_table() {
    is_framed("crates/console/src/built_in_scene.toml", "pan");
    is_framed("scenes/plate.toml", "plate");
}

#[test]
fn escape_closes_what_is_open_before_it_selects_nothing() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let document = harness.state_mut().document_mut();
    document.select(Selection::Layer(0));
    harness.run_steps(3);
    let selected = |harness: &Harness<'static, Viewer>| harness.state().document().selection();
    // A menu.
    click_on(&mut harness, "Edit");
    assert!(
        harness.query_by_label_contains("Duplicate\u{20}").is_some()
            || egui::Popup::is_any_open(&harness.ctx)
    );
    key(&mut harness, Key::Escape);
    assert!(!egui::Popup::is_any_open(&harness.ctx));
    assert_eq!(selected(&harness), Selection::Layer(0), "a menu");
    // A list of choices.
    click_on(&mut harness, "Pattern");
    assert!(egui::Popup::is_any_open(&harness.ctx));
    key(&mut harness, Key::Escape);
    assert!(!egui::Popup::is_any_open(&harness.ctx));
    assert_eq!(selected(&harness), Selection::Layer(0), "a choice");
    // A text.
    harness
        .get_by_role_and_label(egui::accesskit::Role::TextInput, "Name")
        .focus();
    harness.run_steps(2);
    harness.event(Event::Text("x".to_owned()));
    harness.step();
    key(&mut harness, Key::Escape);
    assert_eq!(selected(&harness), Selection::Layer(0), "a text");
    assert_eq!(
        description(&harness).scratches[0].name.as_deref(),
        Some("turned")
    );
    // The tool.
    key(&mut harness, Key::B);
    key(&mut harness, Key::Escape);
    assert_eq!(selected(&harness), Selection::Layer(0), "the brush");
    key(&mut harness, Key::Escape);
    assert_eq!(selected(&harness), Selection::None);
}

#[test]
fn a_click_that_closes_a_menu_selects_and_draws_nothing() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let on_disk = picture(&harness).center() + vec2(40.0, 60.0);
    let before = description(&harness);
    for tool in [Key::V, Key::B] {
        key(&mut harness, tool);
        click_on(&mut harness, "Help");
        assert!(egui::Popup::is_any_open(&harness.ctx));
        click_at(&mut harness, on_disk);
        harness.run_steps(2);
        assert!(!egui::Popup::is_any_open(&harness.ctx));
        assert_eq!(
            harness.state().document().selection(),
            Selection::None,
            "{tool:?}"
        );
        assert_eq!(*description(&harness), *before);
    }
    key(&mut harness, Key::V);
    click_at(&mut harness, on_disk);
    assert_eq!(harness.state().document().selection(), Selection::Object(0));
}

/// Names and materials that no object has are not seen.
#[test]
fn a_new_name_and_an_unused_material_leave_the_picture() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let revision = |harness: &Harness<'static, Viewer>| {
        harness
            .state()
            .renderer()
            .built()
            .map(|built| built.revision)
    };
    let before = revision(&harness);
    let edits: [fn(&mut hairline_document::Description); 4] = [
        |d| d.scratches[0].name = Some("another".to_owned()),
        |d| d.lights[0].name = None,
        |d| {
            hairline_editor::actions::objects::rename(d, 0, "plate").unwrap();
        },
        |d| {
            let mut more = d.materials[0].clone();
            more.name = "gold".to_owned();
            d.materials.insert(0, more);
        },
    ];
    for (i, edit) in edits.into_iter().enumerate() {
        harness.state_mut().document_mut().edit("by the test", edit);
        harness.run_steps(3);
        assert!(!harness.state().renderer().is_building(), "edit {i}");
        assert_eq!(revision(&harness), before, "edit {i}");
    }
    // A visible change is built.
    let document = harness.state_mut().document_mut();
    document.edit("by the test", |d| {
        d.objects[0].material = Some("gold".to_owned())
    });
    document.edit("by the test", |d| d.materials[0].roughness = 0.5);
    wait_until(&mut harness, "another scene", |viewer| {
        let built = viewer.renderer().built();
        built.is_some_and(|built| Some(built.revision) != before)
    });
}

fn is_below(harness: &Harness<'static, Viewer>, above: &str, below: &str) {
    let y = |label: &str| {
        let mut rects = harness
            .query_all_by_label_contains(label)
            .map(|node| node.rect());
        // The menu's, not that of the bar above it.
        rects
            .find(|rect: &Rect| rect.min.y > 24.0)
            .map(|rect| rect.min.y)
    };
    let (above_y, below_y) = (y(above), y(below));
    assert!(
        above_y.is_some() && above_y < below_y,
        "{above} {above_y:?}, {below} {below_y:?}"
    );
}

#[test]
fn menus_have_the_usual_order_and_redo_its_other_key() {
    let mut harness = viewer_with(crate::common::built_in(SMALL));
    wait_built(&mut harness);
    click_on(&mut harness, "File");
    is_below(&harness, "Open…", "Recent");
    is_below(&harness, "Recent", "Save");
    is_below(&harness, "Save", "Save as…");
    is_below(&harness, "Save as…", "Quit");
    key(&mut harness, Key::Escape);
    let before = description(&harness);
    let document = harness.state_mut().document_mut();
    document.edit("Exposure", |d| d.camera.exposure_ev = 1.0);
    let after = description(&harness);
    crate::common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    harness.run_steps(2);
    assert_eq!(*description(&harness), *after);
}

#[test]
fn panels_hide_and_come_back() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let width = picture(&harness).width();
    key(&mut harness, Key::F9);
    key(&mut harness, Key::F10);
    harness.run_steps(3);
    assert!(picture(&harness).width() > width + 400.0);
    key(&mut harness, Key::F9);
    key(&mut harness, Key::F10);
    harness.run_steps(30);
    assert!((picture(&harness).width() - width).abs() < 2.0);
}

#[test]
fn the_right_button_opens_what_can_be_done() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let line = harness.get_by_label("lamp").rect().center();
    right_click(&mut harness, line);
    assert_eq!(harness.state().document().selection(), Selection::Light(0));
    harness.get_by_label_contains("Hide or show").click();
    harness.run_steps(3);
    assert!(description(&harness).lights[0].hidden);
    // In the picture, on the disk.
    let on_disk = picture(&harness).center() + vec2(40.0, 60.0);
    right_click(&mut harness, on_disk);
    assert_eq!(harness.state().document().selection(), Selection::Object(0));
    assert!(egui::Popup::is_any_open(&harness.ctx));
}

/// The whole of the help, without a bar to scroll it, on a small screen.
#[test]
fn the_help_fits_and_reads_as_the_keyboard_does() {
    let mut harness = viewer_of(crate::common::built_in(SMALL), [1360.0, 800.0]);
    wait_built(&mut harness);
    key(&mut harness, Key::F1);
    harness.run_steps(5);
    let window = Rect::from_min_size(Pos2::ZERO, Vec2::new(1360.0, 800.0));
    let close = harness.get_by_label("Close").rect();
    for text in [
        "[",
        "Esc",
        "F11",
        "Ctrl+Shift+Z, Ctrl+Y",
        "Double click: looks at the point",
    ] {
        let rects: Vec<Rect> = harness.query_all_by_label(text).map(|n| n.rect()).collect();
        assert!(!rects.is_empty(), "{text:?} is not in the help");
        assert!(
            rects.iter().all(|rect| window.contains_rect(*rect)),
            "{text:?}: {rects:?}"
        );
        assert!(
            rects.iter().all(|rect| rect.max.y <= close.min.y),
            "{text:?} is to be scrolled to"
        );
    }
    for text in ["OpenBracket", "Escape", "ArrowUp"] {
        assert!(harness.query_by_label(text).is_none(), "{text:?}");
    }
}

/// egui's own sign of a colour picker needs a special font; the test panics where a sign has no
/// glyph.
#[test]
fn the_colour_picker_has_all_its_signs() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    harness
        .state_mut()
        .document_mut()
        .select(Selection::Light(0));
    harness.run_steps(3);
    harness
        .get_by_role_and_label(egui::accesskit::Role::ColorWell, "Colour")
        .click();
    harness.run_steps(4);
    assert!(egui::Popup::is_any_open(&harness.ctx));
}

/// The line stays with the error, and with the typed path.
#[test]
fn the_line_for_a_path_stays_until_the_path_is_right() {
    let folder = tempfile::tempdir().unwrap();
    let wrong = folder.path().join("wrong.toml");
    std::fs::write(&wrong, "fow_y_deg = 3\n").unwrap();
    let right = folder.path().join("right.toml");
    std::fs::write(&right, SMALL).unwrap();
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    let mut typed = String::new();
    let mut enter = |harness: &mut Harness<'static, Viewer>, path: &Path| {
        for _ in 0..typed.chars().count() {
            harness.key_press(Key::Backspace);
        }
        typed = path.display().to_string();
        harness.event(Event::Text(typed.clone()));
        harness.run_steps(2);
        harness.key_press(Key::Enter);
        harness.run_steps(4);
    };
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    harness.run_steps(4);
    for (path, says) in [
        (folder.path().join("none.toml"), "none.toml is not there."),
        (
            folder.path().to_owned(),
            "is a folder; give the path of a file.",
        ),
        (wrong, "fow_y_deg"),
    ] {
        enter(&mut harness, &path);
        harness.get_by_label_contains(says);
        harness.get_by_label("Path");
        assert_eq!(*description(&harness), *before);
        assert!(harness.state().messages().is_empty());
    }
    enter(&mut harness, &right);
    assert_eq!(harness.state().document().path(), Some(right.as_path()));
    assert!(harness.query_by_label("Path").is_none());
    // A folder that is not there to save into.
    save_as(
        &mut harness,
        folder.path().join("no/a.toml").to_str().unwrap(),
    );
    harness.get_by_label_contains("There is no folder");
    harness.get_by_label("Path");
}

/// The keys come in one slow pass: the path's letters are no commands.
#[test]
fn what_is_typed_after_the_key_for_open_is_the_path() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = harness.state().camera();
    let key = |key: Key, modifiers: Modifiers| Event::Key {
        key,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers,
    };
    harness.input_mut().events.extend([
        key(Key::O, Modifiers::COMMAND),
        key(Key::Num5, Modifiers::NONE),
        Event::Text("5".to_owned()),
    ]);
    harness.step();
    harness
        .input_mut()
        .events
        .extend([key(Key::Num6, Modifiers::NONE), Event::Text("6".to_owned())]);
    harness.run_steps(3);
    assert_eq!(harness.state().camera(), before);
    let line = harness.get_by_role_and_label(egui::accesskit::Role::TextInput, "Path");
    assert_eq!(line.accesskit_node().value().as_deref(), Some("56"));
}

#[test]
fn f2_and_a_double_click_in_the_list_rename() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let document = harness.state_mut().document_mut();
    document.select(Selection::Light(0));
    harness.run_steps(3);
    key(&mut harness, Key::F2);
    harness.event(Event::Text("bulb".to_owned()));
    harness.run_steps(2);
    key(&mut harness, Key::Enter);
    let name = |harness: &Harness<'static, Viewer>| description(harness).lights[0].name.clone();
    assert_eq!(name(&harness).as_deref(), Some("bulb"));
    let line = harness.get_by_label("disk").rect().center();
    crate::common::double_click_at(&mut harness, line);
    harness.run_steps(2);
    harness.event(Event::Text("plate".to_owned()));
    harness.run_steps(2);
    key(&mut harness, Key::Enter);
    let d = description(&harness);
    assert_eq!(d.objects[0].name, "plate");
    assert_eq!(d.scratches[0].object, "plate");
}

#[test]
fn a_new_material_is_given_to_what_is_selected() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let document = harness.state_mut().document_mut();
    document.select(Selection::Object(0));
    harness.run_steps(3);
    let before = description(&harness);
    click_on(&mut harness, "Add to materials");
    click_on(&mut harness, "Mirror");
    let d = description(&harness);
    let added = d.materials.last().unwrap().name.clone();
    assert_eq!(d.materials.len(), before.materials.len() + 1);
    assert_eq!(d.objects[0].material.as_ref(), Some(&added));
    crate::common::undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}
