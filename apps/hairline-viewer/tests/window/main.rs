//! The viewer as a person meets it: a real window, on a display without a screen, worked with a mouse and a keyboard. Where
//! things are is asked of the same interface run beside it without a window.
//!
//! Skipped where there is no Xvfb or no graphics driver; `HAIRLINE_REQUIRE_GPU=1` forbids that. With
//! `HAIRLINE_SCREENSHOTS=FOLDER` it leaves what it saw in that folder.

mod display;
mod drag;
mod layout;
mod pictures;

use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use display::{Display, Picture};
use hairline_document::Description;
use hairline_document::description::Layer;
use hairline_gpu::headless::{skip, test_gpu};
use layout::Layout;
use tempfile::TempDir;

/// A small scene, so that pictures come quickly on any machine. The view is oblique: a drag turns it.
const SCENE: &str = r#"
[camera]
position_m = [0.0, -0.21, 0.18]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = 40.0

[[material]]
name = "steel"
kind = "metal"
metal = "steel"

[[object]]
name = "plate"
shape = { disk = { radius_m = 0.08 } }
material = "steel"

[[scratches]]
object = "plate"
pattern = "random"
count = 400
width_um = { mean = 4.0, spread = 0.1 }

[[light]]
kind = "sphere"
center_m = [-0.065, 0.20, 0.24]
radius_m = 0.01
radiance = 300.0

[[light]]
kind = "polygon"
vertices_m = [[-1.0, -1.0, 0.6], [-1.0, 1.0, 0.6], [1.0, 1.0, 0.6], [1.0, -1.0, 0.6]]
radiance = 0.3
two_sided = true
"#;

/// Longest wait: machines that test may be tenfold slower than they were, for minutes.
const PATIENCE: Duration = Duration::from_secs(600);

/// A window as people have it.
const LARGE_PX: [u16; 2] = [1280, 800];
/// The panels at both sides, and a small picture between them: most of the time goes into the pixels of each frame, which a software driver
/// draws.
const SMALL_PX: [u16; 2] = [1000, 480];

/// The program with its window.
struct Window<'d> {
    program: Child,
    display: &'d Display,
    folder: PathBuf,
}

impl<'d> Window<'d> {
    fn open(display: &'d Display, folder: &Path, scene: &Path) -> Self {
        Self::open_with(display, folder, scene, &[])
    }

    fn open_with(display: &'d Display, folder: &Path, scene: &Path, flags: &[&str]) -> Self {
        Self::open_titled(display, folder, scene, flags, "plate.toml · Hairline")
    }

    fn open_titled(
        display: &'d Display,
        folder: &Path,
        scene: &Path,
        flags: &[&str],
        title: &str,
    ) -> Self {
        let program = Command::new(env!("CARGO_BIN_EXE_hairline-viewer"))
            .args(["--backend", "cpu", "--plain-dialogs", "--state-dir"])
            .arg(folder.join("state"))
            .arg(scene)
            .args(flags)
            .env("DISPLAY", display.name())
            .env_remove("WAYLAND_DISPLAY")
            // Settings by which tests of shaders start sooner make the window slow.
            .env_remove("GALLIVM_PERF")
            .env_remove("LP_NATIVE_VECTOR_WIDTH")
            .spawn()
            .unwrap();
        let window = Self {
            program,
            display,
            folder: folder.to_owned(),
        };
        window.wait_for_title(title);
        window.display.focus();
        window
    }

    fn wait_for_title(&self, wanted: &str) {
        self.wait_for(&format!("the title {wanted:?}"), || {
            self.display.title().as_deref() == Some(wanted)
        });
    }

    fn wait_for(&self, what: &str, mut is_there: impl FnMut() -> bool) {
        let start = Instant::now();
        while !is_there() {
            assert!(
                start.elapsed() < PATIENCE,
                "waited in vain for {what}; the title is {:?}",
                self.display.title()
            );
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Saves by the keyboard and reads the saved file.
    fn save(&self) -> Description {
        self.display.keys(&["Control_L", "s"]);
        self.wait_for_title("plate.toml · Hairline");
        let path = self.folder.join("plate.toml");
        let text = std::fs::read_to_string(&path).unwrap();
        Description::from_toml(&text, &path).unwrap()
    }

    fn is_modified(&self) {
        self.wait_for_title("plate.toml • · Hairline");
    }

    /// The picture's area once it does not change any more.
    fn settled(&self, layout: &Layout) -> Picture {
        let area = layout.picture();
        let mut last = self.display.screenshot(area);
        let (start, mut since) = (Instant::now(), Instant::now());
        self.wait_for("a picture that stands still", || {
            let now = self.display.screenshot(area);
            if now.differing(&last) > 0 {
                last = now;
                since = Instant::now();
            }
            // Between two refinements less time passes, on a scene as small as this; and less than they all took so far.
            since.elapsed() > Duration::from_secs(3).max(start.elapsed() / 3)
        });
        last
    }

    fn quit(mut self) {
        self.display.keys(&["Control_L", "q"]);
        let start = Instant::now();
        loop {
            if let Some(status) = self.program.try_wait().unwrap() {
                assert!(status.success(), "{status}");
                return;
            }
            assert!(start.elapsed() < PATIENCE, "it does not quit");
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Drop for Window<'_> {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

/// Writes the picture where a person would look for it afterwards.
fn keep(picture: &Picture, name: &str) {
    if let Some(folder) = std::env::var_os("HAIRLINE_SCREENSHOTS") {
        picture.write(&Path::new(&folder).join(format!("{name}.png")));
    }
}

fn width_um(description: &Description) -> f64 {
    match &description.scratches[0].layer {
        Layer::Laid(laid) => laid.width_um.mean,
        other => panic!("{other:?}"),
    }
}

/// Starts a display; none where there can be none and need not be.
fn display(size_px: [u16; 2]) -> Option<Display> {
    let display = Display::start(size_px);
    if display.is_none() {
        assert!(
            std::env::var_os("HAIRLINE_REQUIRE_GPU").is_none_or(|value| value != "1"),
            "HAIRLINE_REQUIRE_GPU is set, but Xvfb cannot be started"
        );
        skip("Xvfb cannot be started");
    }
    display
}

/// A display and a folder with the scene.
fn prepare(size_px: [u16; 2]) -> Option<(Display, TempDir)> {
    // eframe draws by the same drivers.
    test_gpu()?;
    let display = display(size_px)?;
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("plate.toml"), SCENE).unwrap();
    Some((display, folder))
}

#[test]
fn an_artist_turns_the_view_drags_a_value_undoes_and_saves() {
    let Some((display, folder)) = prepare(SMALL_PX) else {
        return;
    };
    let scene = folder.path().join("plate.toml");
    let before = Description::from_toml(SCENE, &scene).unwrap();
    let layout = Layout::new(&scene, &display);
    let window = Window::open_with(&display, folder.path(), &scene, &["--shadows", "off"]);
    let first = window.settled(&layout);
    assert!(first.brightest() > 100, "the picture is dark");

    // The picture turns while the hand moves on, which waits for none.
    let middle = layout.picture().center();
    display.press(middle);
    let mut angle = 0.0_f32;
    window.wait_for("a picture of the turned view", || {
        for _ in 0..5 {
            angle += 0.1;
            display.hurry_to(middle + 60.0 * angle.sin() * egui::vec2(1.0, 0.2));
            std::thread::sleep(Duration::from_millis(10));
        }
        display.screenshot(layout.picture()).differing(&first) > first.pixels() / 10
    });
    display.release();
    display.keys(&["k"]);
    window.is_modified();
    let turned = window.save();
    assert_ne!(turned.camera.position_m, before.camera.position_m);
    assert_eq!(turned.scratches, before.scratches);

    // A layer is chosen in the outliner, and its width dragged.
    display.click(layout.layer());
    display.drag(&[layout.width(), layout.width() + egui::vec2(30.0, 0.0)]);
    window.is_modified();
    let widened = window.save();
    assert!(width_um(&widened) > width_um(&before));
    assert_eq!(widened.camera, turned.camera);

    display.keys(&["Control_L", "z"]);
    window.is_modified();
    assert_eq!(window.save(), turned);
    window.quit();
}

#[test]
#[ignore = "long: cargo long"]
fn an_artist_opens_turns_changes_draws_undoes_saves_and_comes_back() {
    let Some((display, folder)) = prepare(LARGE_PX) else {
        return;
    };
    let scene = folder.path().join("plate.toml");
    let before = Description::from_toml(SCENE, &scene).unwrap();
    let layout = Layout::new(&scene, &display);
    // Samples that add up settle late.
    let open = || Window::open_with(&display, folder.path(), &scene, &["--shadows", "off"]);
    let window = open();
    let first = window.settled(&layout);
    assert!(first.brightest() > 100, "the picture is dark");
    keep(&display.screen(), "opened");

    // The picture turns under the mouse; a key brings the scene's camera along.
    let middle = layout.picture().center();
    display.drag(&[
        middle,
        middle + egui::vec2(60.0, 10.0),
        middle + egui::vec2(120.0, 20.0),
    ]);
    display.keys(&["k"]);
    window.is_modified();
    let turned = window.save();
    assert_ne!(turned.camera.position_m, before.camera.position_m);
    assert_eq!(turned.scratches, before.scratches);
    let seen = window.settled(&layout);
    assert!(seen.differing(&first) > 1000, "the picture did not turn");

    // A layer is chosen in the outliner, and its width typed.
    display.click(layout.layer());
    display.click(layout.width());
    display.type_text("7.5");
    display.keys(&["Return"]);
    window.is_modified();
    let widened = window.save();
    assert_eq!(width_um(&widened), 7.5);
    assert_eq!(widened.camera, turned.camera);
    keep(&display.screen(), "width");

    // The brush is picked by its key, and a stroke drawn.
    display.move_to(middle);
    display.keys(&["b"]);
    display.drag(&[
        middle + egui::vec2(-60.0, 20.0),
        middle + egui::vec2(-20.0, 0.0),
        middle + egui::vec2(20.0, 10.0),
        middle + egui::vec2(60.0, 30.0),
    ]);
    window.is_modified();
    keep(&display.screen(), "stroke");
    let drawn = window.save();
    let strokes = |d: &Description| d.scratches.iter().map(|s| s.strokes.len()).sum::<usize>();
    assert_eq!(strokes(&drawn), 1, "{:?}", drawn.scratches);

    // Undone, the scene is what it was before the stroke, to the last digit.
    display.keys(&["Control_L", "z"]);
    window.is_modified();
    let undone = window.save();
    assert_eq!(undone, widened);

    // And back: what was saved is what is seen.
    let last = window.settled(&layout);
    window.quit();
    let window = open();
    let reopened = window.settled(&layout);
    keep(&display.screen(), "reopened");
    // The mouse's ring, the selection's lines and dither are the only differences left.
    let share = reopened.differing(&last) as f64 / reopened.pixels() as f64;
    assert!(
        share < 0.05,
        "{share} of the pixels differ after the scene was opened again"
    );
    assert!(
        reopened.differing(&first) > 1000,
        "it shows the scene as it was at first"
    );
    window.quit();
}
