//! Scratches as the closed form needs them under a footprint: free ends are moved inwards here, once, by the lengths of
//! docs/model.md, section 6, for the whole scratch; joined ends do not move, and pieces shorter than an end's shift are left out. For a
//! view pieces are put together to arcs.

use crate::arcs::{Deviations, Pieces};
use crate::depth_spread::object_coherence;
use crate::indexed_segment::IndexedSegment;
use crate::layer_runs::{LayerRun, groups};
use crate::segment_tree::{SegmentTree, Tree, TreeSource, build_trees};
use crate::watch::Watch;
use hairline_scene::{Camera, GrooveShapes, Object, Scene, Scratch};
use std::ops::Range;

/// The scratches of a scene under footprints. Each large layer on an object has a tree of its own, so that those that an edit
/// leaves alone are grown once.
#[derive(Clone, Debug)]
pub struct ScratchIndex {
    /// Trees of the pieces, with their places.
    pub tree: SegmentTree<IndexedSegment>,
    /// Coherence of the phase steps of each object's scratches (docs/model.md, section 3).
    pub depth_coherence: Vec<f32>,
    /// Shapes of the scene's grooves, whose numbers the pieces hold.
    shapes: GrooveShapes,
    /// Largest coherence length of the materials of each object.
    coherence_max_um: Vec<f32>,
    /// How far arcs may lie beside what was laid.
    deviations: Deviations,
}

/// Number of standard deviations at which a footprint is cut off: 5e-4 of its Gaussian lies beyond.
pub const REACH_STD: f32 = 3.5;

/// Least cosine between the normals of a segment and of a point at which it shows: the far side of a thin sheet has the opposite
/// normal.
pub const FACING_MIN_COS: f32 = 0.2;

impl ScratchIndex {
    /// Builds the trees over the pieces as the scene's camera sees them, all cores at work; the same for any number of them.
    ///
    /// # Panics
    /// Beyond 268 million pieces; no loaded scene has as many on one object.
    pub fn build(scene: &Scene) -> Self {
        Self::with_pieces(scene, Pieces::Seen)
    }

    /// Builds the trees over the pieces as they were laid.
    ///
    /// # Panics
    /// As [`Self::build`].
    pub fn laid(scene: &Scene) -> Self {
        Self::with_pieces(scene, Pieces::Laid)
    }

    /// Builds the trees over some pieces.
    ///
    /// # Panics
    /// As [`Self::build`].
    pub fn with_pieces(scene: &Scene, pieces: Pieces) -> Self {
        Self::rebuild(scene, pieces, None, &Watch::default())
            .unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// Builds the index while a watch listens, reusing the trees of an earlier scene for those layers that did not change. `None` if
    /// it was cancelled.
    ///
    /// # Panics
    /// As [`Self::build`].
    pub fn rebuild(
        scene: &Scene,
        pieces: Pieces,
        last: Option<(&Scene, &Self)>,
        watch: &Watch,
    ) -> Option<Self> {
        let shapes = GrooveShapes::new(scene);
        let deviations = Deviations::from_scene(scene, pieces);
        let kept = last.filter(|(_, index)| index.shapes == shapes);
        let sources = sources(scene, &shapes, &deviations, kept);
        let (tree, depth_coherence) = rayon::join(
            || build_trees(sources, last.map(|(_, index)| &index.tree), watch),
            || Self::depth_coherence(scene),
        );
        Some(Self {
            tree: tree?,
            depth_coherence,
            coherence_max_um: coherences_max_um(scene),
            shapes,
            deviations,
        })
    }

    /// Whether the pieces are those that were laid.
    pub fn is_laid(&self) -> bool {
        self.deviations.is_none()
    }

    /// Whether the pieces serve another camera, or the same one for a picture of another size.
    pub fn serves(&self, camera: &Camera, size_px: [u32; 2]) -> bool {
        self.is_laid() || self.deviations.serve(&camera.frame(size_px))
    }

    /// Makes the index without trees, for pictures of a draft, which looks nothing up there.
    pub fn without_trees(scene: &Scene) -> Self {
        let objects = scene.objects.len();
        Self {
            tree: SegmentTree {
                nodes: Vec::new(),
                segments: Vec::new(),
                objects: vec![0..0; objects],
                trees: vec![Vec::new(); objects],
            },
            depth_coherence: Self::depth_coherence(scene),
            coherence_max_um: coherences_max_um(scene),
            shapes: GrooveShapes::default(),
            deviations: Deviations::from_scene(scene, Pieces::Laid),
        }
    }

    /// The segments of an object in [`SegmentTree::segments`].
    pub fn segment_range(&self, object: usize) -> Range<u32> {
        self.tree.segment_range(object)
    }

    /// Largest coherence length of the materials of each object: no point of it sees further along a surface.
    pub fn coherence_max_um(&self) -> &[f32] {
        &self.coherence_max_um
    }

    /// Coherence of the phase steps of each object's scratches, without the trees.
    pub fn depth_coherence(scene: &Scene) -> Vec<f32> {
        scene.objects.iter().map(object_coherence).collect()
    }

    /// Returns the laid pieces of some scratches of an object, their free ends moved inwards, one scratch after the other, as a tree
    /// is grown over them. For pictures that show a few of all scratches.
    pub fn pieces(
        scene: &Scene,
        shapes: &GrooveShapes,
        object: &Object,
        scratches: &[Scratch],
    ) -> Vec<IndexedSegment> {
        let run = LayerRun::new(scene, shapes, object, scratches, 0.0);
        let mut pieces = Vec::with_capacity(run.piece_count());
        run.append_effective(&mut pieces);
        pieces
    }

    /// The layers of the scene that this was built of, with their trees.
    fn groups<'s>(&'s self, scene: &'s Scene) -> Vec<(Vec<LayerRun<'s>>, &'s Tree)> {
        let objects = scene.objects.iter().zip(&self.tree.trees);
        let objects = objects.zip(self.deviations.iter());
        objects
            .flat_map(|((object, trees), deviation_m)| {
                let groups = groups(scene, &self.shapes, object, deviation_m);
                groups.into_iter().zip(trees)
            })
            .collect()
    }
}

/// Trees for the layers on each object: those that exist, or the segments to grow them over.
fn sources<'a>(
    scene: &'a Scene,
    shapes: &'a GrooveShapes,
    deviations: &Deviations,
    last: Option<(&'a Scene, &'a ScratchIndex)>,
) -> Vec<Vec<TreeSource<'a, IndexedSegment>>> {
    let kept = last.map_or_else(Vec::new, |(scene, index)| index.groups(scene));
    let source = |group: Vec<LayerRun<'a>>| {
        let is_like = |before: &[LayerRun]| {
            let mut pairs = before.iter().zip(&group);
            before.len() == group.len() && pairs.all(|(a, b)| a.is_like(b))
        };
        match kept.iter().find(|(before, _)| is_like(before)) {
            Some((_, tree)) => TreeSource::Kept((*tree).clone()),
            None => TreeSource::New {
                most: group.iter().map(LayerRun::piece_count).sum(),
                fill: Box::new(move |pieces: &mut Vec<_>| {
                    group.iter().for_each(|run| run.append_effective(pieces));
                }),
            },
        }
    };
    let objects = scene.objects.iter().zip(deviations.iter());
    objects
        .map(|(object, deviation_m)| {
            let groups = groups(scene, shapes, object, deviation_m).into_iter();
            groups.map(source).collect()
        })
        .collect()
}

fn coherences_max_um(scene: &Scene) -> Vec<f32> {
    let objects = scene.objects.iter();
    objects
        .map(|object| coherence_max_um(scene, object))
        .collect()
}

/// The largest coherence length of the materials that an object's triangles refer to.
fn coherence_max_um(scene: &Scene, object: &Object) -> f32 {
    let mut is_used = vec![false; scene.materials.len()];
    for &material in &object.mesh.triangle_materials {
        is_used[material as usize] = true;
    }
    let used = scene
        .materials
        .iter()
        .zip(is_used)
        .filter(|(_, used)| *used);
    used.map(|(material, _)| material.coherence_um as f32)
        .fold(0.0, f32::max)
}

/// The pieces of an object's scratches, free ends moved inwards along the scratch.
#[cfg(test)]
fn effective_segments(scene: &Scene, object: &Object) -> Vec<IndexedSegment> {
    let shapes = GrooveShapes::new(scene);
    let runs: Vec<_> = LayerRun::from_object(scene, &shapes, object, 0.0).collect();
    let mut effective = Vec::with_capacity(runs.iter().map(LayerRun::piece_count).sum());
    for run in runs {
        run.append_effective(&mut effective);
    }
    effective
}

#[cfg(test)]
mod tests;
