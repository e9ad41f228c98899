//! Scratches on a mesh.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use bevy::mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::BevyError;
use hairline_gpu::scratch_tree;
use hairline_index::ScratchIndex;
use hairline_optics::section::GrooveShape;
use hairline_scene::{
    Arrays, Description, GrooveShapes, Loader, MeshArrays, Scene, SceneBuilder,
};

/// Name of the mesh where a scene has a file.
const NAME: &str = "mesh";
/// Rest of the scene; no picture is rendered of it, so nothing lights it.
const REST: &str = "
studio = { hidden = true }
camera = { position_m = [0.0, 0.0, 1.0], target_m = [0.0, 0.0, 0.0], up = [0.0, 1.0, 0.0] }
material = [{ name = 'material', kind = 'mirror' }]
object = [{ name = 'mesh', mesh = 'mesh', material = 'material' }]
";

/// The scratches of one mesh, in its own frame, with the tree that shaders find them by.
#[derive(Clone, Debug)]
pub struct Scratches {
    pub(crate) texels: Vec<[u32; 4]>,
    /// Shapes of the grooves, each with a layer of the spectra.
    pub(crate) shapes: Vec<GrooveShape>,
}

impl Scratches {
    /// Lays layers on a mesh whose unit is the metre. Each layer has the keys of a table `[[scratches]]` of a scene file (docs/scene.md),
    /// but `object`: `"pattern = 'random'\ncount = 1500"`, or `"pattern = 'file'\nfile = 'scratches.csv'"` for a list of your own.
    ///
    /// # Errors
    /// What is wrong with a layer, by its key, or that the mesh is not one of triangles with positions.
    pub fn on_mesh(mesh: &Mesh, layers: &[&str]) -> Result<Self, BevyError> {
        let mut text = String::from(REST);
        for layer in layers {
            write!(text, "[[scratches]]\nobject = 'mesh'\n{layer}\n")?;
        }
        let description = Description::from_toml(&text, Path::new("layers of scratches"))?;
        let mut arrays = Arrays::default();
        arrays.insert_mesh(NAME, Arc::new(arrays_of(mesh)?));
        let loader = Loader {
            arrays: &arrays,
            ..Loader::default()
        };
        let scene = SceneBuilder::new().build(&loader, &description, Path::new("."))?;
        Ok(Self::of_scene(&scene, 0))
    }

    /// Those of one of a scene's objects, in world space: for a mesh that is not moved.
    pub fn of_scene(scene: &Scene, object: usize) -> Self {
        Self {
            texels: scratch_tree::texels(&ScratchIndex::build(scene), object),
            shapes: GrooveShapes::new(scene).shapes().collect(),
        }
    }
}

fn arrays_of(mesh: &Mesh) -> Result<MeshArrays, BevyError> {
    if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
        let found = mesh.primitive_topology();
        return Err(format!("mesh: found {found:?}; must be a list of triangles").into());
    }
    let three = |attribute| match mesh.attribute(attribute) {
        Some(VertexAttributeValues::Float32x3(rows)) => Some(
            rows.iter()
                .map(|row| row.map(f64::from))
                .collect::<Vec<_>>(),
        ),
        _ => None,
    };
    let positions = three(Mesh::ATTRIBUTE_POSITION)
        .ok_or("mesh: found no positions; must have three f32 for each vertex")?;
    let indices: Vec<u32> = match mesh.indices() {
        Some(Indices::U16(indices)) => indices.iter().map(|i| u32::from(*i)).collect(),
        Some(Indices::U32(indices)) => indices.clone(),
        None => (0..positions.len() as u32).collect(),
    };
    let (triangles, _) = indices.as_chunks::<3>();
    let normals = three(Mesh::ATTRIBUTE_NORMAL);
    Ok(MeshArrays::new(
        positions,
        triangles.to_vec(),
        normals,
        None,
    )?)
}
