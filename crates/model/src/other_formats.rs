//! Models of other formats, made into glTF in memory: whatever reads glTF reads them.

mod creased;
mod obj;
mod stl;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::flaw::Flaw;
use crate::gltf_file::GltfFile;
use crate::packed;

/// A model's file as glTF.
#[derive(Debug, Default)]
pub(crate) struct Translated {
    /// A glTF file, text or binary.
    pub bytes: Vec<u8>,
    /// The files that it names in turn and that were read already.
    pub files: Vec<PathBuf>,
    /// Notes for its author, a line each.
    pub notes: Vec<String>,
}

/// A format by the ending of a file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OtherFormat {
    /// Wavefront's, with materials in .mtl files.
    Obj,
    /// Of 3D printers: triangles alone.
    Stl,
}

impl OtherFormat {
    /// The format of the file that a path leads into; none of glTF and of unknown ones.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let file = packed::file_of(path);
        let ending = file.extension()?;
        let formats = [("obj", Self::Obj), ("stl", Self::Stl)];
        let found = formats
            .iter()
            .find(|(name, _)| ending.eq_ignore_ascii_case(name));
        found.map(|(_, format)| *format)
    }

    /// Makes glTF of a file's bytes.
    pub(crate) fn translated(self, path: &Path, bytes: &[u8]) -> Result<Translated, Flaw> {
        match self {
            Self::Obj => obj::translated(bytes, folder(path)),
            Self::Stl => stl::translated(bytes),
        }
    }

    /// The files that a file names, each with its use; none where it cannot be read.
    pub(crate) fn names(self, path: &Path) -> Vec<(String, PathBuf)> {
        match self {
            Self::Obj => obj::names(path, folder(path)).unwrap_or_default(),
            Self::Stl => Vec::new(),
        }
    }

    /// Bytes of a file for each triangle, at least.
    pub(crate) fn bytes_a_triangle(self) -> f64 {
        match self {
            // `f 1 2 3`, and half a vertex.
            Self::Obj => 20.0,
            Self::Stl => 50.0,
        }
    }
}

fn folder(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// A steel-like metal, for what has no material: scratches show on it.
fn bare_metal() -> Value {
    json!({
        "name": "metal",
        "pbrMetallicRoughness": { "baseColorFactor": [0.56, 0.57, 0.58, 1.0], "metallicFactor": 1.0, "roughnessFactor": 0.3 },
    })
}

/// Triangles of one material, in the file's own unit.
#[derive(Default)]
struct Part {
    name: String,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    /// None, or one a vertex.
    uvs: Vec<[f32; 2]>,
    /// None, or one a vertex; linear.
    colors: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    material: usize,
}

/// Adds a part as a mesh with a node, and returns the node's number.
fn push_part(file: &mut GltfFile, part: &Part) -> usize {
    let positions = file.push_floats(part.positions.as_flattened(), 3, true);
    let normals = file.push_floats(part.normals.as_flattened(), 3, false);
    let mut attributes = json!({ "POSITION": positions, "NORMAL": normals });
    if !part.uvs.is_empty() {
        attributes["TEXCOORD_0"] = json!(file.push_floats(part.uvs.as_flattened(), 2, false));
    }
    if !part.colors.is_empty() {
        attributes["COLOR_0"] = json!(file.push_floats(part.colors.as_flattened(), 3, false));
    }
    let indices = file.push_wholes(part.triangles.as_flattened());
    let primitive =
        json!({ "attributes": attributes, "indices": indices, "material": part.material });
    let mesh = file.push("meshes", json!({ "primitives": [primitive] }));
    file.push("nodes", json!({ "name": part.name, "mesh": mesh }))
}

/// Puts nodes into the scene, and the file into bytes.
fn finished(mut file: GltfFile, nodes: Vec<usize>) -> Result<Vec<u8>, Flaw> {
    file.set_root_nodes(nodes);
    file.to_glb()
}

/// A file to be filled.
fn begun() -> GltfFile {
    let mut file = GltfFile::new("Hairline");
    file.pushes_own = true;
    file
}
