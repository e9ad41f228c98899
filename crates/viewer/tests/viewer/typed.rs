//! Texts typed into the panels: numbers that a scene file cannot hold are refused, and all others are saved and
//! loaded.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use crate::common::{FULL, description, viewer};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use hairline_document::description::{Shape, Surface};
use hairline_editor::{Document, Selection};
use hairline_viewer::Viewer;

const TEXTS: [&str; 3] = ["ACME 🎲", "", "\"]\n[x]"];
const NUMBERS: [&str; 2] = ["1e99", "0"];

fn selected(harness: &mut Harness<'static, Viewer>, selection: Selection) {
    harness.state_mut().document_mut().select(selection);
    harness.run_steps(3);
}

/// The labels of the panel's controls of a kind, from above.
fn labels(harness: &Harness<'static, Viewer>, role: Role) -> Vec<String> {
    let picture = crate::common::picture(harness);
    let nodes = harness.query_all_by_role(role);
    nodes
        .filter(|node| node.rect().min.x >= picture.max.x)
        .map(|node| node.accesskit_node().label().unwrap_or_default())
        .collect()
}

/// Types into the control with this index in the panel, and presses Enter.
fn type_into(harness: &mut Harness<'static, Viewer>, role: Role, place: usize, text: &str) {
    {
        let picture = crate::common::picture(harness);
        let nodes = harness.query_all_by_role(role);
        let mut in_panel = nodes.filter(|node| node.rect().min.x >= picture.max.x);
        in_panel.nth(place).expect("it is still there").focus();
    }
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.step();
    harness.key_press(Key::Delete);
    harness.event(Event::Text(text.to_owned()));
    harness.step();
    harness.key_press(Key::Enter);
    harness.run_steps(2);
}

#[test]
fn what_is_typed_into_any_control_can_be_saved_and_loaded() {
    what_is_typed_can_be_saved_and_loaded(|place, of| place % of..place % of + 1);
}

#[test]
#[ignore = "long: cargo long"]
fn all_that_is_typed_into_any_control_can_be_saved_and_loaded() {
    what_is_typed_can_be_saved_and_loaded(|_, of| 0..of);
}

/// `chosen` tells which texts of so many are typed into the control with this index.
fn what_is_typed_can_be_saved_and_loaded(chosen: fn(usize, usize) -> Range<usize>) {
    let mut harness = viewer(FULL);
    let d = description(&harness);
    let mut selections = vec![
        Selection::Camera,
        Selection::Render,
        Selection::Environment,
        Selection::Studio,
        Selection::Ground,
    ];
    selections.extend((0..d.objects.len()).map(Selection::Object));
    selections.extend((0..d.materials.len()).map(Selection::Material));
    selections.extend((0..d.scratches.len()).map(Selection::Layer));
    selections.extend((0..d.lights.len()).map(Selection::Light));
    let mut taken = 0;
    for selection in selections {
        selected(&mut harness, selection);
        for (role, typed) in [
            (Role::TextInput, &TEXTS[..]),
            (Role::SpinButton, &NUMBERS[..]),
        ] {
            let labels = labels(&harness, role);
            for (place, label) in labels.iter().enumerate() {
                for text in &typed[chosen(place, typed.len())] {
                    let before = description(&harness);
                    type_into(&mut harness, role, place, text);
                    let after = description(&harness);
                    if Arc::ptr_eq(&before, &after) {
                        continue;
                    }
                    taken += 1;
                    let what = format!("{text:?} in {label:?} of {selection:?}");
                    let saved = after
                        .to_toml()
                        .unwrap_or_else(|error| panic!("{what}: {error}"));
                    let again = Document::read(&saved, Path::new("saved"));
                    let again = again.unwrap_or_else(|error| panic!("{what}: {error}"));
                    assert_eq!(again.to_toml().unwrap(), saved, "{what}");
                    while harness.state_mut().document_mut().undo().is_some() {}
                    harness.step();
                }
            }
        }
    }
    assert!(taken > 20, "most is refused: {taken} were taken");
}

#[test]
fn a_text_of_characters_that_the_font_lacks_is_refused_by_name() {
    let mut harness = viewer(FULL);
    selected(&mut harness, Selection::Object(0));
    let before = description(&harness);
    let place = labels(&harness, Role::TextInput)
        .iter()
        .position(|label| label == "Text")
        .unwrap();
    type_into(&mut harness, Role::TextInput, place, "ACME 🎲");
    assert_eq!(*description(&harness), *before);
    let told = harness.state().messages().concat();
    assert!(told.contains("Text: ") && told.contains('🎲'), "{told:?}");
    assert!(!told.contains("shape.text"), "{told:?}");
    type_into(&mut harness, Role::TextInput, place, " ");
    assert_eq!(*description(&harness), *before);
    let told = harness.state().messages().concat();
    assert!(told.contains("Text: found \" \""), "{told:?}");
    // The next good one takes the message away.
    type_into(&mut harness, Role::TextInput, place, "Ærø");
    let Surface::Shape(Shape::Text { line, .. }) = &description(&harness).objects[0].surface else {
        panic!("a text");
    };
    assert_eq!(line, "Ærø");
    assert!(harness.state().messages().is_empty());
}
