//! Pictures at the limits: parts, threads, sizes, numbers.

use super::*;
use hairline_image::{BATCH_SAMPLES, Batches};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A scene of a camera, a shape, a layer of scratches and lights, as scene files have them.
fn scene(camera: &str, size_px: [u32; 2], shape: &str, scratches: &str, lights: &str) -> Scene {
    let text = format!(
        "[camera]\n{camera}\n[render]\nsize_px = [{}, {}]\n\
         [[material]]\nname = \"m\"\nkind = \"metal\"\nmetal = \"steel\"\nroughness = 0.1\n\
         [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = {{ {shape} }}\n\
         [[scratches]]\nobject = \"o\"\n{scratches}\nwidth_um = 2.0\ndepth_nm = 200.0\n{lights}",
        size_px[0], size_px[1]
    );
    hairline_document::from_toml(&text, "test", ".")
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const SLANTED: &str =
    "position_m = [0.0, -0.3, 0.3]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]";
const DISK: &str = "disk = { radius_m = 0.08 }";
const RANDOM: &str = "pattern = \"random\"\ncount = 500\nlength_m = 0.02";

fn lamp(place: [f64; 3]) -> String {
    format!("[[light]]\nkind = \"sphere\"\ncenter_m = {place:?}\nradius_m = 0.05\nradiance = 9.0\n")
}

fn disk(size_px: [u32; 2]) -> Scene {
    scene(SLANTED, size_px, DISK, RANDOM, &lamp([0.0, 0.3, 0.3]))
}

fn options(samples: u32) -> RenderOptions {
    RenderOptions {
        samples,
        ..RenderOptions::default()
    }
}

fn render(scene: &Scene, samples: u32) -> (Image, Counts) {
    let rows = 0..scene.render.size_px[1];
    Prepared::new(scene).render_counted(&options(samples), rows, &|_| {})
}

fn sum(layer: &[[f32; 3]]) -> f64 {
    layer.iter().flatten().map(|&v| f64::from(v)).sum()
}

fn is_finite(image: &Image) -> bool {
    let layers = [&image.base, &image.scratches, &image.density, &image.normal];
    layers
        .into_iter()
        .flatten()
        .flatten()
        .all(|v| v.is_finite())
}

#[test]
fn rows_are_the_pictures() {
    let scene = disk([60, 40]);
    let prepared = Prepared::new(&scene);
    let whole = prepared.render(&options(3), &|_| {});
    for rows in [0..1, 0..7, 7..24, 8..16, 39..40] {
        let pixels = 60 * rows.start as usize..60 * rows.end as usize;
        let some = prepared.render_rows(&options(3), rows, &|_| {});
        assert_eq!(some.scratches, whole.scratches[pixels.clone()]);
        assert_eq!(some.base, whole.base[pixels.clone()]);
        assert_eq!(some.density, whole.density[pixels.clone()]);
        assert_eq!(some.normal, whole.normal[pixels.clone()]);
        assert_eq!(some.depth_m, whole.depth_m[pixels]);
    }
}

#[test]
fn threads_make_no_difference() {
    let mut scene = disk([60, 40]);
    let curved = self::scene(
        SLANTED,
        [60, 40],
        "sphere = { radius_m = 0.07 }",
        "pattern = \"random\"\ncount = 20000\nlength_m = 0.004",
        &lamp([0.0, 0.3, 0.3]),
    );
    for scene in [&mut scene, &mut curved.clone()] {
        let by = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().expect("threads");
            pool.install(|| render(scene, 4))
        };
        let (one, of_one) = by(1);
        let (two, of_two) = by(2);
        assert!(sum(&one.scratches) > 0.0);
        assert_eq!((one, of_one), (two, of_two));
    }
}

/// The segments are as long as the plate, which is larger than the picture: every tile of the
/// middle row has them.
#[test]
fn a_segment_across_the_whole_picture() {
    let camera = "position_m = [0.0, 0.0, 0.002]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 1.0, 0.0]";
    let parallel =
        "pattern = \"parallel\"\ndirection = [1.0, 0.0, 0.0]\ncount = 3\nlength_m = 0.0038";
    let plate = "plane = { size_m = [0.004, 0.001] }";
    let scene = scene(camera, [128, 72], plate, parallel, &lamp([0.0, 0.1, 0.1]));
    let (image, counts) = render(&scene, 1);
    assert!(is_finite(&image) && counts.entries >= 16);
    let row = |y: usize| -> f64 { sum(&image.density[y * 128..(y + 1) * 128]) };
    let fullest = (0..72).max_by(|&a, &b| row(a).total_cmp(&row(b))).unwrap();
    let line = &image.density[fullest * 128..(fullest + 1) * 128];
    assert!(line.iter().all(|d| d[1] > 1e-3), "{line:?}");
}

#[test]
fn a_camera_inside_an_object_and_one_on_a_surface() {
    let inside = "position_m = [0.0, -0.0699, 0.0]\ntarget_m = [0.0, 0.0, 0.01]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 100.0";
    let many = "pattern = \"random\"\ncount = 5000\nlength_m = 0.01";
    let sphere = "sphere = { radius_m = 0.07 }";
    let scene_inside = scene(inside, [40, 24], sphere, many, &lamp([0.0, 0.0, 0.0]));
    let (image, _) = render(&scene_inside, 2);
    assert!(is_finite(&image) && image.depth_m.iter().all(|&depth| depth > 0.0));
    // Thirty micrometres above a plate, along it: the windows of scratches are as wide.
    let on = "position_m = [0.0, 0.0, 3e-5]\ntarget_m = [0.0, 0.01, 0.0]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 90.0";
    let plate = "plane = { size_m = [0.01, 0.01] }";
    let scene_on = scene(on, [40, 24], plate, many, &lamp([0.0, 0.3, 0.1]));
    let (image, counts) = render(&scene_on, 2);
    assert!(is_finite(&image) && counts.pairs > 0);
}

#[test]
fn pictures_of_one_pixel_and_of_one_row_of_tiles() {
    let (image, _) = render(&disk([1, 1]), 4);
    assert!(is_finite(&image) && sum(&image.base) > 0.0);
    let (image, counts) = render(&disk([16384, 8]), 1);
    assert!(is_finite(&image) && counts.pairs > 0);
    assert!(sum(&image.scratches) > 0.0);
}

#[test]
fn seventy_thousand_segments_in_a_tile() {
    let camera = "position_m = [0.0, -0.1, 0.3]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 1.0, 0.0]\nfov_y_deg = 1.0";
    let many = "pattern = \"random\"\ncount = 70000\nlength_m = 0.0005";
    let plate = "plane = { size_m = [0.004, 0.004] }";
    let scene = scene(camera, [8, 8], plate, many, &lamp([0.0, 0.3, 0.1]));
    let (image, counts) = render(&scene, 1);
    assert!(counts.entries >= 70_000, "{counts:?}");
    assert!(is_finite(&image) && sum(&image.scratches) > 0.0);
}

/// The light of scratches is the sum over lights; each alone asks for other bounds.
#[test]
fn five_hundred_lights_are_the_sum_of_a_hundred_at_a_time() {
    let lights: Vec<String> = (0..500)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * 0.1).sin_cos();
            lamp([0.3 * cos, 0.3 * sin, 0.2 + 0.001 * f64::from(i)])
        })
        .collect();
    let by = |lights: &[String]| {
        let scene = scene(SLANTED, [24, 16], DISK, RANDOM, &lights.concat());
        render(&scene, 1).0.scratches
    };
    let all = by(&lights);
    let mut parts = vec![[0.0; 3]; all.len()];
    for some in lights.chunks(100) {
        for (sum, light) in parts.iter_mut().zip(by(some)) {
            (0..3).for_each(|c| sum[c] += light[c]);
        }
    }
    assert!(sum(&all) > 0.0);
    for (a, b) in all.iter().flatten().zip(parts.iter().flatten()) {
        assert!((a - b).abs() <= 1e-5 * b.abs() + 1e-9, "{a} {b}");
    }
}

#[test]
fn edges_that_are_refined_later_make_the_same_picture() {
    let scene = disk([60, 40]);
    let prepared = Prepared::new(&scene);
    let whole = prepared.render(&options(5), &|_| {});
    let once = prepared.render(&options(1), &|_| {});
    assert_ne!(once.base, whole.base);
    let rows = 0..40;
    let refined = prepared.refine_edges_unless(&|| false, &options(5), rows, once);
    let refined = refined.expect("nobody cancels it");
    assert_eq!(refined.base, whole.base);
    assert_eq!(refined.scratches, whole.scratches);
    assert_eq!(refined.density, whole.density);
    assert_eq!(refined.depth_m, whole.depth_m);
    assert_eq!(refined.normal, whole.normal);
}

#[test]
fn a_picture_is_given_up_after_the_tiles_in_hand() {
    let scene = disk([160, 120]);
    let prepared = Prepared::new(&scene);
    let (tiles, threads) = (20 * 15, rayon::current_num_threads());
    // Gives up at a question; returns how many there were after it.
    let asked_after = |at: usize| {
        let asked = AtomicUsize::new(0);
        let cancelled = || asked.fetch_add(1, Ordering::Relaxed) >= at;
        let picture = prepared.render_unless(&cancelled, &options(8), 0..120, &|_| {});
        let all = asked.into_inner();
        (picture.is_some(), all.saturating_sub(at))
    };
    let (is_there, _) = asked_after(usize::MAX);
    assert!(is_there);
    for at in [0, 1, 20, tiles / 2, tiles - 1] {
        let (is_there, after) = asked_after(at);
        assert!(!is_there, "{at}");
        // Each thread asks once more; the first call is the picture's, and one more asks whether there is a
        // picture.
        assert!(after <= threads + 2, "{at}: {after} further tiles");
    }
}

/// Half of the lamp is hidden from the middle of the disk by a smaller one.
fn screened() -> Scene {
    let screen = "[[object]]\nname = \"s\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.03 } }\n\
                  translation_m = [0.0, 0.1, 0.1]\n";
    let lights = format!("{screen}{}", lamp([0.0, 0.3, 0.3]));
    scene(SLANTED, [40, 24], DISK, RANDOM, &lights)
}

/// The mean of all batches, and that of the first ones.
fn added_up(scene: &Scene, samples: u32, batches: u32) -> Image {
    let prepared = Prepared::new(scene);
    let mut sum = Batches::new(samples).unfiltered();
    let rows = 0..scene.render.size_px[1];
    while let Some(batch) = sum.next().filter(|it| it.first < batches * BATCH_SAMPLES) {
        let options = RenderOptions {
            batch: Some(batch),
            shadows: true,
            ..options(samples)
        };
        sum.add(prepared.render_rows(&options, rows.clone(), &|_| {}));
    }
    assert_eq!(sum.done(), samples.min(batches * BATCH_SAMPLES));
    sum.into_image().unwrap()
}

#[test]
fn shadows_add_up_to_those_of_all_rays_at_once() {
    let scene = screened();
    let at_once = |shadows| {
        let options = RenderOptions {
            shadows,
            ..options(256)
        };
        Prepared::new(&scene).render(&options, &|_| {})
    };
    let (open, all) = (at_once(false), at_once(true));
    let off = |image: &Image| {
        let pairs = image.base.iter().zip(&all.base);
        let squares = pairs.map(|(a, b)| f64::from(a[1] - b[1]).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let [one, few, many] = [1, 4, 64].map(|batches| off(&added_up(&scene, 256, batches)));
    // Errors fall as those of independent samples do, or faster.
    assert!(few < 0.7 * one && many < 0.3 * few, "{one} {few} {many}");

    let image = added_up(&scene, 256, 64);
    let noise = image.noise.as_ref().unwrap();
    let (mut half, mut lit) = (0, 0);
    for i in 0..all.base.len() {
        if all.base[i] == open.base[i] && all.scratches[i] == open.scratches[i] {
            lit += usize::from(open.base[i][1] > 0.0);
            // On edges one sample of a batch shades the scratches of all.
            assert!((image.base[i][1] - open.base[i][1]).abs() <= 0.02 * open.base[i][1]);
        }
        half += usize::from(noise.base[i][1] > 0.0);
    }
    assert!(half > 50 && lit > 10, "{half} {lit}");
}
