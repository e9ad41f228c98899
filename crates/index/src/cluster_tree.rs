//! Scratches by orientation first and by place then: trees whose nodes bound the tangents of what lies below them, so that a walk
//! leaves out what no light can reach, and tell what it adds up to, so that a bundle which is thin against a pixel's footprint
//! is one scratch (docs/model.md, section 7).
//!
//! The bound of a node is a cylinder around its mean tangent: long scratches that run aslant would fill boxes along the
//! world's axes with nothing. Trees are split at medians, so a build is n log n and every array has its final size from the
//! start; both halves are built at once. One tree for each layer of an object: layers differ in width and depth, and a layer
//! that changes leaves the others' trees as they are.

mod moments;

use crate::scratch_index::{IndexedSegment, effective_segments};
use glam::Vec3;
use hairline_scene::{Object, Scene};
use moments::Moments;
use rayon::prelude::*;
use std::ops::Range;

/// A node in depth-first order: seven texels of 16 bytes. A walk that leaves out what is below goes on with `skip`.
///
/// The first three texels are all that a walk needs to pass a node by.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClusterNode {
    /// Weighted mean place, world space, metres; the cylinder's middle.
    pub center_m: Vec3,
    /// The next node that is not below this one.
    pub skip: u32,
    /// Unit mean tangent; tangents have no sign.
    pub axis: Vec3,
    /// 0 for an inner node; else the number of segments in the upper 4 bits and the first segment in the lower 28, counted
    /// within the tree.
    pub leaf: u32,
    /// Radius of the cylinder around all segments below, metres.
    pub radius_m: f32,
    /// Half its length, metres.
    pub half_m: f32,
    /// Sine and cosine of the largest angle between a tangent and the axis.
    pub spread: [f32; 2],
    /// Mean normal, unit length.
    pub normal: Vec3,
    /// How far, as a standard deviation, what is below strays from the one scratch that stands for it; infinite where nothing can
    /// stand for it. Never less than that of a node below.
    pub stray_um: f32,
    /// The parent's `stray_um`; infinite at the root.
    pub parent_stray_um: f32,
    /// Standard deviation of the tangents' angles; never less than that of a node below.
    pub turn_rad: f32,
    /// The parent's `turn_rad`.
    pub parent_turn_rad: f32,
    /// Sum of width times length.
    pub weight_um2: f32,
    /// Length of the one scratch that stands for all below.
    pub length_um: f32,
    /// Standard deviation that smooths its ends.
    pub blur_um: f32,
    /// Variance of place across it.
    pub across_um2: f32,
    /// Mean width, weighted by area like the following.
    pub width_um: f32,
    /// Mean depth.
    pub depth_nm: f32,
    /// Standard deviation of width.
    pub width_std_um: f32,
    /// Standard deviation of depth.
    pub depth_std_nm: f32,
    /// Variance of the tangents' angles about the axis.
    pub turn_rad2: f32,
}

impl ClusterNode {
    /// The segments of a leaf; empty for an inner node.
    pub fn segments(&self) -> Range<usize> {
        let first = (self.leaf & ((1 << LEAF_FIRST_BITS) - 1)) as usize;
        first..first + (self.leaf >> LEAF_FIRST_BITS) as usize
    }
}

/// Most segments in one leaf.
const LEAF_SEGMENTS: usize = 4;
/// Bits of [`ClusterNode::leaf`] that hold the first segment.
const LEAF_FIRST_BITS: u32 = 28;
/// Both halves are built at once where there are more segments than this.
const PARALLEL_SEGMENTS: usize = 2048;

/// The tree over one layer of scratches.
#[derive(Clone, Debug, Default)]
pub struct ClusterTree {
    /// In depth-first order.
    pub nodes: Vec<ClusterNode>,
    /// In the order of the leaves.
    pub segments: Vec<IndexedSegment>,
}

impl ClusterTree {
    /// Builds the tree, all cores at work; the same for any number of them.
    pub fn build(mut segments: Vec<IndexedSegment>) -> Self {
        let leaves = segments.len().div_ceil(LEAF_SEGMENTS);
        let mut nodes = vec![ClusterNode::default(); (2 * leaves).saturating_sub(1)];
        if leaves > 0 {
            build(&mut segments, 0, &mut nodes, 0);
            tell_parents(&mut nodes);
        }
        Self { nodes, segments }
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.segments)
    }
}

/// Fills `nodes` with the tree over `segments`, which are ordered for it. `first` and `at` are the places of both in the whole.
/// Returns what the parent has to bound.
fn build(
    segments: &mut [IndexedSegment],
    first: usize,
    nodes: &mut [ClusterNode],
    at: usize,
) -> (f32, f32) {
    let skip = (at + nodes.len()) as u32;
    let moments = Moments::new(segments);
    let mut node = moments.node(segments);
    node.skip = skip;
    if let [leaf] = nodes {
        node.leaf = ((segments.len() as u32) << LEAF_FIRST_BITS) | first as u32;
        *leaf = node;
        return (node.stray_um, node.turn_rad);
    }
    // As many leaves to the left as to the right, all of them full but the last.
    let left = nodes.len().div_ceil(2) / 2;
    let middle = left * LEAF_SEGMENTS;
    let split = moments.split(&node);
    segments.select_nth_unstable_by(middle, |a, b| split.key(a).total_cmp(&split.key(b)));
    let (left_segments, right_segments) = segments.split_at_mut(middle);
    let (own, below) = nodes.split_at_mut(1);
    let (left_nodes, right_nodes) = below.split_at_mut(2 * left - 1);
    let right_at = at + 1 + left_nodes.len();
    let parallel = left_segments.len() > PARALLEL_SEGMENTS;
    let mut build_left = || build(left_segments, first, left_nodes, at + 1);
    let mut build_right = || build(right_segments, first + middle, right_nodes, right_at);
    let (a, b) = if parallel {
        rayon::join(build_left, build_right)
    } else {
        (build_left(), build_right())
    };
    // Never less than below: the weights of a path then sum to one.
    node.stray_um = node.stray_um.max(a.0).max(b.0);
    node.turn_rad = node.turn_rad.max(a.1).max(b.1);
    own[0] = node;
    (node.stray_um, node.turn_rad)
}

fn tell_parents(nodes: &mut [ClusterNode]) {
    nodes[0].parent_stray_um = f32::INFINITY;
    nodes[0].parent_turn_rad = f32::INFINITY;
    for at in 0..nodes.len() {
        let ClusterNode {
            stray_um,
            turn_rad,
            leaf,
            ..
        } = nodes[at];
        if leaf == 0 {
            let second = nodes[at + 1].skip as usize;
            for child in [at + 1, second] {
                nodes[child].parent_stray_um = stray_um;
                nodes[child].parent_turn_rad = turn_rad;
            }
        }
    }
}

/// The trees of all objects of a scene.
#[derive(Clone, Debug, Default)]
pub struct ClusterIndex {
    /// One for each layer of an object that has scratches, object by object.
    pub trees: Vec<ClusterTree>,
    /// Each object's part of `trees`.
    pub objects: Vec<Range<u32>>,
}

impl ClusterIndex {
    /// Builds the trees.
    pub fn build(scene: &Scene) -> Self {
        let mut index = Self::default();
        for object in &scene.objects {
            let first = index.trees.len() as u32;
            let trees: Vec<ClusterTree> = layers(object)
                .into_par_iter()
                .map(|layer| ClusterTree::build(effective_segments(scene, object, Some(layer))))
                .filter(|tree| !tree.nodes.is_empty())
                .collect();
            index.trees.extend(trees);
            index.objects.push(first..index.trees.len() as u32);
        }
        index
    }

    /// The trees of an object.
    pub fn of(&self, object: usize) -> &[ClusterTree] {
        let Range { start, end } = self.objects[object];
        &self.trees[start as usize..end as usize]
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        self.trees.iter().map(ClusterTree::bytes).sum()
    }
}

/// The layers that have scratches on an object, ascending.
fn layers(object: &Object) -> Vec<u32> {
    let mut layers: Vec<u32> = object.scratches.iter().map(|s| s.layer).collect();
    layers.sort_unstable();
    layers.dedup();
    layers
}

#[cfg(test)]
mod tests;
