//! Changes to inputs: of bytes, and of the words and numbers of texts.

use rand::RngExt;
use rand_pcg::Pcg64;

/// Numbers at which programs fail, in any text.
const NUMBERS: [&str; 26] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "3",
    "0.5",
    "1e-5",
    "1e-30",
    "1e-320",
    "999",
    "1000",
    "1001",
    "4096",
    "65535",
    "65536",
    "16777217",
    "1e7",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "1e18",
    "1e39",
    "1e308",
    "-1e308",
];
/// Words in the place of a number.
const WORDS: [&str; 12] = [
    "nan",
    "inf",
    "-inf",
    "true",
    "\"x\"",
    "[]",
    "{}",
    "[[0]]",
    "null",
    "\"\\u001b[2J\"",
    "2020-01-01",
    "",
];

/// Changes bytes in a few places.
pub fn bytes(bytes: &mut Vec<u8>, random: &mut Pcg64) {
    for _ in 0..random.random_range(1..=6) {
        if bytes.is_empty() {
            bytes.push(random.random());
        }
        let at = random.random_range(0..bytes.len());
        let length = random.random_range(1..=16.min(bytes.len() - at));
        match random.random_range(0..8) {
            0 | 1 => bytes[at] ^= 1 << random.random_range(0..8),
            2 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random.random_range(0..5)],
            3 => bytes[at..at + length].fill(0xff),
            4 => drop(bytes.drain(at..at + length)),
            5 => {
                let copy = bytes[at..at + length].to_vec();
                let to = random.random_range(0..=bytes.len());
                bytes.splice(to..to, copy);
            }
            6 => bytes.truncate(at),
            _ => {
                // A number of four bytes: lengths, counts, offsets, floats.
                let number = [
                    0u32,
                    1,
                    0x7fff_ffff,
                    u32::MAX,
                    0x7f80_0000,
                    0x7fc0_0000,
                    1 << 28,
                ];
                let number = number[random.random_range(0..number.len())].to_le_bytes();
                for (byte, value) in bytes[at..].iter_mut().zip(number) {
                    *byte = value;
                }
            }
        }
    }
}

/// Changes numbers, words and lines of a text; now and then its bytes.
pub fn text(text: &str, random: &mut Pcg64) -> Vec<u8> {
    let mut text = text.to_owned();
    for _ in 0..random.random_range(1..=4) {
        match random.random_range(0..8) {
            0..=3 => number(&mut text, random),
            4 => line(&mut text, random),
            5 => word(&mut text, random),
            6 => {
                let mut changed = text.into_bytes();
                bytes(&mut changed, random);
                return changed;
            }
            _ => repeat(&mut text, random),
        }
    }
    text.into_bytes()
}

/// Puts another number, or a word, in the place of a number.
fn number(text: &mut String, random: &mut Pcg64) {
    let is_of_number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    let starts: Vec<usize> = text
        .char_indices()
        .zip(std::iter::once(' ').chain(text.chars()))
        .filter(|((_, c), before)| {
            c.is_ascii_digit()
                && !is_of_number(*before)
                && !before.is_ascii_alphanumeric()
                && *before != '_'
        })
        .map(|((i, _), _)| i)
        .collect();
    if starts.is_empty() {
        return;
    }
    let start = starts[random.random_range(0..starts.len())];
    let length = text[start..]
        .find(|c| !is_of_number(c))
        .unwrap_or(text.len() - start);
    let other = match random.random_range(0..8) {
        0 => WORDS[random.random_range(0..WORDS.len())],
        _ => NUMBERS[random.random_range(0..NUMBERS.len())],
    };
    text.replace_range(start..start + length, other);
}

/// Takes a line out, or puts one in twice.
fn line(text: &mut String, random: &mut Pcg64) {
    let mut lines: Vec<&str> = text.lines().collect();
    if lines.is_empty() {
        return;
    }
    let at = random.random_range(0..lines.len());
    match random.random_range(0..3) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[at]),
        _ => {
            let to = random.random_range(0..lines.len());
            lines.swap(at, to);
        }
    }
    *text = lines.join("\n") + "\n";
}

/// Puts one word of the text in the place of another.
fn word(text: &mut String, random: &mut Pcg64) {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let words: Vec<(usize, &str)> = text
        .split(|c| !is_part(c))
        .filter(|word| !word.is_empty())
        .map(|word| (word.as_ptr() as usize - text.as_ptr() as usize, word))
        .collect();
    if words.is_empty() {
        return;
    }
    let (at, old) = words[random.random_range(0..words.len())];
    let (_, new) = words[random.random_range(0..words.len())];
    let (length, new) = (old.len(), new.to_owned());
    text.replace_range(at..at + length, &new);
}

/// Repeats a part many times.
fn repeat(text: &mut String, random: &mut Pcg64) {
    let starts: Vec<usize> = text.char_indices().map(|(i, _)| i).collect();
    if starts.is_empty() {
        return;
    }
    let from = random.random_range(0..starts.len());
    let to = (from + random.random_range(1..=40)).min(starts.len() - 1);
    let part = text[starts[from]..starts[to]].to_owned();
    let times = [2, 10, 1000][random.random_range(0..3)];
    text.insert_str(starts[from], &part.repeat(times));
}
