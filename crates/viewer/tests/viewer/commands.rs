//! Every command of the menus, by its key where it has one.

use crate::common::{SMALL, click_on, description, viewer, wait_built};
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_document::Description;
use hairline_editor::Selection;
use hairline_viewer::Viewer;

fn press(harness: &mut Harness<'static, Viewer>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(3);
}

/// A key that must change the scene, and one undo that must bring it back.
fn changes(
    harness: &mut Harness<'static, Viewer>,
    selection: Selection,
    (modifiers, key): (Modifiers, Key),
    is_done: impl Fn(&Description, &Description) -> bool,
) {
    harness.state_mut().document_mut().select(selection);
    harness.run_steps(2);
    let before = description(harness);
    press(harness, modifiers, key);
    let after = description(harness);
    assert!(is_done(&before, &after), "{key:?} on {selection:?}");
    press(harness, Modifiers::COMMAND, Key::Z);
    assert!(
        *description(harness) == *before,
        "undo of {key:?} on {selection:?}"
    );
    // Redo, and back again.
    press(harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(
        *description(harness) == *after,
        "redo of {key:?} on {selection:?}"
    );
    press(harness, Modifiers::COMMAND, Key::Z);
}

#[test]
fn keys_edit_what_is_selected() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let duplicate = (Modifiers::COMMAND, Key::D);
    let delete = (Modifiers::NONE, Key::Delete);
    let h = &mut harness;
    changes(h, Selection::Layer(0), duplicate, |a, b| {
        b.scratches.len() == a.scratches.len() + 1
    });
    changes(h, Selection::Light(0), duplicate, |a, b| {
        b.lights.len() == a.lights.len() + 1
    });
    changes(h, Selection::Object(0), duplicate, |a, b| {
        b.objects.len() == a.objects.len() + 1
    });
    changes(h, Selection::Material(0), duplicate, |a, b| {
        b.materials.len() == a.materials.len() + 1
    });
    changes(h, Selection::Layer(0), delete, |a, b| {
        b.scratches.len() + 1 == a.scratches.len()
    });
    changes(h, Selection::Light(1), delete, |a, b| {
        b.lights.len() + 1 == a.lights.len()
    });
    let hide = (Modifiers::NONE, Key::H);
    changes(h, Selection::Layer(0), hide, |_, b| b.scratches[0].hidden);
    changes(h, Selection::Light(0), hide, |_, b| b.lights[0].hidden);
    changes(
        h,
        Selection::Layer(0),
        (Modifiers::SHIFT, Key::H),
        |_, b| b.scratches[0].solo,
    );
    changes(
        h,
        Selection::Light(0),
        (Modifiers::ALT, Key::ArrowDown),
        |a, b| b.lights[1] == a.lights[0],
    );
    changes(
        h,
        Selection::Light(1),
        (Modifiers::ALT, Key::ArrowUp),
        |a, b| b.lights[0] == a.lights[1],
    );
}

#[test]
fn what_is_in_use_is_not_deleted_and_why_is_told() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    harness
        .state_mut()
        .document_mut()
        .select(Selection::Material(0));
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Delete);
    assert_eq!(*description(&harness), *before);
    let messages = harness.state().messages().join("\n");
    assert!(
        messages.contains("steel") && messages.contains("disk"),
        "{messages}"
    );
}

#[test]
fn keys_move_the_view_and_nothing_else() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let keys = [
        Key::A,
        Key::Num1,
        Key::Num2,
        Key::Num3,
        Key::Num4,
        Key::Num5,
        Key::Num6,
        Key::Num7,
    ];
    for key in keys {
        moves(&mut harness, Selection::None, key);
    }
    for selection in [
        Selection::Object(0),
        Selection::Light(0),
        Selection::Layer(0),
    ] {
        moves(&mut harness, selection, Key::F);
    }
}

/// Presses a key and sees the view change, and the scene stay.
fn moves(harness: &mut Harness<'static, Viewer>, selection: Selection, key: Key) {
    harness.state_mut().document_mut().select(selection);
    // Back to the scene's own camera.
    press(harness, Modifiers::NONE, Key::Num0);
    let (scene, view) = (description(harness), harness.state().camera());
    press(harness, Modifiers::NONE, key);
    assert_ne!(harness.state().camera(), view, "{key:?}");
    assert_eq!(*description(harness), *scene, "{key:?}");
}

#[test]
fn tools_help_and_the_reference_open_by_key_and_close() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    press(&mut harness, Modifiers::NONE, Key::B);
    assert!(
        harness.query_all_by_label("Brush radius").count() > 0,
        "the brush's settings"
    );
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(
        harness.query_all_by_label("Brush radius").count() == 0,
        "Escape puts the brush away"
    );
    press(&mut harness, Modifiers::NONE, Key::F1);
    assert!(harness.query_by_label("Close").is_some(), "the help");
    harness.run_steps(10);
    click_on(&mut harness, "Close");
    harness.run_steps(10);
    assert!(harness.query_by_label("Close").is_none());
    // Typing is not commanding.
    harness
        .state_mut()
        .document_mut()
        .select(Selection::Object(0));
    harness.run_steps(2);
    let before = description(&harness);
    harness
        .get_by_role_and_label(egui::accesskit::Role::TextInput, "Name")
        .focus();
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Delete);
    press(&mut harness, Modifiers::NONE, Key::A);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn menus_hold_what_keys_do() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    click_on(&mut harness, "View");
    // The entry's key stands behind it.
    harness.get_by_label_contains("From above").click();
    harness.run_steps(3);
    assert_ne!(harness.state().camera(), description(&harness).camera);
    click_on(&mut harness, "Edit");
    // The toolbar has one too.
    assert!(harness.query_all_by_label_contains("Undo").count() >= 2);
}

/// All commands run, however many a slow pass has gathered, and in their order.
#[test]
fn each_press_of_undo_and_redo_in_one_pass_is_a_step() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    for i in 1..=12 {
        let document = harness.state_mut().document_mut();
        document.edit("Exposure", |d| d.camera.exposure_ev = f64::from(i));
    }
    let exposure_ev = |harness: &Harness<'static, Viewer>| description(harness).camera.exposure_ev;
    let mut pressed = |shift: &[bool]| {
        for shift in shift {
            let modifiers = match shift {
                true => Modifiers::COMMAND | Modifiers::SHIFT,
                false => Modifiers::COMMAND,
            };
            for pressed in [true, false] {
                harness.input_mut().events.push(egui::Event::Key {
                    key: Key::Z,
                    physical_key: None,
                    pressed,
                    repeat: false,
                    modifiers,
                });
            }
        }
        harness.run_steps(2);
        exposure_ev(&harness)
    };
    assert_eq!(pressed(&[false; 10]), 2.0);
    assert_eq!(pressed(&[true; 7]), 9.0);
    // Back three, forth one, back one: in another order it would be something else.
    assert_eq!(pressed(&[true, true, true, true, false, true, false]), 11.0);
}

/// Text that was typed without a box for it may be keys of commands.
#[test]
fn a_key_tells_for_two_seconds_what_it_did() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    for (key, text) in [
        (Key::Comma, "Exposure -0.25 EV in the window (,)"),
        (Key::Num3, "View from the left (3)"),
        (Key::X, "False colour, or the picture: on (X)"),
    ] {
        press(&mut harness, Modifiers::NONE, key);
        assert!(harness.state().messages().contains(&text), "{text}");
    }
    // A pass of tests is a quarter of a second.
    harness.run_steps(12);
    assert_eq!(harness.state().messages(), [""; 0]);
}
