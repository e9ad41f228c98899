//! Rotations as scene files write them: about the world's x axis, then y, then z.

use glam::{DMat3, EulerRot};

/// `rotation_deg` of an object for a rotation.
pub fn rotation_deg(rotation: DMat3) -> [f64; 3] {
    // About the world's x, then y, then z: that is z, y, x about the object's own.
    let (z, y, x) = rotation.to_euler(EulerRot::ZYX);
    // Digits that nobody sees, in a file that people read.
    [x, y, z].map(|angle| (angle.to_degrees() * 1e6).round() / 1e6)
}
