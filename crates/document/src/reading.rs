//! The text of a scene file, read within a limit.

use std::io::Read;

use hairline_image::FilePath;
use hairline_memory::{budget_bytes, in_words};
use hairline_model::packed::refuse_other_model;
use hairline_model::reading::{FileKind, read};

use crate::error::Error;

/// The largest share of the free memory that a scene's text may take.
const TEXT_SHARE: f64 = 1.0 / 64.0;
/// A byte of a scene file while it is read.
const TEXT_BYTES: f64 = 64.0;

/// Reads the text of a scene file: a regular file or a pipe, UTF-8, small enough to be read.
///
/// # Errors
/// Why it cannot be read.
pub fn scene_text(path: impl Into<FilePath>) -> Result<String, Error> {
    let path = path.into();
    refuse_other_model(&path)
        .map_err(|flaw| Error::new("", flaw.found, flaw.right).with_position(&path, None))?;
    let bytes = read(&path, FileKind::FileOrPipe, TEXT_SHARE).map_err(|reason| {
        let found = format!("cannot be read ({reason})");
        Error::new("", found, "give the path of a scene file (TOML)").with_position(&path, None)
    })?;
    text_of(bytes).map_err(|error| error.with_position(&path, None))
}

/// The text of a scene that comes from a stream, read within the same limits.
///
/// # Errors
/// Why it cannot be read.
pub fn scene_text_of(stream: impl Read) -> Result<String, Error> {
    let most = (budget_bytes() as f64 * TEXT_SHARE) as u64;
    let mut bytes = Vec::new();
    let read = stream.take(most + 1).read_to_end(&mut bytes);
    let right = "must be the text of a scene (TOML)";
    read.map_err(|error| Error::new("", format!("cannot be read ({error})"), right))?;
    check_text(bytes.len())?;
    text_of(bytes)
}

/// Refuses the text of a scene file that would not fit into memory while it is read.
///
/// # Errors
/// What it would take.
pub(crate) fn check_text(length: usize) -> Result<(), Error> {
    let bytes = length as f64 * TEXT_BYTES;
    let free_bytes = budget_bytes() as f64;
    match bytes <= free_bytes {
        true => Ok(()),
        false => Err(Error::new(
            "",
            format!(
                "a text of {} would take about {} of memory to read",
                in_words(length as f64),
                in_words(bytes)
            ),
            format!("{} are free for it", in_words(free_bytes)),
        )),
    }
}

fn text_of(bytes: Vec<u8>) -> Result<String, Error> {
    String::from_utf8(bytes)
        .map_err(|_| Error::new("", "it is no text", "must be a scene file (TOML)"))
}
