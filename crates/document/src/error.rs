//! Errors of a scene, addressed to the person who wrote it.

use std::fmt;
use std::path::{Path, PathBuf};

use hairline_model::text::{printable, said};

use crate::key_line::line_of_key;

/// An error of a scene: the key, what was found there, and what would be right.
///
/// It prints as `file:line: key: what was found; what would be right`, leaving out what it does not know.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Error {
    place: Option<FilePosition>,
    key: String,
    found: String,
    right: String,
    is_cancelled: bool,
}

/// A file and, if known, a line in it, counted from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
struct FilePosition {
    file: PathBuf,
    line: Option<usize>,
}

impl Error {
    /// `key` is the path of the value, such as `light[1].radius_m`; `found` and `right` are halves of a sentence. Control
    /// characters in them are escaped, and what is very long is cut: parts of them come from files.
    pub fn new(key: impl Into<String>, found: impl Into<String>, right: impl Into<String>) -> Self {
        Self {
            place: None,
            key: said(&key.into()),
            found: said(&found.into()),
            right: said(&right.into()),
            is_cancelled: false,
        }
    }

    /// Error of work that its caller cancelled.
    pub(crate) fn cancelled() -> Self {
        Self {
            is_cancelled: true,
            ..Self::new("", "the scene was not finished", "it was cancelled")
        }
    }

    /// Whether nothing is wrong, but [`Loader::cancelled`](crate::Loader::cancelled) said so.
    pub fn is_cancelled(&self) -> bool {
        self.is_cancelled
    }

    /// Sets the place of the mistake, unless a more exact one is known already.
    #[must_use]
    pub fn with_position(mut self, file: &Path, line: Option<usize>) -> Self {
        self.place.get_or_insert_with(|| FilePosition {
            file: file.to_owned(),
            line,
        });
        self
    }

    /// Removes the position of an error in a file of this name, for text that is in no file.
    #[must_use]
    pub fn nowhere_in(mut self, name: &Path) -> Self {
        self.place = self.place.filter(|place| place.file != name);
        self
    }

    /// An error whose key belongs to a table.
    #[must_use]
    pub(crate) fn in_table(mut self, table: &str) -> Self {
        self.key = format!("{table}.{}", self.key);
        self
    }

    /// Adds the line to an error whose key belongs to the scene file of this text; `name` is the file's name in the error.
    /// Errors of [`from_toml`](crate::from_toml) have it already.
    #[must_use]
    pub fn in_scene_file(self, text: &str, name: &Path) -> Self {
        let line = line_of_key(text, &self.key);
        self.with_position(name, line)
    }

    /// The file that holds the mistake; `None` for a description that came from no file.
    pub fn file(&self) -> Option<&Path> {
        self.place.as_ref().map(|place| place.file.as_path())
    }

    /// The line of the mistake in [`Error::file`], counted from 1.
    pub fn line(&self) -> Option<usize> {
        self.place.as_ref().and_then(|place| place.line)
    }

    /// The path of the value, such as `light[1].radius_m` (tables of one name are counted from 0).
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Description of what was found there.
    pub fn found(&self) -> &str {
        &self.found
    }

    /// Description of what would be right.
    pub fn right(&self) -> &str {
        &self.right
    }

    /// Both, without the place and the key.
    pub fn found_and_right(&self) -> String {
        format!("{}; {}", self.found, self.right)
    }
}

/// A length to three digits, in the unit that reads best.
pub(crate) fn length(length_m: f64) -> String {
    let (number, unit) = match length_m {
        1.0.. => (length_m, "m"),
        0.01.. => (1e2 * length_m, "cm"),
        0.001.. => (1e3 * length_m, "mm"),
        _ => (1e6 * length_m, "µm"),
    };
    let decimals = (2.0 - number.log10().floor()).clamp(0.0, 2.0) as usize;
    format!("{number:.decimals$} {unit}")
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{}:", printable(&place.file.to_string_lossy()))?;
            if let Some(line) = place.line {
                write!(f, "{line}:")?;
            }
            write!(f, " ")?;
        }
        if !self.key.is_empty() {
            write!(f, "{}: ", self.key)?;
        }
        f.write_str(&self.found_and_right())
    }
}
