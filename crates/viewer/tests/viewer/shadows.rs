//! Shadows in the window: switched, left out while something moves, added up when it stands.

use crate::common::{self, click_on, viewer_in, wait_built, wait_until};
use crate::export::{save_picture, wait_exported};
use egui::{Key, Modifiers, vec2};
use egui_kittest::{Harness, kittest::Queryable};
use hairline_image::exr_file;
use hairline_scene::Transport;
use hairline_viewer::Viewer;
use hairline_viewer::progressive::Picture;

/// A disk under a lamp, and a smaller one between them.
const SCREENED: &str = r#"
camera = { position_m = [0.0, -0.3, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0], fov_y_deg = 30.0 }
render = { size_px = [48, 32] }
material = [{ name = "steel", kind = "metal", metal = "steel", roughness = 0.4 }]
object = [
    { name = "table", shape = { disk = { radius_m = 0.1 } }, material = "steel" },
    { name = "screen", shape = { disk = { radius_m = 0.03 } }, material = "steel", translation_m = [0.0, 0.1, 0.1] },
]
light = [{ kind = "sphere", center_m = [0.0, 0.3, 0.3], radius_m = 0.02, radiance = 30.0 }]
"#;

/// A small window: each sample is of all its pixels.
fn viewer() -> Harness<'static, Viewer> {
    let options = crate::common::built_in(SCREENED);
    let mut harness = viewer_in(options, [900.0, 300.0], 0.5);
    wait_built(&mut harness);
    harness
}

fn switch_shadows(harness: &mut Harness<'static, Viewer>) {
    harness.key_press_modifiers(Modifiers::SHIFT, Key::S);
    harness.run_steps(2);
}

fn wait_final(harness: &mut Harness<'static, Viewer>, shadows: bool) {
    wait_until(harness, "the final picture", |viewer| {
        let frame = viewer.renderer().latest();
        frame.is_some_and(|frame| {
            frame.painted.is_final && frame.painted.transport.shadows == shadows
        })
    });
}

/// The sum of all codes of the picture in the window.
fn brightness(harness: &Harness<'static, Viewer>) -> u64 {
    let frame = harness.state().renderer().latest().unwrap();
    let Picture::Pixels(pixels) = &frame.picture else {
        panic!("the CPU paints pixels");
    };
    pixels.pixels.iter().map(|pixel| u64::from(pixel.g())).sum()
}

#[test]
fn shadows_add_up_when_nothing_moves_and_begin_anew_when_something_did() {
    let mut harness = viewer();
    wait_final(&mut harness, false);
    let open = brightness(&harness);
    harness.get_by_label("no shadows");
    switch_shadows(&mut harness);
    harness.get_by_label("shadows");
    let painted = |viewer: &Viewer| viewer.renderer().latest().unwrap().painted.clone();
    wait_until(&mut harness, "some samples", |viewer| {
        let painted = painted(viewer);
        painted.of_samples == Some(64) && painted.samples >= 8
    });
    let samples = painted(harness.state()).samples;
    harness.step();
    let told = |harness: &Harness<'static, Viewer>, n: u32| {
        harness
            .query_by_label_contains(&format!("sample {n} of 64"))
            .is_some()
    };
    let newest = painted(harness.state()).samples;
    assert!((samples..=newest).any(|n| told(&harness, n)) || newest == 64);
    wait_final(&mut harness, true);
    assert_eq!(painted(harness.state()).samples, 64);
    let shadowed = brightness(&harness);
    assert!(shadowed < open * 98 / 100, "{shadowed} {open}");

    // A step of the view: without shadows at once, then with them from the first sample on.
    let at = common::picture(&harness).center() + vec2(0.0, 60.0);
    let number = harness.state().renderer().latest().unwrap().number;
    common::press(&mut harness, at);
    common::move_to(&mut harness, at, at + vec2(30.0, 0.0), 2);
    wait_until(&mut harness, "a picture in motion", |viewer| {
        let frame = viewer.renderer().latest().unwrap();
        frame.number > number && frame.painted.transport == Transport::DIRECT
    });
    common::release(&mut harness, at + vec2(30.0, 0.0));
    wait_until(&mut harness, "few samples", |viewer| {
        let painted = painted(viewer);
        painted.of_samples == Some(64) && painted.samples < 64
    });
    switch_shadows(&mut harness);
    wait_final(&mut harness, false);
}

#[test]
fn a_saved_picture_has_the_shadows_and_bounces_of_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = viewer();
    let save = |harness: &mut Harness<'static, Viewer>, name: &str| {
        let path = folder.path().join(name);
        save_picture(harness, &path);
        wait_exported(harness);
        let image = exr_file::read_image(&path).unwrap();
        let sum: f64 = image.base.iter().map(|rgb| f64::from(rgb[1])).sum();
        (sum, image.noise.map(|noise| noise.samples[0]))
    };
    let (open, none) = save(&mut harness, "open.exr");
    switch_shadows(&mut harness);
    let (shadowed, _) = save(&mut harness, "shadowed.exr");
    assert_eq!(none, None);
    assert!(shadowed < 0.98 * open, "{shadowed} {open}");
    // Light goes from the table to the screen and back.
    click_on(&mut harness, "shadows");
    let number = harness.get_by_role_and_label(egui::accesskit::Role::SpinButton, "Bounces");
    number.set_value_accesskit(2.0);
    harness.run_steps(3);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    let (lit, samples) = save(&mut harness, "lit.exr");
    assert!(lit > shadowed, "{lit} {shadowed}");
    assert_eq!(samples, Some(8), "as the last question was answered");
}
