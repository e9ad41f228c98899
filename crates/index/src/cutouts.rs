//! Where surfaces are not: rays go on through what is cut out of a triangle.

use std::sync::Arc;

use hairline_scene::{Cutout, Material, Mesh, Scene, Texture};

use crate::hit::Hit;

/// What tells whether a surface is there, for scenes in which something is cut out.
pub(crate) struct Cutouts {
    meshes: Vec<Arc<Mesh>>,
    materials: Vec<Option<(Material, Cutout)>>,
    textures: Arc<Vec<Texture>>,
}

impl Cutouts {
    /// None where every surface is whole.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let cut = |material: &Material| Some((material.clone(), material.cutout?));
        let materials: Vec<_> = scene.materials.iter().map(cut).collect();
        materials.iter().any(Option::is_some).then(|| Self {
            meshes: scene.objects.iter().map(|o| o.mesh.clone()).collect(),
            materials,
            textures: scene.textures.clone(),
        })
    }

    /// Whether a surface is there where a ray meets its triangle.
    pub(crate) fn is_there(&self, hit: &Hit) -> bool {
        let mesh = &self.meshes[hit.object as usize];
        let material = mesh.triangle_materials[hit.triangle as usize];
        let Some((material, cutout)) = &self.materials[material as usize] else {
            return true;
        };
        let triangle = mesh.triangles[hit.triangle as usize];
        let [u, v] = hit.barycentric;
        let weights = [1.0 - u - v, u, v];
        cutout.is_there(material, &self.textures, mesh, triangle, weights)
    }
}
