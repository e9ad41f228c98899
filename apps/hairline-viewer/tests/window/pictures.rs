//! Pictures of the window for the docs, and of what an artist does first.
//!
//! `HAIRLINE_SCREENSHOTS=$PWD/docs/pictures cargo test --release --workspace --test window pictures -- --ignored` makes them all. They show
//! what is there, whether or not it is finished by [`LONGEST`]: look at the status line.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::{Pos2, Vec2, vec2};
use hairline_gpu::headless::test_gpu;

use crate::display::Display;
use crate::layout::Layout;
use crate::{LARGE_PX, Window, display, keep};

/// The built-in scene, with a name.
const SCENE: &str = hairline_console::BUILT_IN;
const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/models/spoon.glb");
/// Time after which a picture is taken even if it still changes.
const LONGEST: Duration = Duration::from_secs(300);
/// One that stood still for so long is finished.
const STILL: Duration = Duration::from_secs(20);

/// A window with the scene, and the positions of its widgets.
struct Studio<'d> {
    display: &'d Display,
    layout: Layout,
    window: Window<'d>,
}

impl<'d> Studio<'d> {
    fn open(display: &'d Display, folder: &Path) -> Self {
        let scene = folder.join("plate.toml");
        std::fs::write(&scene, SCENE).unwrap();
        Self {
            display,
            layout: Layout::new(&scene, display),
            window: Window::open(display, folder, &scene),
        }
    }

    fn middle(&self) -> Pos2 {
        self.layout.picture().center()
    }

    /// Moves the pointer to a place where it hides nothing.
    fn step_aside(&self) {
        let corner = self.layout.picture().left_top();
        self.display.move_to(corner + Vec2::splat(20.0));
    }

    /// Across the light that the marks diffract, where a stroke is seen.
    fn draw_a_stroke(&self) {
        let middle = self.middle();
        self.display.click(self.layout.layer());
        self.display.move_to(middle);
        self.display.keys(&["b"]);
        self.display.drag(&[
            middle + vec2(-110.0, 60.0),
            middle + vec2(-40.0, 25.0),
            middle + vec2(40.0, 30.0),
            middle + vec2(110.0, 5.0),
        ]);
        self.step_aside();
    }

    fn shot(&self, name: &str) {
        let (start, mut since) = (Instant::now(), Instant::now());
        let mut last = self.display.screenshot(self.layout.picture());
        while since.elapsed() < STILL && start.elapsed() < LONGEST {
            std::thread::sleep(Duration::from_millis(500));
            let now = self.display.screenshot(self.layout.picture());
            if now.differing(&last) > 0 {
                (last, since) = (now, Instant::now());
            }
        }
        keep(&self.display.screen(), name);
    }
}

/// Runs `make` in a window with the scene, where there can be one.
fn in_a_window(make: impl FnOnce(Studio, &Path)) {
    if test_gpu().is_none() {
        return;
    }
    let Some(display) = display(LARGE_PX) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    make(Studio::open(&display, folder.path()), folder.path());
}

#[test]
#[ignore = "makes pictures for the docs, for some minutes"]
fn pictures_of_a_layer_and_of_a_stroke() {
    in_a_window(|studio, _| {
        studio.display.click(studio.layout.layer());
        studio.step_aside();
        studio.shot("viewer-layer");
        studio.draw_a_stroke();
        studio.shot("viewer");
    });
}

#[test]
#[ignore = "makes pictures for the docs, for some minutes"]
fn pictures_of_the_probe_and_of_a_snapshot() {
    in_a_window(|studio, _| {
        let display = studio.display;
        studio.draw_a_stroke();
        display.keys(&["i"]);
        display.click(studio.middle() + vec2(-40.0, 25.0));
        studio.shot("viewer-probe");
        display.keys(&["Escape"]);
        display.keys(&["i"]);
        // The look with the stroke, kept; then the one without it, and back to the kept one.
        display.keys(&["s"]);
        display.keys(&["Control_L", "z"]);
        display.keys(&["j"]);
        studio.shot("viewer-snapshot");
    });
}

#[test]
#[ignore = "makes pictures for the docs, for some minutes"]
fn pictures_of_a_comparison_and_of_a_model() {
    in_a_window(|mut studio, folder| {
        studio.step_aside();
        studio.display.keys(&["c"]);
        studio.shot("viewer-compare");
        let (display, model) = (studio.display, Path::new(MODEL));
        drop(studio.window);
        studio.window = Window::open_titled(display, folder, model, &[], "untitled · Hairline");
        studio.shot("viewer-model");
    });
}
