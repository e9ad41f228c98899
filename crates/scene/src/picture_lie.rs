//! Mapping of pictures onto surfaces: by texture coordinates, or from the three sides of an object.

use glam::{DMat4, DVec2, DVec3};

/// Mapping of a picture onto a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PictureLie {
    /// Mapping by the texture coordinates of the mesh.
    ByUv,
    /// Projection from the three sides of the object, repeated.
    FromThreeSides {
        /// The object's own frame, in widths of the picture.
        tiles_from_world: DMat4,
    },
}

impl PictureLie {
    /// Mapping for an object with this transform: repeated at a width in the object's own frame, or by texture
    /// coordinates without a width.
    pub fn new(tile_m: Option<f64>, world_from_object: &DMat4) -> Self {
        tile_m.map_or(Self::ByUv, |tile_m| Self::FromThreeSides {
            tiles_from_world: DMat4::from_scale(DVec3::splat(1.0 / tile_m))
                * world_from_object.inverse(),
        })
    }
}

/// Returns the look-ups of a picture that is projected from three sides, for a place of a surface, with the weight of
/// each side. Twin: groove_places.wgsl.
pub fn three_sides(
    tiles_from_world: &DMat4,
    point_m: DVec3,
    normal: DVec3,
) -> ([DVec2; 3], [f64; 3]) {
    let p = tiles_from_world.transform_point3(point_m);
    let rows = tiles_from_world.transpose();
    // Normals transform by the transpose of the inverse. The shares are sharp, so that few places mix two sides.
    let shares = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| {
        let row = row.truncate();
        (row.dot(normal) / row.length_squared()).powi(4)
    });
    let sum: f64 = shares.iter().sum();
    (
        [[p.y, -p.z], [p.x, -p.z], [p.x, -p.y]].map(DVec2::from),
        shares.map(|share| share / sum),
    )
}
