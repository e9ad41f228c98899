//! Painting gives way to the next request.

use std::time::{Duration, Instant};

use crate::common::{BUILT_IN, picture, viewer, wait_until};
use egui::Key;
use egui_kittest::{Harness, kittest::Queryable};
use hairline_editor::Selection;
use hairline_viewer::Viewer;

/// A tenth of a second on a machine at rest; where tests run side by side, far less than the fine picture would still take.
const SOON: Duration = Duration::from_secs(10);

fn shows_what_is_wanted(viewer: &Viewer) -> bool {
    let frame = viewer.renderer().latest();
    frame.is_some_and(|frame| {
        let wanted = viewer.view();
        wanted.is_some_and(|wanted| frame.view.has_same_pixels(&wanted))
    })
}

/// Presses a key and waits for the resulting picture; returns the time that it took.
fn press(harness: &mut Harness<'static, Viewer>, key: Key) -> Duration {
    let before = harness.state().view();
    harness.key_press(key);
    let start = Instant::now();
    wait_until(harness, "another view", |viewer| viewer.view() != before);
    wait_until(harness, "its first picture", shows_what_is_wanted);
    start.elapsed()
}

#[test]
fn all_is_framed_and_then_the_pan_while_the_built_in_scene_is_refined() {
    let mut harness = viewer(BUILT_IN);
    wait_until(&mut harness, "the finest picture has begun", |viewer| {
        let frame = viewer.renderer().latest();
        // The one before it is there.
        frame.is_some_and(|frame| 3 * frame.painted.size_px[0] > frame.view.size_px[0])
    });
    let pan = Selection::Object(0);
    harness.state_mut().document_mut().select(pan);
    let took = [press(&mut harness, Key::A), press(&mut harness, Key::F)];
    println!("A and F were answered after {took:?}");
    assert!(took.iter().all(|took| *took < SOON), "{took:?}");
}

/// The words stand in the middle of the window, where they are looked for, and in the line at the bottom.
#[test]
fn before_the_first_picture_the_window_says_what_it_does() {
    let harness = viewer(BUILT_IN);
    let middle = picture(&harness).center();
    let said = ["building the scene", "rendering the first picture"];
    let said = said.map(|words| {
        harness
            .query_all_by_label_contains(words)
            .collect::<Vec<_>>()
    });
    let said = said.concat();
    assert_eq!(said.len(), 2);
    assert!(
        said.iter()
            .any(|words| words.rect().center().distance(middle) < 60.0)
    );
}
