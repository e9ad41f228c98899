//! Interface of all kinds of layers for laying a scratch.

use hairline_scene::{Profile, Segment};

use crate::walk::{Course, MeshPoint, Walker};

/// Profile and course of a scratch, besides its segments. Its section is the layer's.
pub struct Groove {
    /// Width and depth.
    pub profile: Profile,
    /// Whether it comes back to its start.
    pub course: Course,
}

/// A layer that can lay its scratches one by one, in any order.
pub trait Laying: Sync {
    /// Appends the segments of one scratch.
    fn lay(&self, walker: &Walker, index: u64, segments: &mut Vec<Segment>) -> Groove;

    /// Middle of a scratch, if it has one, where [`Laying::lay`] lays it.
    fn middle(&self, index: u64) -> Option<MeshPoint>;

    /// Note about what it does not lay.
    fn note(&self) -> Option<String> {
        None
    }

    /// Number of the layer's strokes before a scratch, its own included.
    fn strokes_before(&self, _index: u64) -> usize {
        0
    }
}
