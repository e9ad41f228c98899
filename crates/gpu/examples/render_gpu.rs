//! Renders a scene file on the GPU: `cargo run --release -p hairline-gpu --example render_gpu scenes/plate.toml plate.exr [SAMPLES] [WIDTH]
//! [published]`. Prints how long each pass took by the device's own clock.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use hairline_gpu::{AdapterRequest, RenderOptions, Renderer, headless};
use hairline_image::Display;
use hairline_image::output::Output;
use hairline_index::ScratchIndex;
use hairline_optics::method::Method;
use hairline_scene::{Scene, ScratchTables};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let argument = |i: usize| arguments.get(i).map(String::as_str);
    let (Some(file), Some(out)) = (argument(0), argument(1)) else {
        return Err("usage: render SCENE.toml OUT.exr [SAMPLES] [WIDTH] [published]".into());
    };
    let mut scene = Scene::load(file)?;
    if let Some(width) = argument(3).and_then(|text| text.parse().ok()) {
        let [w, h] = scene.render.size_px;
        scene.render.size_px = [width, (width * h).div_ceil(w)];
    }
    let method = match argument(4) {
        Some("published") => Method::PUBLISHED,
        _ => Method::default(),
    };
    let options = RenderOptions {
        samples: argument(2).map_or(Ok(8), str::parse)?,
        ..Default::default()
    };
    let gpu = headless::open(&AdapterRequest::default())?;
    let (index, tables) = (
        Arc::new(ScratchIndex::build(&scene)),
        ScratchTables::new(&scene),
    );
    let image = gpu.block_on(async {
        let mut renderer = Renderer::new(&gpu).await?;
        let start = Instant::now();
        let uploaded = renderer.upload(&scene, &index, &tables, &method).await?;
        println!(
            "upload and compilation {:.2} s",
            start.elapsed().as_secs_f64()
        );
        // A driver compiles for the device when a pass runs for the first time.
        let start_cold = Instant::now();
        renderer
            .render(&scene, &uploaded, &options, &|_| {})
            .await?;
        println!("first picture {:.3} s", start_cold.elapsed().as_secs_f64());
        renderer.time_passes().await?;
        let start = Instant::now();
        let image = renderer
            .render(&scene, &uploaded, &options, &|_| {})
            .await?;
        println!("{} {:.3} s", gpu.adapter, start.elapsed().as_secs_f64());
        for pass in renderer.pass_times().await?.unwrap_or_default() {
            println!("{:>12} {:8.1} ms", pass.name, pass.time.as_secs_f64() * 1e3);
        }
        Ok::<_, hairline_gpu::Error>(image)
    })?;
    Output::check(Path::new(out))?.write_image(&image, &Display::default())?;
    Ok(())
}
