//! A piece of a scratch with the properties that the closed form needs.

use crate::segment_tree::Straight;
use glam::Vec3;

/// A piece of a scratch, straight or an arc by its chord, its free ends moved inwards; or of a part of a wide scratch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndexedSegment {
    /// World space, metres.
    pub start_m: Vec3,
    /// World space, metres.
    pub end_m: Vec3,
    /// The surface's unit normal.
    pub normal: Vec3,
    /// Angle by which the scratch turns to the left from the start to the end, about the normal; 0 where it is straight.
    pub turn_rad: f32,
    /// Profile of the scratch's groove.
    pub profile: IndexedProfile,
    /// Standard deviation that smooths the ends; one for the whole scratch, so that joined ends cancel.
    pub blur_um: f32,
}

/// The cross section of a groove as it is looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IndexedProfile {
    /// Width of the share, and of what is looked up.
    pub width_um: f32,
    /// Depth of the deepest place.
    pub depth_nm: f32,
    /// Index of the shape: [`GrooveShapes::index`](hairline_scene::GrooveShapes::index).
    pub shape: u8,
    /// Class of the width of the groove that it is a part of, whose other parts lie beside it; 0 for a narrow groove.
    pub width_class: u8,
}

impl IndexedProfile {
    /// A narrow rectangle.
    pub const fn rectangle(width_um: f32, depth_nm: f32) -> Self {
        Self {
            width_um,
            depth_nm,
            shape: 0,
            width_class: 0,
        }
    }

    /// Number of parts side by side that weaken one another as little as a scratch does itself.
    pub fn lines(&self) -> f64 {
        if self.width_class > 0 { 2.0 } else { 1.0 }
    }
}

impl Straight for IndexedSegment {
    fn ends_m(&self) -> [Vec3; 2] {
        [self.start_m, self.end_m]
    }
}
