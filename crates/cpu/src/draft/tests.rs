//! A draft is as bright as all scratches, and one of all scratches is the same picture.

use super::*;
use crate::closed_form::{Prepared, RenderOptions};
use hairline_fixtures::scenes::oblique_plate;
use hairline_image::Image;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

fn scene() -> Scene {
    oblique_plate(6000, 0.03)
        .with_lines("width_um = { mean = 3.0, spread = 0.2 }")
        .random("plate", 7)
        .with_lines("seed = 2")
        .fov_y_deg(30.0)
        .size_px([40, 32])
        .scene()
}

const WHOLE: DraftLayer = DraftLayer {
    weight: 1.0,
    is_random: true,
};

fn picture(scene: &Scene, draft: Option<Draft>) -> Image {
    let mut prepared = Prepared::new(scene);
    if let Some(draft) = draft {
        prepared = prepared.with_draft(Arc::new(draft));
    }
    prepared.render(&RenderOptions::default(), &|_| {})
}

fn mean(image: &Image) -> f64 {
    let beauty = image.beauty();
    let sum: f64 = beauty.rgb.iter().flatten().map(|&c| f64::from(c)).sum();
    sum / beauty.rgb.len() as f64
}

#[test]
fn a_few_scratches_are_as_bright_as_all() {
    let scene = scene();
    let all = mean(&picture(&scene, None));
    for is_random in [true, false] {
        let layer = DraftLayer { is_random, ..WHOLE };
        let draft = Draft::new(&scene, &GrooveShapes::new(&scene), 8, &|_| layer);
        assert!(draft.len() < 6000 * 3, "{} pieces", draft.len());
        let few = mean(&picture(&scene, Some(draft)));
        assert!((few / all - 1.0).abs() < 0.05, "{few} for {all}");
    }
}

#[test]
fn a_small_layer_is_kept_whole() {
    let scene = scene();
    let draft = Draft::new(&scene, &GrooveShapes::new(&scene), 1000, &|_| WHOLE);
    let whole = draft.weights.iter().filter(|&&weight| weight == 1.0);
    assert!(whole.count() >= 7);
    assert!(draft.weights.iter().any(|&weight| weight > 100.0));
}

#[test]
fn what_is_cancelled_ends_without_a_picture() {
    let scene = scene();
    let prepared = Prepared::new(&scene);
    let none = prepared.render_unless(&|| true, &RenderOptions::default(), 0..32, &|_| {});
    assert!(none.is_none());
}

/// A draft has no tree in which a ray finds scratches: the few pieces are not those of the tree.
#[test]
fn what_rays_meet_in_a_draft_has_no_scratches() {
    let scene = oblique_plate(6000, 0.03)
        .object("ball", "steel", "sphere = { radius_m = 0.03 }")
        .size_px([40, 32])
        .scene();
    let options = RenderOptions {
        shadows: true,
        bounces: 1,
        ..RenderOptions::default()
    };
    let draft = Arc::new(Draft::new(&scene, &GrooveShapes::new(&scene), 8, &|_| {
        WHOLE
    }));
    let prepared = Prepared::new(&scene).with_draft(draft);
    let asked = AtomicUsize::new(0);
    let count = || {
        asked.fetch_add(1, Ordering::Relaxed);
        false
    };
    let (image, _) = prepared
        .render_unless(&count, &options, 0..32, &|_| {})
        .unwrap();
    assert!(image.base.iter().flatten().all(|c| c.is_finite()));
    // Rays take a while: what is wanted meanwhile is asked before those of each pixel.
    let seen = image.depth_m.iter().filter(|depth_m| **depth_m > 0.0);
    let (asked, seen) = (asked.into_inner(), seen.count());
    assert!(seen > 500 && asked > seen, "{asked} for {seen} pixels");
}
