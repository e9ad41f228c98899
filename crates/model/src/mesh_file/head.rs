//! Size and files of a glTF file by its text, before its contents are read.

use std::io::Read;
use std::path::PathBuf;

use gltf::json::deserialize::from_slice;
use gltf::json::mesh::Mode;
use gltf::json::validation::Checked::Valid;
use gltf::json::{Index, Root, Value, mesh::Primitive, mesh::Semantic};
use hairline_image::FilePath;

use super::instances;
use super::left_out::{self, LeftOut, UsedContents};
use super::leniency::{drop_order_mark, drop_padding};
use super::root::{self, OptionalElements};
use super::source::{is_data, resolve_uri};
use crate::other_formats::OtherFormat;
use crate::packed;
use crate::reading::check_regular;

/// A longer text than this is no description of a model.
const LONGEST_TEXT: u64 = 1 << 30;
/// Memory for the text while it is read, over its length.
const TEXT_BYTES: f64 = 8.0;

/// Numbers of triangles and vertices that a file places, and the memory for reading it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FileCounts {
    /// Triangles of all places.
    pub triangles: f64,
    /// Vertices of all places.
    pub vertices: f64,
    /// Memory of the file's text and buffers.
    pub bytes: f64,
}

/// Counts the triangles and vertices that a glTF file places; `None` where it cannot be read.
pub fn counts(path: &FilePath) -> Option<FileCounts> {
    if let Some(format) = OtherFormat::from_path(path) {
        return of_length(path, format);
    }
    let (root, text_bytes) = head(path)?;
    let mut counts = FileCounts {
        bytes: text_bytes * TEXT_BYTES,
        ..FileCounts::default()
    };
    for buffer in &root.buffers {
        // A binary chunk is there twice while it is read.
        counts.bytes += 2.0 * buffer.byte_length.0 as f64;
    }
    for node in &root.nodes {
        let mesh = node.mesh.and_then(|mesh| root.meshes.get(mesh.value()));
        let instances = instances(&root, node);
        for primitive in mesh.into_iter().flat_map(|mesh| &mesh.primitives) {
            counts.add(&root, primitive, instances);
        }
    }
    Some(counts)
}

/// Counts what a file of another format has at most, by its length.
fn of_length(path: &FilePath, format: OtherFormat) -> Option<FileCounts> {
    check_regular(path).ok()?;
    let length = path.facts().ok()?.length.unwrap_or(0) as f64;
    let triangles = length / format.bytes_a_triangle();
    Some(FileCounts {
        triangles,
        vertices: 3.0 * triangles,
        // The text, its glTF, and what is read of that.
        bytes: TEXT_BYTES * length,
    })
}

/// Number of times that EXT_mesh_gpu_instancing places a node's mesh.
fn instances(root: &Root, node: &gltf::json::Node) -> f64 {
    let count = || {
        let others = &node.extensions.as_ref()?.others;
        let attributes = others.get(instances::NAME)?.get("attributes")?;
        let index = attributes.as_object()?.values().next()?.as_u64()?;
        let accessor = root.accessors.get(usize::try_from(index).ok()?)?;
        Some(accessor.count.0 as f64)
    };
    count().unwrap_or(1.0)
}

impl FileCounts {
    fn add(&mut self, root: &Root, primitive: &Primitive, instances: f64) {
        let count = |index: Index<gltf::json::Accessor>| {
            let accessor = root.accessors.get(index.value());
            accessor.map_or(0.0, |accessor| accessor.count.0 as f64)
        };
        let attribute = |semantic| primitive.attributes.get(&Valid(semantic)).copied();
        let vertices = attribute(Semantic::Positions).map_or(0.0, count);
        let corners = primitive.indices.map_or(vertices, count);
        let triangles = match primitive.mode {
            Valid(Mode::Triangles) => corners / 3.0,
            Valid(Mode::TriangleStrip | Mode::TriangleFan) => corners,
            _ => 0.0,
        };
        self.triangles += instances * triangles.floor();
        let vertices = match attribute(Semantic::Normals) {
            Some(_) => vertices,
            // Without indices each triangle has its own vertices.
            None => 3.0 * triangles,
        };
        self.vertices += instances * vertices;
    }
}

/// The files that a glTF file names, each with its use; none where it cannot be read.
pub fn names(path: &FilePath) -> Vec<(String, PathBuf)> {
    if let Some(format) = OtherFormat::from_path(path) {
        return format.names(path);
    }
    let Some((root, _)) = head(path) else {
        return Vec::new();
    };
    let base_dir = packed::file_of(path).folder();
    let named = |what: &'static str, i: usize, uri: &Option<String>| {
        let uri = uri.as_deref().filter(|uri| !is_data(uri))?;
        Some((
            format!("{what} {i}"),
            resolve_uri(uri, &base_dir).to_path_buf(),
        ))
    };
    let buffers = (0..)
        .zip(&root.buffers)
        .filter_map(|(i, it)| named("buffer", i, &it.uri));
    let images = (0..)
        .zip(&root.images)
        .filter_map(|(i, it)| named("image", i, &it.uri));
    buffers.chain(images).collect()
}

/// Names of the perspective cameras of a file: their own, else their nodes', else their numbers.
pub fn camera_names(path: &FilePath) -> Vec<String> {
    let Some((root, _)) = head(path) else {
        return Vec::new();
    };
    let name = |node: &gltf::json::Node| {
        let index = node.camera?.value();
        let camera = root.cameras.get(index)?;
        camera.perspective.as_ref()?;
        let name = camera.name.clone().or_else(|| node.name.clone());
        Some(name.unwrap_or_else(|| index.to_string()))
    };
    root.nodes.iter().filter_map(name).collect()
}

/// Lists the contents of a glTF file that the picture does not have; empty where it cannot be read.
pub fn left_out(path: &FilePath, wanted: UsedContents) -> Vec<LeftOut> {
    let root = text(path).and_then(|text| from_slice(&text).ok());
    root.map_or_else(Vec::new, |root| left_out::list_left_out(&root, wanted))
}

/// Reads the text, and returns its length too.
fn head(path: &FilePath) -> Option<(Root, f64)> {
    let text = text(path)?;
    Some((
        root::read(&text, OptionalElements::default()).ok()?,
        text.len() as f64,
    ))
}

/// The text of a .gltf file, or the first chunk of a .glb file.
fn text(path: &FilePath) -> Option<Vec<u8>> {
    match packed::split(path) {
        Some((file, name)) => alone(&whole_text(&file)?, &name),
        None => whole_text(path),
    }
}

/// The text of a model in a file, by the text of the file.
pub(super) fn alone(text: &[u8], name: &str) -> Option<Vec<u8>> {
    let root: Value = from_slice(text).ok()?;
    Some(packed::alone(root, name)?.to_string().into_bytes())
}

/// The text of a file with all that it holds; none of another format than glTF.
pub(crate) fn whole_text(path: &FilePath) -> Option<Vec<u8>> {
    if OtherFormat::from_path(path).is_some() {
        return None;
    }
    check_regular(path).ok()?;
    let mut file = path.open().ok()?;
    let mut start = [0; 20];
    file.read_exact(&mut start).ok()?;
    let mut text = Vec::new();
    if start.starts_with(b"glTF") {
        let length = u32::from_le_bytes([start[12], start[13], start[14], start[15]]);
        file.take(u64::from(length).min(LONGEST_TEXT))
            .read_to_end(&mut text)
            .ok()?;
        drop_padding(&mut text);
    } else {
        text.extend(start);
        file.take(LONGEST_TEXT).read_to_end(&mut text).ok()?;
        drop_order_mark(&mut text);
    }
    Some(text)
}
