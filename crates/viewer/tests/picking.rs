//! What a click in the picture meets.

mod common;

use hairline_editor::Selection;

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
