//! Environment maps from files.

use std::io;
use std::path::{Path, PathBuf};

use hairline_image::{FilePath, Picture, exr_file, in_gamut};
use image::codecs::hdr::HdrDecoder;
use image::{ImageDecoder, ImageError};

use super::radiance_header::{self, Header};
use hairline_model::reading::check_regular;
use hairline_model::text::shown;

/// An environment map that cannot be used. The message names the file and the reason.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file is not there or may not be read.
    #[error("{}: cannot read: {reason}", path.display())]
    CannotRead {
        /// The file.
        path: PathBuf,
        /// Reason in words.
        reason: String,
    },
    /// The file's name does not end in .hdr or .exr.
    #[error("{}: not an environment map by its name: .hdr (Radiance) and .exr (OpenEXR) can be read", path.display())]
    UnknownEnding {
        /// The file.
        path: PathBuf,
    },
    /// The file ends too early.
    #[error("{}: the file is truncated: it ends before the last pixel", path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
    },
    /// The contents are not what the format prescribes.
    #[error("{}: {reason}", path.display())]
    Corrupt {
        /// The file.
        path: PathBuf,
        /// Reason of the failure, in words.
        reason: String,
    },
    /// The picture is not twice as wide as high, so that it cannot be an equirectangular map.
    #[error("{}: {}x{} pixels: an equirectangular map is twice as wide as high", path.display(), size_px[0], size_px[1])]
    NotEquirectangular {
        /// The file.
        path: PathBuf,
        /// Width and height of the map.
        size_px: [u32; 2],
    },
    /// The picture is too large.
    #[error("{}: {}x{} pixels: at most {} pixels wide can be read", path.display(), size_px[0], size_px[1], WIDTH_MAX)]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Width and height of the map.
        size_px: [u32; 2],
    },
}

/// 16k maps are the largest in circulation; 1.6 GB while being read.
const WIDTH_MAX: u32 = 16384;

/// Width and height of a map; only the file's head is read.
pub fn size_px(path: &FilePath) -> Result<[u32; 2], Error> {
    check_regular(path).map_err(|e| cannot_read(path, &e))?;
    let size_px = match ending(path).as_deref() {
        Some("hdr") => {
            let file = path.open().map_err(|e| cannot_read(path, &e))?;
            let (_, file) = radiance_header::take(file).map_err(|e| cannot_read(path, &e))?;
            let decoder = HdrDecoder::new(file).map_err(|e| from_radiance(path, e))?;
            decoder.dimensions().into()
        }
        _ => exr_file::size_px(path).map_err(|e| from_exr(path, e))?,
    };
    check_size(path, size_px)?;
    Ok(size_px)
}

/// Extension of the file's name in lower case.
fn ending(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// Reads an equirectangular map.
pub fn read(path: &FilePath) -> Result<Picture, Error> {
    read_if(path, &check_size)
}

/// Reads a picture of any shape whose size a check allows.
pub fn read_picture(
    path: &FilePath,
    check: &dyn Fn([u32; 2]) -> io::Result<()>,
) -> Result<Picture, Error> {
    read_if(path, &|path: &Path, size_px: [u32; 2]| {
        check_width(path, size_px)?;
        check(size_px).map_err(|e| cannot_read(path, &e))
    })
}

/// Reads a picture whose size is right.
fn read_if(path: &FilePath, check_size: CheckSize) -> Result<Picture, Error> {
    check_regular(path).map_err(|e| cannot_read(path, &e))?;
    match ending(path).as_deref() {
        Some("hdr") => read_radiance(path, check_size),
        Some("exr") => {
            let window = exr_file::window(path).map_err(|e| from_exr(path, e))?;
            check_size(path, window.of_px)?;
            check_width(path, window.size_px)?;
            let picture = exr_file::read_picture(path).map_err(|e| from_exr(path, e))?;
            check_size(path, picture.size_px)?;
            Ok(picture)
        }
        _ => Err(Error::UnknownEnding {
            path: path.to_path_buf(),
        }),
    }
}

type CheckSize<'a> = &'a dyn Fn(&Path, [u32; 2]) -> Result<(), Error>;

fn check_size(path: &Path, size_px: [u32; 2]) -> Result<(), Error> {
    let [width, height] = size_px;
    if height == 0 || u64::from(width) != 2 * u64::from(height) {
        let path = path.to_owned();
        return Err(Error::NotEquirectangular { path, size_px });
    }
    check_width(path, size_px)
}

fn check_width(path: &Path, size_px: [u32; 2]) -> Result<(), Error> {
    let path = path.to_owned();
    if size_px.into_iter().any(|n| n > WIDTH_MAX) {
        return Err(Error::TooLarge { path, size_px });
    }
    Ok(())
}

fn from_exr(path: &Path, error: hairline_image::Error) -> Error {
    let path = path.to_owned();
    match error {
        hairline_image::Error::CannotRead { reason, .. } => Error::CannotRead { path, reason },
        // The exr crate's words for an unexpected end of file.
        hairline_image::Error::Unusable { reason, .. } if reason.contains("missing bytes") => {
            Error::Truncated { path }
        }
        hairline_image::Error::Unusable { reason, .. } => Error::Corrupt { path, reason },
        other => Error::Corrupt {
            path,
            reason: other.to_string(),
        },
    }
}

/// Notes on a map's file for the scene's author.
pub(crate) fn notes(path: &FilePath) -> Vec<String> {
    let is_exr = ending(path).as_deref() == Some("exr");
    let window = is_exr.then(|| exr_file::window(path).ok()).flatten();
    let part = window.filter(|window| !window.covers());
    let name = path.file_name().unwrap_or(path.as_os_str());
    let note = |window| format!("{}: {window}", shown(&name.to_string_lossy()));
    part.map(note).into_iter().collect()
}

/// Reads a Radiance picture. What its header says that radiances were multiplied by is undone. Colours of other primaries become those of Rec.709; a
/// picture that does not state its primaries is taken to be in Rec.709 already, as all write it.
fn read_radiance(path: &FilePath, check_size: CheckSize) -> Result<Picture, Error> {
    let file = path.open().map_err(|e| cannot_read(path, &e))?;
    let (header, file) = radiance_header::take(file).map_err(|e| cannot_read(path, &e))?;
    let decoder = HdrDecoder::new(file).map_err(|e| from_radiance(path, e))?;
    let size_px: [u32; 2] = decoder.dimensions().into();
    check_size(path, size_px)?;
    let corrupt = |reason| Error::Corrupt {
        path: path.to_path_buf(),
        reason,
    };
    let Header { factor, primaries } = header.map_err(corrupt)?;
    let to_rec_709 = match primaries {
        Some(primaries) => primaries.to_rec_709().map_err(corrupt)?,
        None => None,
    };
    let mut bytes = vec![0; decoder.total_bytes() as usize];
    decoder
        .read_image(&mut bytes)
        .map_err(|e| from_radiance(path, e))?;
    let rgb = bytes
        .chunks_exact(12)
        .map(|texel| {
            let rgb = std::array::from_fn(|c| {
                let component = [0, 1, 2, 3].map(|i| texel[4 * c + i]);
                f32::from_ne_bytes(component) / factor[c]
            });
            to_rec_709.map_or(rgb, |to| in_gamut(to.color(rgb)))
        })
        .collect();
    Ok(Picture { size_px, rgb })
}

fn from_radiance(path: &Path, error: ImageError) -> Error {
    match error {
        ImageError::IoError(e) if e.kind() == io::ErrorKind::UnexpectedEof => Error::Truncated {
            path: path.to_owned(),
        },
        ImageError::IoError(e) => cannot_read(path, &e),
        e => Error::Corrupt {
            path: path.to_owned(),
            reason: format!("not a Radiance picture that can be read: {e}"),
        },
    }
}

fn cannot_read(path: &Path, error: &io::Error) -> Error {
    Error::CannotRead {
        path: path.to_owned(),
        reason: match error.kind() {
            io::ErrorKind::NotFound => "there is no such file".to_owned(),
            io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
            io::ErrorKind::IsADirectory => "it is a folder".to_owned(),
            _ => error.to_string(),
        },
    }
}
