//! Pieces put together to arcs, against the pieces that were laid.

use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_fixtures::SceneFile;
use hairline_image::Layer;
use hairline_image::metrics::layer_difference;
use hairline_scene::Scene;

/// Curved scratches under a small lamp.
fn curved(size_px: [u32; 2]) -> Scene {
    SceneFile::seen_from([0.0, -0.07, 0.06])
        .fov_y_deg(24.0)
        .size_px(size_px)
        .metal("steel", "steel")
        .with_lines("roughness = 0.12")
        .object("plate", "steel", "plane = { size_m = [0.1, 0.1] }")
        .random("plate", 900)
        .with_lines("length_m = 0.02\nwidth_um = 3.0\ndepth_nm = 160.0\ncurvature_per_m = { mean = 0.0, spread = 8.0 }")
        .sphere([0.02, 0.09, 0.1], 0.002, 800.0)
        .scene()
}

/// By shares of the chords, whose middles lie a tenth of a pixel off, they differ by 1.4 %.
#[test]
fn arcs_draw_what_was_laid() {
    let scene = curved([96, 64]);
    let arcs = Prepared::new(&scene);
    let [pieces, laid] = [arcs.scratches(), arcs.laid()].map(|index| index.tree.segments.len());
    assert!(2 * pieces < laid, "{pieces} arcs of {laid} pieces");
    let render = |prepared: &Prepared| prepared.render(&RenderOptions::default(), &|_| {});
    let by_arcs = render(&arcs);
    let by_pieces = render(&arcs.as_laid());
    let off = layer_difference(&by_arcs, &by_pieces, Layer::Scratches, None).relative_rms();
    assert!(off < 0.006, "{off}");
}
