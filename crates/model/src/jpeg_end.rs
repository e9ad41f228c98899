//! Checks whether a JPEG file has all of its picture: decoders fill missing parts with grey, and say
//! nothing.
//!
//! ITU-T T.81, annex B: segments with their lengths, scans of coded data, and a mark at the end.

const MARK: u8 = 0xff;
const START: u8 = 0xd8;
const END: u8 = 0xd9;

/// Whether the bytes are a JPEG that ends before its mark of the end.
pub(crate) fn is_cut_off(bytes: &[u8]) -> bool {
    if !bytes.starts_with(&[MARK, START]) {
        return false;
    }
    let mut at = 2;
    loop {
        // Bytes between segments are skipped, and so is the coded data of a scan, in which a mark is followed by 0 or the number of a restart.
        let Some(mark) = mark_from(bytes, at) else {
            return true;
        };
        at = mark + 1;
        match bytes[mark] {
            END => return false,
            // Marks without a length: restarts and 1.
            0x01 | 0xd0..=START => {}
            _ => {
                let Some(length) = bytes.get(at..at + 2) else {
                    return true;
                };
                at += usize::from(u16::from_be_bytes([length[0], length[1]]));
            }
        }
    }
}

/// The place of the next mark's number.
fn mark_from(bytes: &[u8], from: usize) -> Option<usize> {
    let pairs = bytes.get(from..)?.windows(2);
    let place = pairs
        .into_iter()
        .position(|pair| pair[0] == MARK && !matches!(pair[1], 0 | MARK));
    place.map(|place| from + place + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, ImageFormat, RgbImage};
    use std::io::Cursor;

    #[test]
    fn a_file_is_whole_up_to_its_mark_of_the_end() {
        let picture =
            RgbImage::from_fn(64, 48, |x, y| image::Rgb([x as u8, y as u8, (x * y) as u8]));
        let mut file = Cursor::new(Vec::new());
        DynamicImage::from(picture)
            .write_to(&mut file, ImageFormat::Jpeg)
            .unwrap();
        let bytes = file.into_inner();
        assert!(!is_cut_off(&bytes));
        // Bytes that programs append are not part of the picture.
        assert!(!is_cut_off(&[&bytes[..], b"more"].concat()));
        for end in 2..bytes.len() - 1 {
            assert!(is_cut_off(&bytes[..end]), "{end} of {}", bytes.len());
        }
        // A small picture for file browsers, whole within a segment of the large one.
        let length = (bytes.len() as u16 + 2).to_be_bytes();
        let start = [
            &[MARK, START, MARK, 0xe1][..],
            &length,
            &bytes,
            &bytes[2..300],
        ]
        .concat();
        assert!(is_cut_off(&start));
        assert!(!is_cut_off(b"no picture"));
    }
}
