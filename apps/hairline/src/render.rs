//! `hairline render`: a scene file to a picture.

use hairline_image::{Display, Output};

use crate::failure::Failure;
use crate::scene_file::{self, Overrides};
use crate::{backend, cli};

/// Loads, renders and writes.
pub fn run(arguments: &cli::Render) -> Result<(), Failure> {
    let scene_path = arguments.scene.as_deref();
    let output_path = arguments
        .output
        .clone()
        .unwrap_or_else(|| scene_file::picture_path(scene_path, ".png"));
    // Before the work: nobody should wait for a picture that then has no place to go.
    let output = Output::check(&output_path)?;
    let overrides = Overrides {
        size_px: arguments.size,
        exposure_ev: arguments.exposure,
        scratch_seed: arguments.seed,
    };
    let scene = scene_file::load(scene_path, &overrides)?.scene;
    let image = backend::render(&scene, arguments.backend, arguments.samples)?;
    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    output.write_image(&image, &display)?;
    Ok(())
}
