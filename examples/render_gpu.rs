//! Renders a scene file on the GPU: `cargo run --release --example render_gpu [SCENE] [PICTURE] [WIDTH]`.

use std::path::Path;

use hairline_document::DEFAULT_SAMPLES;
use hairline_gpu::{AdapterRequest, RenderOptions, headless};
use hairline_image::{Display, Output};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or("scenes/plate.toml".into());
    let picture = arguments.next().unwrap_or("render_gpu.png".into());
    let mut scene = hairline_document::load(&file)?;
    if let Some(width) = arguments.next() {
        let [full_width, full_height] = scene.render.size_px;
        let width: u32 = width.parse()?;
        scene.render.size_px = [width, (full_height * width).div_ceil(full_width)];
    }

    // Blocks until the picture is there. For many pictures, or in a window: `Renderer`, which waits for nothing.
    let gpu = headless::open(&AdapterRequest::default())?;
    let options = RenderOptions {
        samples: DEFAULT_SAMPLES,
        ..Default::default()
    };
    let image = headless::render(&gpu, &scene, &Default::default(), &options, &|_| {})?;

    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    Output::check(Path::new(&picture))?.write_image(&image, &display)?;
    println!("{picture}, by {}", gpu.adapter);
    Ok(())
}
