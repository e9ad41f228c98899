//! A model's file as glTF, put together of triangles and materials.

use hairline_image::FilePath;
use serde_json::{Value, json};

use crate::flaw::Flaw;
use crate::gltf_file::GltfFile;

/// A model's file as glTF.
#[derive(Debug, Default)]
pub(crate) struct Translated {
    /// A glTF file, text or binary.
    pub bytes: Vec<u8>,
    /// The files that it names in turn and that were read already.
    pub files: Vec<FilePath>,
    /// Notes for its author, a line each.
    pub notes: Vec<String>,
}

/// A steel-like metal, for what has no material: scratches show on it.
pub(super) fn bare_metal() -> Value {
    json!({
        "name": "metal",
        "pbrMetallicRoughness": { "baseColorFactor": [0.56, 0.57, 0.58, 1.0], "metallicFactor": 1.0, "roughnessFactor": 0.3 },
    })
}

/// Triangles of one material, in the file's own unit.
#[derive(Default)]
pub(super) struct Part {
    pub name: String,
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    /// None, or one a vertex.
    pub uvs: Vec<[f32; 2]>,
    /// None, or one a vertex; linear.
    pub colors: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub material: usize,
}

/// Adds a part as a mesh with a node, and returns the node's number.
pub(super) fn push_part(file: &mut GltfFile, part: &Part) -> usize {
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
pub(super) fn finished(mut file: GltfFile, nodes: Vec<usize>) -> Result<Vec<u8>, Flaw> {
    file.set_root_nodes(nodes);
    file.to_glb()
}

/// A file to be filled.
pub(super) fn begun() -> GltfFile {
    let mut file = GltfFile::new("Hairline");
    file.pushes_own = true;
    file
}
