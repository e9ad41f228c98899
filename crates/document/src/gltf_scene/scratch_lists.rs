//! Lists of scratches as accessors of a glTF file.

use std::fmt::Write;

use hairline_image::FilePath;
use hairline_model::flaw::Flaw;
use hairline_model::gltf_file::GltfFile;
use hairline_scene::Profile;
use serde_json::{Value, json};

use crate::arrays::ScratchArrays;
use crate::error::Error;
use crate::scratches::{ListedRow, list_header, read_list};

/// A row of a list, with the number of its scratch.
type Row = ([[f64; 3]; 2], Profile, u32);

/// Adds the list of a CSV file, and returns what the extension has in its place.
pub(super) fn write_file(file: &mut GltfFile, path: &FilePath, key: &str) -> Result<Value, Error> {
    let rows = read_list(path, key)?;
    let row = |row: &ListedRow| (row.ends_m, row.profile.clone(), row.scratch);
    Ok(write(file, rows.iter().map(row)))
}

/// As [`write_file`], of a list in memory.
pub(super) fn write_arrays(file: &mut GltfFile, arrays: &ScratchArrays) -> Value {
    let rows = arrays.ends_m().iter().zip(arrays.profiles());
    let scratches = (0u32..).zip(arrays.first().array_windows());
    let numbers = scratches.flat_map(|(number, [first, end])| (*first..*end).map(move |_| number));
    let rows = numbers.zip(rows);
    write(
        file,
        rows.map(|(number, (ends_m, profile))| (*ends_m, profile.clone(), number)),
    )
}

fn write(file: &mut GltfFile, rows: impl Iterator<Item = Row>) -> Value {
    let (mut starts, mut ends, mut widths, mut depths) = (vec![], vec![], vec![], vec![]);
    let mut exact: Vec<f64> = Vec::new();
    let mut numbers: Vec<u32> = Vec::new();
    for ([start, end], profile, number) in rows {
        starts.extend(start.map(|x| x as f32));
        ends.extend(end.map(|x| x as f32));
        widths.push(profile.width_um);
        depths.push(profile.depth_nm);
        exact.extend([start, end].as_flattened());
        numbers.push(number);
    }
    let mut list = json!({
        "start_m": file.push_floats(&starts, 3, false),
        "end_m": file.push_floats(&ends, 3, false),
        "width_um": file.push_floats(&widths, 1, false),
        "depth_nm": file.push_floats(&depths, 1, false),
    });
    // Hairline computes in double precision, which accessors do not have.
    if exact.iter().any(|x| f64::from(*x as f32) != *x) {
        let bytes: Vec<u8> = exact.iter().flat_map(|x| x.to_le_bytes()).collect();
        list["ends_f64"] = json!(file.push_view(&bytes));
    }
    // Else each is a scratch by itself.
    if numbers.array_windows().any(|[a, b]| a == b) {
        let bytes: Vec<u8> = numbers.iter().flat_map(|it| it.to_le_bytes()).collect();
        list["scratches_u32"] = json!(file.push_view(&bytes));
    }
    list
}

/// The number of an accessor that a list names.
fn number(list: &Value, name: &str) -> Result<usize, Flaw> {
    let number = list.get(name).and_then(Value::as_u64);
    number.map(|number| number as usize).ok_or_else(|| {
        let found = format!("found no `{name}`");
        Flaw::new(found, "must be the number of an accessor")
    })
}

/// The number of the scratch of each piece, as its bytes.
fn scratches<'a>(file: &'a GltfFile, list: &Value, count: usize) -> Result<&'a [[u8; 4]], Flaw> {
    let (numbers, _) = file.view(number(list, "scratches_u32")?)?.as_chunks::<4>();
    match numbers.len() == count {
        true => Ok(numbers),
        false => Err(Flaw::new(
            format!("found {} numbers in `scratches_u32`", numbers.len()),
            format!("must be one for each of {count} pieces"),
        )),
    }
}

/// The CSV text of a list.
pub(super) fn read(file: &GltfFile, list: &Value) -> Result<String, Flaw> {
    let starts = file.floats(number(list, "start_m")?, 3)?;
    let ends = file.floats(number(list, "end_m")?, 3)?;
    let widths = file.floats(number(list, "width_um")?, 1)?;
    let depths = file.floats(number(list, "depth_nm")?, 1)?;
    let count = widths.len();
    if starts.len() != 3 * count || ends.len() != 3 * count || depths.len() != count {
        let found = format!(
            "found {} starts, {} ends, {count} widths and {} depths",
            starts.len() / 3,
            ends.len() / 3,
            depths.len()
        );
        return Err(Flaw::new(found, "must be as many of each"));
    }
    let mut exact: Vec<f64> = (0..count)
        .flat_map(|i| [&starts[3 * i..3 * i + 3], &ends[3 * i..3 * i + 3]])
        .flatten()
        .map(|x| f64::from(*x))
        .collect();
    if list.get("ends_f64").is_some() {
        let (numbers, _) = file.view(number(list, "ends_f64")?)?.as_chunks::<8>();
        if numbers.len() != exact.len() {
            let found = format!("found {} numbers in `ends_f64`", numbers.len());
            let right = format!("must be six for each of {count} scratches");
            return Err(Flaw::new(found, right));
        }
        exact = numbers.iter().map(|it| f64::from_le_bytes(*it)).collect();
    }
    let scratches = match list.get("scratches_u32") {
        Some(_) => Some(scratches(file, list, count)?),
        None => None,
    };
    let mut text = list_header(scratches.is_some());
    for (i, ends) in exact.chunks(6).enumerate() {
        text.push('\n');
        for x in ends {
            // Writing to a text cannot fail.
            let _ = write!(text, "{x},");
        }
        let _ = write!(text, "{},{}", widths[i], depths[i]);
        if let Some(numbers) = scratches {
            let _ = write!(text, ",{}", u32::from_le_bytes(numbers[i]));
        }
    }
    text.push('\n');
    Ok(text)
}
