//! Straight pieces of scratches under a box: bounding volume hierarchies with skip pointers (B. Smits, *Efficiency Issues
//! for Ray Tracing*, 1998). Each object has its own, so that no scratch shows on an object that merely touches its own, and may
//! have several, one after the other: to a walk they are one.

mod build_trees;
mod grow;
mod node;

use crate::watch::Watch;
use glam::Vec3;
use std::ops::Range;

pub(crate) use build_trees::{TreeSource, build_trees};
pub use node::Straight;
pub(crate) use node::Tree;
pub use node::{ScratchNode, SegmentTree};

impl<S: Straight> SegmentTree<S> {
    /// Builds the trees; one list of segments for each object.
    ///
    /// # Panics
    /// Beyond 268 million segments.
    pub fn build(objects: impl Iterator<Item = Vec<S>>) -> Self {
        let sources = objects.map(|segments| {
            vec![TreeSource::New {
                most: segments.len(),
                fill: Box::new(move |all: &mut Vec<S>| all.extend(segments)),
            }]
        });
        build_trees(sources.collect(), None, &Watch::default())
            .unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// The segments of an object, which stand side by side; empty for an object without scratches.
    pub(crate) fn segment_range(&self, object: usize) -> Range<u32> {
        match self.trees[object].as_slice() {
            [first, .., last] => first.segments.start..last.segments.end,
            [only] => only.segments.clone(),
            [] => 0..0,
        }
    }

    /// Calls `visit` with the index of every segment of an object whose node touches the box around a point.
    #[inline]
    pub fn gather(
        &self,
        object: usize,
        center_m: Vec3,
        reach_m: Vec3,
        mut visit: impl FnMut(usize),
    ) {
        self.walk(object, center_m - reach_m, center_m + reach_m, |segments| {
            segments.for_each(&mut visit);
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
