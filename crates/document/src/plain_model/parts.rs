//! The triangles of an object by their materials.

use std::collections::HashMap;

use hairline_scene::Mesh;

/// The triangles of one material, with vertices of their own.
#[derive(Default)]
pub(super) struct Part {
    /// Number of the material.
    pub material: usize,
    /// Numbers of the mesh's vertices.
    pub vertices: Vec<usize>,
    /// Numbers in these, three a triangle.
    pub corners: Vec<u32>,
}

/// The parts of a mesh, in the order of their materials.
pub(super) fn parts(mesh: &Mesh) -> impl Iterator<Item = Part> {
    let materials = mesh.materials().into_iter();
    materials.map(|material| part(mesh, material))
}

fn part(mesh: &Mesh, material: usize) -> Part {
    let mut known = HashMap::new();
    let mut part = Part {
        material,
        ..Part::default()
    };
    let all = mesh.triangles.iter().zip(&mesh.triangle_materials);
    for (triangle, _) in all.filter(|(_, it)| **it as usize == material) {
        for vertex in triangle {
            let number = *known.entry(*vertex).or_insert_with(|| {
                part.vertices.push(*vertex as usize);
                part.vertices.len() as u32 - 1
            });
            part.corners.push(number);
        }
    }
    part
}
