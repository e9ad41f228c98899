//! Nodes and segments of trees.

use glam::Vec3;
use std::borrow::Cow;
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

/// Bits of [`ScratchNode::leaf`] that hold the first segment.
pub(crate) const LEAF_FIRST_BITS: u32 = 28;

impl ScratchNode {
    /// The segments of a leaf; empty for an inner node.
    pub fn segments(&self) -> Range<usize> {
        let first = (self.leaf & ((1 << LEAF_FIRST_BITS) - 1)) as usize;
        first..first + (self.leaf >> LEAF_FIRST_BITS) as usize
    }

    /// The node with its numbers increased by the numbers of nodes and segments that are put before it; decreased if
    /// these wrap around.
    pub(super) fn moved(self, nodes: u32, segments: u32) -> Self {
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

/// A straight piece that a tree can hold.
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

/// Position of a tree among all.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub nodes: Range<u32>,
    pub segments: Range<u32>,
}

/// Nodes in a row, and the changes of their numbers.
pub(super) struct Piece<'a> {
    pub nodes: Cow<'a, [ScratchNode]>,
    /// Index of the tree's first node.
    pub first_node: u32,
    /// Number that is added to the indices of its segments, wrapping around.
    pub segments_by: u32,
}
