use crate::closed_form::{Prepared, RenderOptions};
use hairline_image::Image;
use hairline_index::{ScratchIndex, TriangleIndex};
use hairline_optics::method::{Gather, Method};
use hairline_scene::{Scene, ScratchTables};
use std::sync::{Arc, OnceLock};

/// Scratches of two layers, from far away: one of sizes that are spread, one of a single size.
fn dense(shape: &str, count: u32, spread: f64, distance_m: f64) -> Scene {
    let text = format!(
        "[camera]\nposition_m = [0.0, {}, {distance_m}]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 0.6\n\
         [render]\nsize_px = [5, 4]\n[[material]]\nname = \"m\"\nkind = \"metal\"\nmetal = \"steel\"\nroughness = 0.1\n\
         [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = {{ {shape} }}\n\
         [[scratches]]\nobject = \"o\"\npattern = \"random\"\ncount = {count}\nlength_m = {{ mean = 0.01, spread = 0.4 }}\n\
         width_um = {{ mean = 3.0, spread = {spread} }}\ndepth_nm = {{ mean = 180.0, spread = {spread} }}\n\
         [[scratches]]\nobject = \"o\"\npattern = \"circular\"\njitter_deg = 3.0\ncount = {count}\nlength_m = 0.02\n\
         width_um = 2.0\ndepth_nm = 250.0\n\
         [[light]]\nkind = \"sphere\"\ncenter_m = [-0.3, 0.9, 0.9]\nradius_m = 0.05\nradiance = 50.0\n\
         [[light]]\nkind = \"polygon\"\nvertices_m = [[-2.0, 1.5, 0.5], [2.0, 1.5, 0.5], [2.0, 1.5, 1.5], [-2.0, 1.5, 1.5]]\nradiance = 1.0\ntwo_sided = true\n",
        -distance_m
    );
    Scene::from_toml(&text, "dense", ".").unwrap_or_else(|error| panic!("{error}"))
}

/// All scenes here have one metal, and share its table.
fn prepared(scene: &Scene) -> Prepared<'_> {
    static TABLES: OnceLock<Arc<ScratchTables>> = OnceLock::new();
    let tables = TABLES.get_or_init(|| ScratchTables::new(scene).into());
    let (triangles, scratches) = (TriangleIndex::build(scene), ScratchIndex::build(scene));
    Prepared::from_parts(scene, triangles.into(), scratches.into(), tables.clone())
}

fn picture(prepared: &Prepared, gather: Gather) -> Image {
    let method = Method {
        gather,
        ..Method::default()
    };
    prepared.render(&RenderOptions { samples: 1, method }, &|_| {})
}

/// Relative rms difference of the scratch layer, and of its mean and of what is taken from the base.
fn errors([exact, many]: &[Image; 2]) -> [f64; 3] {
    let both = || {
        exact
            .scratches
            .iter()
            .flatten()
            .zip(many.scratches.iter().flatten())
    };
    let (mut error2, mut value2) = (0.0, 0.0);
    for (a, b) in both() {
        error2 += f64::from(b - a).powi(2);
        value2 += f64::from(*a).powi(2);
    }
    let sum = |layer: &[[f32; 3]]| -> f64 { layer.iter().flatten().map(|v| f64::from(*v)).sum() };
    [
        (error2 / value2).sqrt(),
        sum(&many.scratches) / sum(&exact.scratches) - 1.0,
        sum(&many.density) / sum(&exact.density) - 1.0,
    ]
}

/// The disk fills the picture. Thousands of scratches lie under each pixel; what is left is that single ones differ from their class.
#[test]
fn grids_equal_all_scratches_one_by_one() {
    for (shape, spread, bound, bias) in [
        ("disk = { radius_m = 0.08 }", 0.1, 0.01, 0.003),
        // The normal turns by a quarter radian within three standard deviations of a pixel: a band for all scratches of a direction
        // is as wide there as it moves over the pixel, and the surface itself leaves its tangent plane.
        ("sphere = { radius_m = 0.04 }", 0.0, 0.05, 0.04),
    ] {
        let scene = dense(shape, 8_000, spread, 2.0);
        let prepared = prepared(&scene);
        let pictures = [Gather::Exact, Gather::Clusters].map(|gather| picture(&prepared, gather));
        assert_ne!(pictures[0].scratches, pictures[1].scratches, "one by one");
        let [rms, mean, taken] = errors(&pictures);
        println!(
            "{shape}: {:.2} % rms, mean {:+.2} %, taken from the base {:+.2} %",
            100.0 * rms,
            100.0 * mean,
            100.0 * taken
        );
        assert!(rms < bound && mean.abs() < bias && taken.abs() < 0.01);
    }
}

/// The comparison sees what it should: scratches of another width.
#[test]
fn another_width_is_seen() {
    let scene = dense("disk = { radius_m = 0.08 }", 3_000, 0.0, 2.0);
    let mut wider = scene.clone();
    let object = &mut wider.objects[0];
    for scratch in std::sync::Arc::make_mut(&mut object.scratches) {
        scratch.width_um *= 1.1;
    }
    let exact = picture(&prepared(&scene), Gather::Exact);
    let wider = picture(&prepared(&wider), Gather::Clusters);
    assert!(errors(&[exact, wider])[0] > 0.06);
}

/// As the camera leaves, grids take over from scratches and coarser grids from finer ones: no step of the distance shows.
#[test]
fn nothing_jumps_as_the_camera_leaves() {
    let scene = dense("disk = { radius_m = 0.08 }", 3_000, 0.0, 1.0);
    let prepared = prepared(&scene);
    assert!(prepared.bundle_index().bytes() > 0);
    let mean = |distance: f64| {
        let mut scene = scene.clone();
        scene.camera.position_m *= distance;
        scene.render.size_px = [4, 4];
        let image = picture(&prepared.with_scene(&scene), Gather::Clusters);
        image.scratches.iter().flatten().sum::<f32>()
    };
    let steps: Vec<f32> = (0..60).map(|i| mean(1.02f64.powi(i))).collect();
    let largest = steps
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).abs() / w[1])
        .fold(0.0, f32::max);
    println!("second differences over 2 % of distance: {largest:.4} at most");
    assert!(largest < 0.02, "{largest}");
}
