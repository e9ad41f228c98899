//! Destination of pictures, checked before the work.

use std::path::Path;

use anyhow::anyhow;
use hairline_document::inputs::is_same_file;
use hairline_image::{Animation, Finish, Format, Output};
use hairline_render::Motion;
use hairline_render::failure::Failure;

use super::goals::Goals;
use crate::{cli, scene_file};

/// Destination of pictures.
pub(super) enum Target<'a> {
    One(Output),
    /// A picture of each look, whose names the scene has.
    Looks,
    Many(&'a Motion, Goals),
}

impl<'a> Target<'a> {
    /// The destination by the flags.
    ///
    /// # Errors
    /// As [`Goals::check`].
    pub fn check(arguments: &cli::Render, motion: Option<&'a Motion>) -> Result<Self, Failure> {
        let target = match motion {
            None if arguments.looks => Self::Looks,
            None => Self::One(single(arguments)?),
            Some(motion) => Self::Many(motion, Goals::check(arguments, motion.frames)?),
        };
        match &target {
            Self::One(output) if arguments.bands.is_some() && output.format() != Format::Exr => {
                let path = output.path().display();
                Err(Failure::Input(anyhow!("{path}: --bands needs an .exr")))
            }
            _ => Ok(target),
        }
    }

    /// Where labels go, if they are asked for.
    ///
    /// # Errors
    /// [`Failure::Input`] where they would take the place of a picture, or are no .exr.
    pub fn check_labels(&self, arguments: &cli::Render) -> Result<Option<Output>, Failure> {
        let Some(path) = &arguments.labels else {
            return Ok(None);
        };
        let refused = |what: &str| Failure::Input(anyhow!("--labels {}: {what}", path.display()));
        if matches!(self, Self::Many(..)) {
            return Err(refused(
                "labels are of a single picture; leave --frames out",
            ));
        }
        let output = Output::check(path)?;
        let place = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let is_taken = |other: &&Path| place(other) == place(path) || is_same_file(other, path);
        if self.paths().iter().any(is_taken) {
            return Err(refused("-o names the same file; give the labels another"));
        }
        match output.format() {
            Format::Exr => Ok(Some(output)),
            Format::Png => Err(refused("labels need an .exr")),
        }
    }

    /// All files, but those of looks.
    pub fn paths(&self) -> Vec<&Path> {
        let (pictures, animation) = self.files();
        let pictures = pictures.iter().map(Output::path);
        pictures.chain(animation).collect()
    }

    /// Notes on what the files do not have of what their pictures would.
    pub fn left_out(&self, finish: &Finish) -> Vec<String> {
        let (pictures, animation) = self.files();
        let mut notes = Vec::new();
        if let Some(path) = animation.filter(|_| finish.is_deep) {
            let path = path.display();
            notes.push(format!("{path}: animations have 8 bits a channel, not 16"));
        }
        let mut linear = pictures.iter();
        let linear = linear.find(|it| it.format() == Format::Exr);
        if let Some(output) = linear.filter(|_| finish.behind.is_some()) {
            let path = output.path().display();
            notes.push(format!(
                "{path}: an .exr has alpha in place of the picture behind; end the name in .png for it"
            ));
        }
        notes
    }

    /// Pictures, and the file of an animation.
    fn files(&self) -> (&[Output], Option<&Path>) {
        match self {
            Self::One(output) => (std::slice::from_ref(output), None),
            Self::Looks => (&[], None),
            Self::Many(_, goals) => (&goals.pictures, goals.animation.as_deref()),
        }
    }
}

fn single(arguments: &cli::Render) -> Result<Output, Failure> {
    let path = arguments
        .output
        .clone()
        .unwrap_or_else(|| scene_file::picture_path(arguments.scene.as_deref(), ".png"));
    if path == Path::new("-") {
        return Ok(Output::stdout());
    }
    if Animation::is_asked_by(&path) {
        let path = path.display();
        return Err(Failure::Input(anyhow!(
            "{path}: an animation needs --frames N, with --turntable DEG, --zoom A:B or --time A:B"
        )));
    }
    Ok(Output::check(&path)?)
}
