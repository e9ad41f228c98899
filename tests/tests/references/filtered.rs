//! Properties that the filter of found light preserves: the mean of each layer, and the contrast of scratches in half shadow.

use super::shadowed::{bounced, luminance, scenes};
use conformance::two_renderers::at_width;
use hairline_image::{Image, Layer, filter_found};
use hairline_scene::{DEFAULT_SAMPLES, Scene};
use std::path::Path;

/// A picture with default samples, as rays found it and filtered.
fn found_and_filtered(scene: &Scene) -> [Image; 2] {
    let found = bounced(scene, DEFAULT_SAMPLES, true, 1);
    let mut filtered = found.clone();
    filter_found(&mut filtered);
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
        let scene = Scene::load(folder.join(name).with_extension("toml")).unwrap();
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
