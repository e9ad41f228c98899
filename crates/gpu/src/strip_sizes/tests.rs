use hairline_fixtures::{DISK, SceneFile};
use hairline_image::Layer;
use hairline_image::metrics::layer_difference;

use crate::headless::{render, test_gpu};
use crate::renderer::RenderOptions;

/// Bytes of an array, for 32,768 entries.
const ARRAY_BYTES: u64 = 1 << 19;

#[test]
fn strips_are_cut_until_they_fit() {
    let Some(gpu) = test_gpu() else { return };
    let small = gpu.adapter.clone().open_with_arrays(ARRAY_BYTES);
    let small = gpu.block_on(small).unwrap();
    let scene = SceneFile::seen_from([0.0, -0.22, 0.30])
        .fov_y_deg(25.0)
        .size_px([64, 64])
        .mirror("steel")
        .with_lines("roughness = 0.2")
        .object("plate", "steel", DISK)
        .random("plate", 20_000)
        .with_lines("length_m = 0.03\nwidth_um = 3.0\ndepth_nm = 200.0")
        .sphere([0.02, 0.3, 0.3], 0.02, 40.0)
        .scene();
    let options = RenderOptions {
        samples: 2,
        ..RenderOptions::default()
    };
    let [whole, cut] = [gpu, &small]
        .map(|gpu| render(gpu, &scene, &Default::default(), &options, &|_| {}).unwrap());
    // One for each of two steps, and for the film.
    assert!(small.reads() > 3, "it fits: {} reads", small.reads());
    // A rasteriser may round an edge differently where a strip begins elsewhere.
    let off = layer_difference(&cut, &whole, Layer::Scratches, None).relative_rms();
    assert!(off < 1e-3, "{off}");
}
