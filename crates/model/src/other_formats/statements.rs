//! Statements of OBJ, .mtl and STL files, a line each: what the crates that read them refuse without its place, or take in silence.

use std::path::Path;

use crate::flaw::Flaw;
use crate::text::shown;

/// What an OBJ file has that is read in silence.
#[derive(Default)]
pub(super) struct SilentContents<'a> {
    /// Number of faces of fewer than three corners, and the line of the first.
    pub short_faces: (usize, usize),
    /// Materials that it uses, each time with the line.
    pub used: Vec<(usize, &'a str)>,
}

/// Lines with their numbers from 1, their first word and what follows it.
pub(super) fn split_statements(text: &str) -> impl Iterator<Item = (usize, &str, &str)> {
    (1..).zip(text.lines()).map(|(line, statement)| {
        let statement = statement.trim();
        let (key, rest) = statement
            .split_once(char::is_whitespace)
            .unwrap_or((statement, ""));
        (line, key, rest.trim())
    })
}

/// What OBJ calls the elements of a corner, with their names in messages.
const ELEMENTS: [(&str, &str); 3] = [("v", "vertex"), ("vt", "point"), ("vn", "normal")];

/// Checks the numbers and the faces of an OBJ file.
///
/// # Errors
/// What is wrong, with its line.
pub(super) fn check_obj(text: &str) -> Result<SilentContents<'_>, String> {
    let element = |key: &str| ELEMENTS.iter().position(|(name, _)| *name == key);
    let mut all = [0; 3];
    for index in split_statements(text).filter_map(|(_, key, _)| element(key)) {
        all[index] += 1;
    }
    let (mut before, mut found) = ([0; 3], SilentContents::default());
    for (line, key, rest) in split_statements(text) {
        if let Some(index) = element(key) {
            before[index] += 1;
            let least = if key == "vt" { 1 } else { 3 };
            check_numbers(rest, least).map_err(|what| format!("line {line}: {key}: {what}"))?;
        } else if key == "f" {
            check_face(rest, all, before).map_err(|what| format!("line {line}: {what}"))?;
            if rest.split_whitespace().count() < 3 {
                let (count, first) = &mut found.short_faces;
                *count += 1;
                *first = if *count == 1 { line } else { *first };
            }
        } else if key == "usemtl" {
            found.used.push((line, rest));
        }
    }
    Ok(found)
}

/// Checks that a statement begins with so many numbers, and that all of its numbers are finite.
pub(super) fn check_numbers(rest: &str, least: usize) -> Result<(), String> {
    let mut count = 0;
    for word in rest.split_whitespace() {
        match word.parse::<f32>() {
            Ok(number) if number.is_finite() => count += 1,
            // A comment, or what the crate takes for none.
            _ if count >= least && word.parse::<f32>().is_err() => break,
            _ => return Err(format!("\"{}\" is no finite number", shown(word))),
        }
    }
    match count < least {
        true => Err(format!("it has {count} of {least} numbers")),
        false => Ok(()),
    }
}

/// Checks that what the corners of a face name is there: counted from 1 among all, or back from the face among those before it.
fn check_face(rest: &str, all: [usize; 3], before: [usize; 3]) -> Result<(), String> {
    for corner in rest.split_whitespace() {
        for (i, index) in corner.split('/').enumerate().take(3) {
            let Ok(index) = index.parse::<isize>() else {
                continue;
            };
            let there = if index < 0 { before[i] } else { all[i] };
            // Without any, points and normals are left out.
            let is_there = (1..=there).contains(&index.unsigned_abs()) || (i > 0 && all[i] == 0);
            if !is_there {
                let name = ELEMENTS[i].1;
                return Err(format!("{name} {index}; there are {there}"));
            }
        }
    }
    Ok(())
}

/// Checks what the statements of a .mtl file need.
///
/// # Errors
/// The file, the line, the key, what was found and what would be right.
pub(super) fn check_mtl(name: &Path, text: &str) -> Result<(), Flaw> {
    for (line, key, rest) in split_statements(text) {
        let right = match key {
            "Ka" | "Kd" | "Ks" | "Ke" if check_numbers(rest, 3).is_err() => "3 numbers",
            "Ns" | "Ni" | "d" if check_numbers(rest, 1).is_err() => "a number",
            "illum" if rest.parse::<u8>().is_err() => "a whole number",
            "newmtl" if rest.is_empty() => "a name",
            "bump" if rest.is_empty() => "a file",
            _ if key.starts_with("map_") && rest.is_empty() => "a file",
            _ => continue,
        };
        let [name, found] = [&name.to_string_lossy(), rest].map(shown);
        let found = format!("{name}:{line}: {key}: found \"{found}\"");
        return Err(Flaw::new(found, format!("must be {right}")));
    }
    Ok(())
}
