//! A lens: each batch of samples looks through another point of it. Against the circle of confusion, and every point of the lens by chance.

use super::pictures::{LINEAR, compared, sampled};
use super::scenes::{View, plate, scratch, sphere};
use conformance::two_renderers::compare_pixels;
use glam::DVec2;
use hairline_cpu::closed_form::{self, RenderOptions};
use hairline_gpu::{Method, headless};
use hairline_image::{Batch, Batches, Image, Layer};
use hairline_optics::mask::Mask;
use hairline_optics::metal::Metal;
use hairline_scene::{Base, Lens, Scene};
use std::path::Path;

fn options(samples: u32, batch: Batch) -> RenderOptions {
    RenderOptions {
        samples,
        batch: Some(batch),
        mask: Mask::Linear,
        ..RenderOptions::default()
    }
}

/// The closed form through as many points of the lens as there are batches.
fn added_up(scene: &Scene, samples: u32) -> Image {
    let mut batches = Batches::new(samples).unfiltered();
    while let Some(batch) = batches.next() {
        batches.add(closed_form::render(
            scene,
            &options(samples, batch),
            &|_| {},
        ));
    }
    batches.into_image().unwrap()
}

/// Mean distance of the light from the picture's middle, and its standard deviation, along x and y.
fn spread_px(image: &Image) -> [DVec2; 2] {
    let [width, height] = image.size_px;
    let (mut all, mut sum, mut squares) = (0.0, DVec2::ZERO, DVec2::ZERO);
    for (i, rgb) in image.base.iter().enumerate() {
        let i = i as u32;
        let pixel = DVec2::new((i % width).into(), (i / width).into()) + 0.5;
        let from_middle = pixel - 0.5 * DVec2::new(width.into(), height.into());
        let light = f64::from(rgb[1]);
        all += light;
        sum += light * from_middle;
        squares += light * from_middle * from_middle;
    }
    let mean = sum / all;
    let variance = squares / all - mean * mean;
    [mean, DVec2::new(variance.x.sqrt(), variance.y.sqrt())]
}

/// A small lamp at 0.4 m, by a lens 40 mm wide whose focus is at `focus_m`.
fn lamp(focus_m: f64) -> Scene {
    let text = format!(
        "[camera]\nposition_m = [0, 0, 0]\ntarget_m = [0, 0, -1]\nfov_y_deg = 5\naperture_mm = 40\nfocus_distance_m = {focus_m}
        [render]\nsize_px = [48, 48]
        [[material]]\nname = \"black\"\nkind = \"dielectric\"\nior = 1.0\nbase_color = [0, 0, 0]
        [[object]]\nname = \"wall\"\nmaterial = \"black\"\nshape = {{ plane = {{ size_m = [1, 1] }} }}\ntranslation_m = [0, 0, -0.9]
        [[light]]\nkind = \"disk\"\ncenter_m = [0, 0, -0.4]\ntarget_m = [0, 0, 0]\nradius_m = 0.001\nradiance = 1\nvisible = true\n"
    );
    hairline_document::from_toml(&text, "lamp.toml", Path::new("."))
        .unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_lamp_blurs_to_its_circle_of_confusion() {
    let per_px = 2.0 * 2.5f64.to_radians().tan() / 48.0;
    for focus_m in [0.4, 0.5, 0.3] {
        let scene = lamp(focus_m);
        let lamp_px = 0.001 / 0.4 / per_px;
        let circle_px = 0.02 * (0.4 - focus_m).abs() / (0.4 * focus_m) / per_px;
        // The lamp's disk, the circle and the pixel's filter, one over the other.
        let variance = 0.25 * (lamp_px * lamp_px + circle_px * circle_px);
        let filter = scene.render.filter_std_px * scene.render.filter_std_px;
        for (name, image) in [
            ("closed form", added_up(&scene, 256)),
            ("reference", sampled(&scene, LINEAR, 4)),
        ] {
            let [mean, std] = spread_px(&image);
            let expected = (variance + filter).sqrt();
            println!("{name}, focus {focus_m} m: {std} px, {expected} expected");
            assert!(mean.length() < 0.1 * expected, "{name}: {mean}");
            let off = (std / expected - 1.0).abs().max_element();
            assert!(
                off < 0.03,
                "{name}, focus {focus_m} m: {std} px, {expected} expected"
            );
        }
    }
}

/// Scratches before the focus and behind it.
#[test]
fn scratches_out_of_focus() {
    let view = View {
        angle_rad: 0.9,
        pixel_um: 60.0,
        size_px: 24,
    };
    let mut scene = plate(Base::Metal(Metal::Aluminium.into()), view);
    scratch(&mut scene, view, 40);
    let distance_m = scene.camera.position_m.distance(scene.camera.target_m);
    // Blurs what is 1 % nearer than the focus by two pixels to either side.
    scene.camera.lens = Lens {
        radius_m: 200.0 * 60e-6,
        focus_m: 1.01 * distance_m,
    };
    scene.lights = vec![sphere(view, 0.06, -0.05, 0.08)];
    let reference = sampled(&scene, LINEAR, 4);
    let blurred = compared(
        "blurred",
        &added_up(&scene, 512),
        &reference,
        Layer::Scratches,
    );
    let [at_least, _] = blurred.beyond.relative_rms_within(2.0);
    assert!(at_least < 0.03, "{blurred:?}");
    let batch = Batch {
        first: 20,
        count: 4,
    };
    let one = closed_form::render(&scene, &options(64, batch), &|_| {});
    let sharp = compared("through one point", &one, &reference, Layer::Scratches);
    assert!(sharp.rms().0 > 0.1, "{sharp:?}");
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let on_gpu = hairline_gpu::RenderOptions {
        samples: 64,
        batch: Some(batch),
        without_shadows: true,
        ..Default::default()
    };
    let method = Method {
        mask: options(64, batch).mask,
        ..Method::default()
    };
    let gpu = headless::render(gpu, &scene, &method, &on_gpu, &|_| {}).unwrap();
    compare_pixels("through one point", &gpu, &one, None).unwrap();
}
