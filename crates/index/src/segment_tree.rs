//! Straight pieces of scratches under a box: bounding volume hierarchies with skip pointers (B. Smits, *Efficiency Issues
//! for Ray Tracing*, 1998). Each object has its own, so that no scratch shows on an object that merely touches its own, and may
//! have several, one after the other: to a walk they are one.

mod grow;
mod plant;

use crate::watch::Watch;
use glam::Vec3;
use std::ops::Range;

pub(crate) use plant::{Plot, plant};

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

/// Bits of [`ScratchNode::leaf`] that hold the first segment.
pub const LEAF_FIRST_BITS: u32 = 28;

impl ScratchNode {
    /// The segments of a leaf; empty for an inner node.
    pub fn segments(&self) -> Range<usize> {
        let first = (self.leaf & ((1 << LEAF_FIRST_BITS) - 1)) as usize;
        first..first + (self.leaf >> LEAF_FIRST_BITS) as usize
    }

    /// The same node with others and their segments before it: so many more, or, wrapped around, less.
    fn moved(self, nodes: u32, segments: u32) -> Self {
        Self {
            skip: self.skip.wrapping_add(nodes),
            leaf: if self.leaf == 0 {
                0
            } else {
                self.leaf.wrapping_add(segments)
            },
            ..self
        }
    }
}

/// What a tree can hold.
pub trait Straight: Copy + Send + Sync {
    /// Both ends, world space, metres.
    fn ends_m(&self) -> [Vec3; 2];
}

/// The trees of all objects of a scene.
#[derive(Clone, Debug)]
pub struct SegmentTree<S> {
    /// Nodes, object by object, each object's in depth-first order.
    pub nodes: Vec<ScratchNode>,
    /// Segments in the order of the leaves.
    pub segments: Vec<S>,
    /// Each object's part of `nodes`; empty for an object without scratches.
    pub objects: Vec<Range<u32>>,
    /// The trees of each object, which follow one another in `nodes` and `segments`.
    pub(crate) trees: Vec<Vec<Tree>>,
}

/// Where a tree lies among all.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    nodes: Range<u32>,
    segments: Range<u32>,
}

impl<S: Straight> SegmentTree<S> {
    /// Builds the trees; one list of segments for each object.
    ///
    /// # Panics
    /// Beyond 268 million segments.
    pub fn build(objects: impl Iterator<Item = Vec<S>>) -> Self {
        let plots = objects.map(|segments| {
            vec![Plot::New {
                most: segments.len(),
                fill: Box::new(move |all: &mut Vec<S>| all.extend(segments)),
            }]
        });
        plant(plots.collect(), None, &Watch::default())
            .unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// The segments of an object, which stand side by side; empty for an object without scratches.
    pub fn segment_range(&self, object: usize) -> Range<u32> {
        match self.trees[object].as_slice() {
            [first, .., last] => first.segments.start..last.segments.end,
            [only] => only.segments.clone(),
            [] => 0..0,
        }
    }

    /// Calls `visit` for every segment of an object whose node touches the box around a point.
    #[inline]
    pub fn gather(&self, object: usize, center_m: Vec3, reach_m: Vec3, mut visit: impl FnMut(&S)) {
        self.walk(object, center_m - reach_m, center_m + reach_m, |segments| {
            self.segments[segments].iter().for_each(&mut visit);
        });
    }

    /// Calls `visit` with the indices of every leaf of an object that touches the box from `lower` to `upper`.
    #[inline]
    pub fn walk(
        &self,
        object: usize,
        lower: Vec3,
        upper: Vec3,
        mut visit: impl FnMut(Range<usize>),
    ) {
        let Range { start, end } = self.objects[object];
        let mut at = start;
        while at < end {
            let node = &self.nodes[at as usize];
            if node.min_m.cmple(upper).all() && node.max_m.cmpge(lower).all() {
                visit(node.segments());
                at += 1;
            } else {
                at = node.skip;
            }
        }
    }
}
