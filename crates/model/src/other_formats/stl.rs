//! STL files, binary and text (3D Systems, 1989). They have triangles alone: no unit, no material; z is up in nearly all.

use std::io::Cursor;

use serde_json::json;

use super::creased::add_normals;
use super::statements;
use super::translated::{Part, Translated, bare_metal, begun, finished, push_part};
use crate::flaw::Flaw;

const RIGHT: &str = "must be a whole STL file, binary or text";
/// Length of a binary file's header with the number of its triangles, and of a triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

pub(super) fn translated(bytes: &[u8]) -> Result<Translated, Flaw> {
    let readable = readable(bytes)?;
    let mesh = stl_io::read_stl(&mut Cursor::new(readable)).map_err(|error| {
        let found = match wrong_number(bytes) {
            Some(wrong) => wrong,
            None => format!("it is no valid STL ({error})"),
        };
        Flaw::new(found, RIGHT)
    })?;
    let mut part = Part {
        name: "part".to_owned(),
        positions: mesh.vertices.iter().map(|it| it.0).collect(),
        triangles: (mesh.faces.iter())
            .map(|it| it.vertices.map(|v| v as u32))
            .collect(),
        ..Part::default()
    };
    add_normals(&mut part);
    if part.triangles.is_empty() {
        return Err(Flaw::new("it has no triangles", RIGHT));
    }
    let mut file = begun();
    file.push("materials", bare_metal());
    let child = push_part(&mut file, &part);
    // From millimetres, z up, to metres, y up: columns, one after the other.
    let mm = 1e-3;
    let matrix = [
        mm, 0.0, 0.0, 0.0, 0.0, 0.0, -mm, 0.0, 0.0, mm, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0,
    ];
    let root = file.push(
        "nodes",
        json!({ "name": "stl", "children": [child], "matrix": matrix }),
    );
    Ok(Translated {
        bytes: finished(file, vec![root])?,
        notes: vec![
            "it names no unit and no material; taken for millimetres, z up, of a metal (`scale = 1000` where it is in metres)".to_owned(),
        ],
        ..Translated::default()
    })
}

/// The first line of a text whose numbers are wrong.
fn wrong_number(bytes: &[u8]) -> Option<String> {
    let text = str::from_utf8(bytes).ok()?;
    statements::split_statements(text).find_map(|(line, key, rest)| {
        let numbers = match key {
            "vertex" => rest,
            "facet" => rest.strip_prefix("normal")?,
            _ => return None,
        };
        let wrong = statements::check_numbers(numbers, 3).err()?;
        Some(format!("line {line}: {key}: {wrong}"))
    })
}

/// The bytes as the crate tells the two forms apart: a text begins with `solid`, a space and a name, and nothing else does.
fn readable(bytes: &[u8]) -> Result<Vec<u8>, Flaw> {
    let count = bytes
        .get(80..HEADER)
        .map(|it| u32::from_le_bytes([it[0], it[1], it[2], it[3]]));
    let length = count.map(|count| HEADER + TRIANGLE * count as usize);
    // Headers of binary files may begin like a text.
    let text = str::from_utf8(bytes)
        .ok()
        .filter(|_| length != Some(bytes.len()));
    match text
        .map(str::trim_start)
        .and_then(|text| text.strip_prefix("solid"))
    {
        Some(text) => {
            if !text.contains("endsolid") {
                let lines = text.lines().count();
                let found = format!("it is cut off: it ends in line {lines}, without `endsolid`");
                return Err(Flaw::new(found, RIGHT));
            }
            let (_, facets) = text.split_once('\n').unwrap_or_default();
            Ok(format!("solid part\n{facets}").into_bytes())
        }
        None => {
            let Some(length) = length else {
                return Err(Flaw::new(format!("it has {} bytes", bytes.len()), RIGHT));
            };
            if bytes.len() < length {
                let found = format!(
                    "it is cut off, or no STL: {} of {length} bytes are there",
                    bytes.len()
                );
                return Err(Flaw::new(found, RIGHT));
            }
            let mut bytes = bytes.to_vec();
            bytes[..5].fill(0);
            Ok(bytes)
        }
    }
}
