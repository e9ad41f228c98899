//! The header of a Radiance picture: lines of text, each of which counts from its first column only; programs indent what was said of their
//! inputs (G. Ward, *Real Pixels*, 1991, and Radiance's manual page on picture files).

use std::io::{self, BufRead, Read};

use hairline_image::Primaries;

/// What a header says of the numbers that follow.
#[derive(Debug, PartialEq)]
pub(super) struct Header {
    /// What the radiances were multiplied by, in each channel: the exposure and the correction of colours.
    pub factor: [f32; 3],
    /// Colours that the numbers are of, if it says so.
    pub primaries: Option<Primaries>,
}

/// Longest header in bytes.
const MOST_BYTES: u64 = 1 << 20;
/// Exposures beyond these are taken for numbers that nobody meant: FreeImage writes 0.
const EXPOSURES: std::ops::RangeInclusive<f32> = 1e-10..=1e10;

/// Takes the header off a file. Returns it, and the file with as much of a header as a decoder needs.
pub(super) fn take(mut file: impl BufRead) -> io::Result<(Result<Header, String>, impl BufRead)> {
    let mut kept = Vec::new();
    let mut head = file.by_ref().take(MOST_BYTES);
    let mut header = Ok(Header {
        factor: [1.0; 3],
        primaries: None,
    });
    let mut line = Vec::new();
    for i in 0.. {
        line.clear();
        head.read_until(b'\n', &mut line)?;
        match line.as_slice() {
            // Other programs write the second; decoders know the first.
            text if i == 0 && text.starts_with(b"#?RGBE") => kept.extend(b"#?RADIANCE\n"),
            text if i == 0 || text.starts_with(b"FORMAT=") => kept.extend(text),
            text => {
                let text = String::from_utf8_lossy(text);
                header = header.and_then(|header| header.with_line(text.trim_end()));
            }
        }
        if line.trim_ascii_end().is_empty() {
            kept.extend(&line);
            break;
        }
    }
    Ok((header, io::Cursor::new(kept).chain(file)))
}

impl Header {
    /// The header with another line. All exposures and corrections count, and the last primaries.
    fn with_line(mut self, line: &str) -> Result<Self, String> {
        let Some((key, value)) = line.split_once('=') else {
            return Ok(self);
        };
        let numbers: Option<Vec<f64>> =
            value.split_whitespace().map(|it| it.parse().ok()).collect();
        let numbers = numbers.unwrap_or_default();
        let wrong = |right: &str| format!("{line} in the header: {right}");
        match key {
            "EXPOSURE" => {
                let [exposure] = numbers[..] else {
                    return Err(wrong("a number is needed"));
                };
                self.multiply([exposure as f32; 3]);
            }
            "COLORCORR" => {
                let [r, g, b] = numbers[..] else {
                    return Err(wrong("three numbers are needed: for red, green and blue"));
                };
                self.multiply([r, g, b].map(|number| number as f32));
            }
            "PRIMARIES" => {
                let eight = <[f64; 8]>::try_from(numbers).map_err(|_| {
                    wrong("eight numbers are needed: x and y of red, green, blue and white")
                })?;
                self.primaries = Some(Primaries::of_numbers(eight));
            }
            _ => {}
        }
        Ok(self)
    }

    fn multiply(&mut self, factor: [f32; 3]) {
        if factor.iter().all(|c| EXPOSURES.contains(c)) {
            self.factor = std::array::from_fn(|c| self.factor[c] * factor[c]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(lines: &str) -> (Result<Header, String>, String) {
        let file = format!("#?RGBE\n{lines}\n\n-Y 1 +X 2\npixels");
        let (header, mut rest) = take(file.as_bytes()).unwrap();
        let mut left = String::new();
        rest.read_to_string(&mut left).unwrap();
        (header, left)
    }

    fn factor(lines: &str) -> [f32; 3] {
        taken(lines).0.unwrap().factor
    }

    #[test]
    fn all_exposures_and_corrections_count() {
        assert_eq!(
            factor("EXPOSURE=4\nCOLORCORR=2 1 1\nEXPOSURE= 0.5\r"),
            [4.0, 2.0, 2.0]
        );
    }

    #[test]
    fn exposures_that_nobody_meant_do_not() {
        for none in ["0", "-1", "1e-11", "2e10", "nan", "inf"] {
            assert_eq!(
                factor(&format!("EXPOSURE={none}\nGAMMA=1")),
                [1.0; 3],
                "{none}"
            );
        }
    }

    #[test]
    fn what_is_indented_is_said_of_another_picture() {
        let (header, left) =
            taken("a.hdr:\n\tEXPOSURE=4\n COLORCORR=2 1 1\n\tFORMAT=no\nFORMAT=32-bit_rle_rgbe");
        assert_eq!(header.unwrap().factor, [1.0; 3]);
        assert_eq!(
            left,
            "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\npixels"
        );
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (line, told) in [
            (
                "EXPOSURE=bright",
                "EXPOSURE=bright in the header: a number is needed",
            ),
            ("COLORCORR=1 2", "three numbers"),
            ("PRIMARIES=1 2 3", "eight numbers"),
        ] {
            let message = taken(line).0.unwrap_err();
            assert!(message.contains(told), "{message}");
        }
    }
}
