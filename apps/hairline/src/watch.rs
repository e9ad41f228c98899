//! `hairline render --watch`: renders again when a file of the scene has changed.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use anyhow::anyhow;
use hairline_console::tell;
use hairline_document::Description;

use crate::cli;
use crate::interrupt::{Interrupt, cannot_listen};
use crate::render;
use hairline_work::failure::Failure;

/// Interval of looking at the files. An editor that saves in several steps is done in this time.
const EVERY: Duration = Duration::from_millis(200);

/// Renders, and again on every change, until Ctrl-C. What is wrong with a scene is told, and its next change waited for.
pub fn run(arguments: &cli::Render) -> Result<(), Failure> {
    let Some(scene) = arguments
        .scene
        .as_deref()
        .filter(|path| *path != Path::new("-"))
    else {
        return Err(Failure::Input(anyhow!(
            "--watch needs the path of a scene: there is no file that could change"
        )));
    };
    let interrupt = Interrupt::listen().map_err(cannot_listen)?;
    while !interrupt.is_asked() {
        // Before it is read: a change meanwhile is seen.
        let before = Stamps::read(scene);
        match render::run(arguments) {
            Ok(()) => tell("waiting for a change of the scene; Ctrl-C ends it"),
            Err(failure) => tell(format_args!(
                "error: {failure}\nwaiting for a change of the scene; Ctrl-C ends it"
            )),
        }
        while !interrupt.is_asked() && Stamps::read(scene) == before {
            std::thread::sleep(EVERY);
        }
        // A file that is being written is left alone until it no longer changes.
        let mut last = Stamps::read(scene);
        while !interrupt.is_asked() {
            std::thread::sleep(EVERY);
            let now = Stamps::read(scene);
            if std::mem::replace(&mut last, now.clone()) == now {
                break;
            }
        }
    }
    Ok(())
}

/// Versions of the scene's files, known without reading them all.
#[derive(Clone, PartialEq)]
struct Stamps(Vec<(PathBuf, Option<(SystemTime, u64)>)>);

impl Stamps {
    fn read(scene: &Path) -> Self {
        let folder = scene.parent().unwrap_or(Path::new(""));
        let text = hairline_document::reading::scene_text(scene).ok();
        let description = text.and_then(|text| Description::from_toml(&text, scene).ok());
        let inputs = description.map(|it| it.inputs(folder)).unwrap_or_default();
        let paths = std::iter::once(scene.to_owned()).chain(inputs.into_iter().map(|it| it.path));
        let stamp = |path: &Path| {
            let metadata = path.metadata().ok()?;
            Some((metadata.modified().ok()?, metadata.len()))
        };
        Self(paths.map(|path| (path.clone(), stamp(&path))).collect())
    }
}
