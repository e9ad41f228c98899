//! Properties that the filter of found light preserves: the mean of each layer, and the contrast of scratches in half shadow.

use super::shadowed::{bounced, luminance, scenes};
use conformance::two_renderers::at_width;
use glam::{DVec2, DVec3};
use hairline_document::DEFAULT_SAMPLES;
use hairline_fixtures::SceneFile;
use hairline_image::{Image, Layer, Picture, filter_traced};
use hairline_scene::Scene;
use hairline_scene::environment::lookup::environment_dir;
use std::ops::Range;
use std::path::Path;

/// A picture with default samples, as rays found it and filtered.
fn found_and_filtered(scene: &Scene) -> [Image; 2] {
    let found = bounced(scene, DEFAULT_SAMPLES, true, 1);
    let mut filtered = found.clone();
    filter_traced(&mut filtered);
    [found, filtered]
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The part of a pattern's contrast that a picture has, whatever its noise: 1 where it has all.
fn contrast(found: &[f64], truth: &[f64]) -> f64 {
    let (mean_found, mean_truth) = (mean(found), mean(truth));
    let both = found.iter().zip(truth);
    let covariance: f64 = both.map(|(f, t)| (f - mean_found) * (t - mean_truth)).sum();
    let variance: f64 = truth.iter().map(|t| (t - mean_truth).powi(2)).sum();
    covariance / variance
}

/// Bounds of the scenes of `cargo lab unbiased`. The light of a slit as narrow as few pixels is drawn over the dark beside it, where scratches see less
/// of it.
const BOUNDS: [(&str, f64); 6] = [
    ("edge", 5e-3),
    ("mirrors", 5e-3),
    ("slit", 2e-2),
    ("corner", 5e-3),
    ("sheets", 5e-3),
    ("sky", 5e-3),
];

#[test]
fn means_stay() {
    check_means(&BOUNDS[..3], 64);
}

#[test]
#[ignore = "long: cargo long"]
fn means_stay_in_all_scenes() {
    check_means(&BOUNDS, 96);
}

fn check_means(bounds: &[(&str, f64)], width_px: u32) {
    for &(name, bound) in bounds {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shadows");
        let scene = hairline_document::load(folder.join(name).with_extension("toml")).unwrap();
        let [found, filtered] = found_and_filtered(&at_width(scene, width_px));
        for layer in [Layer::Base, Layer::Scratches] {
            let [before, after] = [&found, &filtered].map(|image| mean(&luminance(image, layer)));
            let off = after / before - 1.0;
            println!("{name}, {}: {:+.3} %", layer.name(), 100.0 * off);
            assert!(off.abs() < bound, "{name}, {}: {off}", layer.name());
        }
    }
}

/// Scratches as wide as a pixel, where lamps are half hidden.
#[test]
fn scratches_in_half_shadow_stay_sharp() {
    check_sharp(scenes().into_iter().take(1));
}

#[test]
#[ignore = "long: cargo long"]
fn scratches_in_half_shadow_stay_sharp_in_all_scenes() {
    // The others have gratings and a sky, which are smooth.
    check_sharp(scenes().into_iter().take(7));
}

fn check_sharp(scenes: impl Iterator<Item = (&'static str, Scene)>) {
    for (name, mut scene) in scenes {
        scene.render.size_px = [16; 2];
        let images = found_and_filtered(&scene);
        let truth = luminance(&bounced(&scene, 256, true, 1), Layer::Scratches);
        let [before, after] =
            images.map(|image| contrast(&luminance(&image, Layer::Scratches), &truth));
        println!("{name}: {before:.4}, filtered {after:.4}");
        assert!(
            (after / before - 1.0).abs() < 0.06,
            "{name}: {before} {after}"
        );
        // The comparison fails for the mean of five pixels in a row.
        let blurred: Vec<f64> = (0..truth.len())
            .map(|i| mean(&truth[i.saturating_sub(2)..(i + 3).min(truth.len())]))
            .collect();
        assert!(contrast(&blurred, &truth) < 0.9, "{name}");
    }
}

/// The rms by which pixels of the base differ from the mean of the four beside them, over the mean of all.
pub(super) fn grain(image: &Image, columns: Range<usize>, rows: Range<usize>) -> f64 {
    let base = luminance(image, Layer::Base);
    let width = image.size_px[0] as usize;
    let at = |x: usize, y: usize| base[y * width + x];
    let pixels = || {
        rows.clone()
            .flat_map(|y| columns.clone().map(move |x| (x, y)))
    };
    let off =
        |(x, y)| at(x, y) - 0.25 * (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1));
    let squares: Vec<f64> = pixels().map(|pixel| f64::powi(off(pixel), 2)).collect();
    let values: Vec<f64> = pixels().map(|(x, y)| at(x, y)).collect();
    mean(&squares).sqrt() / mean(&values)
}

/// A rough table that mirrors a low lamp of a map past a ball: few rays meet the lamp, and these have most of the light.
#[test]
fn half_shadow_of_a_lamp_that_few_rays_meet_has_no_speckle() {
    let mut scene = SceneFile::seen_from([0.0, -0.34, 0.26])
        .fov_y_deg(16.0)
        .size_px([64, 48])
        .part("[[material]]\nname = \"m\"\nkind = \"dielectric\"\nbase_color = [0.05, 0.05, 0.05]")
        .with_lines("roughness = 0.45")
        .object("table", "m", "plane = { size_m = [3.0, 3.0] }")
        .object("ball", "m", "sphere = { radius_m = 0.06 }")
        .with_lines("translation_m = [0.0, 0.16, 0.06]")
        .scene();
    let size_px = [128, 64];
    let mut map = Picture::new(size_px);
    for (i, texel) in map.rgb.iter_mut().enumerate() {
        let at = [i as u32 % size_px[0], i as u32 / size_px[0]].map(|n| f64::from(n) + 0.5);
        let direction = environment_dir(DVec2::from(at) / DVec2::new(128.0, 64.0));
        let is_lamp = direction.angle_between(DVec3::new(0.0, 0.95, 0.3)) < 0.15;
        *texel = [if is_lamp { 30.0 } else { 0.3 }; 3];
    }
    scene.environment = Some(hairline_sky::from_map(map, 0.0, 1.0, false));
    let [found, filtered] = found_and_filtered(&scene);
    let [before, after] = [found, filtered].map(|image| grain(&image, 8..56, 8..40));
    println!("{before:.4}, filtered {after:.4}");
    assert!(before > 0.03 && after < 0.2 * before, "{before} {after}");
}
