//! Scratches as the closed form wants them under a footprint: free ends are moved inwards here, once, by what
//! docs/model.md section 6 says of the whole scratch; where pieces are joined nothing moves, and pieces that an end's shift
//! swallows are gone.

use crate::bundles::BundleIndex;
use crate::depth_spread::object_coherence;
use crate::layer_runs::{LayerRun, groups, longest_m};
use crate::segment_tree::{Plot, SegmentTree, Straight, Tree, plant};
use crate::watch::Watch;
use glam::Vec3;
use hairline_optics::method::Lookup;
use hairline_scene::{Object, Scene};
use std::sync::{Arc, OnceLock};

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

/// The scratches of a scene under footprints. Each large layer on an object has a tree of its own, so that those that an edit
/// leaves alone are grown once.
#[derive(Clone, Debug)]
pub struct ScratchIndex {
    /// What lies where.
    pub tree: SegmentTree<IndexedSegment>,
    /// How alike the phase steps of each object's scratches are (docs/model.md, section 3).
    pub depth_coherence: Vec<f32>,
    /// No longer piece is put together of others.
    longest_m: f32,
    /// See [`Self::grids`].
    grids: OnceLock<Arc<BundleIndex>>,
}

/// A footprint cannot be told apart from its Gaussian's tail beyond this many standard deviations (5e-4 of it is left).
pub const REACH_STD: f32 = 3.5;

/// A segment shows at a point only if their normals agree at least this well: the far side of a thin sheet has the
/// opposite one.
pub const FACING_MIN_COS: f32 = 0.2;

impl ScratchIndex {
    /// Builds the trees for the default look-up, all cores at work; the same for any number of them.
    ///
    /// # Panics
    /// Beyond 268 million pieces; no loaded scene has as many on one object.
    pub fn build(scene: &Scene) -> Self {
        Self::rebuild(scene, Lookup::default(), None, &Watch::default())
            .unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// The same while another watches, with pieces as long as suits the look-up, and with the trees of an earlier scene for those
    /// layers that lie as they lay there, if they were for such a look-up. `None` if it was cancelled.
    ///
    /// # Panics
    /// As [`Self::build`].
    pub fn rebuild(
        scene: &Scene,
        lookup: Lookup,
        last: Option<(&Scene, &Self)>,
        watch: &Watch,
    ) -> Option<Self> {
        let last = last.filter(|(_, index)| index.suits(lookup));
        let plots = plots(scene, lookup, last);
        let (tree, depth_coherence) = rayon::join(
            || plant(plots, last.map(|(_, index)| &index.tree), watch),
            || Self::depth_coherence(scene),
        );
        Some(Self {
            tree: tree?,
            depth_coherence,
            longest_m: longest_m(lookup),
            grids: OnceLock::new(),
        })
    }

    /// Whether its pieces are as long as the look-up would have them. Others give the same pictures, later.
    pub fn suits(&self, lookup: Lookup) -> bool {
        self.longest_m == longest_m(lookup)
    }

    /// What the scratches of the scene that this was built of add up to; built when first asked for, and shared by clones made after.
    pub fn grids(&self, scene: &Scene) -> Arc<BundleIndex> {
        let build = || BundleIndex::build(scene).into();
        Arc::clone(self.grids.get_or_init(build))
    }

    /// Builds what [`Self::grids`] returns while another watches. `None` if it was cancelled.
    pub fn grids_watched(&self, scene: &Scene, watch: &Watch) -> Option<Arc<BundleIndex>> {
        if self.grids.get().is_none() {
            let grids = BundleIndex::watched(scene, watch)?;
            // Another may have been quicker.
            self.grids.set(grids.into()).ok();
        }
        self.grids.get().cloned()
    }

    /// How alike the phase steps of each object's scratches are, without the trees.
    pub fn depth_coherence(scene: &Scene) -> Vec<f32> {
        scene.objects.iter().map(object_coherence).collect()
    }

    /// The layers of the scene that this was built of, with their trees.
    fn groups<'s>(&self, scene: &'s Scene) -> Vec<(Vec<LayerRun<'s>>, &Tree)> {
        let objects = scene.objects.iter().zip(&self.tree.trees);
        objects
            .flat_map(|(object, trees)| groups(scene, object).into_iter().zip(trees))
            .collect()
    }
}

/// For the layers on each object the trees that they have already, or what to grow them over.
fn plots<'a>(
    scene: &'a Scene,
    lookup: Lookup,
    last: Option<(&Scene, &ScratchIndex)>,
) -> Vec<Vec<Plot<'a, IndexedSegment>>> {
    let kept = last.map_or_else(Vec::new, |(scene, index)| index.groups(scene));
    let plot = |group: Vec<LayerRun<'a>>| {
        let is_like = |before: &[LayerRun]| {
            let mut pairs = before.iter().zip(&group);
            before.len() == group.len() && pairs.all(|(a, b)| a.is_like(b))
        };
        match kept.iter().find(|(before, _)| is_like(before)) {
            Some((_, tree)) => Plot::Kept((*tree).clone()),
            None => Plot::New {
                most: group.iter().map(LayerRun::piece_count).sum(),
                fill: Box::new(move |pieces: &mut Vec<_>| {
                    group
                        .iter()
                        .for_each(|run| run.append_effective(lookup, pieces));
                }),
            },
        }
    };
    let objects = scene.objects.iter();
    objects
        .map(|object| groups(scene, object).into_iter().map(plot).collect())
        .collect()
}

/// The pieces of an object's scratches, free ends moved inwards along the scratch, as long as by the default look-up.
pub(crate) fn effective_segments(scene: &Scene, object: &Object) -> Vec<IndexedSegment> {
    let runs: Vec<_> = LayerRun::of(scene, object).collect();
    let mut effective = Vec::with_capacity(runs.iter().map(LayerRun::piece_count).sum());
    for run in runs {
        run.append_effective(Lookup::default(), &mut effective);
    }
    effective
}

#[cfg(test)]
mod tests;
