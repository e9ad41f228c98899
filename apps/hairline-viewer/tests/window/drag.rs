//! Number of pictures that come while a hand drags, and the delay of the first: counted on the screen, with an event every 50 ms that waits
//! for nothing.
//!
//! `HAIRLINE_SCREENSHOTS=FOLDER cargo test --release --workspace --test window drag -- --ignored --nocapture` prints the figures of both
//! scenes; without the folder, those of the plate.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::{Pos2, vec2};
use hairline_gpu::headless::test_gpu;

use crate::display::{Display, Picture};
use crate::layout::Layout;
use crate::{LARGE_PX, Window, keep};

const BUILT_IN: &str = hairline_console::BUILT_IN;
const PLATE: &str = include_str!("../../../../scenes/plate.toml");

/// Positions of lamps whose handles lie in the picture, but not in its middle, where changes are measured.
const LAMP_IN_PLATE_M: [f64; 3] = [-0.07, 0.07, 0.04];
const LAMP_IN_BUILT_IN_M: [f64; 3] = [-0.1, 0.1, 0.055];

/// Interval between two events of the mouse.
const EVENT: Duration = Duration::from_millis(50);
/// Duration of the drag.
const DURATION: Duration = Duration::from_secs(3);
/// A picture from elsewhere changes more of the area than handles that move over it do.
const TURNED: f64 = 0.02;
/// Least change by other scratches, seen from the same place.
const EDITED: f64 = 0.001;

/// Counts of pictures on the screen.
#[derive(Debug)]
struct SeenPictures {
    pictures: usize,
    first: Option<Duration>,
    longest_pause: Duration,
}

impl SeenPictures {
    fn a_second(&self) -> f64 {
        self.pictures as f64 / DURATION.as_secs_f64()
    }

    fn print(&self, what: &str) {
        println!(
            "{what}: {:.1} pictures a second, the first after {:.0} ms, the longest pause {:.0} ms",
            self.a_second(),
            1e3 * self.first.map_or(f64::NAN, |first| first.as_secs_f64()),
            1e3 * self.longest_pause.as_secs_f64(),
        );
    }
}

/// The middle of the picture, where changes are looked for: to look at all of it would take a tenth of two cores from the program.
struct Watch<'d> {
    display: &'d Display,
    area: egui::Rect,
    last: Picture,
}

impl<'d> Watch<'d> {
    fn new(display: &'d Display, layout: &Layout) -> Self {
        let picture = layout.picture();
        let area = egui::Rect::from_center_size(picture.center(), 0.4 * picture.size());
        Self {
            display,
            area,
            last: display.screenshot(area),
        }
    }

    /// Starts to watch once there is a picture.
    fn first(display: &'d Display, layout: &Layout, window: &Window) -> Self {
        let mut watch = Self::new(display, layout);
        window.wait_for("a picture", || watch.is_lit());
        watch.rest();
        watch
    }

    /// Whether there is a picture, in place of none.
    fn is_lit(&self) -> bool {
        self.display.screenshot(self.area).brightest() > 100
    }

    fn has_changed(&mut self, least: f64) -> bool {
        let now = self.display.screenshot(self.area);
        let has = now.differing(&self.last) as f64 > least * now.pixels() as f64;
        if has {
            self.last = now;
        }
        has
    }

    /// Waits as a hand does between two clicks. The picture becomes finer meanwhile, for minutes.
    fn rest(&mut self) {
        std::thread::sleep(Duration::from_secs(1));
        self.has_changed(0.0);
    }
}

/// Drags to and fro from a point by as much, and watches for changes of such a share of the picture at least.
fn drag(watch: &mut Watch, from: Pos2, reach: egui::Vec2, least: f64) -> SeenPictures {
    let display = watch.display;
    display.press(from);
    // A press alone shows nothing but may change the interface.
    std::thread::sleep(Duration::from_millis(100));
    watch.has_changed(0.0);
    let start = Instant::now();
    let (mut events, mut last) = (0, start);
    let mut seen = SeenPictures {
        pictures: 0,
        first: None,
        longest_pause: Duration::ZERO,
    };
    while start.elapsed() < DURATION {
        if start.elapsed() >= EVENT * events {
            events += 1;
            let along = (events as f32 * EVENT.as_secs_f32() * 1.6).sin();
            display.hurry_to(from + reach * along);
        }
        if watch.has_changed(least) {
            seen.pictures += 1;
            seen.first = seen.first.or(Some(start.elapsed()));
            seen.longest_pause = seen.longest_pause.max(last.elapsed());
            last = Instant::now();
        }
        std::thread::sleep(Duration::from_millis(4));
    }
    seen.longest_pause = seen.longest_pause.max(last.elapsed());
    keep(&display.screen(), "dragging");
    display.release();
    seen
}

#[test]
#[ignore = "long: cargo long"]
fn the_picture_follows_a_hand_that_drags() {
    if test_gpu().is_none() {
        return;
    }
    let Some(display) = crate::display(LARGE_PX) else {
        return;
    };
    // The heavier scene would take another half minute of every test run.
    let scenes = [
        ("plate", PLATE, LAMP_IN_PLATE_M),
        ("built-in scene", BUILT_IN, LAMP_IN_BUILT_IN_M),
    ];
    let count = match std::env::var_os("HAIRLINE_SCREENSHOTS") {
        Some(_) => 2,
        None => 1,
    };
    for (name, text, lamp_m) in scenes.into_iter().take(count) {
        let folder = tempfile::tempdir().unwrap();
        let (layout, window) = open(&display, folder.path(), text);
        let mut watch = Watch::first(&display, &layout, &window);
        let middle = layout.picture().center();
        let turned = drag(&mut watch, middle, vec2(120.0, 40.0), TURNED);
        turned.print(&format!("{name}, the view turns"));
        display.click(layout.layer());
        watch.rest();
        let widened = drag(&mut watch, layout.width(), vec2(40.0, 0.0), EDITED);
        widened.print(&format!("{name}, the width of a layer"));
        drop(window);

        let lamp = format!(
            "\n[[light]]\nname = \"lamp\"\nkind = \"sphere\"\ncenter_m = {lamp_m:?}\nradius_m = 0.004\nradiance = 200.0\n"
        );
        let (layout, window) = open(&display, folder.path(), &(text.to_owned() + &lamp));
        let mut watch = Watch::first(&display, &layout, &window);
        let lamp = layout.lamp().expect("the lamp's handles in the picture");
        assert!(!watch.area.expand(60.0).contains(lamp.handle), "{lamp:?}");
        // The very first click was seen to be lost: this one is for that.
        display.click(layout.layer());
        watch.rest();
        display.click(lamp.line);
        watch.rest();
        let moved = drag(&mut watch, lamp.handle, vec2(30.0, 20.0), EDITED);
        moved.print(&format!("{name}, a handle moves a lamp"));
        // Beside the handle the view would have turned.
        window.is_modified();
        drop(window);
        // A busy machine draws fewer; where each event gives the picture in progress up, none comes.
        assert!(turned.pictures >= 2, "{turned:?}");
        assert!(widened.pictures >= 1, "{widened:?}");
        assert!(moved.pictures >= 1, "{moved:?}");
    }
}

fn open<'d>(display: &'d Display, folder: &Path, text: &str) -> (Layout, Window<'d>) {
    let scene = folder.join("plate.toml");
    std::fs::write(&scene, text).unwrap();
    (
        Layout::new(&scene, display),
        Window::open(display, folder, &scene),
    )
}
