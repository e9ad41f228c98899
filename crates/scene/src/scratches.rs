//! Scratches laid on the surface itself: seeded by area, walked across triangles from edge to edge along a pattern's
//! direction field, with no need of texture coordinates.
//!
//! A scratch has its seed in its middle and stops early at a boundary of the surface, at an edge that bends by more than
//! 60 degrees, and where its field has no direction; a seed without direction lays none. Each scratch draws from a random
//! stream of its own, so the result depends neither on the number of threads nor, for the first ones, on the count.

mod closest;
mod drawn;
mod facet;
mod ground;
mod guide;
mod listed;
mod neighbours;
mod random;
mod swirl;
mod walk;

use std::path::Path;

use glam::DMat4;
use rayon::prelude::*;

use crate::description::{Amount, Layer};
use crate::error::Error;
use crate::load::{Loader, Progress, Stage};
use crate::scene::{Mesh, Scratch, Segment};

use drawn::Drawn;
use ground::Ground;
use listed::Listed;
use walk::{Course, Walker};

/// Widths are kept within the spectral table's range, and below the coherence windows that scenes ask for.
const WIDTHS_UM: (f64, f64) = (0.05, 100.0);
/// Depths are kept within the spectral table's range.
const DEPTHS_NM: (f64, f64) = (0.0, 2000.0);

/// What renderers keep for a segment besides the scene: its effective form and its share of a tree, in main memory and once
/// more on the GPU.
const RENDERED_SEGMENT_BYTES: u64 = 160;
/// The renderers' trees number the segments by 28 bits.
const MOST_SEGMENTS: usize = 1 << 28;
/// How many scratches are laid first to learn how many segments one has.
const PILOTS: u64 = 1024;
/// Segments that are enough to know.
const PILOT_SEGMENTS: usize = 1 << 20;
/// Scratches of one task, and of the tasks between two reports of progress.
const CHUNK: u64 = 256;
const BATCH: u64 = 128 * CHUNK;

/// A `[[scratches]]` table.
pub(crate) struct Table<'a> {
    /// The way to it in the scene file.
    pub key: String,
    /// Its object, as an index into the meshes.
    pub object: usize,
    pub layer: &'a Layer,
}

/// The scratches of one object.
#[derive(Clone, Debug, Default)]
pub(crate) struct Laid {
    pub scratches: Vec<Scratch>,
    pub segments: Vec<Segment>,
}

/// What is known of a scratch besides its segments.
struct Groove {
    width_um: f32,
    depth_nm: f32,
    course: Course,
}

/// A layer that can lay its scratches one by one, in any order.
trait Laying: Sync {
    /// Appends the segments of one scratch.
    fn lay(&self, walker: &Walker, index: u64, segments: &mut Vec<Segment>) -> Groove;
}

/// A layer that is ready to be laid.
struct Plan<'a> {
    table: &'a Table<'a>,
    layer: u32,
    ground: &'a Ground<'a>,
    laying: Box<dyn Laying + 'a>,
    count: u64,
}

/// Lays all layers on the meshes, each with its object's transform. Refuses before laying what would not fit into memory.
pub(crate) fn lay(
    loader: &Loader,
    tables: &[Table],
    base_dir: &Path,
    meshes: &[(&Mesh, DMat4)],
) -> Result<Vec<Laid>, Error> {
    let grounds: Vec<_> = meshes
        .iter()
        .enumerate()
        .map(|(i, (mesh, world_from_object))| {
            let is_scratched = tables.iter().any(|table| table.object == i);
            is_scratched.then(|| Ground::new(mesh, *world_from_object))
        })
        .collect();
    let mut plans = Vec::new();
    for (i, table) in tables.iter().enumerate() {
        if let Some(ground) = &grounds[table.object] {
            plans.push(Plan::new(table, i as u32, ground, base_dir)?);
        }
    }
    let mut used_bytes = 0.0;
    for plan in &plans {
        used_bytes = plan.check_memory(loader.memory_budget_bytes, used_bytes)?;
    }

    let total = plans.iter().map(|plan| plan.count).sum();
    let mut done = 0;
    let mut laid = vec![Laid::default(); meshes.len()];
    for plan in &plans {
        let object = &mut laid[plan.table.object];
        for first in (0..plan.count).step_by(BATCH as usize) {
            let end = plan.count.min(first + BATCH);
            plan.lay(first..end, object)?;
            done += end - first;
            (loader.progress)(Progress {
                stage: Stage::Scratches,
                done,
                total,
            });
        }
    }
    Ok(laid)
}

impl<'a> Plan<'a> {
    fn new(
        table: &'a Table<'a>,
        layer: u32,
        ground: &'a Ground<'a>,
        base_dir: &Path,
    ) -> Result<Self, Error> {
        let (laying, count): (Box<dyn Laying>, u64) = match table.layer {
            Layer::Laid(laid) => {
                let count = match laid.amount {
                    Amount::Count(count) => count,
                    Amount::DensityPerM2(density) => (density * ground.area_m2()).round() as u64,
                };
                let drawn = Drawn {
                    laid,
                    layer,
                    ground,
                };
                (Box::new(drawn), count)
            }
            Layer::Brushed(_) => {
                return Err(Error::new(&table.key, "found strokes", "are not laid yet"));
            }
            Layer::Listed(listed) => {
                let path = base_dir.join(&listed.file);
                let rows = listed::read(&path, &table.key)?;
                let listed = Listed::new(rows, &path, ground)?;
                let count = listed.count();
                (Box::new(listed), count)
            }
        };
        Ok(Self {
            table,
            layer,
            ground,
            laying,
            count,
        })
    }

    /// Refuses a layer that would not fit into the budget beside what is used; returns what is used with it.
    fn check_memory(&self, budget_bytes: u64, used_bytes: f64) -> Result<f64, Error> {
        // Few at first, lest scratches of a million segments fill the memory themselves.
        let mut pilots = 0;
        let mut pilot = Laid::default();
        while pilots < PILOTS.min(self.count) && pilot.segments.len() < PILOT_SEGMENTS {
            pilots = self.count.min(4 * pilots.max(1));
            pilot = Laid::default();
            self.lay(0..pilots, &mut pilot)?;
        }
        let segments_each = pilot.segments.len() as f64 / pilots.max(1) as f64;
        let free_bytes = (budget_bytes as f64 - used_bytes).max(0.0);
        let segment_bytes = size_of::<Segment>() as u64 + RENDERED_SEGMENT_BYTES;
        let each_bytes = size_of::<Scratch>() as f64 + segments_each * segment_bytes as f64;
        let bytes = each_bytes * self.count as f64;
        let segments = segments_each * self.count as f64;
        if bytes <= free_bytes && segments < MOST_SEGMENTS as f64 {
            return Ok(used_bytes + bytes);
        }
        let key = match self.table.layer {
            Layer::Listed(_) => "file",
            Layer::Brushed(_) => "strokes",
            Layer::Laid(laid) => match laid.amount {
                Amount::Count(_) => "count",
                Amount::DensityPerM2(_) => "density_per_m2",
            },
        };
        let fitting = (free_bytes / each_bytes).min(MOST_SEGMENTS as f64 / segments_each);
        Err(Error::new(
            format!("{}.{key}", self.table.key),
            format!(
                "found {} scratches, which would take about {} of memory in {segments:.1e} segments",
                self.count,
                gibibytes(bytes)
            ),
            format!(
                "there are {} for them; ask for at most about {fitting:.1e}, or for shorter ones",
                gibibytes(free_bytes)
            ),
        ))
    }

    fn lay(&self, scratches: std::ops::Range<u64>, object: &mut Laid) -> Result<(), Error> {
        let walker = self.ground.walker();
        let chunks: Vec<u64> = scratches.clone().step_by(CHUNK as usize).collect();
        let parts: Vec<Laid> = chunks
            .into_par_iter()
            .map(|first| self.lay_chunk(&walker, first..scratches.end.min(first + CHUNK)))
            .collect();
        for part in parts {
            // The estimate may have been short.
            if object.segments.len() + part.segments.len() > MOST_SEGMENTS {
                return Err(Error::new(
                    &self.table.key,
                    format!("found more than {MOST_SEGMENTS} segments on one object"),
                    "ask for fewer or shorter scratches",
                ));
            }
            let offset = object.segments.len() as u32;
            object.segments.extend_from_slice(&part.segments);
            object
                .scratches
                .extend(part.scratches.into_iter().map(|scratch| Scratch {
                    segments: scratch.segments.start + offset..scratch.segments.end + offset,
                    ..scratch
                }));
        }
        Ok(())
    }

    fn lay_chunk(&self, walker: &Walker, scratches: std::ops::Range<u64>) -> Laid {
        let mut laid = Laid::default();
        for index in scratches {
            let start = laid.segments.len() as u32;
            let groove = self.laying.lay(walker, index, &mut laid.segments);
            let end = laid.segments.len() as u32;
            if start < end {
                laid.scratches.push(Scratch {
                    width_um: groove.width_um,
                    depth_nm: groove.depth_nm,
                    layer: self.layer,
                    closed: groove.course == Course::Closed,
                    segments: start..end,
                });
            }
        }
        laid
    }
}

fn gibibytes(bytes: f64) -> String {
    format!("{:.2} GiB", bytes / f64::from(1 << 30))
}
