//! A picture of each look of a scene. The scene is read once; a look changes its camera, its exposure and its light.

use std::collections::HashMap;
use std::path::Path;

use anyhow::anyhow;
use hairline_document::description::Look;
use hairline_document::text::shown;
use hairline_image::{Display, Image, Output, output};

use crate::cli;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::progress::{Progress, Terminal};
use crate::scene_file::{self, Loaded, refuse_inputs};
use hairline_render::backend::{Painter, Task};
use hairline_render::failure::Failure;
use hairline_render::{Listener, Quiet};

/// Renders all looks; `write` puts a picture in its place.
///
/// # Errors
/// [`Failure::Input`] for a scene without looks and for names of files that cannot be, [`Failure::Work`] where rendering or writing fails or the
/// user stops it: pictures that are whole by then stay.
pub fn run(
    loaded: &mut Loaded,
    arguments: &cli::Render,
    (task, terminal): (Task, &Terminal),
    write: &dyn Fn(&Output, &Image, &Display) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let scene = &loaded.description;
    let outputs = outputs(&scene.looks, arguments)?;
    let paths: Vec<_> = outputs.iter().map(Output::path).collect();
    let inputs = scene.inputs(&loaded.folder);
    refuse_inputs(&paths, arguments.scene.as_deref(), &inputs)?;
    let interrupt = Interrupt::listen().map_err(cannot_listen)?;
    let is_stopped = || interrupt.is_asked();
    let count = outputs.len();
    // All of them, before the first is rendered: what is wrong with the last is told at once. They share what they have in common.
    let scenes = (0..count).map(|i| loaded.with_look(i));
    let scenes = scenes.collect::<Result<Vec<_>, _>>()?;
    let mut progress = None;
    for (i, (scene, output)) in scenes.iter().zip(&outputs).enumerate() {
        // The renderer is reported once.
        let listener: &dyn Listener = if i == 0 { terminal } else { &Quiet };
        let mut painter = Painter::open(scene, task.clone(), listener)?;
        let progress = &*progress.get_or_insert_with(|| Progress::start("rendering"));
        let done = |share: f64| progress.set((i as f64 + share) / count as f64);
        let rendered = painter.render(scene, &is_stopped, &done)?;
        if interrupt.is_asked() {
            let whole = format!("interrupted; {i} of {count} pictures are whole");
            return Err(Failure::Work(anyhow!("{whole}")));
        }
        let display = Display {
            exposure_ev: scene.camera.exposure_ev,
            tone_map: scene.render.tone_map,
        };
        write(output, &rendered.image, &display)?;
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
