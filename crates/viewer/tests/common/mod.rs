//! The window without a screen, for the tests of the viewer. A test file uses some of it.
#![allow(dead_code)]

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{PointerButton, Pos2, Rect};
use egui_kittest::{Harness, kittest::Queryable};
use hairline_document::Description;
use hairline_document::description::Light;
use hairline_fixtures::SceneFile;
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Options, Viewer};

/// The scene of `hairline view` without a file.
pub const BUILT_IN: &str = include_str!("../../../../crates/console/src/built_in_scene.toml");

/// The built-in scene with fewer scratches in each layer: from afar each pixel sees thousands of them, which takes the closed form
/// long.
pub fn thinned(count: u32) -> &'static str {
    let text = BUILT_IN.replace("count = 3400", &format!("count = {count}"));
    assert_ne!(text, BUILT_IN);
    text.leak()
}

/// A disk with a few scratches, a lamp and a square light, all in the picture; small enough to be built at once.
pub const SMALL: &str = include_str!("small_scene.toml");

/// The disk of the small scene under one lamp: a software driver compiles shaders for seconds, for less the less a scene has.
pub fn bare_disk() -> SceneFile {
    SceneFile::seen_from([0.0, -0.5, 0.3])
        .looking_at([0.0, 0.0, 0.03])
        .fov_y_deg(30.0)
        .metal("steel", "steel")
        .with_lines("roughness = 0.1")
        .object("disk", "steel", "disk = { radius_m = 0.1 }")
        .sphere([-0.06, 0.03, 0.1], 0.01, 50.0)
}

/// Something of each kind that a panel changes; slow to render.
pub const FULL: &str = include_str!("full_scene.toml");

/// No test waits longer than this for another thread: machines that test may be tenfold slower than they were, for minutes.
const PATIENCE: Duration = Duration::from_secs(600);

/// Pixels of a picture that few tests look at: painting it in the background takes most of the time of many others.
const FEW_PIXELS_PER_POINT: f32 = 0.25;

/// Time between two passes while a test waits: a pass takes some milliseconds itself.
const PAUSE: Duration = Duration::from_millis(10);

/// The window with the scene of that text, 1280 by 800 points of few pixels, painted by the CPU, after its first pass. Nothing is
/// read or written outside.
pub fn viewer(scene: &'static str) -> Harness<'static, Viewer> {
    viewer_with(built_in(scene))
}

/// Viewer with other options.
pub fn viewer_with(options: Options) -> Harness<'static, Viewer> {
    viewer_in(options, [1280.0, 800.0], FEW_PIXELS_PER_POINT)
}

/// A scene's file, on the CPU, once it is built.
pub fn viewer_of_file(scene: &std::path::Path) -> Harness<'static, Viewer> {
    let mut harness = viewer_of_any_file(scene);
    wait_built(&mut harness);
    harness
}

/// A scene's file, on the CPU, which may make no scene.
pub fn viewer_of_any_file(scene: &std::path::Path) -> Harness<'static, Viewer> {
    viewer_with(Options {
        scene: Some(scene.to_owned()),
        ..built_in(SMALL)
    })
}

/// Viewer in another size, with a pixel for each point.
pub fn viewer_of(options: Options, size: [f32; 2]) -> Harness<'static, Viewer> {
    viewer_in(options, size, 1.0)
}

/// Settings of a viewer that opens this text, renders it on the CPU without rays, and keeps nothing.
pub fn built_in(text: &'static str) -> Options {
    Options {
        scene: None,
        built_in: text,
        backend: Backend::Cpu,
        state_dir: None,
        native_dialogs: false,
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
    }
}

/// Viewer in another size, with pixels of another size.
pub fn viewer_in(
    options: Options,
    size: [f32; 2],
    pixels_per_point: f32,
) -> Harness<'static, Viewer> {
    Harness::builder()
        .with_size(size)
        .with_pixels_per_point(pixels_per_point)
        .build_eframe(|cc| {
            Viewer::new(&cc.egui_ctx, None, options).expect("the test's scene is good")
        })
}

/// Passes until `is_done`.
pub fn wait_until(
    harness: &mut Harness<'static, Viewer>,
    what: &str,
    is_done: impl Fn(&Viewer) -> bool,
) {
    let start = Instant::now();
    loop {
        harness.step();
        if is_done(harness.state()) {
            return;
        }
        assert!(start.elapsed() < PATIENCE, "{what}: not in {PATIENCE:?}");
        std::thread::sleep(PAUSE);
    }
}

/// Passes until the window shows a text that contains these words.
pub fn wait_for_text(harness: &mut Harness<'static, Viewer>, words: &'static str) {
    let start = Instant::now();
    while harness.query_by_label_contains(words).is_none() {
        assert!(start.elapsed() < PATIENCE, "{words}: not in {PATIENCE:?}");
        std::thread::sleep(PAUSE);
        harness.step();
    }
}

/// Passes until the newest description is built.
pub fn wait_built(harness: &mut Harness<'static, Viewer>) {
    wait_until(harness, "the scene is built", |viewer| {
        let renderer = viewer.renderer();
        !renderer.is_building()
            && renderer.built().is_some_and(|built| {
                built.description.objects == viewer.document().description().objects
            })
    });
    // Time for picking and gizmos to show the new state.
    harness.run_steps(2);
}

/// The current description of the scene.
pub fn description(harness: &Harness<'static, Viewer>) -> Arc<Description> {
    Arc::clone(harness.state().document().description())
}

/// The current state of light `i`.
pub fn light(harness: &Harness<'static, Viewer>, i: usize) -> Light {
    description(harness).lights[i].clone()
}

/// Rectangle of the picture.
pub fn picture(harness: &Harness<'static, Viewer>) -> Rect {
    harness.get_by_role_and_label(Role::Image, "Picture").rect()
}

/// Clicks on the widget with this label, as soon as it exists and has stopped moving: news of another thread is shown a
/// pass later, and may push the widget to another place.
pub fn click_on(harness: &mut Harness<'static, Viewer>, label: &str) {
    let start = Instant::now();
    let place =
        |harness: &Harness<'static, Viewer>| harness.query_by_label(label).map(|it| it.rect());
    loop {
        let before = place(harness);
        harness.step();
        if before.is_some() && place(harness) == before || start.elapsed() > PATIENCE {
            break;
        }
        std::thread::sleep(PAUSE);
    }
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// Presses and releases a key.
pub fn key(harness: &mut Harness<'static, Viewer>, key: egui::Key) {
    harness.key_press(key);
    harness.run_steps(2);
}

/// One step back.
pub fn undo(harness: &mut Harness<'static, Viewer>) {
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(2);
}

/// The pointer comes to a place, and a button goes down there.
pub fn press(harness: &mut Harness<'static, Viewer>, at: Pos2) {
    harness.hover_at(at);
    harness.run_steps(2);
    button(harness, at, true);
}

/// The button goes up.
pub fn release(harness: &mut Harness<'static, Viewer>, at: Pos2) {
    button(harness, at, false);
    harness.step();
}

/// Moves the pointer on a straight way, a pass for each step.
pub fn move_to(harness: &mut Harness<'static, Viewer>, from: Pos2, to: Pos2, steps: usize) {
    for i in 1..=steps {
        harness.hover_at(from.lerp(to, i as f32 / steps as f32));
        harness.step();
    }
}

/// Drags with the left button, in so many moves.
pub fn drag(harness: &mut Harness<'static, Viewer>, from: Pos2, to: Pos2, steps: usize) {
    press(harness, from);
    move_to(harness, from, to, steps);
    release(harness, to);
}

/// A click of the left button.
pub fn click_at(harness: &mut Harness<'static, Viewer>, at: Pos2) {
    press(harness, at);
    release(harness, at);
}

/// Two clicks in one pass: passes of tests are a quarter of a second apart, too slow for a double click.
pub fn double_click_at(harness: &mut Harness<'static, Viewer>, at: Pos2) {
    harness.hover_at(at);
    harness.run_steps(2);
    for pressed in [true, false, true, false] {
        let event = button_event(at, pressed);
        harness.input_mut().events.push(event);
    }
    harness.step();
}

fn button(harness: &mut Harness<'static, Viewer>, pos: Pos2, pressed: bool) {
    harness.event(button_event(pos, pressed));
    harness.step();
}

/// An event of the left button.
pub fn button_event(pos: Pos2, pressed: bool) -> egui::Event {
    egui::Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::NONE,
    }
}

/// Clicks with the right button.
pub fn right_click(harness: &mut Harness<'static, Viewer>, at: Pos2) {
    harness.hover_at(at);
    harness.run_steps(2);
    for pressed in [true, false] {
        harness.event(egui::Event::PointerButton {
            pos: at,
            button: egui::PointerButton::Secondary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        });
        harness.step();
    }
    harness.run_steps(2);
}
