//! The gratings of an object, in its panel: all of them begin by the menu, and each control changes the scene.

use crate::common::{SMALL, click_on, description, undo, viewer, wait_built, wait_until};
use crate::panels::{choose, controls, is_live, select};
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_document::description::{Grating, GroovePattern, UvAxis};
use hairline_editor::Selection;
use hairline_editor::grating_presets::GratingPreset;
use hairline_viewer::Viewer;

/// The only grating of the scene.
fn grating(harness: &Harness<'static, Viewer>) -> Grating {
    let gratings = &description(harness).gratings;
    assert_eq!(gratings.len(), 1);
    gratings[0].clone()
}

fn toggle(harness: &mut Harness<'static, Viewer>, name: &str) {
    harness
        .get_by_role_and_label(Role::CheckBox, name)
        .click_accesskit();
    harness.run_steps(3);
}

/// Adds a preset by the menu of the object, which shows its panel.
fn add(harness: &mut Harness<'static, Viewer>, preset: GratingPreset) {
    select(harness, Selection::Object(0));
    click_on(harness, "Add grating…");
    click_on(harness, preset.name());
    harness.run_steps(3);
    assert_eq!(
        harness.state().document().selection(),
        Selection::Grating(0)
    );
}

/// Types a file's name.
fn name_file(harness: &mut Harness<'static, Viewer>, label: &str, file: &str) {
    let field = harness.get_by_role_and_label(Role::TextInput, label);
    field.focus();
    field.type_text(file);
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
}

#[test]
fn every_control_of_a_grating_is_live() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    select(&mut harness, Selection::Object(0));
    let of_grating = |harness: &Harness<'static, Viewer>| controls(harness, Role::SpinButton);
    add(&mut harness, GratingPreset::Foil);
    // A hidden grating takes no table and no file: none is made for each change.
    toggle(&mut harness, "Hidden");
    assert!(grating(&harness).hidden);

    // Pitch, width, depth with its spread, displacement, seed, coverage, and angles.
    let common = 8;
    let patterns = [
        ("parallel", 3),
        ("circular", 6),
        ("radial", 6),
        ("spun", 7),
        ("swirl", 7),
        ("texture coordinates", 0),
    ];
    let mut is_tried = Vec::new();
    for (pattern, own) in patterns {
        choose(&mut harness, "Pattern", pattern);
        let names = of_grating(&harness);
        assert_eq!(names.len(), common + own, "{pattern}: {names:?}");
        for name in names {
            if !is_tried.contains(&name) {
                is_live(&mut harness, &name);
                is_tried.push(name);
            }
        }
    }
    let along = |harness: &_| match grating(harness).pattern {
        GroovePattern::Uv {
            along, directions, ..
        } => (along, directions),
        other => panic!("{other:?}"),
    };
    choose(&mut harness, "Along", "v");
    name_file(&mut harness, "Direction map", "d.png");
    assert_eq!(along(&harness), (UvAxis::V, Some("d.png".into())));

    name_file(&mut harness, "Mask", "m.png");
    assert_eq!(grating(&harness).mask, Some("m.png".into()));
    toggle(&mut harness, "From three sides");
    toggle(&mut harness, "Within radii");
    let names = of_grating(&harness);
    // The tile; two radii and their centre.
    assert_eq!(names.len(), common + 1 + 5, "{names:?}");
    for name in &names[common..] {
        is_live(&mut harness, name);
    }
    let before = description(&harness);
    click_on(&mut harness, "Delete");
    assert!(description(&harness).gratings.is_empty());
    undo(&mut harness);
    assert_eq!(*description(&harness), *before);
}

#[test]
fn presets_are_added_by_the_menu_and_built() {
    are_added_and_built(&[GratingPreset::Vinyl, GratingPreset::Foil]);
}

#[test]
#[ignore = "long: cargo long"]
fn all_presets_are_added_by_the_menu_and_built() {
    are_added_and_built(&GratingPreset::ALL);
}

fn are_added_and_built(presets: &[GratingPreset]) {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    select(&mut harness, Selection::Object(0));
    for &preset in presets {
        add(&mut harness, preset);
        let pitch_um = preset.grating("disk").pitch_um;
        assert_eq!(grating(&harness).pitch_um, pitch_um);
        wait_until(&mut harness, preset.name(), |viewer| {
            let built = viewer.renderer().built();
            built.is_some_and(|built| {
                built.description.gratings == viewer.document().description().gratings
            })
        });
        undo(&mut harness);
        assert!(description(&harness).gratings.is_empty());
    }
}
