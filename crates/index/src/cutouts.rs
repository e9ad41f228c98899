//! Cutouts: rays go on through the parts that are cut out of a triangle, or cover only a share of what lies behind.

use std::sync::Arc;

use hairline_scene::{AlphaRule, Cutout, Material, Mesh, Scene, Texture};

use crate::coverage::Coverage;
use crate::hit::Hit;

/// Materials and textures by which surfaces are cut out, for scenes that have such.
pub(crate) struct Cutouts {
    meshes: Vec<Arc<Mesh>>,
    /// Index of each object's first triangle among those of all objects.
    firsts: Vec<u32>,
    materials: Vec<Option<(Material, Cutout)>>,
    textures: Arc<Vec<Texture>>,
}

impl Cutouts {
    /// Finds the cutouts of a scene; none where every surface is whole.
    pub(crate) fn from_scene(scene: &Scene) -> Option<Self> {
        let cut = |material: &Material| Some((material.clone(), material.cutout?));
        let materials: Vec<_> = scene.materials.iter().map(cut).collect();
        let mut next = 0;
        let mut first = |mesh: &Mesh| {
            let first = next;
            next += mesh.triangles.len() as u32;
            first
        };
        materials.iter().any(Option::is_some).then(|| Self {
            meshes: scene.objects.iter().map(|o| o.mesh.clone()).collect(),
            firsts: scene.objects.iter().map(|o| first(&o.mesh)).collect(),
            materials,
            textures: scene.textures.clone(),
        })
    }

    fn of_hit(&self, hit: &Hit) -> Option<&(Material, Cutout)> {
        let mesh = &self.meshes[hit.object as usize];
        let material = mesh.triangle_materials[hit.triangle as usize];
        self.materials[material as usize].as_ref()
    }

    /// Whether a ray meets the surface where it meets its triangle.
    pub(crate) fn is_there(&self, hit: &Hit, coverage: Coverage) -> bool {
        let Some((material, cutout)) = self.of_hit(hit) else {
            return true;
        };
        let mesh = &self.meshes[hit.object as usize];
        let triangle = mesh.triangles[hit.triangle as usize];
        let [u, v] = hit.barycentric;
        let weights = [1.0 - u - v, u, v];
        let alpha = cutout.alpha_at(material, &self.textures, mesh, triangle, weights);
        match cutout.rule {
            AlphaRule::AtLeast(least) => alpha >= least,
            AlphaRule::Share => {
                let number = self.firsts[hit.object as usize] + hit.triangle;
                coverage.meets(alpha, number, hit.object)
            }
        }
    }

    /// Whether the surface may cover only a part of what lies behind it.
    pub(crate) fn is_partial(&self, hit: &Hit) -> bool {
        matches!(self.of_hit(hit), Some((_, cutout)) if cutout.rule == AlphaRule::Share)
    }
}
