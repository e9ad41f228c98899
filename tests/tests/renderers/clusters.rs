//! Grids of many scratches: the GPU against the CPU, where footprints read them, where they do not, and where one goes over
//! into the other.

use conformance::furnace;
use hairline_gpu::{RenderOptions, Renderer, headless};
use hairline_image::metrics::layer_difference;
use hairline_image::{Image, Layer};
use hairline_optics::method::{Gather, Lookup, Method};
use hairline_reference::closed_form::{self, Prepared};
use hairline_scene::Scene;

/// Two layers under a lamp and `lights`.
fn scene(shape: &str, count: u32, camera: &str, lights: &str, size_px: [u32; 2]) -> Scene {
    let text = format!(
        "[camera]\n{camera}up = [0.0, 0.0, 1.0]\n\
         [render]\nsize_px = {size_px:?}\n[[material]]\nname = \"m\"\nkind = \"metal\"\nmetal = \"steel\"\nroughness = 0.1\n\
         [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = {{ {shape} }}\n\
         [[scratches]]\nobject = \"o\"\npattern = \"random\"\ncount = {count}\nseed = 1\nlength_m = {{ mean = 0.02, spread = 0.4 }}\n\
         width_um = {{ mean = 3.0, spread = 0.2 }}\ndepth_nm = {{ mean = 180.0, spread = 0.2 }}\n\
         [[scratches]]\nobject = \"o\"\npattern = \"circular\"\njitter_deg = 3.0\ncount = {count}\nseed = 2\nlength_m = 0.02\n\
         width_um = 2.0\ndepth_nm = 250.0\n\
         [[light]]\nkind = \"sphere\"\ncenter_m = [-0.3, 0.9, 0.9]\nradius_m = 0.05\nradiance = 50.0\n\
         {lights}"
    );
    Scene::from_toml(&text, "many", ".").unwrap_or_else(|error| panic!("{error}"))
}

/// A tube, and a polygon of many corners.
const POLYGONS: &str = "\
[[light]]
kind = \"polygon\"
vertices_m = [[-2.0, 1.5, 0.5], [2.0, 1.5, 0.5], [2.0, 1.5, 0.6], [-2.0, 1.5, 0.6]]
radiance = 1.0
two_sided = true
[[light]]
kind = \"polygon\"
vertices_m = [[0.5, 1.0, 1.0], [0.6, 1.0, 1.0], [0.65, 1.0, 1.1], [0.6, 1.0, 1.2], [0.5, 1.0, 1.2]]
radiance = 20.0
two_sided = true
";

/// Seen along, so that pixels of the picture's lower edge see few scratches and those of its upper edge many.
fn plane() -> Scene {
    scene(
        "plane = { size_m = [0.03, 0.6] }",
        16_000,
        "position_m = [0.0, -0.34, 0.06]\ntarget_m = [0.0, -0.2, 0.0]\nfov_y_deg = 24.0\n",
        POLYGONS,
        [24, 40],
    )
}

/// Pixels over which normals turn. Without polygons, whose cosine the CPU takes once for a band: where bands are this wide,
/// single scratches differ by as much.
fn ball() -> Scene {
    scene(
        "sphere = { radius_m = 0.05 }",
        30_000,
        "position_m = [0.0, -3.0, 0.4]\ntarget_m = [0.0, 0.0, 0.0]\nfov_y_deg = 2.5\n",
        "",
        [16, 16],
    )
}

fn clusters(lookup: Lookup) -> Method {
    gathered(Gather::Clusters, lookup)
}

fn gathered(gather: Gather, lookup: Lookup) -> Method {
    Method {
        gather,
        lookup,
        ..Method::default()
    }
}

/// The GPU's pictures, method by method; none where there is no driver.
fn on_the_gpu<const N: usize>(
    prepared: &Prepared,
    scene: &Scene,
    methods: [Method; N],
) -> Option<[Image; N]> {
    let gpu = headless::test_gpu()?;
    let mut renderer = gpu.block_on(Renderer::new(gpu)).unwrap();
    Some(methods.map(|method| {
        let (index, tables) = (prepared.scratches(), prepared.tables());
        let uploaded = renderer.upload(scene, index, tables, &method);
        let uploaded = gpu.block_on(uploaded).unwrap();
        let options = RenderOptions {
            samples: 1,
            ..Default::default()
        };
        let image = renderer.render(scene, &uploaded, &options, &|_| {});
        gpu.block_on(image).unwrap()
    }))
}

fn on_the_cpu(prepared: &Prepared, method: Method) -> Image {
    let options = closed_form::RenderOptions { samples: 1, method };
    prepared.render(&options, &|_| {})
}

/// Where both renderers hit the object alike: at edges of triangles one pixel may take either.
fn same_surface(a: &Image, b: &Image) -> Vec<bool> {
    let pairs = a
        .normal
        .iter()
        .zip(&b.normal)
        .zip(a.depth_m.iter().zip(&b.depth_m));
    pairs
        .map(|((m, n), (d, e))| {
            let turn: f32 = (0..3).map(|i| (m[i] - n[i]).powi(2)).sum();
            turn < 1e-5 && (d - e).abs() <= 1e-3 * d
        })
        .collect()
}

fn compare(name: &str, a: &Image, b: &Image) {
    let same = same_surface(a, b);
    let share = same.iter().filter(|s| **s).count() as f64 / same.len() as f64;
    assert!(share > 0.9, "{name}: {share} of the pixels show the same");
    for layer in [Layer::Scratches, Layer::Density] {
        let difference = layer_difference(a, b, layer, Some(&same));
        println!(
            "{name}, {}: {:.4} % rms",
            layer.name(),
            100.0 * difference.relative_rms()
        );
        assert!(
            difference.relative_rms() < 0.005,
            "{name}, {}",
            layer.name()
        );
    }
}

#[test]
fn a_plane_from_few_to_many() {
    let scene = plane();
    let prepared = Prepared::new(&scene);
    let methods = [
        clusters(Lookup::Tiles),
        clusters(Lookup::Bvh),
        Method::default(),
    ];
    let Some([tiles, walked, exact]) = on_the_gpu(&prepared, &scene, methods) else {
        return;
    };
    compare("plane", &tiles, &on_the_cpu(&prepared, methods[0]));
    // Whether a pixel's own walk or its tile's list finds the single ones is no difference.
    compare("plane, tiles and walks", &tiles, &walked);
    // Grids were read, and not everywhere.
    let scratched = (0..exact.density.len()).filter(|i| exact.density[*i] != [0.0; 3]);
    let (alone, many): (Vec<_>, Vec<_>) =
        scratched.partition(|i| exact.density[*i] == tiles.density[*i]);
    let (alone, many) = (alone.len(), many.len());
    println!("{alone} pixels saw single scratches, {many} read grids");
    assert!(alone > 60 && many > 60);
}

/// So dense that hundreds of scratches lie under pixels that are fine against the finest grid, fewer towards the camera; from few
/// under the picture's lower edge on.
fn dense() -> Scene {
    scene(
        "plane = { size_m = [0.01, 0.04] }",
        5_000,
        "position_m = [0.0, -0.048, 0.012]\ntarget_m = [0.0, -0.01, 0.0]\nfov_y_deg = 2.5\n",
        POLYGONS,
        [16, 32],
    )
}

/// Single scratches are added up where they are many, however they are found.
#[test]
fn many_under_a_fine_pixel() {
    let scene = dense();
    let prepared = Prepared::new(&scene);
    let methods = [
        gathered(Gather::Tally, Lookup::Tiles),
        gathered(Gather::Tally, Lookup::Bvh),
        Method::default(),
    ];
    let Some([tiles, walked, exact]) = on_the_gpu(&prepared, &scene, methods) else {
        return;
    };
    compare("dense", &tiles, &on_the_cpu(&prepared, methods[0]));
    compare("dense, tiles and walks", &tiles, &walked);
    let scratched = (0..exact.density.len()).filter(|i| exact.density[*i] != [0.0; 3]);
    let (alone, many): (Vec<_>, Vec<_>) =
        scratched.partition(|i| exact.scratches[*i] == tiles.scratches[*i]);
    // What they take from the base is that of all, one by one.
    let tallied = many.iter().filter(|i| {
        let (a, b) = (exact.density[**i][1], tiles.density[**i][1]);
        (a - b).abs() < 1e-4 * a
    });
    let (alone, many, tallied) = (alone.len(), many.len(), tallied.count());
    println!("{alone} pixels saw single scratches, {many} many, {tallied} of them without a grid");
    assert!(alone > 60 && tallied > 60);
    let difference = layer_difference(&exact, &tiles, Layer::Scratches, None);
    println!(
        "{:.2} % off all scratches",
        100.0 * difference.relative_rms()
    );
    assert!(difference.relative_rms() < 0.02);
}

#[test]
fn a_ball_and_an_environment() {
    for environment in [None, furnace()] {
        let name = match environment {
            None => "ball",
            Some(_) => "ball, environment",
        };
        let scene = Scene {
            environment,
            ..ball()
        };
        let prepared = Prepared::new(&scene);
        let method = clusters(Lookup::Tiles);
        let Some([gpu]) = on_the_gpu(&prepared, &scene, [method]) else {
            return;
        };
        compare(name, &gpu, &on_the_cpu(&prepared, method));
    }
}
