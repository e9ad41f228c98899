//! `hairline reference`: a scene file to a picture by Monte Carlo, with its variance, that can be stopped and gone on with.

use std::time::Duration;

use anyhow::anyhow;
use hairline_console::{Switch, tell};
use hairline_document::Arrays;
use hairline_image::{Format, Output};
use hairline_optics::mask::Mask;
use hairline_reference::{BATCH_SAMPLES, Integrator, Model, Settings};
use hairline_render::reference::{self, Count, End, Limits, identity};

use crate::cli;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::progress::{Progress, Terminal};
use crate::scene_file::{self, Overrides};
use hairline_render::failure::Failure;

/// Largest time whose samples a crash or a power cut may lose.
const SAVE_EVERY: Duration = Duration::from_secs(60);

/// Loads, samples and writes.
pub fn run(arguments: &cli::Reference) -> Result<(), Failure> {
    let scene_path = Some(arguments.scene.as_path());
    let output = output(arguments)?;
    let name = output.path().display();
    let settings = settings(arguments)?;
    let overrides = Overrides {
        size_px: arguments.size,
        exposure_ev: arguments.exposure,
        scratch_seed: arguments.seed,
        ..Overrides::default()
    };
    let loaded = scene_file::load(scene_path, &overrides, &[output.path()])?;
    let scene = &loaded.scene;
    let fingerprint =
        reference::fingerprint(&loaded.description, &loaded.folder, &Arrays::default())
            .map_err(Failure::Work)?;
    let notes = identity::notes(&settings, &fingerprint);

    let exists = output.path().exists();
    let earlier = (exists && arguments.resume)
        .then(|| identity::read_to_resume(output.path(), scene.render.size_px, &notes))
        .transpose()?;
    let limits = Limits::new(arguments.spp, arguments.time, SAVE_EVERY);
    let count = earlier.as_ref().map(Count::new);
    if let Some(count) = count
        && count.least >= limits.samples
    {
        tell(format_args!(
            "{name} has {} samples for each pixel already: nothing to do",
            count.least
        ));
        return Ok(());
    }
    let from = start(count, exists, &output);
    // Work from here on should not be lost by Ctrl-C.
    let interrupt = Interrupt::listen().map_err(cannot_listen)?;
    tell(format_args!(
        "{}: {from}",
        announcement(arguments, &settings, &limits)
    ));
    if output.format() == Format::Png {
        tell("warning: a .png keeps neither the variance nor what --resume needs; an .exr does");
    }

    let display = scene.display();
    let save = |image: &_| -> Result<(), Failure> {
        Ok(output.write_image_with_notes(image, &display, &notes)?)
    };
    let integrator = Integrator::new(scene, settings);
    let mut image = earlier.unwrap_or_else(|| integrator.start());
    let share = Count::new(&image).share_of(limits.samples);
    let terminal = Terminal::showing(Progress::start_from("sampling", share));
    let interrupted = || interrupt.is_asked();
    let end = reference::sample(
        &integrator,
        &mut image,
        &limits,
        &interrupted,
        &terminal,
        &save,
    )?;
    drop(terminal);

    ended(end, Count::new(&image), &output)
}

/// The picture's place. Checked before the work: nobody should wait for a picture that then has no place to go.
fn output(arguments: &cli::Reference) -> Result<Output, Failure> {
    let path = arguments.output.clone();
    let path =
        path.unwrap_or_else(|| scene_file::picture_path(Some(&arguments.scene), "-reference.exr"));
    let output = Output::check(&path)?;
    if output.format() == Format::Png && arguments.resume {
        return Err(Failure::Input(anyhow!(
            "{}: --resume needs what a .png cannot hold, the samples and their variance; end it in .exr",
            path.display()
        )));
    }
    Ok(output)
}

/// In words, where the sampling starts.
fn start(count: Option<Count>, exists: bool, output: &Output) -> String {
    let name = output.path().display();
    match (count, exists) {
        (Some(count), _) => format!("going on from {}", listed(count)),
        (None, true) if output.format() == Format::Exr => {
            format!(
                "from the start, in place of the {name} that is there (--resume goes on from it)"
            )
        }
        (None, _) => "from the start".to_owned(),
    }
}

/// Tells of an end before the last sample.
fn ended(end: End, count: Count, output: &Output) -> Result<(), Failure> {
    let name = output.path().display();
    let reason = match end {
        End::Complete => return Ok(()),
        End::TimeUp => "the time is up",
        End::Interrupted => "interrupted",
    };
    if count.mean == 0.0 {
        return Err(Failure::Work(anyhow!(
            "{reason} before the first samples were done; there is nothing to write"
        )));
    }
    let filled = if count.least == 0 {
        "; pixels without samples show their neighbours"
    } else {
        ""
    };
    let go_on = if output.format() == Format::Exr {
        "; --resume goes on from there"
    } else {
        ""
    };
    tell(format_args!(
        "{reason}: {name} has {}{filled}{go_on}",
        listed(count)
    ));
    Ok(())
}

fn settings(arguments: &cli::Reference) -> Result<Settings, Failure> {
    let model = match arguments.model {
        cli::Model::Separable => Model::Separable,
        cli::Model::Full => Model::Full,
    };
    if model == Model::Full && arguments.mask.is_some() {
        return Err(Failure::Input(anyhow!(
            "--mask is for --model separable: the full model knows by its phases what scratches take from the base"
        )));
    }
    Ok(Settings {
        model,
        mask: arguments.mask.map_or(Mask::Energy, Into::into),
        bounces: arguments.bounces,
        shadows: arguments.shadows == Switch::On,
        seed: arguments.sample_seed,
    })
}

/// The model, the threads and how far to go.
fn announcement(arguments: &cli::Reference, settings: &Settings, limits: &Limits) -> String {
    let mut goal = Vec::new();
    if arguments.spp.is_some() || arguments.time.is_none() {
        goal.push(match arguments.spp {
            Some(asked) if asked != limits.samples => format!(
                "{} samples for each pixel ({asked} in whole batches of {BATCH_SAMPLES})",
                limits.samples
            ),
            _ => format!("{} samples for each pixel", limits.samples),
        });
    }
    if let Some(time) = limits.time {
        goal.push(format!("at most {}", humantime::format_duration(time)));
    }
    format!(
        "sampling by the {} model on {} threads, {}",
        identity::model_name(settings.model),
        rayon::current_num_threads(),
        goal.join(", ")
    )
}

/// "128 samples for each pixel", or the least and the mean where they differ.
fn listed(count: Count) -> String {
    if count.mean == f64::from(count.least) {
        format!("{} samples for each pixel", count.least)
    } else {
        format!(
            "at least {} samples for each pixel, {:.1} in the mean",
            count.least, count.mean
        )
    }
}
