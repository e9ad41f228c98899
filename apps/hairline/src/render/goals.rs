//! Destination of the pictures of a sequence: numbered files, an animation, or both.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use hairline_image::{Animation, FPS, Output, check_sequence, output};

use crate::cli;
use crate::scene_file;
use hairline_render::failure::Failure;

/// Destination of the pictures.
pub struct Goals {
    /// Files in the order of the frames; none where there is only an animation.
    pub pictures: Vec<Output>,
    /// File of the animation.
    pub animation: Option<PathBuf>,
    /// Frames in a second.
    pub fps: u16,
}

impl Goals {
    /// Checks, before the work, that every file will have its place.
    ///
    /// # Errors
    /// [`Failure::Input`] for flags that contradict one another and unknown endings, [`Failure::Work`] for places that cannot be
    /// written.
    pub fn check(arguments: &cli::Render, frames: u32) -> Result<Self, Failure> {
        let flags = &arguments.sequence;
        let mut animation = flags.animation.clone();
        let mut pictures = arguments.output.clone();
        if let Some(path) = pictures.take_if(|path| Animation::is_asked_by(path)) {
            if animation.is_some() {
                let path = path.display();
                return Err(Failure::Input(anyhow!(
                    "{path}: -o names an animation, and so does --animation; leave one of them out"
                )));
            }
            animation = Some(path);
        }
        if animation.is_none() {
            if flags.fps.is_some() {
                return Err(Failure::Input(anyhow!(
                    "--fps is for an animation: add --animation FILE.apng, or end -o in .apng"
                )));
            }
            pictures.get_or_insert_with(|| {
                scene_file::picture_path(arguments.scene.as_deref(), ".png")
            });
        }
        if let Some(path) = &pictures {
            if path == Path::new("-") {
                return Err(Failure::Input(anyhow!(
                    "--frames: -o - is one picture; name a file"
                )));
            }
            check_sequence(path)?;
        }
        if let Some(path) = &animation {
            Animation::check(path)?;
        }
        let pictures = pictures.map_or(Ok(Vec::new()), |path| {
            let numbers = 1..=frames;
            numbers
                .map(|number| Output::check(output::numbered(&path, number, frames)))
                .collect::<Result<_, _>>()
        })?;
        Ok(Self {
            pictures,
            animation,
            fps: flags.fps.unwrap_or(FPS),
        })
    }

    /// Describes which files exist after `whole` frames, and which do not.
    pub fn kept(&self, whole: usize) -> String {
        let mut parts = Vec::new();
        let name = |i: usize| self.pictures[i].path().display();
        match (whole, self.pictures.len()) {
            (_, 0) => {}
            (0, frames) => parts.push(format!("none of {frames} frames was written")),
            (1, frames) => parts.push(format!("1 of {frames} frames is whole, {}", name(0))),
            (whole, frames) => parts.push(format!(
                "{whole} of {frames} frames are whole, {} to {}",
                name(0),
                name(whole - 1)
            )),
        }
        if let Some(path) = &self.animation {
            parts.push(format!("{} was not written", path.display()));
        }
        parts.join("; ")
    }
}
