//! The part of a picture that a file has pixels of.

use std::fmt;

use exr::prelude::*;

use crate::{Error, FilePath};

/// Pixels of a picture that a file holds: its data window in its display window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The first pixel, from the upper left corner of the picture.
    pub at_px: [i64; 2],
    /// Width and height of the window.
    pub size_px: [u32; 2],
    /// Width and height of the whole picture.
    pub of_px: [u32; 2],
}

impl Window {
    pub(super) fn new(at: Vec2<i32>, size: Vec2<usize>, display: IntegerBounds) -> Self {
        let at = [at.0, at.1].map(i64::from);
        let corner = [display.position.0, display.position.1].map(i64::from);
        // Windows that end before they begin are huge to the library.
        let px = |size: Vec2<usize>| [size.0, size.1].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
        Self {
            at_px: [at[0] - corner[0], at[1] - corner[1]],
            size_px: px(size),
            of_px: px(display.size),
        }
    }

    /// Whether it has all pixels of the picture, and no other.
    pub fn is_whole(&self) -> bool {
        self.at_px == [0; 2] && self.size_px == self.of_px
    }

    /// Whether it has all pixels of the picture, and perhaps others around it.
    pub fn covers(&self) -> bool {
        (0..2).all(|i| {
            let end_px = self.at_px[i] + i64::from(self.size_px[i]);
            self.at_px[i] <= 0 && end_px >= i64::from(self.of_px[i])
        })
    }

    /// A value for each pixel of the picture: those of the file, and none elsewhere.
    pub(super) fn placed<T: Copy + Default>(&self, values: &[T]) -> Vec<T> {
        let [width, height] = self.of_px.map(i64::from);
        let mut placed = vec![T::default(); (width * height) as usize];
        let own_width = self.size_px[0] as usize;
        let from = self.at_px[0].clamp(0, width);
        let to = (self.at_px[0] + own_width as i64).clamp(from, width);
        for (y, row) in (self.at_px[1]..).zip(values.chunks_exact(own_width)) {
            if (0..height).contains(&y) && from < to {
                let first = (from - self.at_px[0]) as usize;
                let own = &row[first..first + (to - from) as usize];
                placed[(y * width + from) as usize..][..own.len()].copy_from_slice(own);
            }
        }
        placed
    }
}

impl fmt::Display for Window {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([x, y], [width, height], [of_width, of_height]) =
            (self.at_px, self.size_px, self.of_px);
        let rest = match self.covers() {
            true => "what is outside of that is not seen",
            false => "the rest of that is black",
        };
        write!(
            f,
            "its pixels are {width} x {height} from column {x} and row {y} on, of a picture of {of_width} x {of_height}; {rest}"
        )
    }
}

/// The largest picture that is read, or that a few pixels may be placed in.
pub(super) const LARGEST_PX: u64 = 1 << 29;

/// Reads the window of a file: of its largest part, of which only the head is read.
///
/// # Errors
/// [`Error::CannotRead`], [`Error::Unusable`].
pub fn window(path: impl Into<FilePath>) -> std::result::Result<Window, Error> {
    let path = path.into();
    let file = path.open().map_err(|e| Error::cannot_read(&path, &e))?;
    let unusable = |reason: String| Error::Unusable {
        path: path.to_path_buf(),
        reason,
    };
    let meta = exr::meta::MetaData::read_from_buffered(file, false);
    let meta = meta.map_err(|e| match e {
        exr::error::Error::Io(e) => Error::cannot_read(&path, &e),
        e => unusable(format!("not an EXR file that can be read: {e}")),
    })?;
    let parts = meta.headers.iter().map(|header| {
        Window::new(
            header.own_attributes.layer_position,
            header.layer_size,
            header.shared_attributes.display_window,
        )
    });
    let largest = parts.max_by_key(|window| window.size_px[0] as u64 * window.size_px[1] as u64);
    let largest = largest.ok_or_else(|| unusable("it has no parts".to_owned()))?;
    let [width, height] = largest.size_px;
    if u64::from(width) * u64::from(height) > LARGEST_PX {
        return Err(unusable(format!(
            "it says that it has {width} x {height} pixels"
        )));
    }
    Ok(largest)
}

/// The width and height of the picture in a file: of its display window.
///
/// # Errors
/// As of [`window`].
pub fn size_px(path: impl Into<FilePath>) -> std::result::Result<[u32; 2], Error> {
    Ok(window(path)?.of_px)
}
