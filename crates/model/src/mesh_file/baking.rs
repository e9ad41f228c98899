//! Baking of a file's primitives into one mesh.

use std::collections::BTreeMap;

use glam::DMat4;

use super::material::Materials;
use super::shapes::Shape;
use crate::flaw::Flaw;
use crate::mesh::{Mesh, NodeTriangles};
use crate::surface::Surface;

/// Instances of meshes that one file may place; each is baked.
const MOST_TRIANGLES: usize = 1 << 28;

/// A mesh that is being baked.
pub(super) struct Baking<'a> {
    pub world_from_file: DMat4,
    pub mesh: Mesh,
    /// Triangles of each node.
    pub parts: &'a mut Vec<NodeTriangles>,
    /// Number of triangles that were turned to their normals.
    pub turned: usize,
    /// Sets of texture coordinates that primitives lack, with the number of these.
    pub missing_sets: BTreeMap<u32, usize>,
}

impl Baking<'_> {
    /// Adds a primitive at all of its places.
    pub(super) fn bake(&mut self, shape: Shape, materials: &mut Materials) -> Result<(), Flaw> {
        for set in &shape.rough.missing_sets {
            *self.missing_sets.entry(*set).or_default() += 1;
        }
        let surface = shape.rough.finished(&shape.primitive, &mut self.turned);
        let material = materials.index(&shape.primitive)?;
        let first = self.mesh.triangles.len();
        for file_from_place in &shape.places {
            self.refuse_too_many(&surface)?;
            let world_from_place = self.world_from_file * *file_from_place;
            surface.bake(&world_from_place, material, &mut self.mesh);
        }
        self.parts.push(NodeTriangles {
            nodes: shape.nodes.clone(),
            triangles: first..self.mesh.triangles.len(),
        });
        Ok(())
    }

    fn refuse_too_many(&self, more: &Surface) -> Result<(), Flaw> {
        let so_far = self.mesh.triangles.len().max(self.mesh.positions_m.len());
        let more = more.triangles.len().max(more.vertices.len());
        if so_far + more > MOST_TRIANGLES {
            let found = "it places more than 268 million triangles";
            return Err(Flaw::new(found, "must have fewer"));
        }
        Ok(())
    }

    /// The mesh, if it has a surface of a finite size. `without_surface` is the number of primitives that have none.
    pub(super) fn finished(self, without_surface: usize) -> Result<Mesh, Flaw> {
        if self.mesh.triangles.is_empty() && without_surface > 0 {
            let found = "it has points and lines, and no triangles";
            return Err(Flaw::new(
                found,
                "must have a surface: triangles that span an area",
            ));
        }
        if self.mesh.positions_m.iter().any(|p| !p.is_finite()) {
            return Err(Flaw::new(
                "it has vertices beyond the range of single precision",
                "must be of a finite size",
            ));
        }
        Ok(self.mesh)
    }
}
