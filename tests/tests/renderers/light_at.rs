//! A scratch's light found along it (`LightAt::Scratches`) against the same found for each pixel.

use std::path::{Path, PathBuf};

use conformance::two_renderers::at_width;
use hairline_gpu::{Gpu, RenderOptions, Renderer, headless};
use hairline_image::metrics::layer_difference;
use hairline_image::{Image, Layer};
use hairline_optics::method::{Gather, LightAt, Method, PixelFilter};
use hairline_reference::closed_form::Prepared;
use hairline_scene::Scene;

/// A scratch's light lies between those of its stations by a straight line: where stations are a step apart that is wrong by a
/// hundredth or two beside a light's edge, and right elsewhere.
const SCRATCHES_MOST: f64 = 0.011;
/// Of a light that grazes the surface, which is a ten thousandth of one above it: 1.6 %; 2.4 % where stations are not as close as corners
/// ask for where the horizon cuts an outline.
const SCRATCHES_CUT_MOST: f64 = 0.02;
/// A scratch's light is a small part of most pictures.
const BEAUTY_MOST: f64 = 0.0015;
/// What a scratch takes from the base depends on the viewer's angle, which is that of the part's middle for a whole tile.
const DENSITY_MOST: f64 = 0.004;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

fn scene(name: &str, width_px: u32) -> Scene {
    let scene = Scene::load(root().join("scenes").join(name));
    at_width(scene.unwrap_or_else(|e| panic!("{e}")), width_px)
}

/// A worn disk close by, under one lamp: what `hairline bench` measures, with fewer scratches.
fn disk(light: &str, filter_std_px: f64) -> Scene {
    let text = format!(
        "[camera]\nposition_m = [0.0, -0.1365, 0.236425]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 7.0\n\
         [render]\nsize_px = [320, 240]\nfilter_std_px = {filter_std_px}\n\
         [[material]]\nname = \"steel\"\nkind = \"metal\"\nmetal = \"iron\"\nroughness = 0.1\n\
         [[object]]\nname = \"disk\"\nmaterial = \"steel\"\n\
         shape = {{ lathe = {{ segments = 64, profile_m = [[0.0, 0.0], [0.01, 0.0], [0.02, 0.0], [0.03, 0.0], [0.05, 0.0]] }} }}\n\
         [[scratches]]\nobject = \"disk\"\npattern = \"random\"\ncount = 6000\nseed = 1\nlength_m = {{ mean = 0.0236, spread = 0.4 }}\n\
         width_um = {{ mean = 3.0, spread = 0.15 }}\ndepth_nm = {{ mean = 220.0, spread = 0.3 }}\n\
         [[light]]\nradiance = 40.0\n{light}"
    );
    Scene::from_toml(&text, "disk", ".").unwrap_or_else(|e| panic!("{e}"))
}

const SPHERE: &str = "kind = \"sphere\"\ncenter_m = [0.0, 0.2, 0.34641]\nradius_m = 0.02\n";
const TRIANGLE: &str = "kind = \"polygon\"\ntwo_sided = true\n\
    vertices_m = [[0.04, 0.2, 0.34641], [-0.02, 0.17, 0.3637], [-0.02, 0.23, 0.3291]]\n";

/// Half below the disk's horizon.
const SPHERE_CUT: &str = "kind = \"sphere\"\ncenter_m = [0.15, 0.0, 0.0]\nradius_m = 0.04\n";
const TRIANGLE_CUT: &str = "kind = \"polygon\"\ntwo_sided = true\n\
    vertices_m = [[0.15, -0.06, -0.03], [0.15, 0.06, -0.02], [0.15, 0.0, 0.07]]\n";
/// All below it, where nothing of it may be seen.
const SPHERE_BELOW: &str = "kind = \"sphere\"\ncenter_m = [0.0, 0.2, -0.34641]\nradius_m = 0.04\n";

/// The GPU's pictures, method by method.
fn on_the_gpu<const N: usize>(gpu: &Gpu, scene: &Scene, methods: [Method; N]) -> [Image; N] {
    let prepared = Prepared::new(scene);
    let mut renderer = gpu.block_on(Renderer::new(gpu)).unwrap();
    methods.map(|method| {
        let (index, tables) = (prepared.scratches(), prepared.tables());
        let uploaded = gpu.block_on(renderer.upload(scene, index, tables, &method));
        let uploaded = uploaded.unwrap();
        let options = RenderOptions::default();
        let image = renderer.render(scene, &uploaded, &options, &|_| {});
        gpu.block_on(image).unwrap()
    })
}

fn by_pixels(footprint: PixelFilter, gather: Gather) -> Method {
    Method {
        footprint,
        gather,
        light_at: LightAt::Pixels,
        ..Method::default()
    }
}

fn by_scratches(method: Method) -> Method {
    Method {
        light_at: LightAt::Scratches,
        ..method
    }
}

/// What differs by more than it may.
fn difference(name: &str, image: &Image, wanted: &Image) -> Result<(), String> {
    let layers = [
        (Layer::Scratches, SCRATCHES_MOST),
        (Layer::Density, DENSITY_MOST),
        (Layer::Beauty, BEAUTY_MOST),
    ];
    for (layer, most) in layers {
        let difference = layer_difference(image, wanted, layer, None);
        let rms = difference.relative_rms();
        println!("{name}, {}: {:.4} % rms", layer.name(), 100.0 * rms);
        if difference.not_finite > 0 || !(rms < most) {
            return Err(format!("{name}, {}: {:.3} %", layer.name(), 100.0 * rms));
        }
    }
    Ok(())
}

#[test]
fn a_disk_under_either_lamp_with_footprints_and_without() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    for (name, light) in [("sphere", SPHERE), ("triangle", TRIANGLE)] {
        for footprint in [PixelFilter::Gaussian, PixelFilter::Off] {
            let pixels = by_pixels(footprint, Gather::Exact);
            let scene = disk(light, 0.2887);
            let [wanted, image] = on_the_gpu(gpu, &scene, [pixels, by_scratches(pixels)]);
            difference(&format!("{name}, {footprint:?}"), &image, &wanted).unwrap();
            // Scratches are lit, and not each pixel for itself.
            assert!(wanted.scratches.iter().any(|c| c[1] > 0.0));
            assert_ne!(image.scratches, wanted.scratches);
        }
    }
}

/// Tiles that are shaded by records alone know of no horizon; where it cuts a lamp, none are.
#[test]
fn the_horizon_is_kept() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let above_and_below = format!("{SPHERE}[[light]]\nradiance = 40.0\n{SPHERE_BELOW}");
    for (name, light) in [
        ("sphere, cut", SPHERE_CUT),
        ("triangle, cut", TRIANGLE_CUT),
        ("above and below", above_and_below.as_str()),
    ] {
        let pixels = by_pixels(PixelFilter::Gaussian, Gather::Exact);
        let mut scene = disk(light, 0.2887);
        scene.render.size_px = [160, 120];
        let [wanted, image] = on_the_gpu(gpu, &scene, [pixels, by_scratches(pixels)]);
        for (layer, most) in [
            (Layer::Scratches, SCRATCHES_CUT_MOST),
            (Layer::Base, BEAUTY_MOST),
        ] {
            let rms = layer_difference(&image, &wanted, layer, None).relative_rms();
            println!("{name}, {}: {:.4} % rms", layer.name(), 100.0 * rms);
            assert!(rms < most, "{name}, {}: {rms}", layer.name());
        }
        assert!(wanted.base.iter().any(|c| c[1] > 0.0));
    }
}

/// So many that a software driver would end the loops over some invocation's stations, were there no bound to them: what an earlier
/// picture had left there would be taken for their light.
#[test]
fn many_lamps() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let mut renderer = gpu.block_on(Renderer::new(gpu)).unwrap();
    let mut render = |light: &str, method| {
        let mut scene = disk(light, 0.2887);
        scene.render.size_px = [96, 72];
        let prepared = Prepared::new(&scene);
        let (index, tables) = (prepared.scratches(), prepared.tables());
        let uploaded = gpu.block_on(renderer.upload(&scene, index, tables, &method));
        let uploaded = uploaded.unwrap();
        let options = RenderOptions::default();
        let image = renderer.render(&scene, &uploaded, &options, &|_| {});
        gpu.block_on(image).unwrap()
    };
    let lamps: Vec<String> = (0..500)
        .map(|i| {
            let angle = f64::from(i) * 0.01256;
            let (x, y) = (0.3 * angle.cos(), 0.3 * angle.sin());
            format!("kind = \"sphere\"\ncenter_m = [{x}, {y}, 0.3]\nradius_m = 0.004\n")
        })
        .collect();
    let lamps = lamps.join("[[light]]\nradiance = 40.0\n");
    let pixels = by_pixels(PixelFilter::Gaussian, Gather::Exact);
    let wanted = render(&lamps, pixels);
    render(SPHERE, by_scratches(pixels));
    let image = render(&lamps, by_scratches(pixels));
    let rms = layer_difference(&image, &wanted, Layer::Scratches, None).relative_rms();
    println!("500 lamps: {:.4} % rms", 100.0 * rms);
    assert!(rms < SCRATCHES_MOST, "{rms}");
}

/// Small lamps, tubes, a brushed face; curves, which no plane stands for; a camera so close that stations do not serve.
#[test]
fn scenes_are_the_same() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let mut failures = Vec::new();
    let scenes = [
        ("plate", 640),
        ("brushed", 256),
        ("closeup", 160),
        ("drawn", 256),
        ("pan", 64),
    ];
    for (name, width_px) in scenes {
        let scene = scene(&format!("{name}.toml"), width_px);
        let pixels = by_pixels(PixelFilter::Gaussian, Gather::Exact);
        let [wanted, image] = on_the_gpu(gpu, &scene, [pixels, by_scratches(pixels)]);
        failures.extend(difference(name, &image, &wanted).err());
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// What is taken together has been added up before; single scratches add to it.
#[test]
fn grids_of_many_go_with_it() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let mut scene = disk(SPHERE, 0.5);
    // From so far that some pixels see many scratches.
    scene.camera.position_m *= 4.0;
    scene.render.size_px = [128, 96];
    for gather in [Gather::Clusters, Gather::Tally] {
        let pixels = by_pixels(PixelFilter::Gaussian, gather);
        let [wanted, image] = on_the_gpu(gpu, &scene, [pixels, by_scratches(pixels)]);
        difference(&format!("{gather:?}"), &image, &wanted).unwrap();
    }
}

/// The last band of a picture has fewer rows, and what passes leave for one another lies elsewhere.
#[test]
fn bands_are_the_whole() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let mut scene = disk(SPHERE, 0.5);
    scene.camera.position_m *= 4.0;
    scene.render.size_px = [128, 96];
    for gather in [Gather::Exact, Gather::Tally] {
        let method = by_scratches(by_pixels(PixelFilter::Gaussian, gather));
        let [whole, bands] = [u32::MAX, 128 * 40].map(|submission_px| {
            let options = RenderOptions {
                submission_px,
                ..Default::default()
            };
            headless::render(gpu, &scene, &method, &options, &|_| {}).unwrap()
        });
        let difference = layer_difference(&bands, &whole, Layer::Scratches, None);
        // A part of a scratch is cut by whichever tile asks for it first; it is the same plane's.
        let rms = difference.relative_rms();
        assert!(rms < 1e-5, "{gather:?}: {rms}");
    }
}

/// A lamp a tenth of its radius away is told apart.
#[test]
fn a_moved_lamp_is_seen() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let pixels = by_pixels(PixelFilter::Gaussian, Gather::Exact);
    let [wanted] = on_the_gpu(gpu, &disk(SPHERE, 0.2887), [pixels]);
    let moved = disk(&SPHERE.replace("[0.0, 0.2", "[0.002, 0.2"), 0.2887);
    let [image] = on_the_gpu(gpu, &moved, [by_scratches(pixels)]);
    assert!(difference("moved", &image, &wanted).is_err());
}
