//! glTF 2.0 and GLB files, after the specification of the Khronos Group (2021).
//!
//! All nodes of the file's scene become one mesh with a material per triangle. What the file cannot be trusted with (bounds,
//! cycles, numbers that are none) is checked here: a broken file ends in a [`Flaw`], never in a panic. Left out: skins and
//! morph targets (the rest pose is shown), vertex colours, alpha, texture transforms; points and lines are skipped.

mod accessor;
mod head;
mod material;
mod placing;
mod primitive;
mod root;
mod source;
mod tangents;

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use glam::{DMat4, DQuat, DVec3};
use gltf::Gltf;

use crate::reading::{self, Kind};
use crate::scene::{Material, Mesh, Texture};
use crate::text::shown;
pub(crate) use head::{counts, names};
use material::Materials;
pub(crate) use placing::Placing;
use source::Buffers;

/// What a file must be.
const RIGHT: &str = "must be a whole glTF 2.0 file, text (.gltf) or binary (.glb)";
/// Nodes may lie this deep within each other; more is taken for a mistake.
const DEEPEST: usize = 256;
/// Instances of meshes that one file may place; each is baked.
const MOST_TRIANGLES: usize = 1 << 28;
/// Of the free memory, what one file may take.
const FILE_SHARE: f64 = 1.0 / 4.0;
/// Extensions that are read. Quantization needs nothing done: the accessors read every component type.
const EXTENSIONS: [&str; 3] = [
    "KHR_mesh_quantization",
    "KHR_materials_emissive_strength",
    "EXT_texture_webp",
];

/// What is wrong with a file, and what would be right.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{found}")]
pub(crate) struct Flaw {
    pub found: String,
    pub right: String,
}

impl Flaw {
    fn new(found: impl Into<String>, right: impl Into<String>) -> Self {
        Self {
            found: found.into(),
            right: right.into(),
        }
    }
}

/// Where a file's own materials go.
pub(crate) struct Stock<'a> {
    pub materials: &'a mut Vec<Material>,
    pub textures: &'a mut Vec<Texture>,
    /// The files that it refers to and that were read.
    pub files: &'a mut Vec<PathBuf>,
    /// What textures may still take of the memory.
    pub free_bytes: f64,
    /// Whether textures get their mip chains, which take longer than the rest.
    pub with_mips: bool,
}

/// Reads a file's triangles into world space. Without `material`, an index into the stock, the file's own are added there.
pub(crate) fn read(
    path: &Path,
    material: Option<u32>,
    world_from_object: &DMat4,
    placing: &Placing,
    stock: Stock,
) -> Result<Mesh, Flaw> {
    let bytes = reading::read(path, Kind::File, FILE_SHARE).map_err(|error| {
        Flaw::new(
            format!("it cannot be read ({error})"),
            "give the path of a .gltf or .glb file, relative to the scene file",
        )
    })?;
    let gltf = parse(&bytes)?;
    let base_dir = path.parent().unwrap_or(Path::new(""));
    let buffers = Buffers::read(&gltf, base_dir, stock.files)?;
    let mut materials = match material {
        Some(material) => Materials::One(material),
        None => Materials::own(base_dir, &buffers, stock),
    };
    let mut mesh = Mesh::default();
    let mut without_surface = 0;
    let object_from_file = placing.object_from_file(&gltf.document, &buffers)?;
    for (node, world_from_node) in
        placed_meshes(&gltf.document, *world_from_object * object_from_file)?
    {
        for primitive in node.mesh().into_iter().flat_map(|mesh| mesh.primitives()) {
            let Some(surface) = primitive::read(&primitive, &buffers)? else {
                without_surface += 1;
                continue;
            };
            let so_far = mesh.triangles.len().max(mesh.positions_m.len());
            let more = surface.triangles.len().max(surface.vertices.len());
            if so_far + more > MOST_TRIANGLES {
                return Err(Flaw::new(
                    "it places more than 268 million triangles",
                    "must have fewer",
                ));
            }
            let material = materials.index(&primitive)?;
            surface.bake(&world_from_node, material, &mut mesh);
        }
    }
    if mesh.triangles.is_empty() && without_surface > 0 {
        let found = "it has points and lines, and no triangles";
        return Err(Flaw::new(
            found,
            "must have a surface: triangles that span an area",
        ));
    }
    if mesh.positions_m.iter().any(|p| !p.is_finite()) {
        return Err(Flaw::new(
            "it has vertices beyond the range of single precision",
            "must be of a finite size",
        ));
    }
    Ok(mesh)
}

fn parse(bytes: &[u8]) -> Result<Gltf, Flaw> {
    let right = RIGHT;
    if bytes.is_empty() {
        return Err(Flaw::new("it is empty", right));
    }
    if bytes.starts_with(b"glTF") {
        // The header of 12 bytes and a chunk header of 8; the length is the header's third number.
        let length = bytes
            .get(8..12)
            .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let Some(length) = length.filter(|length| *length >= 20) else {
            return Err(Flaw::new("it ends within its header", right));
        };
        if (bytes.len() as u64) < u64::from(length) {
            let found = format!("it is cut off: {} of {length} bytes are there", bytes.len());
            return Err(Flaw::new(found, right));
        }
    } else if !bytes.trim_ascii_start().starts_with(b"{") {
        return Err(Flaw::new("it is neither binary nor text glTF", right));
    }
    let (text, blob) = parts(bytes)?;
    let mut json = root::read(&text)?;
    json.extensions_required
        .retain(|name| !EXTENSIONS.contains(&name.as_str()));
    if let Some(name) = json.extensions_required.first() {
        return Err(Flaw::new(
            format!(
                "it requires the extension {}, which is not supported",
                shown(name)
            ),
            match name.as_str() {
                "KHR_texture_basisu" => "export it again with PNG, JPEG or WebP images",
                _ => "export it again without that",
            },
        ));
    }
    root::leave_out_what_is_ignored(&mut json);
    root::find_images(&mut json)?;
    // What the crate's own validation takes for granted.
    let accessors = json.accessors.len();
    let mut primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    if primitives.any(|p| p.attributes.values().any(|a| a.value() >= accessors)) {
        let found = "an attribute refers to an accessor that is not there";
        return Err(Flaw::new(found, right));
    }
    let has_source = |image: &gltf::json::Image| match image.buffer_view {
        Some(_) => image.mime_type.is_some(),
        None => image.uri.is_some(),
    };
    if !json.images.iter().all(has_source) {
        let found = "an image has neither a `uri` nor a `bufferView` with its `mimeType`";
        return Err(Flaw::new(found, right));
    }
    let document = gltf::Document::from_json(json)
        .map_err(|error| Flaw::new(format!("it is no valid glTF ({error})"), right))?;
    Ok(Gltf { document, blob })
}

/// The text of a file, and its binary chunk.
type Parts<'a> = (Cow<'a, [u8]>, Option<Vec<u8>>);

/// Takes a file apart.
fn parts(bytes: &[u8]) -> Result<Parts<'_>, Flaw> {
    if !bytes.starts_with(b"glTF") {
        return Ok((Cow::Borrowed(bytes), None));
    }
    if bytes.get(4..8) == Some(&[1, 0, 0, 0]) {
        return Err(root::wrong_version("1.0"));
    }
    let glb = gltf::binary::Glb::from_slice(bytes).map_err(|error| {
        let found = format!("it is no valid binary glTF ({error})");
        Flaw::new(found, RIGHT)
    })?;
    Ok((glb.json, glb.bin.map(Cow::into_owned)))
}

/// The nodes of the file's scene that have a mesh, with their transforms.
fn placed_meshes(
    document: &gltf::Document,
    world_from_object: DMat4,
) -> Result<Vec<(gltf::Node<'_>, DMat4)>, Flaw> {
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    let roots: Vec<_> = match scene {
        Some(scene) => scene.nodes().collect(),
        // A file without a scene is a library; then all that is nobody's child is shown.
        None => {
            let mut is_child = vec![false; document.nodes().len()];
            for child in document.nodes().flat_map(|node| node.children()) {
                is_child[child.index()] = true;
            }
            document
                .nodes()
                .filter(|node| !is_child[node.index()])
                .collect()
        }
    };
    let mut placed = Vec::new();
    let mut seen = vec![false; document.nodes().len()];
    let mut stack: Vec<_> = roots
        .into_iter()
        .rev()
        .map(|root| (root, world_from_object, 0))
        .collect();
    while let Some((node, world_from_parent, depth)) = stack.pop() {
        // Nodes form trees, so meeting one twice is a mistake, and might go on for ever.
        if depth > DEEPEST {
            return Err(Flaw::new(
                format!(
                    "its node {} lies more than {DEEPEST} nodes deep",
                    node.index()
                ),
                "export it again with fewer levels",
            ));
        }
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(Flaw::new(
                format!(
                    "its node {} is its own ancestor or has two parents",
                    node.index()
                ),
                "nodes must form trees",
            ));
        }
        let world_from_node = world_from_parent * parent_from_node(&node);
        for child in node.children().collect::<Vec<_>>().into_iter().rev() {
            stack.push((child, world_from_node, depth + 1));
        }
        if node.mesh().is_some() {
            placed.push((node, world_from_node));
        }
    }
    Ok(placed)
}

fn parent_from_node(node: &gltf::Node) -> DMat4 {
    match node.transform() {
        gltf::scene::Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        gltf::scene::Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => {
            let rotation = DQuat::from_array(rotation.map(f64::from));
            // Exporters round, and a zero quaternion has no direction.
            let rotation = match rotation.length() > 1e-6 {
                true => rotation.normalize(),
                false => DQuat::IDENTITY,
            };
            DMat4::from_scale_rotation_translation(
                DVec3::from_array(scale.map(f64::from)),
                rotation,
                DVec3::from_array(translation.map(f64::from)),
            )
        }
    }
}
