//! Reading the picture: the probe, the histogram, false colour, layers and the exposure of the window.

use crate::common::{self, SMALL, click_at, viewer_in, wait_built, wait_until};
use egui::{Key, Modifiers, Pos2, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hairline_gpu::headless::test_gpu;
use hairline_viewer::progressive::{Backend, Frame, Picture};
use hairline_viewer::reading::{Reading, Shows};
use hairline_viewer::{Options, Viewer};
use std::sync::Arc;

const LARGE: [f32; 2] = [1280.0, 800.0];
/// Few pixels are soon finished.
const PIXELS_PER_POINT: f32 = 0.5;

fn viewer(scene: &'static str, backend: Backend, size: [f32; 2]) -> Harness<'static, Viewer> {
    let options = Options {
        scene: None,
        built_in: scene,
        backend,
        state_dir: None,
        native_dialogs: false,
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
    };
    let mut harness = viewer_in(options, size, PIXELS_PER_POINT);
    wait_built(&mut harness);
    harness
}

fn key(harness: &mut Harness<'static, Viewer>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(2);
}

/// The finished picture of the current view.
fn finished(harness: &mut Harness<'static, Viewer>) -> Arc<Frame> {
    wait_until(harness, "a finished picture", |viewer| {
        let frame = viewer.renderer().latest();
        frame.is_some_and(|frame| frame.painted.is_final && Some(frame.view) == viewer.view())
    });
    harness.state().renderer().latest().unwrap()
}

fn pixels(frame: &Frame) -> &egui::ColorImage {
    match &frame.picture {
        Picture::Pixels(pixels) => pixels,
        Picture::Texture(_) => panic!("the picture is in main memory"),
    }
}

/// Reading of the probe at a place.
fn read(harness: &mut Harness<'static, Viewer>, at: Pos2) -> Reading {
    harness.hover_at(at);
    let picture = common::picture(harness);
    let within = (at - picture.min) * PIXELS_PER_POINT;
    wait_until(harness, "the probe", |viewer| {
        // The picture's sides are no whole points.
        let is_there = |reading: Reading| {
            let [x, y] = reading.at_px.map(|at| at as f32 + 0.5);
            (x - within.x).abs() <= 1.5 && (y - within.y).abs() <= 1.5
        };
        viewer.probed().is_some_and(is_there)
    });
    harness.state().probed().unwrap()
}

#[test]
fn the_probe_reads_the_pixel_that_the_picture_shows() {
    let mut harness = viewer(SMALL, Backend::Cpu, LARGE);
    let frame = finished(&mut harness);
    key(&mut harness, Modifiers::NONE, Key::I);
    let middle = common::picture(&harness).center();
    let mut scratched = 0;
    for offset in [vec2(-30.0, 60.0), vec2(-97.0, 61.0), vec2(-80.0, 40.0)] {
        let reading = read(&mut harness, middle + offset);
        let under = reading.under.as_ref().expect("the disk");
        assert_eq!((&*under.object, &*under.material), ("disk", "steel"));
        let [x, y] = reading.at_px.map(|at| at as usize);
        let shown = pixels(&frame)[(x, y)];
        for (read, shown) in reading
            .codes(&frame.view.display)
            .iter()
            .zip(shown.to_array())
        {
            // The picture is dithered.
            assert!(read.abs_diff(shown) <= 1, "{reading:?} {shown}");
        }
        assert!(
            reading.depth_m > 0.1 && reading.normal[2] > 0.9,
            "{reading:?}"
        );
        assert_eq!(
            under.layers.is_empty(),
            reading.segments == 0.0,
            "{reading:?}"
        );
        scratched += u32::from(under.layers == ["turned"]);
    }
    assert!(scratched > 0);
    // The value of a row stands beside its name.
    harness.run_steps(2);
    let row = harness.get_by_label("Layers").rect();
    let beside = |rect: &Rect| rect.left() > row.right() && row.y_range().contains(rect.center().y);
    let told = harness.query_all_by_label("turned");
    let mut told = told.map(|words| words.rect()).collect::<Vec<_>>();
    told.retain(beside);
    let told = told[0];
    assert!((told.center().y - row.center().y).abs() < 1.0, "{told:?}");
    // Beside the disk there is nothing.
    let corner = common::picture(&harness).left_bottom() + vec2(20.0, -20.0);
    assert_eq!(read(&mut harness, corner).under, None);
    // A click keeps a pixel, and selects nothing.
    let kept = read(&mut harness, middle + vec2(-30.0, 60.0));
    click_at(&mut harness, middle + vec2(-30.0, 60.0));
    harness.hover_at(corner);
    harness.run_steps(20);
    assert_eq!(harness.state().probed(), Some(kept));
    harness.get_by_label("Follow the pointer");
    let selection = harness.state().document().selection();
    assert_eq!(selection, hairline_editor::Selection::None);
    common::key(&mut harness, Key::Escape);
    assert!(harness.query_by_label("Follow the pointer").is_none());
    assert_eq!(read(&mut harness, corner).under, None);
}

#[test]
fn the_histogram_counts_the_scenes_picture() {
    let mut harness = viewer(SMALL, Backend::Cpu, LARGE);
    key(&mut harness, Modifiers::NONE, Key::G);
    let frame = finished(&mut harness);
    let histogram = frame.findings.histogram.as_ref().expect("a histogram");
    let [width, height] = frame.view.reading.histogram_px.unwrap();
    assert_eq!(histogram.pixels, width * height);
    assert!(width * height <= frame.view.size_px.iter().product());
    // A disk before a black background.
    assert!(
        (0.1..0.95).contains(&histogram.unlit),
        "{}",
        histogram.unlit
    );
    let lit = histogram.bins.iter().map(|bin| bin[0]).sum::<u32>();
    let unlit = (histogram.unlit * f64::from(histogram.pixels)).round() as u32;
    assert!(lit + unlit <= histogram.pixels + 1 && lit > 1000);
    harness.get_by_label_contains("without light");
    key(&mut harness, Modifiers::NONE, Key::G);
    assert_eq!(finished(&mut harness).findings.histogram, None);
}

#[test]
fn layers_and_exposure_are_shown_and_the_scene_stays() {
    let mut harness = viewer(SMALL, Backend::Cpu, LARGE);
    let before = common::description(&harness);
    let beauty = finished(&mut harness);
    let at = {
        let middle = common::picture(&harness).size() * 0.5 + vec2(0.0, 60.0);
        let [x, y] = <[f32; 2]>::from(middle * PIXELS_PER_POINT).map(|at| at as usize);
        (x, y)
    };
    let mut seen = vec![pixels(&beauty)[at]];
    for shows in &Shows::ALL[1..] {
        key(&mut harness, Modifiers::NONE, Key::N);
        let frame = finished(&mut harness);
        assert_eq!(frame.view.reading.shows, *shows);
        harness.get_by_label(shows.name());
        // The disk's normal points up.
        if *shows == Shows::Normal {
            assert_eq!(pixels(&frame)[at], egui::Color32::from_rgb(128, 128, 255));
        }
        seen.push(pixels(&frame)[at]);
    }
    seen.sort_by_key(|color| color.to_array());
    seen.dedup();
    // The picture is the base where no scratch is lit.
    assert!(seen.len() >= 5, "{seen:?}");
    common::click_on(&mut harness, "Back to the picture");
    key(&mut harness, Modifiers::NONE, Key::X);
    assert_eq!(finished(&mut harness).view.reading.shows, Shows::FalseColor);
    key(&mut harness, Modifiers::NONE, Key::X);
    for _ in 0..4 {
        key(&mut harness, Modifiers::NONE, Key::Period);
    }
    let brighter = finished(&mut harness);
    assert_eq!(brighter.view.display.exposure_ev, 1.0);
    assert!(pixels(&brighter)[at].g() > pixels(&beauty)[at].g());
    harness.get_by_label("Exposure +1 EV");
    key(&mut harness, Modifiers::NONE, Key::Comma);
    assert_eq!(finished(&mut harness).view.display.exposure_ev, 0.75);
    key(&mut harness, Modifiers::SHIFT, Key::Comma);
    assert_eq!(finished(&mut harness).view.display.exposure_ev, 0.0);
    assert_eq!(*common::description(&harness), *before);
    assert!(!harness.state().document().is_modified());
}

/// The layers are read back from a device.
#[test]
fn layers_of_a_device_are_those_of_the_cpu() {
    let Some(gpu) = test_gpu() else { return };
    let scene: &str = common::bare_disk().to_string().leak();
    let mut pictures = [Backend::Cpu, Backend::Gpu(gpu.clone())].map(|backend| {
        let mut harness = viewer(scene, backend, [760.0, 240.0]);
        key(&mut harness, Modifiers::NONE, Key::G);
        for _ in 0..6 {
            key(&mut harness, Modifiers::NONE, Key::N);
        }
        finished(&mut harness)
    });
    pictures.sort_by_key(|frame| frame.number);
    let [a, b] = &pictures;
    assert_eq!(a.view.reading.shows, Shows::Depth);
    let [near, far] = a.findings.depths_m.unwrap();
    let [other_near, other_far] = b.findings.depths_m.unwrap();
    assert!((near - other_near).abs() + (far - other_far).abs() < 1e-3);
    let differing = std::iter::zip(&pixels(a).pixels, &pixels(b).pixels);
    let differing = differing.filter(|(a, b)| a.r().abs_diff(b.r()) > 1).count();
    assert!(differing < 20, "{differing} pixels differ");
    let [a, b] = [a, b].map(|frame| frame.findings.histogram.as_ref().unwrap());
    assert_eq!(a.pixels, b.pixels);
    assert!((a.unlit - b.unlit).abs() < 0.01);
}
