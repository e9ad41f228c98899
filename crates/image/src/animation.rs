//! Animations: frames as a display shows them, 8 bits a channel, sRGB. An animated PNG (the third edition of the PNG specification) is without
//! loss; what shows no animations shows its first frame. MPEG-4 is made by another program ([`crate::mp4`]).

use std::path::Path;

use png::{BitDepth, ColorType, Compression, Encoder, Filter, SrgbRenderingIntent, Writer};

use crate::mp4::Mp4;
use crate::output::Format;
use crate::png::quantize_finished;
use crate::{Display, Error, FilePath, Finish, Image};

/// Largest number of frames in a second: viewers take delays below 10 ms for a mistake, and show more frames slower than
/// asked.
pub const FPS_MAX: u16 = 100;

/// An animation in the making. The file is whole or not there: an animated PNG is kept in memory, compressed, until [`Animation::finish`].
pub struct Animation {
    path: FilePath,
    size_px: [u32; 2],
    left: u32,
    to: Encoded,
    finish: Finish,
}

enum Encoded {
    Apng {
        writer: Box<Writer<Shared>>,
        bytes: Shared,
    },
    Mp4(Mp4),
}

/// Frames in a second where nothing else is asked for.
pub const FPS: u16 = 30;

/// Checks the ending of a name under which a sequence is to be written: numbered pictures, or an animation.
///
/// # Errors
/// [`Error::NoSequence`].
pub fn check_sequence(path: &Path) -> Result<(), Error> {
    match Animation::is_asked_by(path) || Format::from_ending(path).is_ok() {
        true => Ok(()),
        false => Err(Error::NoSequence {
            path: path.to_owned(),
        }),
    }
}

impl Animation {
    /// Whether the file name ends in .apng or .mp4, in either case.
    pub fn is_asked_by(path: &Path) -> bool {
        has_ending(path, "apng") || Mp4::is_asked_by(path)
    }

    /// Checks a path before the work that is to go there: .apng, .png or .mp4, the folder, the right to write, and for .mp4 the program that makes
    /// it. Leaves nothing behind and an existing file as it is.
    ///
    /// # Errors
    /// [`Error::NoAnimation`], [`Error::CannotWrite`].
    pub fn check(path: impl Into<FilePath>) -> Result<(), Error> {
        let path = path.into();
        if !Self::is_asked_by(&path) && !has_ending(&path, "png") {
            return Err(Error::NoAnimation {
                path: path.to_path_buf(),
            });
        }
        if Mp4::is_asked_by(&path) {
            Mp4::check(&path)?;
        }
        path.check_writable()
    }

    /// Begins an animation of `frames` pictures, `fps` of them in a second (1 to [`FPS_MAX`]), that repeats without end. With `has_alpha` each of
    /// them has [`Image::alpha`], and so has the animation unless a picture is behind.
    ///
    /// # Errors
    /// As [`Animation::check`]; [`Error::CannotWrite`] for no frames or an empty picture, and for alpha in an .mp4.
    pub fn begin(
        path: impl Into<FilePath>,
        size_px: [u32; 2],
        frames: u32,
        fps: u16,
        has_alpha: bool,
        finish: &Finish,
    ) -> Result<Self, Error> {
        let path = path.into();
        Self::check(&path)?;
        let has_alpha = has_alpha && finish.behind.is_none();
        let fps = fps.clamp(1, FPS_MAX);
        let to = match Mp4::is_asked_by(&path) {
            true if has_alpha => {
                let reason = "an .mp4 has no alpha: leave the transparent background out, put a picture behind, or end the name in .apng";
                return Err(Error::CannotWrite {
                    path: path.to_path_buf(),
                    reason: reason.to_owned(),
                });
            }
            true => Encoded::Mp4(Mp4::begin(&path, size_px, fps)?),
            false => {
                let bytes = Shared::default();
                let color = if has_alpha {
                    ColorType::Rgba
                } else {
                    ColorType::Rgb
                };
                let writer = header(bytes.clone(), size_px, color, frames, fps);
                let writer = Box::new(writer.map_err(|error| refused(&path, &error))?);
                Encoded::Apng { writer, bytes }
            }
        };
        Ok(Self {
            path,
            size_px,
            left: frames,
            to,
            finish: finish.clone(),
        })
    }

    /// Adds the next frame.
    ///
    /// # Errors
    /// [`Error::CannotWrite`] for one frame too many, or one with alpha where the others have none.
    ///
    /// # Panics
    /// If the frame has another size.
    pub fn add(&mut self, frame: &Image, display: &Display) -> Result<(), Error> {
        assert_eq!(frame.size_px, self.size_px, "frames of different sizes");
        let codes = quantize_finished(frame, display, &self.finish);
        let codes = codes.map_err(|reason| Error::CannotWrite {
            path: self.path.to_path_buf(),
            reason,
        })?;
        match &mut self.to {
            Encoded::Mp4(mp4) => mp4.add(&codes)?,
            Encoded::Apng { writer, .. } => {
                let written = writer.write_image_data(&codes);
                written.map_err(|error| refused(&self.path, &error))?;
            }
        }
        self.left = self.left.saturating_sub(1);
        Ok(())
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`Error::CannotWrite`], also where frames are missing.
    pub fn finish(self) -> Result<(), Error> {
        let Self { path, left, to, .. } = self;
        if left > 0 {
            return Err(Error::CannotWrite {
                path: path.to_path_buf(),
                reason: format!("{left} frames are missing"),
            });
        }
        match to {
            Encoded::Mp4(mp4) => mp4.finish(),
            Encoded::Apng { writer, bytes } => {
                writer.finish().map_err(|error| refused(&path, &error))?;
                path.write(&bytes.take())
            }
        }
    }
}

fn has_ending(path: &Path, wanted: &str) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case(wanted))
}

fn header(
    bytes: Shared,
    [width, height]: [u32; 2],
    color: ColorType,
    frames: u32,
    fps: u16,
) -> Result<Writer<Shared>, png::EncodingError> {
    let mut encoder = Encoder::new(bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::Adaptive);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    // 0 plays: for ever.
    encoder.set_animated(frames, 0)?;
    encoder.set_frame_delay(1, fps)?;
    encoder.validate_sequence(true);
    encoder.write_header()
}

fn refused(path: &Path, error: &png::EncodingError) -> Error {
    Error::CannotWrite {
        path: path.to_owned(),
        reason: error.to_string(),
    }
}

/// Bytes that the encoder writes, shared so that they can be had back when it is done: it keeps its writer.
#[derive(Clone, Default)]
struct Shared(std::sync::Arc<std::sync::Mutex<Vec<u8>>>);

impl Shared {
    fn take(&self) -> Vec<u8> {
        std::mem::take(&mut self.lock())
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<u8>> {
        self.0
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

impl std::io::Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.lock().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::png::quantize_image;
    use image::AnimationDecoder;
    use image::codecs::png::PngDecoder;
    use std::fs::File;
    use std::io::BufReader;

    const SIZE_PX: [u32; 2] = [7, 5];

    fn grey(level: f32) -> Image {
        let mut image = Image::new(SIZE_PX);
        image.base.fill([level; 3]);
        image
    }

    fn animation(path: &Path, frames: u32) -> Animation {
        Animation::begin(path, SIZE_PX, frames, 25, false, &Finish::default())
            .unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn frames_come_back_in_order_as_they_are_shown() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grey.apng");
        let levels = [0.1, 0.5, 0.9];
        let display = Display::default();
        let mut writer = animation(&path, 3);
        for level in levels {
            assert!(!path.exists(), "not before it is whole");
            writer.add(&grey(level), &display).unwrap();
        }
        writer.finish().unwrap();
        let file = BufReader::new(File::open(&path).unwrap());
        let frames = PngDecoder::new(file).unwrap().apng().unwrap().into_frames();
        let frames = frames.collect_frames().unwrap();
        assert_eq!(frames.len(), levels.len());
        for (frame, level) in frames.iter().zip(levels) {
            assert_eq!(frame.delay().numer_denom_ms(), (40, 1));
            let codes: Vec<u8> = frame
                .buffer()
                .pixels()
                .flat_map(|pixel| pixel.0[..3].to_vec())
                .collect();
            assert_eq!(codes, quantize_image(&grey(level), &display).unwrap());
        }
        // A program that supports no animations shows the first picture.
        let still = crate::png::read_picture(&path).unwrap();
        assert_eq!(still.size_px, SIZE_PX);
    }

    #[test]
    fn nothing_is_left_of_an_animation_that_is_not_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("short.apng");
        let mut writer = animation(&path, 2);
        writer.add(&grey(0.2), &Display::default()).unwrap();
        let error = writer.finish().unwrap_err().to_string();
        assert!(error.contains("1 frames are missing"), "{error}");
        drop(animation(&path, 2));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        let mut writer = animation(&path, 1);
        writer.add(&grey(0.2), &Display::default()).unwrap();
        assert!(writer.add(&grey(0.2), &Display::default()).is_err());
    }

    #[test]
    fn frames_with_alpha_go_together() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("clear.apng");
        let mut clear = grey(0.2);
        clear.alpha = Some(vec![0.4; 35]);
        let mut writer = Animation::begin(&path, SIZE_PX, 2, 25, true, &Finish::default()).unwrap();
        writer.add(&clear, &Display::default()).unwrap();
        assert!(writer.add(&grey(0.2), &Display::default()).is_err());
        assert!(
            animation(&path, 1)
                .add(&clear, &Display::default())
                .is_err()
        );
    }

    #[test]
    fn endings_tell_animations() {
        for (name, asked, possible) in [
            ("a.apng", true, true),
            ("a.APNG", true, true),
            ("a.png", false, true),
            ("a.webp", false, false),
            ("apng", false, false),
        ] {
            let path = std::env::temp_dir().join(name);
            assert_eq!(Animation::is_asked_by(&path), asked, "{name}");
            assert_eq!(Animation::check(&path).is_ok(), possible, "{name}");
        }
    }
}
