//! Pictures to files: one by one, numbered, or as the frames of an animation. Each file is whole or not there.

use hairline_image::{Animation, Display, Finish, Image, Notes, Output};
use hairline_scene::Scene;

use crate::adding::Rendered;
use crate::painter::Painter;
use crate::rows::GoOn;

/// Reason why a picture is not in its place.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The device failed.
    #[error(transparent)]
    Device(#[from] hairline_gpu::Error),
    /// A picture cannot be written.
    #[error(transparent)]
    Picture(hairline_image::Error),
    /// An animation cannot be written.
    #[error(transparent)]
    Animation(hairline_image::Error),
}

/// What files have of their pictures.
#[derive(Clone)]
pub struct Writer {
    /// Exposure and tone curve of what is shown.
    pub display: Display,
    /// What a PNG has besides the colours.
    pub finish: Finish,
    /// Notes on the making.
    pub notes: Notes,
}

impl Writer {
    /// Writes a picture.
    ///
    /// # Errors
    /// As [`Output::write_image`].
    pub fn write(&self, output: &Output, image: &Image) -> Result<(), hairline_image::Error> {
        let output = output.clone().finished(&self.finish);
        output.write_image_with_notes(image, &self.display, &self.notes)
    }
}

/// Frames on their way to files.
pub struct Sequence {
    /// What their files have of them.
    pub writer: Writer,
    /// The file that has all of them, if there is one.
    pub animation: Option<Animation>,
}

impl Sequence {
    /// Renders the next frame and puts it in its place: a file of its own, the animation, or both. None once `go_on` says no: a frame of fewer samples
    /// would stand out.
    ///
    /// # Errors
    /// Where rendering or writing fails.
    pub async fn add(
        &mut self,
        painter: &mut Painter<'_>,
        scene: &Scene,
        output: Option<&Output>,
        go_on: GoOn<'_>,
    ) -> Result<Option<Image>, Error> {
        painter.look_from(scene).await?;
        let rendered = painter.render(scene, go_on).await?;
        let whole = rendered.filter(|rendered| rendered.is_whole() && go_on(1.0));
        let Some(Rendered { image, .. }) = whole else {
            return Ok(None);
        };
        if let Some(output) = output {
            self.writer.write(output, &image).map_err(Error::Picture)?;
        }
        if let Some(animation) = &mut self.animation {
            let added = animation.add(&image, &self.writer.display);
            added.map_err(Error::Animation)?;
        }
        Ok(Some(image))
    }
}
