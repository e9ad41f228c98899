//! Normal maps whose bumps are about as wide as a pixel.

use super::pictures::{LINEAR, closed, compared, sampled};
use conformance::two_renderers::at_width;
use hairline_image::Layer;
use hairline_scene::Scene;
use std::path::Path;

fn bumpy_ball() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers/scenes/bumpy-ball-lamps.toml");
    at_width(hairline_document::load(path).unwrap(), 96)
}

/// Paths see one normal each. One wider lobe for the whole pixel is 33 % off.
#[test]
fn a_pixel_has_the_mean_over_its_bumps() {
    let scene = bumpy_ball();
    let truth = sampled(&scene, LINEAR, 4);
    let base = |scene: &Scene| compared("bumps", &closed(scene), &truth, Layer::Base);
    let seen = base(&scene);
    assert!((seen.mean_ratio - 1.0).abs() < 0.03, "{}", seen.mean_ratio);
    assert!(seen.rms().0 < 0.14, "{:?}", seen.rms());
    // The comparison tells bumps that are a fifth lower.
    let mut lower = bumpy_ball();
    let materials = lower.materials.iter_mut();
    for map in materials.filter_map(|it| it.normal_texture.as_mut()) {
        map.1 *= 0.8;
    }
    let lower = base(&lower);
    assert!(lower.rms().0 > 0.3, "{:?}", lower.rms());
}
