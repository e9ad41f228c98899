//! A window in which nothing happens draws nothing: on a machine that draws by software each pass costs the picture its
//! cores, on a laptop the battery.

use crate::common::{SMALL, viewer, wait_until};
use egui::ViewportId;

#[test]
fn a_finished_picture_leaves_the_window_at_rest() {
    let mut harness = viewer(SMALL);
    wait_until(&mut harness, "the final picture", |viewer| {
        let frame = viewer.renderer().latest();
        frame.is_some_and(|frame| frame.painted.is_final)
    });
    // Fading and sliding widgets come to rest.
    harness.run_steps(20);
    let delay = harness.output().viewport_output[&ViewportId::ROOT].repaint_delay;
    assert!(delay.as_secs() >= 1, "the next pass is wanted in {delay:?}");
}
