//! `hairline render`: a scene file to a picture.

use hairline_image::exr_file::Notes;
use hairline_image::{Display, Output};
use hairline_optics::method::Method;

use crate::backend::{Painter, Task};
use crate::failure::Failure;
use crate::progress::Progress;
use crate::scene_file::{self, Overrides};
use crate::{backend, cli, method_flags};

/// Loads, renders and writes.
pub fn run(arguments: &cli::Render) -> Result<(), Failure> {
    let method = arguments.method.method()?;
    backend::check(&method, arguments.backend)?;
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
    let task = Task {
        method,
        backend: arguments.backend,
        samples: arguments.samples,
        pictures: 1,
    };
    let mut painter = Painter::open(&scene, task)?;
    let progress = Progress::start("rendering");
    let image = painter.render(&scene, &|share| progress.set(share))?;
    drop(progress);
    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    output.write_image_with_notes(&image, &display, &notes(&method))?;
    Ok(())
}

/// By which method a picture was made, where that was another than the default.
fn notes(method: &Method) -> Notes {
    let mut notes = Notes::new();
    if *method != Method::default() {
        notes.insert("method".to_owned(), method_flags::flags_of(method));
    }
    notes
}
