//! How far the pictures of bundled scratches (docs/model.md, section 7) are from those of all scratches one by one, and what each
//! costs: `cargo run --release -p hairline-reference --example clusters -- [SCENE ...] [--zoom A,B,..] [--size W,H]`, where a scene is a
//! file, `built-in`, or `disk:COUNT:LAYERS`.
//!
//! A zoom divides the camera's distance. What is rendered is the middle of a picture 720 pixels high, so that pixels are as large
//! as in a whole one. Times are of one thread, by the kernel's account of it, for each pixel that shows scratches.

use hairline_image::{Display, Image};
use hairline_optics::method::{Gather, Method};
use hairline_reference::closed_form::{Prepared, RenderOptions};
use hairline_scene::Scene;
use std::path::Path;
use std::time::Instant;

const FULL_HEIGHT_PX: f64 = 720.0;

fn main() {
    let mut scenes = Vec::new();
    let mut zooms = vec![0.1, 0.35, 1.0, 3.0, 8.0];
    let mut size_px = [96u32, 54];
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut numbers = || -> Vec<f64> {
            let text = arguments.next().unwrap_or_default();
            text.split(',').filter_map(|n| n.parse().ok()).collect()
        };
        match argument.as_str() {
            "--zoom" => zooms = numbers(),
            "--size" => {
                let numbers = numbers();
                size_px = [numbers[0] as u32, numbers[1] as u32];
            }
            scene => scenes.push(scene.to_string()),
        }
    }
    println!(
        "{:26} {:>5} | {:>7} {:>8} {:>8} {:>6} | {:>8} {:>8} {:>7} | {:>8} {:>7} {:>7} {:>7} {:>7} {:>8}",
        "scene",
        "zoom",
        "rms %",
        "block %",
        "total %",
        "FLIP",
        "segments",
        "lit",
        "us",
        "probes",
        "segm.",
        "shares",
        "bundles",
        "lit",
        "us"
    );
    for name in &scenes {
        let scene = load(name);
        let start = Instant::now();
        let prepared = Prepared::new(&scene);
        let exact_s = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let clusters = prepared.bundle_index();
        let clusters_s = start.elapsed().as_secs_f64();
        let scratches: usize = scene.objects.iter().map(|o| o.scratches.len()).sum();
        let segments: usize = scene.objects.iter().map(|o| o.segments.len()).sum();
        for object in clusters.objects.iter().filter(|o| o.level_count > 0) {
            println!(
                "cells of {:.0} um, {} levels, {} vertices in the finest",
                object.cell_m * 1e6,
                object.level_count,
                object
                    .classes
                    .iter()
                    .map(|l| l.levels[0].vertices.len())
                    .sum::<usize>()
            );
        }
        println!(
            "{name}: {scratches} scratches, {segments} segments; tree and tables {exact_s:.2} s, grids and spectra {clusters_s:.2} s, {:.0} bytes a scratch",
            clusters.bytes() as f64 / scratches as f64
        );
        for &zoom in &zooms {
            report(name, &scene, &prepared, zoom, size_px);
        }
    }
}

fn report(name: &str, scene: &Scene, built: &Prepared, zoom: f64, size_px: [u32; 2]) {
    let mut scene = scene.clone();
    let camera = &mut scene.camera;
    let away = camera.position_m - camera.target_m;
    camera.position_m = camera.target_m + away / zoom;
    let half = (0.5 * camera.fov_y_rad).tan() * size_px[1] as f64 / FULL_HEIGHT_PX;
    camera.fov_y_rad = 2.0 * half.atan();
    scene.render.size_px = size_px;
    let prepared = built.with_scene(&scene);
    let exact = Method::default();
    let bundled = Method {
        gather: Gather::Tally,
        ..exact
    };
    let (reference, exact_us) = render(&prepared, exact);
    let (image, bundled_us) = render(&prepared, bundled);
    let error = Errors::of(&scene, &image, &reference);
    let (e, pixels) = prepared.gather_counts(exact, 3);
    let (b, _) = prepared.gather_counts(bundled, 3);
    let each = |n: u64| n as f64 / pixels.max(1) as f64;
    let scratched = reference
        .density
        .iter()
        .filter(|d| d.iter().any(|c| *c != 0.0))
        .count() as f64;
    println!(
        "{name:26} {zoom:5} | {:7.2} {:8.3} {:8.3} {:6.4} | {:8.0} {:8.1} {:7.1} | {:8.1} {:7.1} {:7.1} {:7.1} {:7.1} {:8.1}",
        100.0 * error.rms,
        100.0 * error.blocks,
        100.0 * error.total,
        error.flip,
        each(e.segments),
        each(e.lit),
        exact_us / scratched,
        each(b.nodes),
        each(b.segments),
        each(b.shares),
        each(b.clusters),
        each(b.lit),
        bundled_us / scratched,
    );
}

/// The picture and the time that one thread worked on it, microseconds.
fn render(prepared: &Prepared, method: Method) -> (Image, f64) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread");
    pool.install(|| {
        let options = RenderOptions { samples: 1, method };
        let start = worked_us();
        let image = prepared.render(&options, &|_| {});
        (image, worked_us() - start)
    })
}

fn worked_us() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ns: Option<f64> = text.split_whitespace().next().and_then(|n| n.parse().ok());
    ns.unwrap_or(0.0) * 1e-3
}

struct Errors {
    rms: f64,
    blocks: f64,
    total: f64,
    flip: f64,
}

impl Errors {
    fn of(scene: &Scene, image: &Image, reference: &Image) -> Self {
        let [width, height] = image.size_px;
        let relative = |side: u32| {
            let (mut error2, mut value2) = (0.0, 0.0);
            for y in (0..height).step_by(side as usize) {
                for x in (0..width).step_by(side as usize) {
                    for c in 0..3 {
                        let mean = |image: &Image| -> f64 {
                            (y..height.min(y + side))
                                .flat_map(|y| (x..width.min(x + side)).map(move |x| (x, y)))
                                .map(|(x, y)| f64::from(image.scratches[image.index(x, y)][c]))
                                .sum()
                        };
                        let (a, b) = (mean(image), mean(reference));
                        error2 += (a - b) * (a - b);
                        value2 += b * b;
                    }
                }
            }
            (error2 / f64::max(value2, 1e-300)).sqrt()
        };
        let sum = |image: &Image| -> f64 {
            image
                .scratches
                .iter()
                .flatten()
                .map(|c| f64::from(*c))
                .sum()
        };
        let display = Display {
            exposure_ev: scene.camera.exposure_ev,
            tone_map: scene.render.tone_map,
        };
        let flip =
            hairline_image::metrics::flip(&image.beauty(), &reference.beauty(), &display, None);
        Self {
            rms: relative(1),
            blocks: relative(16),
            total: sum(image) / sum(reference) - 1.0,
            flip: flip.map_or(0.0, |f| f.mean),
        }
    }
}

fn load(name: &str) -> Scene {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let result = if name == "built-in" {
        Scene::load(root.join("apps/hairline/src/built_in_scene.toml"))
    } else if let Some(disk) = name.strip_prefix("disk:") {
        let mut parts = disk.split(':').map(|n| n.parse::<u32>().unwrap_or(1));
        let (count, layers) = (parts.next().unwrap_or(10_000), parts.next().unwrap_or(1));
        Scene::from_toml(&disk_toml(count, layers), "disk", ".")
    } else {
        Scene::load(root.join(name))
    };
    result.unwrap_or_else(|error| panic!("{error}"))
}

/// A worn disk under a lamp and a tube.
fn disk_toml(count: u32, layers: u32) -> String {
    let mut text = String::from(
        "[camera]\nposition_m = [0.0, -0.27, 0.22]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 22.5\n\
         [[material]]\nname = \"steel\"\nkind = \"metal\"\nmetal = \"steel\"\nroughness = 0.055\n\
         [[object]]\nname = \"disk\"\nmaterial = \"steel\"\nshape = { disk = { radius_m = 0.08 } }\n\
         [[light]]\nkind = \"sphere\"\ncenter_m = [-0.088, 0.212, 0.197]\nradius_m = 0.01\nradiance = 40.0\n\
         [[light]]\nkind = \"polygon\"\nvertices_m = [[-0.39, 0.401, 0.1777], [0.51, 0.401, 0.1777], [0.51, 0.399, 0.1823], [-0.39, 0.399, 0.1823]]\nradiance = 320.0\n",
    );
    for layer in 0..layers {
        let (pattern, width) = match layer {
            0 => (
                "pattern = \"random\"\ncurvature_per_m = { mean = 0.0, spread = 6.0 }",
                3.0,
            ),
            1 => ("pattern = \"circular\"\njitter_deg = 3.0", 5.0),
            _ => (
                "pattern = \"parallel\"\ndirection = [1.0, 0.3, 0.0]\njitter_deg = 3.0",
                2.0,
            ),
        };
        text += &format!(
            "[[scratches]]\nobject = \"disk\"\n{pattern}\ncount = {}\nseed = {layer}\nlength_m = {{ mean = 0.01, spread = 0.5 }}\n\
             width_um = {{ mean = {width:.1}, spread = 0.12 }}\ndepth_nm = {{ mean = {}, spread = 0.12 }}\n",
            count / layers,
            190 - 20 * layer
        );
    }
    text
}
