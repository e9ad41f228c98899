//! Whether a file can be used, before a scene names it: all errors that loading would give, in less time.

use std::path::Path;

use glam::{DMat4, Vec3};

use crate::description::Description;
use crate::environment;
use crate::error::Error;
use crate::mesh_file::{self, Stock};

/// What a mesh file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSummary {
    /// Triangles that span an area, of all nodes of the file's scene.
    pub triangles: usize,
    /// The least and the greatest coordinates, in the file's own frame.
    pub bounds_m: (Vec3, Vec3),
    /// Names of the materials that the triangles use.
    pub materials: Vec<String>,
}

/// What an environment file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EnvironmentSummary {
    /// Width and height as in the file.
    pub size_px: [u32; 2],
}

/// Reads a .gltf or .glb file as an object would, buffers and images included.
///
/// # Errors
/// What is wrong with the file.
pub fn mesh(path: &Path) -> Result<MeshSummary, Error> {
    let (mut materials, mut textures) = (Vec::new(), Vec::new());
    let stock = Stock {
        materials: &mut materials,
        textures: &mut textures,
        files: &mut Vec::new(),
        with_mips: false,
    };
    let mesh = mesh_file::read(path, None, &DMat4::IDENTITY, stock)
        .map_err(|flaw| Error::new("", flaw.found, flaw.right).at(path, None))?;
    if mesh.triangles.is_empty() {
        let right = "must have triangles that span an area";
        return Err(Error::new("", "it has no surface", right).at(path, None));
    }
    Ok(MeshSummary {
        triangles: mesh.triangles.len(),
        bounds_m: mesh.bounds_m(),
        materials: materials.into_iter().map(|m| m.name).collect(),
    })
}

/// Reads an .hdr or .exr file as an environment would, down to its last pixel.
///
/// # Errors
/// What is wrong with the file.
pub fn environment(path: &Path) -> Result<EnvironmentSummary, Error> {
    let map = environment::read(path).map_err(|error| {
        // It says the path itself.
        let message = error.to_string();
        let found = message.strip_prefix(&format!("{}: ", path.display()));
        let right = "must be an equirectangular .hdr or .exr";
        Error::new("", found.unwrap_or(&message), right).at(path, None)
    })?;
    Ok(EnvironmentSummary {
        size_px: map.size_px,
    })
}

/// Reads a scene file: its form, its ranges, and the names that its tables call one another by. What its files hold is left
/// to [`mesh()`] and [`environment()`].
///
/// # Errors
/// What is wrong with the scene, with its line.
pub fn scene(path: &Path) -> Result<Description, Error> {
    let bytes = std::fs::read(path).map_err(|error| {
        let found = format!("cannot be read ({error})");
        Error::new("", found, "give the path of a scene file (TOML)").at(path, None)
    })?;
    let text = String::from_utf8(bytes).map_err(|_| {
        let right = "must be a scene file (TOML)";
        Error::new("", "it is no text", right).at(path, None)
    })?;
    let description = Description::from_toml(&text, path)?;
    description
        .check()
        .and_then(|()| description.check_references())
        .map_err(|error| error.in_scene_file(&text, path))?;
    Ok(description)
}
