//! How far pictures with scratches lit along themselves are from those with scratches lit at pixels (docs/model.md, section 6), and
//! what both cost: `cargo run --release -p hairline-reference --example light_at -- SCENE.toml ... [--zoom A,B,..] [--alone]`.
//!
//! A zoom divides the camera's distance. Times are of one thread, by the kernel's account of it, for the whole picture, base and all.
//! With `--alone` only the quicker of both is done.

use hairline_image::Image;
use hairline_optics::method::{LightAt, Method};
use hairline_reference::closed_form::{Prepared, RenderOptions};
use hairline_scene::Scene;
use std::path::Path;

fn main() {
    let mut scenes = Vec::new();
    let mut zooms = vec![1.0];
    let mut alone = false;
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--zoom" => {
                let text = arguments.next().unwrap_or_default();
                zooms = text.split(',').filter_map(|n| n.parse().ok()).collect();
            }
            "--alone" => alone = true,
            scene => scenes.push(scene.to_string()),
        }
    }
    println!(
        "{:26} {:>5} | {:>8} {:>8} {:>6} | {:>7} {:>8} {:>8}",
        "scene", "zoom", "pixel ms", "along ms", "times", "rms %", "block %", "total %"
    );
    for name in &scenes {
        let scene = Scene::load(Path::new(name)).expect("a scene");
        let built = Prepared::new(&scene);
        for &zoom in &zooms {
            let mut scene = scene.clone();
            let camera = &mut scene.camera;
            let away = camera.position_m - camera.target_m;
            camera.position_m = camera.target_m + away / zoom;
            let prepared = built.with_scene(&scene);
            let of = |light_at| Method {
                light_at,
                ..Method::default()
            };
            let (image, along_ms) = render(&prepared, of(LightAt::Scratches));
            if alone {
                println!("{name:26} {zoom:5} | {:8} {along_ms:8.0}", "");
                continue;
            }
            let (reference, pixel_ms) = render(&prepared, of(LightAt::Pixels));
            let [rms, block, total] = errors(&image, &reference);
            println!(
                "{name:26} {zoom:5} | {pixel_ms:8.0} {along_ms:8.0} {:6.1} | {:7.3} {:8.3} {:8.3}",
                pixel_ms / along_ms,
                100.0 * rms,
                100.0 * block,
                100.0 * total
            );
        }
    }
}

/// The picture and the time that one thread worked on it, milliseconds.
fn render(prepared: &Prepared, method: Method) -> (Image, f64) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread");
    pool.install(|| {
        let options = RenderOptions { samples: 1, method };
        let start = worked_ms();
        let image = prepared.render(&options, &|_| {});
        (image, worked_ms() - start)
    })
}

fn worked_ms() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ns: Option<f64> = text.split_whitespace().next().and_then(|n| n.parse().ok());
    ns.unwrap_or(0.0) * 1e-6
}

/// Of the scratch layer: root mean square over that of the reference, the same of means over 16 x 16 pixels, and of the whole.
fn errors(image: &Image, reference: &Image) -> [f64; 3] {
    let width = image.size_px[0] as usize;
    let (mut off, mut all) = (0.0, 0.0);
    let across = width.div_ceil(16);
    let mut blocks = vec![[[0.0; 3]; 2]; across * (image.size_px[1] as usize).div_ceil(16)];
    let mut totals = [0.0; 2];
    for (i, (a, b)) in image.scratches.iter().zip(&reference.scratches).enumerate() {
        let block = &mut blocks[i / width / 16 * across + i % width / 16];
        for c in 0..3 {
            let (a, b) = (f64::from(a[c]), f64::from(b[c]));
            off += (a - b) * (a - b);
            all += b * b;
            block[0][c] += a - b;
            block[1][c] += b;
            totals[0] += a - b;
            totals[1] += b;
        }
    }
    let sum = |which: usize| -> f64 { blocks.iter().flat_map(|b| b[which]).map(|x| x * x).sum() };
    [
        (off / all).sqrt(),
        (sum(0) / sum(1)).sqrt(),
        totals[0] / totals[1],
    ]
}
