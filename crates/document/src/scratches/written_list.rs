//! Lists of laid scratches, for other programs and to be read again.

use std::io::{self, Write};

use glam::{DMat3, DMat4, Vec3};
use hairline_scene::{Object, Scratch};

use super::listed::{MORE_COLUMNS, columns};
use super::sizes::LISTED_SIZES;

/// Writes laid scratches of an object: a straight piece a row, in the frame that `frame_from_world` leads to. In the object's own frame
/// `pattern = "file"` reads them. The numbers read back as what they were. packages/hairline-shaders reads them in world space.
///
/// # Errors
/// What cannot be written.
pub fn write_scratches<'a>(
    object: &Object,
    scratches: impl IntoIterator<Item = &'a Scratch>,
    frame_from_world: &DMat4,
    out: &mut impl Write,
) -> io::Result<()> {
    let place = |at_m: Vec3| frame_from_world.transform_point3(at_m.as_dvec3()).as_vec3();
    // Normals go by the inverse transpose of the way that places take.
    let turn = DMat3::from_mat4(*frame_from_world).inverse().transpose();
    let names = columns().into_iter().chain(MORE_COLUMNS);
    writeln!(out, "{}", names.collect::<Vec<_>>().join(","))?;
    for (number, scratch) in scratches.into_iter().enumerate() {
        let mut profile = scratch.profile.clone();
        let sizes = LISTED_SIZES.each_ref().map(|size| *(size.of)(&mut profile));
        for piece in object.pieces(scratch) {
            let ends = [piece.start_m, piece.end_m].map(|end| place(end).to_array());
            for x in ends.as_flattened().iter().chain(&sizes) {
                write!(out, "{x},")?;
            }
            let normal = (turn * piece.normal.as_dvec3()).normalize_or_zero();
            let [x, y, z] = normal.as_vec3().to_array();
            writeln!(out, "{number},{x},{y},{z}")?;
        }
    }
    Ok(())
}
