//! Output files that are either whole or not there: everything is encoded in memory, then written in one step.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::exr_file::Notes;
use crate::exr_file::encode::{encode_image, encode_picture};
use crate::{Display, Error, FilePath, Finish, Image, Picture, png};

/// A picture format that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8 bits a channel, tone-mapped, sRGB.
    Png,
    /// Linear Rec.709, 32-bit float, layers.
    Exr,
}

impl Format {
    /// Format by the ending of a file name, in either case.
    ///
    /// # Errors
    /// [`Error::UnknownEnding`].
    pub fn from_ending(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().map(|e| e.to_ascii_lowercase());
        match ending.as_ref().and_then(|e| e.to_str()) {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => Err(Error::UnknownEnding {
                path: path.to_owned(),
            }),
        }
    }
}

/// An output path that was found writable.
#[derive(Clone, Debug)]
pub struct Output {
    path: FilePath,
    format: Format,
    finish: Finish,
}

impl Output {
    /// Checks an output path before the work that is to go there: the ending, the folder, and the right to write.
    /// Leaves nothing behind and an existing file as it is.
    ///
    /// # Errors
    /// [`Error::UnknownEnding`], [`Error::CannotWrite`].
    pub fn check(path: impl Into<FilePath>) -> Result<Self, Error> {
        let path = path.into();
        let format = Format::from_ending(&path)?;
        path.check_writable()?;
        Ok(Self {
            path,
            format,
            finish: Finish::default(),
        })
    }

    /// The standard output, for a PNG. Its path is `-`.
    pub fn stdout() -> Self {
        Self {
            path: Path::new("-").into(),
            format: Format::Png,
            finish: Finish::default(),
        }
    }

    /// The same with what a PNG has besides the colours.
    #[must_use]
    pub fn finished(self, finish: &Finish) -> Self {
        Self {
            finish: finish.clone(),
            ..self
        }
    }

    /// Whether it is the standard output.
    pub fn is_stdout(&self) -> bool {
        self.path() == Path::new("-")
    }

    /// The path as given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The format that the path's ending chose.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Writes a render: all layers as EXR, the displayed beauty as PNG. With [`Image::alpha`] both have a channel of alpha: EXR keeps the
    /// colours multiplied by it; PNG, which wants them divided, has them divided before the tone curve.
    ///
    /// # Errors
    /// [`Error::CannotWrite`].
    pub fn write_image(&self, image: &Image, display: &Display) -> Result<(), Error> {
        self.write_image_with_notes(image, display, &Notes::new())
    }

    /// Writes a render with notes on its making. A PNG holds neither notes nor noise.
    ///
    /// # Errors
    /// [`Error::CannotWrite`].
    pub fn write_image_with_notes(
        &self,
        image: &Image,
        display: &Display,
        notes: &Notes,
    ) -> Result<(), Error> {
        let encoded = match self.format {
            Format::Png => png::encode_image(image, display, &self.finish),
            Format::Exr => encode_image(image, notes),
        };
        self.write_encoded(encoded)
    }

    /// Writes a plain picture.
    ///
    /// # Errors
    /// [`Error::CannotWrite`].
    pub fn write_picture(&self, picture: &Picture, display: &Display) -> Result<(), Error> {
        let encoded = match self.format {
            Format::Png => png::encode(picture, display),
            Format::Exr => encode_picture(picture),
        };
        self.write_encoded(encoded)
    }

    fn write_encoded(&self, encoded: Result<Vec<u8>, String>) -> Result<(), Error> {
        let bytes = encoded.map_err(|reason| Error::CannotWrite {
            path: self.path().to_owned(),
            reason,
        })?;
        if self.is_stdout() {
            let mut stdout = std::io::stdout().lock();
            let written = stdout.write_all(&bytes).and_then(|()| stdout.flush());
            return written.map_err(|e| Error::cannot_write(&self.path, &e));
        }
        self.path.write(&bytes)
    }
}

/// Checks that [`write_atomically`] will be able to write here, whatever the ending. Leaves nothing behind and an existing
/// file as it is.
///
/// # Errors
/// [`Error::CannotWrite`].
pub fn check_writable(path: impl Into<FilePath>) -> Result<(), Error> {
    path.into().check_writable()
}

/// Writes a whole file or none: a reader sees the old contents or the new ones, never a part.
///
/// # Errors
/// [`Error::CannotWrite`].
pub fn write_atomically(path: impl Into<FilePath>, bytes: &[u8]) -> Result<(), Error> {
    path.into().write(bytes)
}

/// NAME-0001.png for NAME.png: as many digits as the last one needs, so that names sort as the frames do.
pub fn numbered(path: &Path, number: u32, last: u32) -> PathBuf {
    let digits = last.to_string().len().max(4);
    with_suffix(path, &format!("{number:0digits$}"))
}

/// NAME-SUFFIX.png for NAME.png.
pub fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push("-");
    name.push(suffix);
    if let Some(ending) = path.extension() {
        name.push(".");
        name.push(ending);
    }
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_sort_as_frames_do() {
        let name = |number, last| numbered(Path::new("/a.b/pan.old.png"), number, last);
        assert_eq!(name(7, 24), Path::new("/a.b/pan.old-0007.png"));
        assert_eq!(name(7, 12345), Path::new("/a.b/pan.old-00007.png"));
    }
}
