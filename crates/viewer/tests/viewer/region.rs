//! The region that is rendered first, and the pause.

use crate::common::{
    self, SMALL, click_on, description, drag, key, picture, viewer, wait_built, wait_until,
};
use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;

#[test]
fn a_region_is_drawn_by_a_drag_and_given_up_by_a_click_or_a_key() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    let before = description(&harness);
    let camera = harness.state().camera();
    let middle = picture(&harness).center();
    let region = |harness: &egui_kittest::Harness<'static, hairline_viewer::Viewer>| {
        harness.state().view().unwrap().region
    };
    let draw = |harness: &mut _| {
        key(harness, Key::R);
        drag(
            harness,
            middle - vec2(100.0, 60.0),
            middle + vec2(60.0, 40.0),
            4,
        );
        harness.run_steps(2);
    };
    draw(&mut harness);
    let drawn = region(&harness).expect("there is a region");
    // A quarter of a pixel for each point.
    assert!(
        drawn.size_px[0].abs_diff(40) <= 1 && drawn.size_px[1].abs_diff(25) <= 1,
        "{drawn:?}"
    );
    wait_until(&mut harness, "the region", |viewer| {
        viewer.renderer().region().is_some()
    });
    // Neither the scene nor the view is changed by it.
    assert_eq!(*description(&harness), *before);
    assert_eq!(harness.state().camera(), camera);
    common::click_at(&mut harness, middle);
    harness.run_steps(2);
    assert_eq!(region(&harness), None);
    draw(&mut harness);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::R);
    harness.run_steps(2);
    assert_eq!(region(&harness), None);
}

#[test]
fn the_picture_is_paused_by_a_button_and_a_key() {
    let mut harness = viewer(SMALL);
    wait_built(&mut harness);
    click_on(&mut harness, "Pause");
    assert!(harness.state().renderer().is_paused());
    click_on(&mut harness, "Go on");
    assert!(!harness.state().renderer().is_paused());
    harness.key_press_modifiers(Modifiers::SHIFT, Key::P);
    harness.run_steps(3);
    assert!(harness.state().renderer().is_paused());
    harness.get_by_label("Go on");
}
