//! Text of unknown origin in messages: names, cells, paths. What a terminal would obey is escaped, what is long is shortened.

/// Largest number of characters of a name or a cell in a message.
const LONGEST: usize = 60;
/// Largest number of characters of one half of a message.
const LONGEST_HALF: usize = 1000;

/// Text for one line of a message: control characters, line ends and marks that turn the direction of writing are escaped.
pub fn printable(text: &str) -> String {
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        match is_printable(c) {
            true => line.push(c),
            false => line.extend(c.escape_default()),
        }
    }
    line
}

/// [`printable`] text, cut after 60 characters.
pub fn shown(text: &str) -> String {
    shortened(text, LONGEST)
}

/// Text of an input for a message: escaped, and short enough to be read.
pub fn said(text: &str) -> String {
    shortened(text, LONGEST_HALF)
}

fn shortened(text: &str, longest: usize) -> String {
    match text.char_indices().nth(longest) {
        Some((end, _)) => printable(&text[..end]) + "..",
        None => printable(text),
    }
}

fn is_printable(c: char) -> bool {
    // The marks for embedded and isolated writing directions, which make a line read as another one.
    let turns =
        matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{200e}' | '\u{200f}');
    !c.is_control() && !turns && !matches!(c, '\u{2028}' | '\u{2029}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_escaped() {
        assert_eq!(printable("a\u{1b}[2Jb\nc"), r"a\u{1b}[2Jb\nc");
        assert_eq!(printable("\u{9b}31m \u{202e}x"), r"\u{9b}31m \u{202e}x");
        assert_eq!(
            printable("Kaffeekanne é 漢字 \"x\""),
            "Kaffeekanne é 漢字 \"x\""
        );
    }

    #[test]
    fn what_is_long_is_shortened() {
        assert_eq!(shown(&"é".repeat(100)), "é".repeat(60) + "..");
        assert_eq!(shown("short"), "short");
    }
}
