//! A scene as the fragment of an address: its text, compressed, in letters that need no escapes.

use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use flate2::read::ZlibEncoder;
use flate2::{Compression, Decompress, FlushDecompress, Status};

/// Beginning of the fragment.
const KEY: &str = "scene=";
/// Longer ones are cut by programs that pass links on.
const MOST_BYTES: usize = 8 << 10;
/// A short fragment must not fill the memory.
const MOST_TEXT_BYTES: usize = 1 << 20;

/// Reason why there is no link, or why a link holds no scene.
#[derive(Debug, PartialEq, thiserror::Error)]
pub(crate) enum Error {
    /// The scene does not fit.
    #[error(
        "the scene takes {needed} bytes as a link, and a link holds at most {}: strokes of the brush take most; save the scene as a file",
        MOST_BYTES
    )]
    TooLong {
        /// Length of the fragment.
        needed: usize,
    },
    /// The link is cut short, or a part of it was changed.
    #[error(
        "the link holds no whole scene: it was cut short or changed on its way; ask for the whole of it"
    )]
    Damaged,
    /// The link holds more than any scene that this program makes a link of.
    #[error(
        "the link holds more than {MOST_TEXT_BYTES} bytes of text, which no scene of a link has"
    )]
    TooLarge,
}

/// The fragment that holds a scene file's text, without `#`.
///
/// # Errors
/// [`Error::TooLong`].
pub(crate) fn fragment(text: &str) -> Result<String, Error> {
    let mut bytes = Vec::new();
    // Reading from memory fails at nothing.
    let _ = ZlibEncoder::new(text.as_bytes(), Compression::best()).read_to_end(&mut bytes);
    let fragment = format!("{KEY}{}", URL_SAFE_NO_PAD.encode(bytes));
    match fragment.len() {
        ..=MOST_BYTES => Ok(fragment),
        needed => Err(Error::TooLong { needed }),
    }
}

/// The text in a fragment, which may begin with `#`; none where the fragment is of another kind.
///
/// # Errors
/// [`Error::Damaged`], [`Error::TooLarge`].
pub(crate) fn text(fragment: &str) -> Option<Result<String, Error>> {
    let encoded = fragment.trim_start_matches('#').strip_prefix(KEY)?;
    Some(decoded(encoded))
}

fn decoded(encoded: &str) -> Result<String, Error> {
    let bytes = URL_SAFE_NO_PAD.decode(encoded.trim_end_matches('='));
    let bytes = bytes.map_err(|_| Error::Damaged)?;
    let mut text = Vec::with_capacity(MOST_TEXT_BYTES);
    // The data ends behind its checksum, or where the room ends.
    let status = Decompress::new(true).decompress_vec(&bytes, &mut text, FlushDecompress::Finish);
    match status {
        Ok(Status::StreamEnd) => String::from_utf8(text).map_err(|_| Error::Damaged),
        Ok(_) if text.len() == MOST_TEXT_BYTES => Err(Error::TooLarge),
        Ok(_) | Err(_) => Err(Error::Damaged),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_comes_back_whole_or_not_at_all() {
        let scene = hairline_fixtures::scenes::oblique_plate(300, 0.01);
        let written = scene.description().to_toml().unwrap();
        let whole = fragment(&written).unwrap();
        assert_eq!(text(&format!("#{whole}")), Some(Ok(written)));
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "=-_".contains(c);
        assert!(whole.chars().all(is_plain), "{whole}");
        for length in KEY.len()..whole.len() {
            assert_eq!(
                text(&whole[..length]),
                Some(Err(Error::Damaged)),
                "{length}"
            );
        }
        let mut changed = whole.clone().into_bytes();
        let middle = KEY.len() + 30;
        changed[middle] = if changed[middle] == b'A' { b'B' } else { b'A' };
        let changed = String::from_utf8(changed).unwrap();
        assert_eq!(text(&changed), Some(Err(Error::Damaged)));
        assert_eq!(text("#top"), None);
    }

    #[test]
    fn what_is_too_long_or_too_large_is_refused() {
        // Letters that follow no pattern: a linear congruential generator's high bits.
        let states = std::iter::successors(Some(1_u32), |state| {
            Some(state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223))
        });
        let letters = states.map(|state| char::from(32 + (state >> 24) as u8 % 90));
        let noise: String = letters.take(20_000).collect();
        assert!(matches!(fragment(&noise), Err(Error::TooLong { needed }) if needed > MOST_BYTES));
        let blank = fragment(&" ".repeat(2 << 20)).unwrap();
        assert_eq!(text(&blank), Some(Err(Error::TooLarge)));
    }
}
