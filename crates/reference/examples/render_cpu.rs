//! Renders a scene file on the CPU: `cargo run --release -p hairline-reference --example render_cpu scenes/plate.toml plate.exr [SAMPLES]
//! [WIDTH]`. Prints how much work it was.

use std::path::Path;
use std::time::Instant;

use hairline_image::Display;
use hairline_image::output::Output;
use hairline_optics::method::Method;
use hairline_reference::closed_form::{Prepared, RenderOptions};
use hairline_scene::Scene;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let argument = |i: usize| arguments.get(i).map(String::as_str);
    let (Some(file), Some(out)) = (argument(0), argument(1)) else {
        return Err("usage: render SCENE.toml OUT.exr [SAMPLES] [WIDTH]".into());
    };
    let mut scene = Scene::load(file)?;
    if let Some(width) = argument(3).and_then(|text| text.parse().ok()) {
        let [w, h] = scene.render.size_px;
        scene.render.size_px = [width, (width * h).div_ceil(w)];
    }
    let options = RenderOptions {
        samples: argument(2).map_or(Ok(8), str::parse)?,
        method: Method::default(),
    };
    let prepared = Prepared::new(&scene);
    let start = Instant::now();
    let rows = 0..scene.render.size_px[1];
    let (image, counts) = prepared.render_counted(&options, rows, &|_| {});
    println!("{:.3} s, {counts:?}", start.elapsed().as_secs_f64());
    Output::check(Path::new(out))?.write_image(&image, &Display::default())?;
    Ok(())
}
