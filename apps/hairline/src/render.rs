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
use hairline_scene::{DEFAULT_TRANSPORT, Transport};

use crate::backend::{Painter, Rendered, Task};
use crate::console::tell;
use crate::failure::Failure;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::progress::Progress;
use crate::scene_file::{self, Overrides};
use crate::switch::Switch;
use crate::{cli, method_flags};
use goals::Goals;
use motion::Motion;

/// Loads, renders and writes.
pub fn run(arguments: &cli::Render) -> Result<(), Failure> {
    let method = arguments.method.method()?;
    let transport = transport(arguments, &method)?;
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
    let notes = notes(&method, transport);
    let write = |output: &Output, image: &Image, notes: &Notes| -> Result<(), Failure> {
        Ok(output.write_image_with_notes(image, &display, notes)?)
    };
    let task = Task {
        method,
        backend: arguments.backend,
        samples: arguments.samples,
        transport,
    };
    let mut painter = Painter::open(scene, task)?;
    match target {
        Target::One(output) => {
            let interrupt = match transport.shadows {
                true => Interrupt::listen().map_err(cannot_listen)?,
                false => Interrupt::default(),
            };
            let progress = Progress::start("rendering");
            let is_stopped = || interrupt.is_asked();
            let rendered = painter.render(scene, &is_stopped, &|share| progress.set(share))?;
            drop(progress);
            let Rendered {
                image,
                samples,
                wanted,
            } = rendered;
            if samples == wanted {
                return write(&output, &image, &notes);
            }
            let so_far = format!("{samples} of {wanted}");
            let mut notes = notes;
            notes.insert("samples".to_owned(), so_far.clone());
            write(&output, &image, &notes)?;
            let name = output.path().display();
            tell(format_args!("interrupted: {name} has {so_far} samples"));
            Ok(())
        }
        Target::Many(motion, goals) => {
            let stability = arguments.sequence.stability;
            let write = |output: &Output, image: &Image| write(output, image, &notes);
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

/// The ways of light: what is asked for, else the default as far as the method has it.
fn transport(arguments: &cli::Render, method: &Method) -> Result<Transport, Failure> {
    let refuse = |why: &str| Err(Failure::Input(anyhow!("{why}")));
    let asked = arguments.shadows.map(|switch| switch == Switch::On);
    if method.published.is_some() && asked == Some(true) {
        return refuse(
            "--shadows on: the published method has no shadows; leave out --method published",
        );
    }
    let is_default = DEFAULT_TRANSPORT.shadows && method.published.is_none();
    let asked_bounces = arguments.bounces.filter(|&bounces| bounces > 0);
    if !asked.unwrap_or(is_default) {
        return match asked_bounces {
            None => Ok(Transport::DIRECT),
            Some(bounces) => refuse(&format!(
                "--bounces {bounces}: without shadows the light that an object hides would be counted beside its own; add --shadows on"
            )),
        };
    }
    Ok(Transport {
        shadows: true,
        bounces: arguments.bounces.unwrap_or(DEFAULT_TRANSPORT.bounces),
    })
}

/// What of how a picture was made is not the default.
fn notes(method: &Method, Transport { shadows, bounces }: Transport) -> Notes {
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
