//! Two rows of a picture by the closed form: the plate under two small spheres and a dim sky, and the same under one polygon.
//!
//! On one thread, so that a run measures arithmetic and not how many cores are free.

use criterion::{Criterion, criterion_group, criterion_main};
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_scene::{LightShape, Scene};
use std::path::Path;

/// Size of the picture. It sets how many scratches lie under a pixel; the time is that of the rows.
const SIZE_PX: [u32; 2] = [480, 270];
const ROWS: std::ops::Range<u32> = 140..142;

fn plate() -> Scene {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut scene =
        hairline_document::load(scenes.join("plate.toml")).expect("the scene of the plate");
    scene.render.size_px = SIZE_PX;
    scene
}

fn closed_form(c: &mut Criterion) {
    let mut by_a_polygon = plate();
    by_a_polygon
        .lights
        .retain(|light| matches!(light.shape, LightShape::Polygon { .. }));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread");
    let mut group = c.benchmark_group("closed form");
    group.sample_size(10);
    for (name, scene) in [("plate", plate()), ("plate, one polygon", by_a_polygon)] {
        let prepared = Prepared::new(&scene);
        group.bench_function(name, |b| {
            b.iter(|| {
                pool.install(|| prepared.render_rows(&RenderOptions::default(), ROWS, &|_| {}))
            })
        });
    }
}

criterion_group!(benches, closed_form);
criterion_main!(benches);
