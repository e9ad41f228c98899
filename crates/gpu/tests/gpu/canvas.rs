//! A picture that comes together in bands is the rendered one, at any size, and looks right at any moment.

use std::future::Future;
use std::pin::pin;
use std::task::{Context, Waker};

use crate::common::{BUILT_IN, Stage, default_limits, options, plates, scene};
use hairline_gpu::headless::test_gpu;
use hairline_gpu::{Canvas, Error, Gpu, RenderOptions, steps};
use hairline_image::tone_map::{display_code, dither_offset};
use hairline_image::{Batch, Display, Image, ToneMap, filter_traced};

const DISPLAY: Display = Display {
    exposure_ev: 0.0,
    tone_map: ToneMap::None,
};

/// Renders in bands of the same rows, since a rasteriser may round an edge differently where a band begins
/// elsewhere.
fn rendered(stage: &mut Stage, size_px: [u32; 2], samples: u32, submission_px: u32) -> Image {
    let mut scene = stage.made.scene.clone();
    scene.render.size_px = size_px;
    let options = RenderOptions {
        samples,
        submission_px,
        ..Default::default()
    };
    let picture = stage
        .renderer
        .render(&scene, &stage.uploaded, &options, &|_| {});
    stage.gpu.block_on(picture).unwrap()
}

fn image(canvas: &Canvas, gpu: &Gpu) -> Image {
    gpu.block_on(canvas.image()).unwrap()
}

/// Pixels of the size that they have in a picture of 64 rows: else a few rows would each see all scratches.
fn look_through(stage: &mut Stage, rows: u32) {
    stage.made.scene.camera.fov_y_rad = 0.1 * f64::from(rows) / 64.0;
}

#[test]
fn a_canvas_of_any_size_becomes_the_rendered_picture() {
    let Some(gpu) = test_gpu() else { return };
    let mut stage = Stage::new(gpu, plates().scene());
    for (size_px, submission_px, bands) in [
        ([97, 64], 7 * 97 + 5, 8),
        ([64, 96], 1 << 18, 1),
        ([33, 13], 1, 2),
        ([1, 17], 4, 3),
        ([1, 1], 64, 1),
    ] {
        look_through(&mut stage, size_px[1]);
        let mut canvas = stage.canvas(size_px, submission_px);
        assert_eq!((canvas.size_px(), canvas.bands()), (size_px, bands));
        stage.paint(&mut canvas, steps(3), 3);
        let expected = rendered(&mut stage, size_px, 3, submission_px);
        // The same commands in the same order: not a digit differs.
        assert!(image(&canvas, gpu) == expected, "{size_px:?}");
    }
}

/// The host adds the batches up: each is to be the one that it renders without a canvas.
#[test]
fn a_canvas_holds_a_batch_of_samples_by_itself() {
    const SAMPLES: u32 = 12;
    let Some(gpu) = test_gpu() else { return };
    let mut stage = Stage::new(gpu, plates().scene());
    let Stage {
        renderer,
        made,
        uploaded,
        ..
    } = &mut stage;
    gpu.block_on(renderer.add_shadows(uploaded, &made.scene, 1))
        .unwrap();
    let mut canvas = gpu.block_on(renderer.canvas([97, 64], 40 * 97)).unwrap();
    let mut parts = Vec::new();
    for batch in Batch::split(SAMPLES) {
        let options = RenderOptions {
            batch: Some(batch),
            submission_px: 40 * 97,
            ..options(SAMPLES)
        };
        for band in 0..canvas.bands() {
            for step in 0..steps(batch.count) {
                let scene = &made.scene;
                let added = renderer.accumulate(scene, uploaded, &mut canvas, band, step, &options);
                gpu.block_on(added).unwrap();
            }
        }
        let settled = renderer.settle(&made.scene, uploaded, &mut canvas, &options);
        gpu.block_on(settled).unwrap();
        let part = renderer.render(&made.scene, uploaded, &options, &|_| {});
        let part = gpu.block_on(part).unwrap();
        assert_eq!(image(&canvas, gpu), part, "{batch:?}");
        parts.push(part);
    }
    let pixels = std::iter::zip(&parts[0].base, &parts[1].base);
    let penumbra = pixels.filter(|(a, b)| a != b).count();
    assert!(penumbra > 50, "each batch has its own rays: {penumbra}");
}

/// A canvas shows the result of the host's filter, across bands.
#[test]
fn a_canvas_is_shown_as_the_host_filters_it() {
    let Some(gpu) = test_gpu() else { return };
    let mut stage = Stage::new(gpu, plates().scene());
    let Stage {
        renderer,
        made,
        uploaded,
        ..
    } = &mut stage;
    gpu.block_on(renderer.add_shadows(uploaded, &made.scene, 1))
        .unwrap();
    let mut canvas = gpu.block_on(renderer.canvas([97, 64], 40 * 97)).unwrap();
    for samples in [1, 4] {
        let options = options(samples);
        for band in 0..canvas.bands() {
            for step in 0..steps(samples) {
                let scene = &made.scene;
                let added = renderer.accumulate(scene, uploaded, &mut canvas, band, step, &options);
                gpu.block_on(added).unwrap();
            }
        }
        let settled = renderer.settle(&made.scene, uploaded, &mut canvas, &options);
        gpu.block_on(settled).unwrap();
        let raw = image(&canvas, gpu);
        let mut filtered = raw.clone();
        filter_traced(&mut filtered);
        let shown = gpu
            .block_on(renderer.read_shown(&canvas, &DISPLAY))
            .unwrap();
        let off = |image: &Image| {
            let beauty = image.beauty();
            let squares = (0..64 * 97usize).map(|i| {
                let (x, y) = ((i % 97) as u32, (i / 97) as u32);
                let code = DISPLAY.apply(beauty.pixel(x, y))[1];
                let code = f64::from(display_code(code, dither_offset(x, y)));
                (code - f64::from(shown[4 * i + 1])).powi(2)
            });
            (squares.sum::<f64>() / (64.0 * 97.0)).sqrt()
        };
        let (of_filtered, of_raw) = (off(&filtered), off(&raw));
        println!("{samples}: {of_filtered} codes, {of_raw} without the filter");
        // Rounding to codes; where noise decides what is averaged, single precision may tip it.
        assert!(of_filtered < 0.5, "{of_filtered}");
        assert!(of_raw > 4.0 * of_filtered, "{of_raw}");
        // Showing changes nothing of what was found.
        assert!(image(&canvas, gpu) == raw);
    }
}

fn mean(image: &Image, rows: std::ops::Range<u32>) -> f64 {
    let (first, end) = (image.index(0, rows.start), rows.end * image.size_px[0]);
    let beauty = image.beauty();
    let pixels = &beauty.rgb[first..end as usize];
    pixels.iter().map(|rgb| f64::from(rgb[1])).sum::<f64>() / pixels.len() as f64
}

/// A few samples of many are as bright as all of them, in memory and on the display, band by band.
#[test]
fn bands_with_fewer_samples_are_exposed_alike() {
    let Some(gpu) = test_gpu() else { return };
    let mut stage = Stage::new(gpu, plates().scene());
    let mut canvas = stage.canvas([97, 64], 16 * 97);
    stage.paint(&mut canvas, 1, 32);
    for band in [1, 3] {
        stage.accumulate(&mut canvas, band, 1, 32).unwrap();
    }
    let done: Vec<u32> = (0..4).map(|band| canvas.steps(band)).collect();
    assert_eq!(done, [1, 2, 1, 2]);
    let few = image(&canvas, gpu);
    let few_shown = gpu
        .block_on(stage.renderer.read_shown(&canvas, &DISPLAY))
        .unwrap();
    stage.paint(&mut canvas, steps(32), 32);
    let all = image(&canvas, gpu);
    let all_shown = gpu
        .block_on(stage.renderer.read_shown(&canvas, &DISPLAY))
        .unwrap();
    for band in 0..canvas.bands() {
        let [few, all] = [&few, &all].map(|image| mean(image, canvas.rows(band)));
        // Only pixels on edges have more to come.
        assert!((few / all - 1.0).abs() < 0.03, "{band}: {few}, not {all}");
    }
    let [few, all] = [few_shown, all_shown].map(|shown| {
        assert_eq!(shown.len(), 4 * 97 * 64);
        shown.iter().map(|code| f64::from(*code)).sum::<f64>() / shown.len() as f64
    });
    assert!((few - all).abs() < 1.0, "{few}, not {all} of 255");
}

/// Nothing of an earlier view is left, whether that was complete or not.
#[test]
fn an_interrupted_view_leaves_nothing_behind() {
    let Some(gpu) = test_gpu() else { return };
    let mut stage = Stage::new(gpu, plates().scene());
    let mut canvas = stage.canvas([97, 64], 16 * 97);
    let view = stage.made.scene.camera;
    stage.made.scene.camera.position_m.x += 0.05;
    for (band, steps) in [(0, 2), (1, 1)] {
        for step in 0..steps {
            stage.accumulate(&mut canvas, band, step, 32).unwrap();
        }
    }
    // Dropped where it first waits, if it waits for memory.
    {
        let (scene, uploaded) = (&stage.made.scene, &stage.uploaded);
        let renderer = &mut stage.renderer;
        let options = options(32);
        let step = pin!(renderer.accumulate(scene, uploaded, &mut canvas, 0, 2, &options));
        let _ = step.poll(&mut Context::from_waker(Waker::noop()));
    }
    assert!([0, 3].contains(&canvas.steps(0)));
    let moved = image(&canvas, gpu);
    stage.made.scene.camera = view;
    for band in 0..canvas.bands() {
        for step in 0..steps(2) {
            stage.accumulate(&mut canvas, band, step, 2).unwrap();
        }
    }
    let expected = rendered(&mut stage, [97, 64], 2, 16 * 97);
    assert!(image(&canvas, gpu) == expected);
    assert!(moved != expected, "the views do not differ");
}

#[test]
#[should_panic(expected = "cannot follow")]
fn a_step_that_does_not_follow_is_a_mistake() {
    let Some(gpu) = test_gpu() else {
        panic!("cannot follow what there is not");
    };
    let mut stage = Stage::new(gpu, plates().scene());
    let mut canvas = stage.canvas([8, 8], 64);
    stage.accumulate(&mut canvas, 0, 0, 4).unwrap();
    let _ = stage.accumulate(&mut canvas, 0, 2, 4);
}

/// Edits, bands and display of the built-in scene ask for nothing beyond WebGPU's defaults, 3,840 pixels wide.
#[test]
fn default_limits_are_enough_for_a_wide_canvas() {
    let Some(gpu) = default_limits() else { return };
    let mut stage = Stage::new(&gpu, scene(BUILT_IN));
    // A strip through the pan.
    stage.made.scene.camera.fov_y_rad = 1e-3;
    let mut canvas = stage.canvas([3840, 12], 3840 * 4);
    assert_eq!(canvas.bands(), 2);
    stage.paint(&mut canvas, 1, 1);
    let expected = rendered(&mut stage, [3840, 12], 1, 3840 * 4);
    assert!(image(&canvas, &gpu) == expected);

    stage.made.scene.camera.fov_y_rad = 0.03;
    let mut canvas = stage.canvas([90, 60], u32::MAX);
    stage.paint(&mut canvas, steps(2), 2);
    let before = image(&canvas, &gpu);
    // Without the ceiling, which the steel mirrors.
    stage.made.scene.lights.remove(2);
    let Stage {
        renderer,
        made,
        uploaded,
        ..
    } = &mut stage;
    gpu.block_on(made.update(renderer, uploaded)).unwrap();
    for step in 0..steps(2) {
        stage.accumulate(&mut canvas, 0, step, 2).unwrap();
    }
    let after = image(&canvas, &gpu);
    assert!(mean(&after, 0..60) < mean(&before, 0..60));
    let shown = gpu
        .block_on(stage.renderer.read_shown(&canvas, &DISPLAY))
        .unwrap();
    assert!(shown.iter().step_by(4).any(|red| *red > 20));
}

/// A whole 4K picture is 531 MB of films: there, or refused in words.
#[test]
fn a_4k_canvas_is_there_or_refused_by_its_memory() {
    let Some(gpu) = default_limits() else { return };
    let stage = Stage::new(&gpu, plates().scene());
    match gpu.block_on(stage.renderer.canvas([3840, 2160], u32::MAX)) {
        Ok(canvas) => {
            assert_eq!(canvas.bytes(), 3840 * 2160 * 64);
            // 128 MiB hold what rays find of 128 rows, and tiles have eight.
            assert_eq!((canvas.bands(), canvas.rows(0)), (17, 0..128));
            assert_eq!(canvas.rows(16), 2048..2160);
        }
        Err(error) => {
            assert!(matches!(error, Error::OutOfMemory { .. }), "{error}");
            assert!(error.to_string().contains("memory"), "{error}");
        }
    }
}
