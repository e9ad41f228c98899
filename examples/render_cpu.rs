//! Renders a scene file on the CPU: `cargo run --release --example render_cpu [SCENE] [PICTURE] [WIDTH]`.

use std::path::Path;

use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_document::DEFAULT_SAMPLES;
use hairline_image::{Display, Output};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or("scenes/plate.toml".into());
    let picture = arguments.next().unwrap_or("render_cpu.png".into());
    let mut scene = hairline_document::load(&file)?;
    if let Some(width) = arguments.next() {
        let [full_width, full_height] = scene.render.size_px;
        let width: u32 = width.parse()?;
        scene.render.size_px = [width, (full_height * width).div_ceil(full_width)];
    }

    // The trees over triangles and scratches and the tables of the materials, for any number of pictures.
    let prepared = Prepared::new(&scene);
    let options = RenderOptions {
        samples: DEFAULT_SAMPLES,
        ..Default::default()
    };
    let image = prepared.render(&options, &|_| {});

    // PNG for a display, or EXR with all layers: the ending says which.
    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    Output::check(Path::new(&picture))?.write_image(&image, &display)?;
    println!("{picture}");
    Ok(())
}
