//! The scratches of one layer on one object, which stand in a row, and the layers that share a tree, so that the next scene of an
//! editor can reuse it.

use hairline_optics::footprint;
use hairline_optics::section::{Parts, width_class};
use hairline_scene::{GrooveShapes, Object, Scene, Scratch, Segment};
use rayon::prelude::*;

use crate::arcs::join;
use crate::indexed_segment::{IndexedProfile, IndexedSegment};

/// Largest turn between pieces that count as one: a tenth of the width of the narrowest bands, and a micrometre off in the middle of
/// a centimetre.
const STRAIGHT_RAD: f32 = 2e-4;
/// Least cosine between the normals of two pieces that lie on one side of a sheet.
const SAME_SIDE_COS: f32 = 0.9999;

/// Pieces are put together up to this length. A renderer projects each piece once for the whole picture, so longer pieces are fewer
/// projections; but the box of a long slanting piece in the BVH is mostly empty.
const LONGEST_M: f32 = 4e-3;

/// Whether a piece that follows another is its straight continuation: scratches are cut at the edges of triangles, which on flat
/// surfaces are nothing to see.
fn goes_on(last: &IndexedSegment, next: &IndexedSegment) -> bool {
    let (a, b) = (last.end_m - last.start_m, next.end_m - next.start_m);
    let whole = next.end_m - last.start_m;
    last.end_m == next.start_m
        && whole.length_squared() <= LONGEST_M * LONGEST_M
        && last.normal.dot(next.normal) >= SAME_SIDE_COS
        && a.dot(b) > 0.0
        && a.cross(b).length_squared()
            < STRAIGHT_RAD * STRAIGHT_RAD * a.length_squared() * b.length_squared()
        && whole.cross(b).length_squared()
            < STRAIGHT_RAD * STRAIGHT_RAD * whole.length_squared() * b.length_squared()
}

/// Neighbouring scratches of the same layer.
#[derive(Clone, Copy)]
pub(crate) struct LayerRun<'a> {
    scene: &'a Scene,
    shapes: &'a GrooveShapes,
    object: &'a Object,
    scratches: &'a [Scratch],
    /// By which arcs may lie beside what was laid, metres.
    deviation_m: f32,
}

/// Scratches of one task.
const TASK: usize = 1024;
/// Scratches whose pieces wait to be put in their place: some tens of megabytes.
const BATCH: usize = 32 * TASK;

/// Layers are put together up to so many pieces. A walk through several trees is longer than through one: with ten of a tenth
/// each a pixel costs 12 % more where 100,000 scratches lie, 28 % where 10,000 do. And as many pieces grow in some 10 ms.
const SHARED_PIECES: usize = 1 << 16;

/// The layers of an object, in their order, by the trees that they go to: a large one for itself, small ones together.
pub(crate) fn groups<'a>(
    scene: &'a Scene,
    shapes: &'a GrooveShapes,
    object: &'a Object,
    deviation_m: f32,
) -> Vec<Vec<LayerRun<'a>>> {
    let mut groups: Vec<Vec<LayerRun>> = Vec::new();
    // Pieces in the last group.
    let mut pieces = 0;
    for run in LayerRun::from_object(scene, shapes, object, deviation_m) {
        let own = run.piece_count();
        match groups.last_mut() {
            Some(group) if pieces + own <= SHARED_PIECES => {
                group.push(run);
                pieces += own;
            }
            _ => {
                groups.push(vec![run]);
                pieces = own;
            }
        }
    }
    groups
}

impl<'a> LayerRun<'a> {
    /// All runs of an object, in their order; one for each layer, since a builder lays them layer by layer.
    pub(crate) fn from_object(
        scene: &'a Scene,
        shapes: &'a GrooveShapes,
        object: &'a Object,
        deviation_m: f32,
    ) -> impl Iterator<Item = Self> {
        let runs = object.scratches.chunk_by(|a, b| a.layer == b.layer);
        runs.map(move |scratches| Self::new(scene, shapes, object, scratches, deviation_m))
    }

    /// Some scratches of an object.
    pub(crate) fn new(
        scene: &'a Scene,
        shapes: &'a GrooveShapes,
        object: &'a Object,
        scratches: &'a [Scratch],
        deviation_m: f32,
    ) -> Self {
        Self {
            scene,
            shapes,
            object,
            scratches,
            deviation_m,
        }
    }

    /// Number of its straight pieces, about: wide scratches count as two of each, and seldom more.
    pub(crate) fn piece_count(&self) -> usize {
        let own =
            |scratch: &Scratch| scratch.segments.len() * (1 + usize::from(self.is_wide(scratch)));
        self.scratches.iter().map(own).sum()
    }

    fn is_wide(&self, scratch: &Scratch) -> bool {
        self.shapes.is_wide(self.scene, self.object, scratch)
    }

    fn pieces(&self, scratch: &Scratch) -> &'a [Segment] {
        &self.object.segments[scratch.segments.start as usize..scratch.segments.end as usize]
    }

    /// Coherence length of the material under the scratch's beginning.
    fn coherence_um(&self, scratch: &Scratch) -> Option<f64> {
        self.scene.scratch_coherence_um(self.object, scratch)
    }

    /// Whether the same pieces come of both, in the same order. Wherever their layers stand, and whatever else their objects
    /// have.
    pub(crate) fn is_like(&self, other: &LayerRun) -> bool {
        let alike = |(a, b): (&Scratch, &Scratch)| {
            (&a.profile, a.closed) == (&b.profile, b.closed)
                && self.pieces(a) == other.pieces(b)
                && self.coherence_um(a) == other.coherence_um(b)
        };
        self.scratches.len() == other.scratches.len()
            && self.deviation_m == other.deviation_m
            && (self.scratches.par_iter().with_min_len(TASK))
                .zip(other.scratches)
                .all(alike)
    }

    /// Appends the pieces with their free ends moved inwards, in the order of the scratches whatever the number of threads. Straight
    /// ones are put together.
    pub(crate) fn append_effective(&self, effective: &mut Vec<IndexedSegment>) {
        for batch in self.scratches.chunks(BATCH) {
            let tasks = batch.par_chunks(TASK).map(|scratches| {
                let pieces = Self { scratches, ..*self }.piece_count();
                let mut effective = Vec::with_capacity(pieces);
                for scratch in scratches {
                    self.append_scratch(scratch, &mut effective);
                }
                effective
            });
            for mut part in tasks.collect::<Vec<_>>() {
                effective.append(&mut part);
            }
        }
    }

    fn append_scratch(&self, scratch: &Scratch, effective: &mut Vec<IndexedSegment>) {
        let pieces = self.pieces(scratch);
        let Some(coherence_um) = self.coherence_um(scratch) else {
            return;
        };
        let length_um: f64 = pieces
            .iter()
            .map(|p| p.start_m.distance(p.end_m) as f64 * 1e6)
            .sum();
        let ends = footprint::ends(length_um, coherence_um);
        let shrink_um = if scratch.closed { 0.0 } else { ends.shrink_um };
        let width_um = scratch.profile.width_um;
        let profile = IndexedProfile {
            shape: self.shapes.index(self.scene, self.object, scratch),
            ..IndexedProfile::rectangle(width_um, scratch.profile.depth_nm)
        };
        let first = effective.len();
        let mut arc_um = 0.0;
        for piece in pieces {
            let piece_um = piece.start_m.distance(piece.end_m) as f64 * 1e6;
            let start = (shrink_um - arc_um).max(0.0) / piece_um;
            let end = (length_um - shrink_um - arc_um).min(piece_um) / piece_um;
            arc_um += piece_um;
            // Also false for a piece of no length.
            if start < end {
                let next = IndexedSegment {
                    start_m: piece.start_m.lerp(piece.end_m, start as f32),
                    end_m: piece.start_m.lerp(piece.end_m, end as f32),
                    normal: piece.normal,
                    turn_rad: 0.0,
                    profile,
                    blur_um: ends.blur_um as f32,
                };
                match effective[first..].last_mut() {
                    Some(last) if goes_on(last, &next) => last.end_m = next.end_m,
                    _ => effective.push(next),
                }
            }
        }
        join(
            effective,
            first,
            self.deviation_m.min(coherence_um as f32 * 1e-6),
        );
        if self.is_wide(scratch) {
            let section = &scratch.profile.section;
            let parts = section.parts(width_um.into(), coherence_um);
            let class = width_class(f64::from(width_um) / coherence_um);
            append_parts(effective, first, &parts, class);
        }
    }
}

/// Puts the parts of a wide groove in the place of the pieces from `first` on.
fn append_parts(effective: &mut Vec<IndexedSegment>, first: usize, parts: &Parts, class: u8) {
    let pieces = effective.split_off(first);
    for &offset_um in &parts.offsets_um {
        effective.extend(pieces.iter().map(|piece| {
            let across = piece.normal.cross(piece.end_m - piece.start_m);
            let offset_m = across.normalize_or_zero() * (offset_um * 1e-6) as f32;
            IndexedSegment {
                start_m: piece.start_m + offset_m,
                end_m: piece.end_m + offset_m,
                profile: IndexedProfile {
                    width_um: parts.width_um as f32,
                    width_class: class,
                    ..piece.profile
                },
                ..*piece
            }
        }));
    }
}
