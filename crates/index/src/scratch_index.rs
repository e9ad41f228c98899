//! Scratches under a footprint: a bounding volume hierarchy with skip pointers (B. Smits, *Efficiency Issues for Ray
//! Tracing*, 1998), one for each object, so that no scratch shows on an object that merely touches its own.
//!
//! What the tree holds is ready for the footprint integral: free ends are moved inwards here, once, by what docs/model.md
//! section 6 says of the whole scratch; where pieces are joined nothing moves, and pieces that an end's shift swallows
//! are gone.

use glam::Vec3;
use hairline_optics::footprint;
use hairline_optics::mask::depth_coherence;
use hairline_scene::{Object, Scene};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};
use std::ops::Range;

/// A node in depth-first order. A walk goes on with the next node, or with `skip` if it wants nothing below this one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScratchNode {
    /// Lower corner, world space, metres.
    pub min_m: Vec3,
    /// The next node that is not below this one; always greater than the node's own index.
    pub skip: u32,
    /// Upper corner, world space, metres.
    pub max_m: Vec3,
    /// 0 for an inner node; else the number of segments in the upper 4 bits and the first segment in the lower 28.
    pub leaf: u32,
}

/// Most segments in one leaf.
const LEAF_SEGMENTS: u32 = 4;
/// Bits of [`ScratchNode::leaf`] that hold the first segment.
pub const LEAF_FIRST_BITS: u32 = 28;

impl ScratchNode {
    /// The segments of a leaf; empty for an inner node.
    pub fn segments(&self) -> Range<usize> {
        let first = (self.leaf & ((1 << LEAF_FIRST_BITS) - 1)) as usize;
        first..first + (self.leaf >> LEAF_FIRST_BITS) as usize
    }
}

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

/// An object's part of the index.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectScratches {
    /// Its nodes in [`ScratchIndex::nodes`]; empty for an object without scratches.
    pub nodes: Range<u32>,
    /// How alike the phase steps of its scratches are (docs/model.md, section 3).
    pub depth_coherence: f32,
}

/// The trees of all objects of a scene.
#[derive(Clone, Debug, Default)]
pub struct ScratchIndex {
    /// Nodes, object by object, each object's in depth-first order.
    pub nodes: Vec<ScratchNode>,
    /// Segments in the order of the leaves.
    pub segments: Vec<IndexedSegment>,
    /// One for each object of the scene.
    pub objects: Vec<ObjectScratches>,
}

/// A footprint cannot be told apart from its Gaussian's tail beyond this many standard deviations (5e-4 of it is left).
pub const REACH_STD: f32 = 3.5;

/// A segment shows at a point only if their normals agree at least this well: the far side of a thin sheet has the
/// opposite one.
pub const FACING_MIN_COS: f32 = 0.2;

impl ScratchIndex {
    /// Builds the trees.
    pub fn build(scene: &Scene) -> Self {
        let mut index = Self::default();
        for object in &scene.objects {
            let segments = effective_segments(scene, object);
            let first_node = index.nodes.len() as u32;
            index.append_tree(segments);
            let depths = object.scratches.iter().map(|s| {
                let pieces = &object.segments[s.segments.start as usize..s.segments.end as usize];
                let length: f32 = pieces.iter().map(|p| p.start_m.distance(p.end_m)).sum();
                (s.depth_nm as f64, (s.width_um * length) as f64)
            });
            index.objects.push(ObjectScratches {
                nodes: first_node..index.nodes.len() as u32,
                depth_coherence: depth_coherence(depths) as f32,
            });
        }
        index
    }

    /// Calls `visit` for every segment of an object whose node touches the box around a point.
    #[inline]
    pub fn gather(
        &self,
        object: usize,
        center_m: Vec3,
        reach_m: Vec3,
        mut visit: impl FnMut(&IndexedSegment),
    ) {
        let Range { start, end } = self.objects[object].nodes;
        let (lower, upper) = (center_m - reach_m, center_m + reach_m);
        let mut at = start;
        while at < end {
            let node = &self.nodes[at as usize];
            if node.min_m.cmple(upper).all() && node.max_m.cmpge(lower).all() {
                self.segments[node.segments()].iter().for_each(&mut visit);
                at += 1;
            } else {
                at = node.skip;
            }
        }
    }

    fn append_tree(&mut self, segments: Vec<IndexedSegment>) {
        if segments.is_empty() {
            return;
        }
        let boxes: Vec<SegmentBox> = segments.iter().map(SegmentBox::new).collect();
        let params = BvhBuildParams {
            max_prims_per_leaf: LEAF_SEGMENTS,
            ..BvhBuildParams::medium_build()
        };
        let tree = build_bvh2(&boxes, params, &mut std::time::Duration::default());
        self.append_depth_first(&tree, &segments, 0);
    }

    /// obvhs keeps siblings side by side; skip pointers want depth-first order.
    fn append_depth_first(&mut self, tree: &Bvh2, segments: &[IndexedSegment], root: usize) {
        // The second child's turn comes when the first one's subtree is done; a node's skip is known when its own is.
        enum Step {
            Enter(usize),
            Leave(usize),
        }
        let mut steps = vec![Step::Enter(root)];
        while let Some(step) = steps.pop() {
            match step {
                Step::Leave(written) => self.nodes[written].skip = self.nodes.len() as u32,
                Step::Enter(at) => {
                    let node = &tree.nodes[at];
                    let written = self.nodes.len();
                    let mut leaf = 0;
                    steps.push(Step::Leave(written));
                    if node.is_leaf() {
                        let first = self.segments.len() as u32;
                        assert!(
                            first < 1 << LEAF_FIRST_BITS,
                            "more than 268 million segments"
                        );
                        let own = node.first_index as usize
                            ..(node.first_index + node.prim_count) as usize;
                        self.segments.extend(
                            tree.primitive_indices[own]
                                .iter()
                                .map(|i| segments[*i as usize]),
                        );
                        leaf = first | node.prim_count << LEAF_FIRST_BITS;
                    } else {
                        steps.push(Step::Enter(node.first_index as usize + 1));
                        steps.push(Step::Enter(node.first_index as usize));
                    }
                    let bounds = node.aabb();
                    self.nodes.push(ScratchNode {
                        min_m: bounds.min.into(),
                        skip: 0,
                        max_m: bounds.max.into(),
                        leaf,
                    });
                }
            }
        }
    }
}

struct SegmentBox(Aabb);

impl SegmentBox {
    fn new(segment: &IndexedSegment) -> Self {
        Self(Aabb::from_points(&[
            segment.start_m.into(),
            segment.end_m.into(),
        ]))
    }
}

impl Boundable for SegmentBox {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

/// The pieces of all scratches of an object, free ends moved inwards along the scratch.
fn effective_segments(scene: &Scene, object: &Object) -> Vec<IndexedSegment> {
    let mut effective = Vec::with_capacity(object.segments.len());
    for scratch in &object.scratches {
        let pieces =
            &object.segments[scratch.segments.start as usize..scratch.segments.end as usize];
        let Some(first) = pieces.first() else {
            continue;
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
    effective
}
