//! A layer whose scratches are listed in a CSV file: one straight scratch a row, or the straight pieces of one.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use hairline_image::FilePath;
use hairline_laying::{Course, Groove, Ground, Guide, LONGEST_WAY, Laying, MeshPoint, Walker};
use hairline_model::reading::{self, FileKind};
use hairline_model::text::shown;
use hairline_scene::{Profile, Segment};
use rayon::prelude::*;

use super::off_object::at_most;
use super::sizes::LISTED_SIZES;
use crate::arrays::ScratchArrays;
use crate::error::{Error, length};
use crate::loader::Loader;

const ENDS: [&str; 6] = ["x0_m", "y0_m", "z0_m", "x1_m", "y1_m", "z1_m"];
const COUNT: usize = ENDS.len() + LISTED_SIZES.len();
/// Further columns: the number of the scratch, whose straight pieces follow one another, and the surface's normal in the middle of the
/// piece. A list to be read has all, none, or the number alone. The normal is not read.
pub(super) const MORE_COLUMNS: [&str; 4] = ["scratch", "nx", "ny", "nz"];
/// Largest distance of a scratch's end from the surface, relative to the diagonal of the object: a list for the ideal shape fits its
/// facets.
const OFF_SURFACE: f64 = 0.01;

/// A row of the file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ListedRow {
    /// Counted from 1.
    line: usize,
    pub ends_m: [[f64; 3]; 2],
    pub profile: Profile,
    /// Number of its scratch. Rows side by side with one number are pieces of one scratch.
    pub scratch: u32,
}

/// The header.
pub(super) fn columns() -> Vec<&'static str> {
    let sizes = LISTED_SIZES.iter().map(|size| size.key);
    ENDS.into_iter().chain(sizes).collect()
}

/// The header of a list, with the numbers of the scratches or without.
pub(crate) fn list_header(has_numbers: bool) -> String {
    let numbers = has_numbers.then_some(MORE_COLUMNS[0]);
    let names: Vec<_> = columns().into_iter().chain(numbers).collect();
    names.join(",")
}

/// Reads all rows. `key` is the path of the layer's table in the scene file.
pub(crate) fn read(path: &FilePath, key: &str) -> Result<Vec<ListedRow>, Error> {
    // The rows take about as much as the text, twice.
    let text = reading::read(path, FileKind::File, 1.0 / 6.0).map_err(|error| {
        Error::new(
            format!("{key}.file"),
            format!("\"{}\" cannot be read ({error})", path.display()),
            "must be a CSV file, relative to the scene file",
        )
    })?;
    let text = String::from_utf8(text).map_err(|_| {
        let right = format!("must be a text with the header `{}`", columns().join(","));
        Error::new("", "found bytes that are no UTF-8", right).with_position(path, None)
    })?;
    parse(&text, path)
}

/// Parses the list. An error gets its line in the file of this path.
fn parse(text: &str, path: &Path) -> Result<Vec<ListedRow>, Error> {
    // A byte order mark is no part of the first name.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty());
    let header_is = || format!("must be the header `{}`", columns().join(","));
    let Some((first, header)) = lines.next() else {
        return Err(Error::new("", "found an empty file", header_is()).with_position(path, Some(1)));
    };
    let header: Vec<_> = header.split(',').map(bare).collect();
    let all: Vec<_> = columns().into_iter().chain(MORE_COLUMNS).collect();
    let is_known = [COUNT, COUNT + 1, all.len()].contains(&header.len());
    if !is_known || header != all[..header.len()] {
        let found = format!("found `{}`", shown(&header.join(",")));
        return Err(Error::new("", found, header_is()).with_position(path, Some(first)));
    }
    let lines: Vec<_> = lines.collect();
    let rows: Vec<_> = (0u32..lines.len() as u32)
        .into_par_iter()
        .zip(&lines)
        .map(|(number, &(line, row))| {
            let row = parse_row(line, row, header.len(), number);
            row.map_err(|error| error.with_position(path, Some(line)))
        })
        .collect();
    // The first wrong one, whichever was read first.
    let rows: Vec<ListedRow> = rows.into_iter().collect::<Result<_, _>>()?;
    for [before, row] in rows.array_windows() {
        row.check_after(before)
            .map_err(|error| error.with_position(path, Some(row.line)))?;
    }
    Ok(rows)
}

impl ListedRow {
    /// Refuses a piece that does not go on where the one before it, of the same scratch, ends.
    fn check_after(&self, before: &Self) -> Result<(), Error> {
        if self.scratch != before.scratch {
            return Ok(());
        }
        if self.ends_m[0] != before.ends_m[1] {
            let [x, y, z] = before.ends_m[1];
            let found = format!(
                "found a start off the row before, of the same scratch {}",
                self.scratch
            );
            return Err(Error::new(
                "x0_m",
                found,
                format!("must be its end {x}, {y}, {z}"),
            ));
        }
        if self.profile != before.profile {
            let found = format!(
                "found other sizes than in the row before, of the same scratch {}",
                self.scratch
            );
            return Err(Error::new("", found, "must be the same"));
        }
        Ok(())
    }
}

/// A cell without spaces around it, and without quotes, which some programs write around all.
fn bare(cell: &str) -> &str {
    let cell = cell.trim();
    let quoted = cell.strip_prefix('"').and_then(|it| it.strip_suffix('"'));
    quoted.map_or(cell, str::trim)
}

/// Parses a row of so many cells; without a column for it `number` is that of its scratch.
fn parse_row(line: usize, row: &str, count: usize, number: u32) -> Result<ListedRow, Error> {
    let cells: Vec<_> = row.split(',').map(bare).collect();
    if cells.len() != count {
        let found = format!("found {} cells", cells.len());
        let right = format!("must be {count}, as in the header");
        return Err(Error::new("", found, right));
    }
    let scratch = cells.get(COUNT).map_or(Ok(number), |cell| {
        cell.parse().map_err(|_| {
            let found = format!("found \"{}\"", shown(cell));
            Error::new(MORE_COLUMNS[0], found, "must be a whole number")
        })
    })?;
    let mut values = [0.0; COUNT];
    for (i, cell) in cells[..COUNT].iter().enumerate() {
        values[i] = cell
            .parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
            .ok_or_else(|| {
                let found = format!("found \"{}\"", shown(cell));
                Error::new(columns()[i], found, "must be a number")
            })?;
    }
    let [x0, y0, z0, x1, y1, z1, sizes @ ..] = values;
    let mut profile = Profile::default();
    for (size, value) in LISTED_SIZES.iter().zip(sizes) {
        size.check(|| size.key.to_owned(), value)?;
        *(size.of)(&mut profile) = value as f32;
    }
    if (x0, y0, z0) == (x1, y1, z1) {
        return Err(Error::new(
            "",
            "found both ends at one point",
            "must be two points",
        ));
    }
    Ok(ListedRow {
        line,
        ends_m: [[x0, y0, z0], [x1, y1, z1]],
        profile,
        scratch,
    })
}

/// A straight piece with its ends on the surface.
struct PlacedPiece {
    start: MeshPoint,
    end_m: DVec3,
    profile: Profile,
}

/// Scratches on the ground that they go on.
pub(super) struct Listed<'a> {
    pieces: Vec<PlacedPiece>,
    /// Index of the first piece of each scratch, and behind the last one.
    first: Vec<u32>,
    ground: &'a Ground,
}

impl<'a> Listed<'a> {
    /// Makes the layer, or refuses rows that do not lie on the surface.
    pub(super) fn new(
        loader: &Loader,
        rows: &[ListedRow],
        path: &Path,
        ground: &'a Ground,
    ) -> Result<Self, Error> {
        let row = |i: usize| (rows[i].ends_m, rows[i].profile.clone());
        let begins = |i: &usize| *i == 0 || rows[*i].scratch != rows[i - 1].scratch;
        let first = (0..rows.len()).filter(begins).map(|i| i as u32);
        let first = first.chain([rows.len() as u32]).collect();
        Self::placed(loader, first, row, ground, |i, end, found, right| {
            let key = ["x0_m", "x1_m"][end];
            Error::new(key, found, right).with_position(path, Some(rows[i].line))
        })
    }

    /// Reads scratches from arrays in memory. `key` is the path of the layer's table in the scene.
    pub(super) fn of_arrays(
        loader: &Loader,
        arrays: &ScratchArrays,
        key: &str,
        ground: &'a Ground,
    ) -> Result<Self, Error> {
        let (ends_m, profiles) = (arrays.ends_m(), arrays.profiles());
        let row = |i: usize| (ends_m[i], profiles[i].clone());
        let first = arrays.first().to_vec();
        Self::placed(loader, first, row, ground, |i, end, found, right| {
            Error::new(format!("{key}.ends_m[{i}][{end}]"), found, right)
        })
    }

    /// Places both ends of each row on the surface, or refuses the first end that is too far from it. `error` makes the message from a
    /// row, one of its ends and two halves of a sentence.
    fn placed(
        loader: &Loader,
        first: Vec<u32>,
        row: impl Fn(usize) -> ([[f64; 3]; 2], Profile) + Sync,
        ground: &'a Ground,
        error: impl Fn(usize, usize, String, String) -> Error,
    ) -> Result<Self, Error> {
        const TOGETHER: usize = 1 << 16;
        let count = first.last().map_or(0, |end| *end as usize);
        let tolerance_m = OFF_SURFACE * ground.diagonal_m;
        let closest = ground.closest();
        // Twice the row, and the end.
        let wrong = AtomicUsize::new(usize::MAX);
        let place = |i: usize| {
            let (ends_m, profile) = row(i);
            let [start, end] = [0, 1].map(|end| {
                let point_m = ground.point_in_world_m(ends_m[end]);
                let found = closest.find_within(point_m, tolerance_m);
                found.map_or_else(
                    || {
                        wrong.fetch_min(2 * i + end, Ordering::Relaxed);
                        let triangle = 0;
                        MeshPoint { triangle, point_m }
                    },
                    |(spot, _)| spot,
                )
            });
            PlacedPiece {
                start,
                end_m: end.point_m,
                profile,
            }
        };
        let mut pieces = Vec::with_capacity(count);
        for from in (0..count).step_by(TOGETHER) {
            loader.go_on()?;
            let together = from..count.min(from + TOGETHER);
            pieces.par_extend(together.into_par_iter().map(place));
            let wrong = wrong.load(Ordering::Relaxed);
            if wrong < usize::MAX {
                let (i, end) = (wrong / 2, wrong % 2);
                let (ends_m, _) = row(i);
                let (_, off_m) = closest.find(ground.point_in_world_m(ends_m[end]));
                let found = format!("found a point {} off the object's surface", length(off_m));
                return Err(error(i, end, found, at_most(tolerance_m)));
            }
        }
        Ok(Self {
            pieces,
            first,
            ground,
        })
    }

    pub(super) fn count(&self) -> u64 {
        self.first.len() as u64 - 1
    }

    fn pieces_of(&self, index: u64) -> &[PlacedPiece] {
        let at = |i: u64| self.first[i as usize] as usize;
        &self.pieces[at(index)..at(index + 1)]
    }
}

impl Laying for Listed<'_> {
    fn lay(&self, walker: &Walker, index: u64, segments: &mut Vec<Segment>) -> Groove {
        let pieces = self.pieces_of(index);
        let begin = segments.len();
        for piece in pieces {
            let guide = Guide::Towards { end_m: piece.end_m };
            let length_m = LONGEST_WAY * piece.start.point_m.distance(piece.end_m);
            walker.lay_from(piece.start, &guide, length_m, segments);
        }
        let [first, last] = [&pieces[0], &pieces[pieces.len() - 1]];
        // Fewer than three segments cannot go round.
        let is_closed = first.start.point_m == last.end_m && segments.len() - begin > 2;
        Groove {
            profile: first.profile.clone(),
            course: match is_closed {
                true => Course::Closed,
                false => Course::Open,
            },
        }
    }

    fn middle(&self, index: u64) -> Option<MeshPoint> {
        let pieces = self.pieces_of(index);
        let piece = &pieces[pieces.len() / 2];
        let middle_m = piece.start.point_m.lerp(piece.end_m, 0.5);
        Some(self.ground.closest().find(middle_m).0)
    }
}
