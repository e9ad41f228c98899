//! What a click in the picture meets.

use crate::common;
use egui::{Rect, vec2};
use glam::{DVec2, DVec3};
use hairline_editor::{Selection, navigate};

#[test]
fn a_click_on_the_disk_selects_it_and_one_beside_it_nothing() {
    let mut harness = common::viewer(common::SMALL);
    common::wait_built(&mut harness);
    let picture = common::picture(&harness);
    common::click_at(&mut harness, picture.center() + egui::vec2(0.0, 60.0));
    assert_eq!(harness.state().document().selection(), Selection::Object(0));
    // Clicks a moment apart are no double click.
    harness.run_steps(60);
    common::click_at(
        &mut harness,
        picture.left_bottom() + egui::vec2(20.0, -20.0),
    );
    assert_eq!(harness.state().document().selection(), Selection::None);
}

#[test]
fn a_double_click_where_the_disks_centre_is_seen_looks_at_its_centre() {
    let mut harness = common::viewer(common::SMALL);
    common::wait_built(&mut harness);
    let description = common::description(&harness);
    // The scene's own picture lies in the middle of the area, as large as fits.
    let area = common::picture(&harness);
    let [width, height] = description.render.size_px.map(|side| side as f32);
    let fitting = (area.width() / width).min(area.height() / height);
    let frame = Rect::from_center_size(area.center(), vec2(width, height) * fitting);
    let size = DVec2::new(frame.width().into(), frame.height().into());
    let seen = navigate::project(&description.camera, DVec3::ZERO, size);
    let seen = seen.expect("the disk is in view");
    let at = frame.min + vec2(seen.x as f32, seen.y as f32);
    common::double_click_at(&mut harness, at);
    let target_m = DVec3::from(harness.state().camera().target_m);
    // Half a pixel is 0.3 mm there; a hundredth of one is what rounding to the screen's single precision leaves.
    assert!(target_m.length() < 1e-5, "{target_m} instead of the origin");
}
