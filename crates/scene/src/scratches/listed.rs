//! A layer whose scratches are listed in a CSV file, one straight scratch a row; and lists for other programs.

use std::io::{self, Write};
use std::path::Path;

use rayon::prelude::*;

use super::ground::Ground;
use super::guide::Guide;
use super::laying::{DEPTHS_NM, Groove, Laying, WIDTHS_UM};
use super::walk::{Course, Walker};
use crate::arrays::ScratchArrays;
use crate::error::Error;
use crate::loader::Loader;
use crate::reading::{self, Kind};
use crate::scene::{Object, Profile, Scratch, Segment};
use crate::text::shown;

const COLUMNS: [&str; 8] = [
    "x0_m", "y0_m", "z0_m", "x1_m", "y1_m", "z1_m", "width_um", "depth_nm",
];
/// What a list for other programs has besides: the number of the scratch, whose straight pieces follow one another, and the surface's
/// normal in the middle of the piece.
const MORE_COLUMNS: &str = "scratch,nx,ny,nz";
/// Ends may lie this far off the surface, relative to the diagonal of the object: a list made for the ideal shape fits its facets.
const OFF_SURFACE: f64 = 0.01;
/// On a curved surface the way between two points is longer than the straight line through it.
const LONGEST_WAY: f64 = 4.0;

/// A row of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    /// Counted from 1.
    line: usize,
    ends_m: [[f64; 3]; 2],
    profile: Profile,
}

/// Reads all rows. `key` is the way to the layer's table in the scene file.
pub(super) fn read(path: &Path, key: &str) -> Result<Vec<Row>, Error> {
    // The rows take about as much as the text, twice.
    let text = reading::read(path, Kind::File, 1.0 / 6.0).map_err(|error| {
        Error::new(
            format!("{key}.file"),
            format!("\"{}\" cannot be read ({error})", path.display()),
            "must be a CSV file, relative to the scene file",
        )
    })?;
    let text = String::from_utf8(text).map_err(|_| {
        let right = format!("must be a text with the header `{}`", COLUMNS.join(","));
        Error::new("", "found bytes that are no UTF-8", right).at(path, None)
    })?;
    parse(&text, path)
}

/// An error goes with its line in the file of this path.
fn parse(text: &str, path: &Path) -> Result<Vec<Row>, Error> {
    // A byte order mark is no part of the first name.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty());
    let header_is = || format!("must be the header `{}`", COLUMNS.join(","));
    let Some((first, header)) = lines.next() else {
        return Err(Error::new("", "found an empty file", header_is()).at(path, Some(1)));
    };
    let header: Vec<_> = header.split(',').map(str::trim).collect();
    if header != COLUMNS {
        let found = format!("found `{}`", shown(&header.join(",")));
        return Err(Error::new("", found, header_is()).at(path, Some(first)));
    }
    lines
        .map(|(line, row)| parse_row(line, row).map_err(|error| error.at(path, Some(line))))
        .collect()
}

fn parse_row(line: usize, row: &str) -> Result<Row, Error> {
    let cells: Vec<_> = row.split(',').map(str::trim).collect();
    if cells.len() != COLUMNS.len() {
        let found = format!("found {} cells", cells.len());
        let right = format!("must be {}, as in the header", COLUMNS.len());
        return Err(Error::new("", found, right));
    }
    let mut values = [0.0; COLUMNS.len()];
    for (i, cell) in cells.iter().enumerate() {
        values[i] = cell
            .parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
            .ok_or_else(|| {
                let found = format!("found \"{}\"", shown(cell));
                Error::new(COLUMNS[i], found, "must be a number")
            })?;
    }
    let [x0, y0, z0, x1, y1, z1, width_um, depth_nm] = values;
    for (name, value, (least, most)) in [
        ("width_um", width_um, WIDTHS_UM),
        ("depth_nm", depth_nm, DEPTHS_NM),
    ] {
        if !(least..=most).contains(&value) {
            let right = format!("must be from {least} to {most}");
            return Err(Error::new(name, format!("found {value}"), right));
        }
    }
    Ok(Row {
        line,
        ends_m: [[x0, y0, z0], [x1, y1, z1]],
        profile: Profile {
            width_um: width_um as f32,
            depth_nm: depth_nm as f32,
        },
    })
}

/// Writes laid scratches of an object for other programs: a straight piece a row, in world space. The numbers read back as what they were.
/// packages/hairline-shaders reads it.
///
/// # Errors
/// What cannot be written.
pub fn write_scratches<'a>(
    object: &Object,
    scratches: impl IntoIterator<Item = &'a Scratch>,
    out: &mut impl Write,
) -> io::Result<()> {
    writeln!(out, "{},{MORE_COLUMNS}", COLUMNS.join(","))?;
    for (number, scratch) in scratches.into_iter().enumerate() {
        let Profile { width_um, depth_nm } = scratch.profile;
        let own = scratch.segments.start as usize..scratch.segments.end as usize;
        for piece in &object.segments[own] {
            for x in [piece.start_m, piece.end_m]
                .iter()
                .flat_map(|end| end.to_array())
            {
                write!(out, "{x},")?;
            }
            let [x, y, z] = piece.normal.to_array();
            writeln!(out, "{width_um},{depth_nm},{number},{x},{y},{z}")?;
        }
    }
    Ok(())
}

/// Refuses the first end that does not lie on the surface. `error` makes the message of a row, one of its ends and two halves of a
/// sentence.
fn check_on_surface(
    loader: &Loader,
    rows: &[Row],
    ground: &Ground,
    error: impl Fn(usize, usize, String, String) -> Error + Sync,
) -> Result<(), Error> {
    const TOGETHER: usize = 1 << 16;
    let tolerance_m = OFF_SURFACE * ground.diagonal_m;
    let closest = ground.closest();
    for (first, rows) in (0..).step_by(TOGETHER).zip(rows.chunks(TOGETHER)) {
        loader.go_on()?;
        let off = |end_m: &[f64; 3]| {
            let point_m = ground.point_in_world_m(*end_m);
            closest.find_within(point_m, tolerance_m).is_none()
        };
        let wrong = rows.par_iter().enumerate().find_map_first(|(i, row)| {
            let end = row.ends_m.iter().position(off)?;
            Some((i, end))
        });
        if let Some((i, end)) = wrong {
            let (_, distance_m) = closest.find(ground.point_in_world_m(rows[i].ends_m[end]));
            let found = format!("found a point {distance_m:.3e} m off the object's surface");
            let right = format!(
                "must be at most {tolerance_m:.3e} m off, in metres of the object's own frame"
            );
            return Err(error(first + i, end, found, right));
        }
    }
    Ok(())
}

/// Rows with the ground that they go on.
pub(super) struct Listed<'a> {
    rows: Vec<Row>,
    ground: &'a Ground,
}

impl<'a> Listed<'a> {
    /// Refuses rows that do not lie on the surface.
    pub(super) fn new(
        loader: &Loader,
        rows: Vec<Row>,
        path: &Path,
        ground: &'a Ground,
    ) -> Result<Self, Error> {
        check_on_surface(loader, &rows, ground, |i, end, found, right| {
            let key = ["x0_m", "x1_m"][end];
            Error::new(key, found, right).at(path, Some(rows[i].line))
        })?;
        Ok(Self { rows, ground })
    }

    /// The same of scratches in memory. `key` is the way to the layer's table in the scene.
    pub(super) fn of_arrays(
        loader: &Loader,
        arrays: &ScratchArrays,
        key: &str,
        ground: &'a Ground,
    ) -> Result<Self, Error> {
        let rows = arrays.ends_m().iter().zip(arrays.profiles()).enumerate();
        let rows: Vec<_> = rows
            .map(|(i, (&ends_m, &profile))| Row {
                line: i,
                ends_m,
                profile,
            })
            .collect();
        check_on_surface(loader, &rows, ground, |i, end, found, right| {
            Error::new(format!("{key}.ends_m[{i}][{end}]"), found, right)
        })?;
        Ok(Self { rows, ground })
    }

    pub(super) fn count(&self) -> u64 {
        self.rows.len() as u64
    }
}

impl Laying for Listed<'_> {
    fn lay(&self, walker: &Walker, index: u64, segments: &mut Vec<Segment>) -> Groove {
        let row = &self.rows[index as usize];
        let [(start, _), (end, _)] = row.ends_m.map(|point| {
            self.ground
                .closest()
                .find(self.ground.point_in_world_m(point))
        });
        let guide = Guide::Towards { end_m: end.point_m };
        let length_m = LONGEST_WAY * start.point_m.distance(end.point_m);
        walker.lay_from(start, &guide, length_m, segments);
        Groove {
            profile: row.profile,
            course: Course::Open,
        }
    }
}
