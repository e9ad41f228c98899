//! One picture of a scene, with notes on what it does not show, and its labels.

use std::io::IsTerminal;
use std::path::Path;

use hairline_console::tell;
use hairline_document::Description;
use hairline_image::shown::{LITTLE, Shown};
use hairline_image::{Image, Output};
use hairline_render::failure::Failure;
use hairline_render::{bands, labels};
use hairline_scene::Scene;

use super::work::Work;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::progress::Progress;
use crate::scene_file::Loaded;

/// Renders and writes a picture, and `labels` where they are asked for. One that was stopped has the samples until then.
pub(super) fn run(
    loaded: &Loaded,
    work: &Work<'_>,
    output: &Output,
    labels: Option<&Output>,
) -> Result<(), Failure> {
    let scene = &loaded.scene;
    // Before the trees are built, which takes seconds.
    let interrupt = match work.task.transport.shadows {
        true => Interrupt::listen().map_err(cannot_listen)?,
        false => Interrupt::default(),
    };
    let mut painter = work.painter(scene)?;
    let progress = Progress::start("rendering");
    let rendered = painter.render_now(scene, &interrupt.go_on(&progress))?;
    drop(progress);
    tell_of_what_is_not_seen(&rendered.image, loaded, work);
    if !rendered.is_whole() {
        let so_far = format!("{} of {}", rendered.samples, rendered.wanted);
        let mut writer = work.writer.clone();
        writer.notes.insert("samples".to_owned(), so_far.clone());
        writer.write(output, &rendered.image)?;
        let name = output.path().display();
        tell(format_args!("interrupted: {name} has {so_far} samples"));
        return Ok(());
    }
    if let Some(labels) = labels {
        write_labels(scene, labels.path(), &interrupt)?;
    }
    work.writer.write(output, &rendered.image)?;
    // Names the picture to whoever sees no command but this one: scripts know it.
    if std::io::stderr().is_terminal() && !output.is_stdout() {
        tell(format_args!("wrote {}", output.path().display()));
    }
    Ok(())
}

/// Renders and writes a picture in bands of the spectrum.
pub(super) fn write_bands(
    scene: &Scene,
    bands_nm: &[[f64; 2]],
    work: &Work<'_>,
    output: &Output,
) -> Result<(), Failure> {
    let interrupt = Interrupt::listen().map_err(cannot_listen)?;
    let progress = Progress::start("rendering bands");
    let picture = bands::render(
        scene,
        bands_nm,
        work.arguments.backend.into(),
        &work.task,
        &work.terminal,
        &interrupt.go_on(&progress),
    )?;
    drop(progress);
    Ok(picture.write(output.path())?)
}

fn write_labels(scene: &Scene, path: &Path, interrupt: &Interrupt) -> Result<(), Failure> {
    let progress = Progress::start("labelling");
    let labels = labels::labels(scene, &|| interrupt.is_asked());
    drop(progress);
    match labels {
        Some(labels) => labels.write(path, scene)?,
        None => tell(format_args!("interrupted: no labels")),
    }
    Ok(())
}

fn tell_of_what_is_not_seen(image: &Image, loaded: &Loaded, work: &Work<'_>) {
    let note = |note: &str| tell(format_args!("note: {note}"));
    if let Some(nothing) = nothing_seen(image) {
        note(nothing);
    }
    if work.arguments.scene_flags.show_scratches
        && let Some(shown) =
            Shown::new(image, &work.writer.display).filter(|it| it.noticed < LITTLE)
    {
        note(&shown.little());
    }
    let is_filled = |alpha: &Vec<f32>| alpha.iter().all(|share| *share == 1.0);
    if image.alpha.as_ref().is_some_and(is_filled) {
        let why = why_filled(&loaded.description);
        note(&format!("no pixel is transparent: {why}"));
    }
}

/// Why a picture shows nothing, where it does.
fn nothing_seen(image: &Image) -> Option<&'static str> {
    if image.depth_m.iter().all(|depth_m| *depth_m == 0.0) {
        return Some(
            "no object is in the picture: `position_m` and `target_m` of the camera decide where it looks",
        );
    }
    let is_black = |rgb: &[f32; 3]| rgb.iter().all(|c| *c <= 0.0);
    (image.base.iter().all(is_black) && image.scratches.iter().all(is_black)).then_some(
        "the picture is black: no light comes to what the camera sees; it may stand inside of an object",
    )
}

/// Why no pixel of a picture is transparent.
fn why_filled(scene: &Description) -> &'static str {
    let ground = scene.ground.as_ref();
    match ground.is_some_and(|it| !it.hidden && !it.shadows_only) {
        true => {
            "the ground is behind all of it; --shadows-only leaves its shadows, `hidden = true` in [ground] nothing"
        }
        false => "objects fill the picture; `hidden = true` takes one of them out",
    }
}
