//! `hairline render`: a scene file to a picture, or to a sequence of them.

mod goals;
mod looks;
mod motion;
mod sequence;
mod single;
mod steadiness;
mod target;
mod work;

use anyhow::anyhow;
use hairline_console::{Switch, tell};
use hairline_image::exr_file::Notes;
use hairline_published::Method;
use hairline_render::failure::Failure;
use hairline_render::{Task, Writer};
use hairline_scene::Transport;

use crate::progress::Terminal;
use crate::scene_file::{self, Overrides};
use crate::{cli, method_flags};
use target::Target;
use work::Work;

/// Loads, renders and writes.
pub fn run(arguments: &cli::Render) -> Result<(), Failure> {
    let method = arguments.method.method()?;
    let mut task = task(arguments, &method)?;
    let motion = motion::from_flags(&arguments.sequence, arguments.time)?;
    // Before the work: nobody should wait for a picture that then has no place to go.
    let target = Target::check(arguments, motion.as_ref())?;
    let labels = target.check_labels(arguments)?;
    let mut outputs = target.paths();
    outputs.extend(labels.as_ref().map(|labels| labels.path()));
    let loaded = scene_file::load(arguments.scene.as_deref(), &overrides(arguments), &outputs)?;
    if let Some(motion) = &motion {
        motion::check(motion, &loaded.description.camera)?;
    }
    task.is_transparent = loaded.description.cuts_out() && arguments.bands.is_none();
    if arguments.bands.is_none() {
        for note in target.left_out(&loaded.finish) {
            tell(format_args!("note: {note}"));
        }
    }
    let work = Work {
        arguments,
        writer: Writer {
            display: loaded.scene.display(),
            finish: loaded.finish.clone(),
            notes: notes(&task, &method),
        },
        task,
        terminal: Terminal::default(),
    };
    match target {
        Target::Looks => looks::run(loaded, &work),
        Target::Many(motion, goals) => sequence::run(loaded, motion, &goals, &work),
        Target::One(output) => match &arguments.bands {
            Some(cli::Bands(bands_nm)) => {
                single::write_bands(&loaded.scene, bands_nm, &work, &output)
            }
            None => single::run(&loaded, &work, &output, labels.as_ref()),
        },
    }
}

/// Settings of the rendering by the flags.
fn task(arguments: &cli::Render, method: &Method) -> Result<Task, Failure> {
    let transport = transport(arguments.shadows, arguments.bounces, method)?;
    if arguments.shadows_only && !transport.shadows {
        return Err(Failure::Input(anyhow!(
            "--shadows-only: nothing is left without shadows; leave --shadows off and --method published out"
        )));
    }
    Ok(Task {
        mask: method.mask,
        method: plugged(method),
        is_filtered: arguments.filter == Switch::On,
        ..Task::new(arguments.samples, transport)
    })
}

/// Values of flags that replace those of the scene file.
fn overrides(arguments: &cli::Render) -> Overrides<'_> {
    Overrides {
        size_px: arguments.size,
        exposure_ev: arguments.exposure,
        scratch_seed: arguments.scene_flags.seed,
        tone_map: arguments.tone_map,
        time_s: arguments.time.map(|[from, _]| from),
        camera: arguments.scene_flags.camera.as_deref(),
        highlight: arguments.highlight.as_ref(),
        is_lit_for_scratches: arguments.scene_flags.show_scratches,
        wear: arguments.scene_flags.wear,
        transparent: arguments.transparent,
        shadows_only: arguments.shadows_only,
        behind: arguments.behind.as_deref(),
        png_bits: arguments.png_bits,
        interrupt: None,
    }
}

/// Transport of light by the flags, else the default.
pub fn transport(
    shadows: Option<Switch>,
    bounces: Option<u32>,
    method: &Method,
) -> Result<Transport, Failure> {
    if method.published.is_none() {
        return hairline_console::transport(shadows, bounces);
    }
    if shadows == Some(Switch::On) {
        return Err(Failure::Input(anyhow!(
            "--shadows on: the published method has no shadows; leave out --method published"
        )));
    }
    hairline_console::transport(Some(Switch::Off), bounces)
}

/// The method for both renderers, unless it is Hairline's own.
fn plugged(method: &Method) -> Option<hairline_render::Method> {
    Some(hairline_render::Method {
        on_cpu: method.on_cpu()?,
        on_gpu: method.on_gpu().other?,
    })
}

/// Notes on the settings of a picture that are not the default.
fn notes(task: &Task, method: &Method) -> Notes {
    let mut notes = task.notes();
    if *method != Method::default() {
        notes.insert("method".to_owned(), method_flags::flags_of(method));
    }
    notes
}
