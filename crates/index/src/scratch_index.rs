//! Scratches as the closed form wants them under a footprint: free ends are moved inwards here, once, by what
//! docs/model.md section 6 says of the whole scratch; where pieces are joined nothing moves, and pieces that an end's shift
//! swallows are gone.

use crate::segment_tree::{SegmentTree, Straight};
use glam::Vec3;
use hairline_optics::footprint;
use hairline_optics::mask::depth_coherence;
use hairline_scene::{Object, Scene, Scratch};
use rayon::prelude::*;

/// A straight piece of a scratch, its free ends moved inwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndexedSegment {
    /// World space, metres.
    pub start_m: Vec3,
    /// World space, metres.
    pub end_m: Vec3,
    /// The surface's unit normal.
    pub normal: Vec3,
    /// Width of the groove.
    pub width_um: f32,
    /// Depth of the groove.
    pub depth_nm: f32,
    /// Standard deviation that smooths the ends; one for the whole scratch, so that joined ends cancel.
    pub blur_um: f32,
}

impl Straight for IndexedSegment {
    fn ends_m(&self) -> [Vec3; 2] {
        [self.start_m, self.end_m]
    }
}

/// The scratches of a scene under footprints.
#[derive(Clone, Debug)]
pub struct ScratchIndex {
    /// What lies where.
    pub tree: SegmentTree<IndexedSegment>,
    /// How alike the phase steps of each object's scratches are (docs/model.md, section 3).
    pub depth_coherence: Vec<f32>,
}

/// A footprint cannot be told apart from its Gaussian's tail beyond this many standard deviations (5e-4 of it is left).
pub const REACH_STD: f32 = 3.5;

/// A segment shows at a point only if their normals agree at least this well: the far side of a thin sheet has the
/// opposite one.
pub const FACING_MIN_COS: f32 = 0.2;

impl ScratchIndex {
    /// Builds the trees.
    pub fn build(scene: &Scene) -> Self {
        let objects = scene.objects.iter();
        Self {
            tree: SegmentTree::build(objects.map(|object| effective_segments(scene, object, None))),
            depth_coherence: Self::depth_coherence(scene),
        }
    }

    /// How alike the phase steps of each object's scratches are, without the trees.
    pub fn depth_coherence(scene: &Scene) -> Vec<f32> {
        scene.objects.iter().map(object_depth_coherence).collect()
    }
}

fn object_depth_coherence(object: &Object) -> f32 {
    let depths = object.scratches.iter().map(|s| {
        let pieces = &object.segments[s.segments.start as usize..s.segments.end as usize];
        let length: f32 = pieces.iter().map(|p| p.start_m.distance(p.end_m)).sum();
        (s.depth_nm as f64, (s.width_um * length) as f64)
    });
    depth_coherence(depths) as f32
}

/// The pieces of an object's scratches, those of one layer or all, free ends moved inwards along the scratch.
pub(crate) fn effective_segments(
    scene: &Scene,
    object: &Object,
    layer: Option<u32>,
) -> Vec<IndexedSegment> {
    let of_layer = |scratch: &&Scratch| layer.is_none_or(|layer| scratch.layer == layer);
    // Scratches in a row, so that the order is that of the object whatever the number of threads.
    let runs = object.scratches.par_chunks(RUN).map(|run| {
        let pieces = run.iter().map(|s| s.segments.len()).sum();
        let mut effective = Vec::with_capacity(pieces);
        for scratch in run.iter().filter(of_layer) {
            append_effective(scene, object, scratch, &mut effective);
        }
        effective
    });
    runs.collect::<Vec<_>>().concat()
}

/// Scratches of one task.
const RUN: usize = 1024;

/// Appends the pieces of one scratch.
fn append_effective(
    scene: &Scene,
    object: &Object,
    scratch: &Scratch,
    effective: &mut Vec<IndexedSegment>,
) {
    let pieces = &object.segments[scratch.segments.start as usize..scratch.segments.end as usize];
    let Some(first) = pieces.first() else {
        return;
    };
    let material = object.mesh.triangle_materials[first.triangle as usize] as usize;
    let coherence_um = scene.materials[material].coherence_um;
    let length_um: f64 = pieces
        .iter()
        .map(|p| p.start_m.distance(p.end_m) as f64 * 1e6)
        .sum();
    let ends = footprint::ends(length_um, coherence_um);
    let shrink_um = if scratch.closed { 0.0 } else { ends.shrink_um };
    let mut arc_um = 0.0;
    for piece in pieces {
        let piece_um = piece.start_m.distance(piece.end_m) as f64 * 1e6;
        let start = (shrink_um - arc_um).max(0.0) / piece_um;
        let end = (length_um - shrink_um - arc_um).min(piece_um) / piece_um;
        arc_um += piece_um;
        // Also false for a piece of no length.
        if start < end {
            effective.push(IndexedSegment {
                start_m: piece.start_m.lerp(piece.end_m, start as f32),
                end_m: piece.start_m.lerp(piece.end_m, end as f32),
                normal: piece.normal,
                width_um: scratch.width_um,
                depth_nm: scratch.depth_nm,
                blur_um: ends.blur_um as f32,
            });
        }
    }
}
