//! A picture of each look of a scene. The scene is read once; a look changes its camera, its exposure and its light.

use std::collections::HashMap;
use std::path::Path;

use anyhow::anyhow;
use hairline_document::description::Look;
use hairline_document::text::shown;
use hairline_image::{Output, output};

use super::work::Work;
use crate::cli;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::progress::Progress;
use crate::scene_file::{self, Loaded, refuse_inputs};
use hairline_render::failure::Failure;
use hairline_render::{Painter, Writer};

/// Renders and writes all looks.
///
/// # Errors
/// [`Failure::Input`] for a scene without looks and for names of files that cannot be, [`Failure::Work`] where rendering or writing fails or the
/// user stops it: pictures that are whole by then stay.
pub(super) fn run(mut loaded: Loaded, work: &Work<'_>) -> Result<(), Failure> {
    let (scene, arguments) = (&loaded.description, work.arguments);
    let outputs = outputs(&scene.looks, arguments)?;
    let paths: Vec<_> = outputs.iter().map(Output::path).collect();
    let inputs = scene.inputs(&loaded.folder);
    refuse_inputs(&paths, arguments.scene.as_deref(), &inputs)?;
    let interrupt = Interrupt::listen().map_err(cannot_listen)?;
    let count = outputs.len();
    // All of them, before the first is rendered: what is wrong with the last is told at once. They share what they have in common.
    let scenes = (0..count).map(|i| loaded.with_look(i));
    let scenes = scenes.collect::<Result<Vec<_>, _>>()?;
    let (mut painter, mut progress) = (None::<Painter<'_>>, None);
    for (i, (scene, output)) in scenes.iter().zip(&outputs).enumerate() {
        let painter = match &mut painter {
            Some(painter) => {
                painter.take_now(scene)?;
                painter
            }
            none => none.insert(work.painter(scene)?),
        };
        let progress = &*progress.get_or_insert_with(|| Progress::start("rendering"));
        let go_on = interrupt.go_on(progress);
        let done = |share: f64| go_on((i as f64 + share) / count as f64);
        let rendered = painter.render_now(scene, &done)?;
        if interrupt.is_asked() {
            let whole = format!("interrupted; {i} of {count} pictures are whole");
            return Err(Failure::Work(anyhow!("{whole}")));
        }
        let writer = Writer {
            display: scene.display(),
            ..work.writer.clone()
        };
        writer.write(output, &rendered.image)?;
    }
    Ok(())
}

/// The file of each look: NAME-LOOK.png for -o NAME.png.
fn outputs(looks: &[Look], arguments: &cli::Render) -> Result<Vec<Output>, Failure> {
    let refused = |what: String| Failure::Input(anyhow!("--looks: {what}"));
    if arguments.exposure.is_some() {
        let right = "leave it out, or write `exposure_ev` in each look";
        let what = format!("--exposure would give all looks one exposure; {right}");
        return Err(refused(what));
    }
    let scene = arguments.scene.as_deref();
    if looks.is_empty() {
        let scene = scene.unwrap_or(Path::new("the built-in scene")).display();
        let right = "write one with a `name`, or leave --looks out";
        return Err(refused(format!("{scene} has no `[[look]]`; {right}")));
    }
    let path = arguments.output.clone();
    let path = path.unwrap_or_else(|| scene_file::picture_path(scene, ".png"));
    if path == Path::new("-") {
        return Err(refused("-o - is one picture; name a file".to_owned()));
    }
    let mut known: HashMap<String, &str> = HashMap::new();
    let mut outputs = Vec::new();
    for Look { name, .. } in looks {
        let part = file_part(name);
        if let Some(other) = known.insert(part.to_lowercase(), name) {
            let (one, other) = (shown(other), shown(name));
            let right = "rename one";
            return Err(refused(format!(
                "\"{one}\" and \"{other}\" have one file, by \"{part}\"; {right}"
            )));
        }
        outputs.push(Output::check(output::with_suffix(&path, &part))?);
    }
    Ok(outputs)
}

/// The name of a look as part of the name of a file.
fn file_part(name: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || " -_.,+()".contains(c);
    let plain = |c: char| if is_plain(c) { c } else { '-' };
    name.trim().chars().map(plain).collect()
}
