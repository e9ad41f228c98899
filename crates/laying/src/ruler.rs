//! Distances along a surface.

use std::sync::Arc;

use glam::{DMat4, DVec3};
use hairline_scene::Mesh;

use crate::ground::Ground;
use crate::guide::Guide;
use crate::walk::{LONGEST_WAY, MeshPoint};

/// A mesh on which ways are measured.
#[derive(Debug)]
pub struct Ruler(Ground);

impl Ruler {
    /// Makes the mesh ready.
    pub fn new(mesh: Arc<Mesh>) -> Self {
        Self(Ground::new(mesh, DMat4::IDENTITY))
    }

    /// The mesh.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.0.mesh
    }

    /// The path on the surface from a point of a triangle to another point, as its bends: that of a listed scratch, which heads for its end and in each
    /// triangle goes by the projection of the straight line. On a plane and on a sphere it is the shortest. None where it does not get
    /// there: a boundary of the surface lies between, or an edge that bends by more than 60 degrees.
    pub fn path_m(&self, triangle: usize, from_m: DVec3, to_m: DVec3) -> Option<Vec<DVec3>> {
        let start = MeshPoint {
            triangle: triangle as u32,
            point_m: from_m,
        };
        let mut pieces = Vec::new();
        let walker = self.0.walker();
        let length_m = LONGEST_WAY * from_m.distance(to_m);
        walker.lay_from(
            start,
            &Guide::Towards { end_m: to_m },
            length_m,
            &mut pieces,
        );
        let bends_m = pieces.iter().map(|piece| piece.end_m.as_dvec3());
        let mut path_m: Vec<_> = std::iter::once(from_m).chain(bends_m).collect();
        let last_m = path_m.last_mut()?;
        // Ends may lie a rounding off the surface, and pieces that are too short are left out.
        let near_m = 2.0 * walker.shortest_piece_m + 1e-4 * from_m.distance(to_m);
        if last_m.distance(to_m) > near_m {
            return None;
        }
        *last_m = to_m;
        Some(path_m)
    }
}
