//! The reference beside the picture: it agrees with it, follows it, and ends when it is closed.

use crate::common;

use std::time::{Duration, Instant};

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::{Harness, kittest::Queryable};
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_image::{Image, Layer};
use hairline_index::{Pieces, Watch};
use hairline_viewer::progressive::Backend;
use hairline_viewer::{Figures, LayerFigures, Options, Viewer};

/// A window whose panels leave little room for the picture, with few pixels, so that samples come soon.
fn viewer(scene: &'static str) -> Harness<'static, Viewer> {
    let options = Options {
        scene: None,
        built_in: scene,
        backend: Backend::Cpu,
        state_dir: None,
        native_dialogs: false,
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
    };
    let mut harness = common::viewer_in(options, [640.0, 400.0], 0.5);
    common::wait_built(&mut harness);
    common::wait_until(&mut harness, "a picture", |viewer| {
        viewer.renderer().latest().is_some()
    });
    harness
}

/// Figures of pixels that have two batches of samples each, at least.
fn sampled(harness: &mut Harness<'static, Viewer>) -> Figures {
    common::wait_until(harness, "two batches", |viewer| {
        let figures = viewer.comparison();
        figures.is_some_and(|figures| figures.beauty.reference_mean_error.is_some())
    });
    harness.state().comparison().unwrap()
}

fn mean(image: &Image, layer: Layer) -> f64 {
    let values = image.layer(layer);
    let sum: f64 = values.iter().flatten().map(|&v| f64::from(v)).sum();
    sum / (3 * values.len()) as f64
}

/// Whether noise, and the part that the closed form is off by at most where nothing is wrong, explain the difference.
fn agrees(figures: &LayerFigures, mean: f64, share: f64) -> bool {
    let noise = figures.reference_mean_error.unwrap();
    (mean - figures.reference_mean).abs() < 4.0 * noise + share * mean
}

fn rendered(text: &str, size_px: [u32; 2]) -> Image {
    let mut scene = hairline_document::from_toml(text, "test", "").unwrap();
    scene.render.size_px = size_px;
    let options = RenderOptions {
        samples: 16,
        ..RenderOptions::default()
    };
    let near = Prepared::watched(&scene, Pieces::Near, &Watch::default());
    near.unwrap().render(&options, &|_| {})
}

#[test]
fn a_scene_agrees_with_its_reference_and_another_scene_does_not() {
    agrees_and_another_does_not(common::SMALL);
}

#[test]
#[ignore = "long: cargo long"]
fn the_built_in_scene_agrees_with_its_reference_and_another_scene_does_not() {
    agrees_and_another_does_not(common::thinned(340));
}

fn agrees_and_another_does_not(text: &'static str) {
    let mut harness = viewer(text);
    common::key(&mut harness, Key::C);
    // Until noise is a small part of what is to be seen.
    common::wait_until(&mut harness, "little noise", |viewer| {
        let scratches = viewer.comparison().map(|figures| figures.scratches);
        scratches.is_some_and(|scratches| {
            let noise = scratches.reference_mean_error;
            noise.is_some_and(|noise| noise < 0.06 * scratches.reference_mean)
        })
    });
    let figures = sampled(&mut harness);
    let (beauty, scratches) = (figures.beauty, figures.scratches);
    // In a picture of so few pixels the lamps' images are smaller than one, and the base looks from one place in each.
    assert!(agrees(&beauty, beauty.mean, 0.15), "{figures:?}");
    // The closed form is within a few percent of the integral where scratches are many.
    assert!(agrees(&scratches, scratches.mean, 0.03), "{figures:?}");
    // The comparison's picture is the renderer's, of the arcs that the window has at another size.
    let right = rendered(text, figures.size_px);
    let off = mean(&right, Layer::Scratches) / scratches.mean - 1.0;
    assert!(off.abs() < 2e-3, "{off}");

    // Grooves half as deep scatter less.
    let shallow = text
        .replace("depth_nm = { mean = 180.0", "depth_nm = { mean = 90.0")
        .replace("depth_nm = { mean = 95.0", "depth_nm = { mean = 47.5");
    assert_ne!(shallow, text);
    let wrong = mean(&rendered(&shallow, figures.size_px), Layer::Scratches);
    assert!(!agrees(&scratches, wrong, 0.03), "{wrong} {figures:?}");
}

#[test]
fn another_view_begins_anew() {
    let mut harness = viewer(common::SMALL);
    common::key(&mut harness, Key::C);
    let before = sampled(&mut harness);
    common::key(&mut harness, Key::Num5);
    assert_eq!(
        harness.state().comparison(),
        None,
        "not that of another view"
    );
    let after = sampled(&mut harness);
    assert_ne!(before.scratches.mean, after.scratches.mean);
    // In a picture of so few pixels the lamp's image is as small as one, and the base has one ray for each.
    assert!(agrees(&after.beauty, after.beauty.mean, 0.06), "{after:?}");
}

#[test]
fn closing_it_stops_the_thread() {
    let mut harness = viewer(common::SMALL);
    common::key(&mut harness, Key::C);
    common::wait_until(&mut harness, "samples", |viewer| {
        viewer.comparison().is_some()
    });
    assert!(harness.state().is_sampling());
    let asked = Instant::now();
    common::click_on(&mut harness, "Close the comparison");
    common::wait_until(&mut harness, "the end", |viewer| !viewer.is_sampling());
    // A batch takes milliseconds; the rest is for a machine that stands still now and then. All samples take minutes.
    assert!(
        asked.elapsed() < Duration::from_secs(20),
        "{:?}",
        asked.elapsed()
    );
    assert_eq!(harness.state().comparison(), None);
    assert!(harness.query_by_label("Close the comparison").is_none());
}

#[test]
fn buttons_stay_where_they_are_when_figures_come() {
    let mut harness = viewer(common::SMALL);
    common::key(&mut harness, Key::C);
    let names = ["Reference", "Error map", "Close the comparison"];
    let places = |harness: &Harness<'static, Viewer>| {
        names.map(|name| harness.get_by_role_and_label(Role::Button, name).rect())
    };
    let before = places(&harness);
    assert!(harness.query_by_label("relative rms").is_none());
    sampled(&mut harness);
    harness.step();
    assert!(harness.query_by_label("relative rms").is_some());
    assert_eq!(places(&harness), before);
}

#[test]
fn the_divider_can_be_dragged_and_moved_by_keys() {
    const DIVIDER: &str = "Divider between picture and reference";
    let mut harness = viewer(common::SMALL);
    common::key(&mut harness, Key::C);
    let camera = common::description(&harness).camera.clone();
    let at = |harness: &Harness<'static, Viewer>| harness.get_by_label(DIVIDER).rect().center();
    let middle = at(&harness);
    common::drag(&mut harness, middle, middle + egui::vec2(-30.0, 5.0), 6);
    harness.run_steps(2);
    let dragged = at(&harness);
    assert!(
        (dragged.x - (middle.x - 30.0)).abs() < 2.0,
        "{dragged} from {middle}"
    );
    harness.get_by_label(DIVIDER).increment_accesskit();
    harness.run_steps(2);
    assert!(at(&harness).x > dragged.x);
    assert_eq!(
        common::description(&harness).camera,
        camera,
        "the view stays"
    );
}

#[test]
fn the_error_map_has_a_scale() {
    let mut harness = viewer(common::SMALL);
    common::key(&mut harness, Key::C);
    common::wait_until(&mut harness, "samples", |viewer| {
        viewer.comparison().is_some()
    });
    common::click_on(&mut harness, "Error map");
    let scale = harness.get_by_label_contains("Relative error from");
    assert!(scale.rect().is_positive());
}
