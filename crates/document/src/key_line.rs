//! Finds the line of a key in the file by its path (`light[1].radius_m`).

use std::ops::Range;

use toml::de::{DeTable, DeValue};

/// The line of the deepest part of `key` that is there, counted from 1.
pub(crate) fn line_of_key(text: &str, key: &str) -> Option<usize> {
    let root = DeTable::parse(text).ok()?;
    find(root.get_ref(), key).map(|span| line_of(text, span.start))
}

fn find(root: &DeTable, key: &str) -> Option<Range<usize>> {
    let mut table = root;
    let mut found = None;
    for part in key.split('.') {
        let (name, indices) = part.split_once('[').unwrap_or((part, ""));
        let Some((key, mut value)) = table.get_key_value(name) else {
            break;
        };
        found = Some(key.span());
        for index in indices.split('[').filter(|index| !index.is_empty()) {
            let element = index.trim_end_matches(']').parse::<usize>().ok();
            match (value.get_ref(), element) {
                (DeValue::Array(array), Some(i)) if i < array.len() => {
                    value = &array[i];
                    found = Some(value.span());
                }
                _ => return found,
            }
        }
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => break,
        }
    }
    found
}

/// The line of a byte, counted from 1.
pub(crate) fn line_of(text: &str, offset: usize) -> usize {
    1 + text.as_bytes()[..offset.min(text.len())]
        .iter()
        .filter(|&&byte| byte == b'\n')
        .count()
}
