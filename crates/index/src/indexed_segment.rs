//! A straight piece of a scratch with the properties that the closed form needs.

use crate::segment_tree::Straight;
use glam::Vec3;
use hairline_scene::Profile;

/// A straight piece of a scratch, its free ends moved inwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndexedSegment {
    /// World space, metres.
    pub start_m: Vec3,
    /// World space, metres.
    pub end_m: Vec3,
    /// The surface's unit normal.
    pub normal: Vec3,
    /// Profile of the scratch's groove.
    pub profile: Profile,
    /// Standard deviation that smooths the ends; one for the whole scratch, so that joined ends cancel.
    pub blur_um: f32,
}

impl Straight for IndexedSegment {
    fn ends_m(&self) -> [Vec3; 2] {
        [self.start_m, self.end_m]
    }
}
