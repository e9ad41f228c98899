//! What the methods do for a pixel of the table's 1x cells, counted: the same index is walked on the CPU, and every node, segment,
//! pair and look-up on the way is counted. Not a guess, and not a profile: operations follow from the counts by the table of
//! [`work`], which says what each thing takes.

mod tally;
mod tile;
mod walk;
pub mod work;

use hairline_optics::method::{Lookup, Method};
use rayon::prelude::*;
use serde::Serialize;

use super::figures::{Row, Way, Whose};
use super::stage::{Lamps, Stage};
use super::table::ways;
use crate::failure::Failure;
use tally::Tally;
use tile::TILE_PX;
use walk::Counted;

/// Of one cell of the table, mean over the pixels that see the disk.
#[derive(Clone, Debug, Serialize)]
pub struct Counts {
    pub row: Row,
    pub method: Whose,
    pub antialiasing: bool,
    pub lookup: &'static str,
    /// The part of the picture that sees the disk.
    pub covered: f64,
    /// Pixels that were looked at.
    pub pixels: usize,
    pub per_pixel: Tally,
    /// Bytes read, by [`work`].
    pub bytes: f64,
    /// Operations of single precision, by [`work`].
    pub operations: f64,
}

/// Every so many tiles in x and in y one is looked at.
const EVERY: u32 = 5;

/// The lit cells at 1x, on a renderer with tiles or on one where each pixel walks for itself.
pub fn of_the_table(base: Stage, ours: &Method, tiles: bool) -> Result<Vec<Counts>, Failure> {
    let mut counts = Vec::new();
    for (row, lamps) in [
        (Row::Sphere, Lamps::Sphere),
        (Row::Triangle, Lamps::Triangle),
    ] {
        let scene = Stage { lamps, ..base }.build()?;
        // Ours by look-ups that it has only to be compared with say nothing new.
        let own = |way: &Way| way.whose == Whose::Published || way.method.lookup == ours.lookup;
        for way in ways(ours).iter().filter(|way| own(way)) {
            let counted = Counted::new(&scene, way.method.lookup);
            counts.push(of_way(&counted, base.size_px, row, way, tiles));
        }
    }
    Ok(counts)
}

fn of_way(counted: &Counted, size_px: [u32; 2], row: Row, way: &Way, has_tiles: bool) -> Counts {
    let method = Method {
        lookup: match way.method.lookup {
            Lookup::Tiles if !has_tiles => Lookup::Bvh,
            lookup => lookup,
        },
        ..way.method
    };
    let tiles = size_px.map(|px| px.div_ceil(TILE_PX));
    let corners: Vec<[u32; 2]> = (0..tiles[1])
        .step_by(EVERY as usize)
        .flat_map(|y| (0..tiles[0]).step_by(EVERY as usize).map(move |x| [x, y]))
        .map(|tile| tile.map(|t| TILE_PX * t))
        .collect();
    let sum = corners
        .par_iter()
        .map(|corner| counted.tile(*corner, &method))
        .reduce(Default::default, |a, b| a + b);
    let per_pixel = sum.tally.over(sum.seen as f64);
    let work = work::of(&per_pixel, row, &method);
    Counts {
        row,
        method: way.whose,
        antialiasing: way.antialiasing(),
        lookup: way.lookup(),
        covered: sum.seen as f64 / (sum.looked_at.max(1)) as f64,
        pixels: sum.seen,
        per_pixel,
        bytes: work.bytes,
        operations: work.operations,
    }
}
