//! Pictures of the window for the docs, and of what an artist does first.
//!
//! `HAIRLINE_SCREENSHOTS=$PWD/docs/pictures cargo test --release --workspace --test window pictures -- --ignored` makes them all. They show
//! what is there, whether or not it is finished by [`LONGEST`]: look at the status line.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::vec2;
use hairline_gpu::headless::test_gpu;

use crate::layout::Layout;
use crate::{Window, display, keep};

/// The built-in scene, with a name.
const SCENE: &str = include_str!("../../src/built_in_scene.toml");
const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/models/spoon.glb");
/// A picture that still changes after so long is taken as it is.
const LONGEST: Duration = Duration::from_secs(150);
/// One that stood still for so long is finished.
const STILL: Duration = Duration::from_secs(10);

#[test]
#[ignore = "makes pictures for the docs, for some minutes"]
fn pictures_of_the_window() {
    if test_gpu().is_none() {
        return;
    }
    let Some(display) = display() else { return };
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("plate.toml");
    std::fs::write(&scene, SCENE).unwrap();
    let layout = Layout::of(&scene);
    let picture = layout.picture();
    let middle = picture.center();
    let aside = picture.left_top() + vec2(20.0, 20.0);
    let window = Window::open(&display, folder.path(), &scene);
    let shot = |name: &str| {
        let (start, mut since) = (Instant::now(), Instant::now());
        let mut last = display.screenshot(picture);
        while since.elapsed() < STILL && start.elapsed() < LONGEST {
            std::thread::sleep(Duration::from_millis(500));
            let now = display.screenshot(picture);
            if now.differing(&last) > 0 {
                (last, since) = (now, Instant::now());
            }
        }
        keep(&display.screen(), name);
    };
    shot("viewer-start");
    display.click(layout.layer());
    display.move_to(aside);
    shot("viewer-layer");
    // Across the light that the marks diffract, where a stroke is seen.
    display.move_to(middle);
    display.keys(&["b"]);
    display.drag(&[
        middle + vec2(-110.0, 60.0),
        middle + vec2(-40.0, 25.0),
        middle + vec2(40.0, 30.0),
        middle + vec2(110.0, 5.0),
    ]);
    display.move_to(aside);
    shot("viewer");
    display.keys(&["i"]);
    display.click(middle + vec2(-40.0, 25.0));
    shot("viewer-probe");
    display.keys(&["Escape"]);
    display.keys(&["i"]);
    // The look with the stroke, kept; then the one without it, and back to the kept one.
    display.keys(&["s"]);
    display.keys(&["Control_L", "z"]);
    display.keys(&["j"]);
    shot("viewer-snapshot");
    display.keys(&["j"]);
    display.keys(&["c"]);
    shot("viewer-compare");
    drop(window);

    let window = Window::open_titled(
        &display,
        folder.path(),
        Path::new(MODEL),
        &[],
        "untitled · Hairline",
    );
    shot("viewer-model");
    drop(window);
}
