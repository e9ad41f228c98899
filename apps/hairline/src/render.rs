//! `hairline render`: a scene file to a picture, or to a sequence of them.

mod goals;
mod motion;
mod sequence;
mod steadiness;

use std::path::Path;

use anyhow::anyhow;
use hairline_image::exr_file::Notes;
use hairline_image::{Animation, Display, Image, Output};
use hairline_index::method::Method;

use crate::backend::{Painter, Task};
use crate::failure::Failure;
use crate::progress::Progress;
use crate::scene_file::{self, Overrides};
use crate::switch::Switch;
use crate::{cli, method_flags};
use goals::Goals;
use motion::Motion;

/// Loads, renders and writes.
pub fn run(arguments: &cli::Render) -> Result<(), Failure> {
    let method = arguments.method.method()?;
    let shadows = shadows(arguments, &method)?;
    let motion = Motion::of(&arguments.sequence)?;
    // Before the work: nobody should wait for a picture that then has no place to go.
    let target = match &motion {
        None => Target::One(single(arguments)?),
        Some(motion) => Target::Many(motion, Goals::check(arguments, motion.frames)?),
    };
    let overrides = Overrides {
        size_px: arguments.size,
        exposure_ev: arguments.exposure,
        scratch_seed: arguments.seed,
        tone_map: arguments.tone_map,
        highlight: arguments.highlight.as_ref(),
    };
    let loaded = scene_file::load(arguments.scene.as_deref(), &overrides, &target.paths())?;
    if let Some(motion) = &motion {
        motion.check(&loaded.description.camera)?;
    }
    let scene = &loaded.scene;
    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    let write = |output: &Output, image: &Image| -> Result<(), Failure> {
        Ok(output.write_image_with_notes(
            image,
            &display,
            &notes(&method, shadows, arguments.bounces),
        )?)
    };
    let task = Task {
        method,
        backend: arguments.backend,
        samples: arguments.samples,
        shadows,
        bounces: arguments.bounces,
    };
    let mut painter = Painter::open(scene, task)?;
    match target {
        Target::One(output) => {
            let progress = Progress::start("rendering");
            let image = painter.render(scene, &|share| progress.set(share))?;
            drop(progress);
            write(&output, &image)
        }
        Target::Many(motion, goals) => {
            let stability = arguments.sequence.stability;
            sequence::run(&loaded, motion, &goals, stability, &mut painter, &write)
        }
    }
}

/// Where pictures go.
enum Target<'a> {
    One(Output),
    Many(&'a Motion, Goals),
}

impl Target<'_> {
    fn paths(&self) -> Vec<&Path> {
        match self {
            Self::One(output) => vec![output.path()],
            Self::Many(_, goals) => {
                let pictures = goals.pictures.iter().map(Output::path);
                pictures.chain(goals.animation.as_deref()).collect()
            }
        }
    }
}

fn single(arguments: &cli::Render) -> Result<Output, Failure> {
    let path = arguments
        .output
        .clone()
        .unwrap_or_else(|| scene_file::picture_path(arguments.scene.as_deref(), ".png"));
    if Animation::is_asked_by(&path) {
        let path = path.display();
        return Err(Failure::Input(anyhow!(
            "{path}: an animation needs --frames N, with --turntable DEG or --zoom A:B"
        )));
    }
    Ok(Output::check(&path)?)
}

/// Whether there are shadows.
fn shadows(arguments: &cli::Render, method: &Method) -> Result<bool, Failure> {
    let refuse = |why: &str| Err(Failure::Input(anyhow!("{why}")));
    let bounces = arguments.bounces;
    if arguments.shadows == Switch::Off {
        if bounces > 0 {
            return refuse(&format!(
                "--bounces {bounces}: without shadows the light that an object hides would be counted beside its own; add --shadows on"
            ));
        }
        return Ok(false);
    }
    if method.published.is_some() {
        return refuse(
            "--shadows on: the published method has no shadows; leave out --method published",
        );
    }
    Ok(true)
}

/// What of how a picture was made is not the default.
fn notes(method: &Method, shadows: bool, bounces: u32) -> Notes {
    let mut notes = Notes::new();
    if shadows {
        notes.insert("shadows".to_owned(), "on".to_owned());
    }
    if bounces > 0 {
        notes.insert("bounces".to_owned(), bounces.to_string());
    }
    if *method != Method::default() {
        notes.insert("method".to_owned(), method_flags::flags_of(method));
    }
    notes
}
