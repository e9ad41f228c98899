//! Scratches and gratings of a mesh.

use std::fmt::Write;
use std::path::Path;

use bevy::log::warn;
use bevy::mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::BevyError;
use hairline_document::{Arrays, MeshArrays, description, lay_on_mesh, object_of_gratings};
use hairline_engine::{GratingTexels, LaidGrating, Pieces, ScratchTexels};
use hairline_optics::metal::Metal;
use hairline_scene::{DEFAULT_COHERENCE_UM, Scene};

/// Name of the mesh where a scene has a file.
const NAME: &str = "mesh";

/// The scratches and gratings of one mesh, in its own frame, with the tree that shaders find them by.
#[derive(Clone, Debug)]
pub struct Scratches {
    pub(crate) texels: ScratchTexels,
    pub(crate) gratings: Vec<GratingTexels>,
}

impl Scratches {
    /// Lays layers on a mesh whose unit is the metre. Each layer has the keys of a table `[[scratches]]` of a scene file (docs/scene.md),
    /// but `object`: `"pattern = 'random'\ncount = 1500"`, or `"pattern = 'file'\nfile = 'scratches.csv'"` for a list of your own. A seed means the same
    /// scratches as there.
    ///
    /// # Errors
    /// What is wrong with a layer, by its key, or that the mesh is not one of triangles with positions.
    pub fn on_mesh(mesh: &Mesh, layers: &[&str]) -> Result<Self, BevyError> {
        let text = tables("scratches", layers)?;
        let layers = description::Scratches::from_toml(&text, Path::new("layers of scratches"))?;
        let mut files = Arrays::default();
        files.read_pictures(&layers, Path::new("."))?;
        let pieces = Pieces::of_object(&lay_on_mesh(&arrays_of(mesh)?, &layers, &files, 1.0)?, 1.0);
        Ok(Self::of_pieces(&pieces, DEFAULT_COHERENCE_UM, 1.0)?)
    }

    pub(crate) fn of_pieces(
        pieces: &Pieces,
        coherence_um: f64,
        metres_per_unit: f64,
    ) -> Result<Self, hairline_engine::Error> {
        Ok(Self {
            texels: pieces.texels(coherence_um, metres_per_unit)?,
            gratings: Vec::new(),
        })
    }

    /// Adds rows of grooves, as of turned metal or a compact disc. Each has the keys of a table `[[grating]]` of a scene file, but `object`:
    /// `"pattern = 'circular'\npitch_um = 1.6\nwidth_um = 0.5\ndepth_nm = 110.0"`. Their spectra are those of the metal. Fine rows take seconds.
    ///
    /// # Errors
    /// What is wrong with a row, by its key.
    pub fn with_gratings(
        mut self,
        metal: Option<Metal>,
        gratings: &[&str],
    ) -> Result<Self, BevyError> {
        let text = tables("grating", gratings)?;
        let rows = description::Grating::from_toml(&text, Path::new("gratings"))?;
        let laid = LaidGrating::of_object(object_of_gratings(&rows), metal, DEFAULT_COHERENCE_UM);
        self.gratings.extend(drawn(laid));
        Ok(self)
    }

    /// Those of one of a scene's objects, in world space: for a mesh that is not moved. Gratings by texture coordinates, in spots and with masks
    /// are left out, which a warning tells.
    pub fn of_scene(scene: &Scene, object: usize) -> Self {
        Self {
            texels: ScratchTexels::of_scene(scene, object, 1.0),
            gratings: drawn(LaidGrating::of_scene(scene, object)),
        }
    }
}

/// Tables of a name on the mesh.
fn tables(name: &str, rows: &[&str]) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for row in rows {
        write!(text, "[[{name}]]\nobject = '{NAME}'\n{row}\n")?;
    }
    Ok(text)
}

/// Those that this package draws; a warning tells of others.
pub(crate) fn drawn(laid: Vec<Option<LaidGrating>>) -> Vec<GratingTexels> {
    let all = laid.into_iter().map(|it| it?.without_pictures());
    let all: Vec<_> = all.collect();
    if all.iter().any(Option::is_none) {
        warn!("not drawn: a grating by texture coordinates, in spots or with a mask");
    }
    all.into_iter().flatten().collect()
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
