//! Profile, normal and blur of a piece in two words, as shaders unpack them.

use glam::Vec3;
use half::f16;

use crate::IndexedSegment;

/// The normal of pieces whose normal is zero: they show on both sides of a sheet.
const NO_NORMAL: u32 = 0x8080;

/// Profile, normal and blur of a segment. Twin: `profile_unpacked` in scratch.wgsl.
pub fn profile_words(segment: &IndexedSegment) -> [u32; 2] {
    let profile = segment.profile;
    // The shape has the place of the last four digits of a half float's ten.
    let blur = (half_bits(segment.blur_um) + 8) & 0xfff0;
    let class = u32::from(profile.width_class);
    let signs = [(class & 1) << 15 | (class & 2) << 30, (class & 4) << 29];
    [
        half_bits(profile.width_um) | half_bits(profile.depth_nm) << 16 | signs[0],
        octahedral(segment.normal) | (blur | u32::from(profile.shape)) << 16 | signs[1],
    ]
}

/// The nearest half float.
pub fn half_bits(value: f32) -> u32 {
    u32::from(f16::from_f32(value).to_bits())
}

/// A unit vector as two signed bytes. Twin: `octahedral_normal` in scratch.wgsl.
pub fn octahedral(normal: Vec3) -> u32 {
    if normal == Vec3::ZERO {
        return NO_NORMAL;
    }
    let v = normal / (normal.x.abs() + normal.y.abs() + normal.z.abs()).max(1e-30);
    let folded = |value: f32, other: f32| {
        if v.z >= 0.0 {
            value
        } else {
            (1.0 - other.abs()).copysign(value)
        }
    };
    let byte = |value: f32| u32::from((value * 127.0).round() as i8 as u8);
    byte(folded(v.x, v.y)) | byte(folded(v.y, v.x)) << 8
}
