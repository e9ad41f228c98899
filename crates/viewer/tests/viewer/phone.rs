//! A window of a telephone's size.

use egui::Rect;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_viewer::Viewer;

use crate::common::{SMALL, viewer_of, wait_built};

const SIZE: [f32; 2] = [390.0, 844.0];
/// What fingers hit, as operating systems of telephones ask for.
const TARGET: f32 = 44.0;

fn telephone() -> Harness<'static, Viewer> {
    let options = crate::common::built_in(SMALL);
    let mut harness = viewer_of(options, SIZE);
    wait_built(&mut harness);
    harness.run_steps(3);
    harness
}

fn press(harness: &mut Harness<'static, Viewer>, name: &str) {
    harness.get_by_label(name).click();
    harness.run_steps(3);
}

#[test]
fn all_that_a_finger_touches_is_in_sight_and_large() {
    let harness = telephone();
    let window = Rect::from_min_size(egui::Pos2::ZERO, SIZE.into());
    for name in ["Menu", "Undo", "Redo", "Snapshot", "Parts", "Settings"] {
        let rect = harness.get_by_label(name).rect();
        assert!(window.contains_rect(rect), "{name} at {rect}");
        assert!(rect.height() >= TARGET, "{name} is {} high", rect.height());
        assert!(rect.width() >= TARGET, "{name} is {} wide", rect.width());
    }
}

#[test]
fn a_sheet_leaves_half_of_the_window_to_the_picture() {
    let mut harness = telephone();
    let height = |harness: &Harness<'static, Viewer>| {
        let rect = harness.get_by_label("Picture").rect();
        assert_eq!(rect.width(), SIZE[0]);
        rect.height() / SIZE[1]
    };
    assert!(height(&harness) < 0.6, "a sheet is open at first");
    press(&mut harness, "Settings");
    assert!(height(&harness) > 0.8, "{}", height(&harness));
    press(&mut harness, "Parts");
    assert!(height(&harness) > 0.4, "{}", height(&harness));
    let line = harness.get_by_label("Camera").rect();
    assert!(line.height() >= TARGET && line.right() <= SIZE[0], "{line}");
    press(&mut harness, "Camera");
    press(&mut harness, "Settings");
    assert!(height(&harness) > 0.4, "one sheet at a time");
    let numbers: Vec<Rect> = (harness.get_all_by_role(Role::SpinButton))
        .map(|node| node.rect())
        .collect();
    for rect in numbers {
        assert!(rect.height() >= TARGET && rect.right() <= SIZE[0], "{rect}");
    }
}

#[test]
fn one_menu_has_all_commands() {
    let mut harness = telephone();
    press(&mut harness, "Menu");
    for name in ["File", "Edit", "View", "Tools", "Help"] {
        let rect = harness.get_by_label(name).rect();
        assert!(rect.right() <= SIZE[0], "{name} at {rect}");
    }
}
