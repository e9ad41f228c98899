//! Scratches laid on the surface itself: seeded by area, walked across triangles from edge to edge along a pattern's
//! direction field, with no need of texture coordinates.
//!
//! A scratch has its seed in its middle and stops early at a boundary of the surface, at an edge that bends by more than
//! 60 degrees, and where its field has no direction; a seed without direction lays none. Each scratch draws from a random
//! stream of its own, so the result depends neither on the number of threads nor, for the first ones, on the count.

mod engraved;
mod listed;
mod memory;
mod off_object;
mod outlines;
mod painted;
mod place;
mod scattered;
mod sizes;
mod written_list;

use hairline_image::FilePath;
use hairline_laying::{Course, Eraser, Ground, Laying, Stream, Walker, remaining_runs};
use hairline_optics::section::Section;
use hairline_scene::{Profile, Scratch, Segment};
use rayon::prelude::*;

use crate::description::{Amount, Layer, Stroke};
use crate::error::Error;
use crate::loader::{Loader, Stage};

use engraved::Engraving;
use listed::Listed;
pub(crate) use listed::{ListedRow, list_header, read as read_list};
use memory::{Demand, MOST_SEGMENTS, SEGMENT_BYTES};
use painted::Painted;
use place::GroundPlaces;
pub(crate) use place::PlaceInputs;
use scattered::Scattered;
pub use sizes::LISTED_RANGES;
pub(crate) use sizes::LISTED_SIZES;
pub use written_list::write_scratches;

/// Number of scratches that are laid first, to learn how many segments one has.
const PILOTS: u64 = 1024;
/// Number of segments of a sample that is laid for an estimate.
const PILOT_SEGMENTS: usize = 1 << 20;
/// Bit that distinguishes the draws of whether a scratch is laid from all others: seeds of layers end below.
const LOT: u64 = 1 << 63;
/// Scratches of one task.
const CHUNK: u64 = 32;
/// Scratches between two looks at whether to give up: so few at first, twice as many after a batch of fewer segments than that, which
/// are some hundredths of a second.
const BATCH_FIRST: u64 = 8 * CHUNK;
const BATCH_MOST: u64 = 256 * CHUNK;
const BATCH_SEGMENTS: usize = 1 << 14;
/// Number of scratches or segments that are worth another thread to copy them.
const COPY: usize = 1 << 14;

/// A `[[scratches]]` table with the surface that it goes on.
pub(crate) struct Table<'a> {
    /// Path of the layer's key in the scene file.
    pub key: String,
    pub layer: &'a Layer,
    /// Cross section of its grooves.
    pub section: &'a Section,
    pub strokes: &'a [Stroke],
    /// Number of earlier layers on the same object with the same seed.
    pub number: u64,
    pub ground: &'a Ground,
    /// Inputs for the places on the surface where the layer lies.
    pub means: PlaceInputs<'a>,
}

/// The scratches of one layer; their `layer` is 0.
#[derive(Clone, Debug, Default)]
pub(crate) struct Laid {
    pub scratches: Vec<Scratch>,
    pub segments: Vec<Segment>,
    /// Note for the layer's author about what was not laid.
    pub note: Option<String>,
}

impl Laid {
    /// Memory of the scratches, here and in renderers.
    pub(crate) fn bytes(&self) -> f64 {
        bytes(self.scratches.len(), self.segments.len())
    }

    fn push(&mut self, profile: Profile, course: Course, segments: std::ops::Range<usize>) {
        if !segments.is_empty() {
            self.scratches.push(Scratch {
                profile,
                layer: 0,
                closed: course == Course::Closed,
                segments: segments.start as u32..segments.end as u32,
            });
        }
    }
}

/// Memory of laid scratches, here and in renderers.
pub(crate) fn bytes(scratches: usize, segments: usize) -> f64 {
    (scratches * size_of::<Scratch>()) as f64 + (segments as u64 * SEGMENT_BYTES) as f64
}

/// A layer that is ready to be laid.
struct Plan<'a> {
    table: &'a Table<'a>,
    laying: Box<dyn Laying + 'a>,
    eraser: Option<Eraser>,
    place: Option<GroundPlaces<'a>>,
    count: u64,
    /// The first scratches, and how many: they told how much memory all of them take.
    pilot: (Laid, u64),
}

/// Lays all layers, each for itself. Refuses before laying what would not fit into memory beside `used_bytes`.
pub(crate) fn lay(
    loader: &Loader,
    tables: &[Table],
    base_dir: &FilePath,
    mut used_bytes: f64,
) -> Result<Vec<Laid>, Error> {
    let mut plans = Vec::new();
    for table in tables {
        loader.go_on()?;
        plans.push(Plan::new(loader, table, base_dir)?);
    }
    for plan in &mut plans {
        loader.go_on()?;
        let free_bytes = (loader.memory_budget_bytes as f64 - used_bytes).max(0.0);
        used_bytes += plan.check_memory(loader, free_bytes)?;
    }

    let total = plans.iter().map(|plan| plan.count).sum();
    let mut done = 0;
    let mut all = Vec::new();
    for plan in &mut plans {
        let (mut laid, mut first) = std::mem::take(&mut plan.pilot);
        done += first;
        loader.report(Stage::Scratches, done, total);
        let mut batch = BATCH_FIRST;
        // One batch is put with the others while the next one is laid.
        let mut parts = Vec::new();
        while first < plan.count {
            loader.go_on()?;
            let end = plan.count.min(first + batch);
            let last = std::mem::take(&mut parts);
            let (next, taken) = rayon::join(|| plan.lay(first..end), || plan.take(last, &mut laid));
            taken?;
            parts = next;
            done += end - first;
            first = end;
            if parts.iter().map(|part| part.segments.len()).sum::<usize>() < BATCH_SEGMENTS {
                batch = (2 * batch).min(BATCH_MOST);
            }
            loader.report(Stage::Scratches, done, total);
        }
        plan.take(parts, &mut laid)?;
        laid.note = plan.laying.note();
        all.push(laid);
    }
    Ok(all)
}

/// Puts the scratches of layers on one object side by side; each goes with the place of its table in the scene file.
///
/// # Errors
/// More segments than renderers can number.
pub(crate) fn put_together<'l>(
    layers: impl Iterator<Item = (u32, &'l Laid)> + Clone,
) -> Result<Laid, Error> {
    let mut all = Laid::default();
    let lengths = layers.clone();
    all.scratches
        .reserve_exact(lengths.map(|(_, laid)| laid.scratches.len()).sum());
    let lengths = layers.clone();
    all.segments
        .reserve_exact(lengths.map(|(_, laid)| laid.segments.len()).sum());
    for (layer, laid) in layers {
        let offset = all.segments.len();
        check_segments(offset + laid.segments.len(), &format!("scratches[{layer}]"))?;
        let offset = offset as u32;
        let segments = laid.segments.par_iter().with_min_len(COPY);
        all.segments.par_extend(segments.copied());
        let scratches = laid.scratches.par_iter().with_min_len(COPY);
        all.scratches.par_extend(scratches.map(|scratch| Scratch {
            layer,
            segments: scratch.segments.start + offset..scratch.segments.end + offset,
            ..scratch.clone()
        }));
    }
    Ok(all)
}

fn check_segments(segments: usize, key: &str) -> Result<(), Error> {
    match segments <= MOST_SEGMENTS {
        true => Ok(()),
        false => Err(Error::new(
            key,
            format!("found more than {MOST_SEGMENTS} segments on one object"),
            "ask for fewer or shorter scratches",
        )),
    }
}

impl<'a> Plan<'a> {
    fn new(loader: &Loader, table: &'a Table<'a>, base_dir: &FilePath) -> Result<Self, Error> {
        let ground = table.ground;
        painted::check(table.strokes, &table.key, ground)?;
        let (laying, count): (Box<dyn Laying>, u64) = match table.layer {
            Layer::Laid(laid) => {
                let count = match laid.amount {
                    Amount::Count(count) => count,
                    Amount::DensityPerM2(density) => (density * ground.area_m2()).round() as u64,
                };
                let scattered = Scattered {
                    laid,
                    number: table.number,
                    ground,
                };
                (Box::new(scattered), count)
            }
            Layer::Brushed(brushed) => {
                let painted = Painted::new(brushed, table.number, table.strokes, ground);
                let count = painted.count();
                (Box::new(painted), count)
            }
            Layer::Engraved(engraved) => {
                let engraving =
                    Engraving::new(loader, engraved, table.number, ground, &table.key, base_dir)?;
                let count = engraving.count();
                (Box::new(engraving), count)
            }
            Layer::Listed(listed) => {
                let listed = match loader.arrays.scratches(&listed.file) {
                    Some(arrays) => Listed::of_arrays(loader, arrays, &table.key, ground)?,
                    None => {
                        let path = base_dir.join(&listed.file);
                        let rows = listed::read(&path, &table.key)?;
                        Listed::new(loader, &rows, &path, ground)?
                    }
                };
                let count = listed.count();
                (Box::new(listed), count)
            }
        };
        Ok(Self {
            table,
            laying,
            eraser: Eraser::new(painted::erasing(table.strokes, ground), ground, || {
                loader.go_on()
            })?,
            place: GroundPlaces::new(&table.means, ground, &table.key)?,
            count,
            pilot: Default::default(),
        })
    }

    /// Refuses a layer that would not fit; returns its memory.
    fn check_memory(&mut self, loader: &Loader, free_bytes: f64) -> Result<f64, Error> {
        // Few at first, lest scratches of a million segments fill the memory themselves.
        let (mut pilot, mut pilots) = (Laid::default(), 0);
        while pilots < PILOTS.min(self.count) && pilot.segments.len() < PILOT_SEGMENTS {
            loader.go_on()?;
            let more = self.count.min(2 * pilots.max(2));
            self.take(self.lay(pilots..more), &mut pilot)?;
            pilots = more;
        }
        let demand = Demand {
            count: self.count,
            segments_each: pilot.segments.len() as f64 / pilots.max(1) as f64,
        };
        self.pilot = (pilot, pilots);
        demand.check(free_bytes, || {
            let key = match self.table.layer {
                Layer::Listed(_) => "file",
                Layer::Brushed(_) => "strokes",
                Layer::Engraved(engraved) => engraved.line.key().name,
                Layer::Laid(laid) => match laid.amount {
                    Amount::Count(_) => "count",
                    Amount::DensityPerM2(_) => "density_per_m2",
                },
            };
            format!("{}.{key}", self.table.key)
        })
    }

    /// Lays a range of scratches in chunks, each on its own.
    fn lay(&self, scratches: std::ops::Range<u64>) -> Vec<Laid> {
        let walker = self.table.ground.walker();
        let chunks: Vec<u64> = scratches.clone().step_by(CHUNK as usize).collect();
        chunks
            .into_par_iter()
            .map(|first| self.lay_chunk(&walker, first..scratches.end.min(first + CHUNK)))
            .collect()
    }

    /// Appends parts to the laid scratches.
    fn take(&self, parts: Vec<Laid>, laid: &mut Laid) -> Result<(), Error> {
        for part in parts {
            // The estimate may have been short.
            let offset = laid.segments.len();
            check_segments(offset + part.segments.len(), &self.table.key)?;
            let offset = offset as u32;
            laid.segments.extend_from_slice(&part.segments);
            laid.scratches
                .extend(part.scratches.into_iter().map(|scratch| Scratch {
                    segments: scratch.segments.start + offset..scratch.segments.end + offset,
                    ..scratch
                }));
        }
        Ok(())
    }

    /// Whether a scratch is kept, at the density of the place where it lies.
    fn is_drawn(&self, index: u64) -> bool {
        let Some(place) = self.place.as_ref().filter(|place| !place.is_even()) else {
            return true;
        };
        let chance = self.laying.middle(index).map_or(0.0, |it| place.chance(it));
        // A separate stream, so that the scratch itself stays as it is without a density.
        let seed = LOT ^ self.table.layer.seed().unwrap_or(0);
        Stream::new(seed, self.table.number, index).uniform() < chance
    }

    /// Parts of a scratch, in runs, that remain after erasers and the layer's places; `None` if that is all of it.
    fn rest(
        &self,
        walker: &Walker,
        index: u64,
        course: Course,
        whole: &[Segment],
    ) -> Option<Vec<Vec<Segment>>> {
        let place = self.place.as_ref().filter(|place| place.has_ends());
        if self.eraser.is_none() && place.is_none() {
            return None;
        }
        remaining_runs(walker, course, whole, |segment, parts| {
            if let Some(eraser) = &self.eraser {
                eraser.erased(segment, self.laying.strokes_before(index), parts);
            }
            if let Some(place) = place {
                place.elsewhere(segment, parts);
            }
        })
    }

    fn lay_chunk(&self, walker: &Walker, scratches: std::ops::Range<u64>) -> Laid {
        let mut laid = Laid::default();
        for index in scratches {
            if !self.is_drawn(index) {
                continue;
            }
            let start = laid.segments.len();
            let groove = self.laying.lay(walker, index, &mut laid.segments);
            let profile = Profile {
                section: self.table.section.clone(),
                ..groove.profile
            };
            let whole = &laid.segments[start..];
            let Some(runs) = self.rest(walker, index, groove.course, whole) else {
                laid.push(profile, groove.course, start..laid.segments.len());
                continue;
            };
            laid.segments.truncate(start);
            for run in runs {
                let start = laid.segments.len();
                laid.segments.extend(run);
                laid.push(profile.clone(), Course::Open, start..laid.segments.len());
            }
        }
        laid
    }
}
