//! glTF 2.0 and GLB files, after the specification of the Khronos Group (2021), and what is made into such.
//!
//! All nodes of the file's scene become one mesh with a material per triangle. What the file cannot be trusted with (bounds,
//! cycles, numbers that are none) is checked here: a broken file ends in a [`Flaw`], never in a panic. What is not read is told:
//! [`LeftOut`].

mod accessor;
mod anisotropy;
mod attributes;
mod baking;
mod cameras;
mod channels;
mod coat;
mod cutout;
mod draco;
mod elements;
mod extension_texture;
mod extensions;
mod head;
mod images;
mod instances;
mod left_out;
mod leniency;
mod lights;
mod material;
mod meshopt;
mod nodes;
mod notes;
mod placing;
mod pose;
mod primitive;
mod root;
mod shapes;
mod skin;
mod source;
mod spec_gloss;
mod specular;
mod stock;
mod tangents;
mod uv;

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

use glam::DMat4;
use gltf::Gltf;
use hairline_image::FilePath;

pub use crate::flaw::Flaw;
use crate::flaw::RIGHT;
use crate::mesh::Mesh;
use crate::other_formats::{OtherFormat, Translated};
use crate::packed;
use crate::reading::{self, FileKind};
use crate::text::shown;
use baking::Baking;
pub use cameras::FileCamera;
pub(crate) use head::whole_text;
pub use head::{camera_names, counts, left_out, names};
use images::Images;
pub use left_out::LeftOut;
pub use left_out::UsedContents;
pub(crate) use leniency::drop_order_mark;
pub use lights::{Punctual, PunctualKind};
use material::Materials;
pub use placing::{Placing, quarter_turn};
use root::OptionalElements;
use shapes::Shapes;
use source::Buffers;
pub(crate) use source::resource;
use stock::FILE_SHARE;
pub use stock::FileContents;

/// Reads a file's triangles into world space. Without `material`, an index into the stock, the file's own are added there.
pub fn read(
    path: &FilePath,
    material: Option<u32>,
    world_from_object: &DMat4,
    placing: &Placing,
    stock: FileContents,
) -> Result<Mesh, Flaw> {
    let kept = OptionalElements {
        animations: placing.time_s.is_some(),
        cameras: false,
    };
    let (gltf, translated) = parse(path, kept)?;
    let base_dir = &folder(path);
    let FileContents {
        parts,
        materials,
        textures,
        files,
        moved_from,
        notes,
        free_bytes,
        with_mips,
    } = stock;
    files.extend(translated.files);
    notes.extend(translated.notes);
    let buffers = Buffers::read(&gltf, base_dir, files)?;
    let first_own = materials.len();
    let images = Images {
        base_dir,
        buffers: &buffers,
        textures,
        files,
        free_bytes,
        with_mips,
        known: HashMap::new(),
    };
    let mut materials = match material {
        Some(material) => Materials::One(material),
        None => Materials::own(&gltf.document, images, materials),
    };
    let shapes = Shapes::new(&gltf.document, &buffers, placing.moment())?;
    let start = placing.start(&shapes, world_from_object)?;
    let mut baking = Baking {
        world_from_file: *world_from_object * start.object_from_file,
        mesh: Mesh::default(),
        parts,
        turned: 0,
        missing_sets: BTreeMap::new(),
    };
    *moved_from = start.moved_from;
    notes.extend(start.moved_from.map(notes::moved));
    let without_surface = shapes.visit(&mut |shape| baking.bake(shape, &mut materials))?;
    materials.forget_whole(first_own, &baking.mesh);
    if material.is_none() {
        let missing_sets = std::mem::take(&mut baking.missing_sets);
        notes.extend(missing_sets.into_iter().map(notes::missing_set));
    }
    notes.extend((baking.turned > 0).then(|| notes::turned(baking.turned)));
    baking.finished(without_surface)
}

/// A camera of a file, in world space.
pub fn camera(
    path: &FilePath,
    world_from_object: &DMat4,
    placing: &Placing,
    wanted: &str,
) -> Result<FileCamera, Flaw> {
    let kept = OptionalElements {
        animations: placing.time_s.is_some(),
        cameras: true,
    };
    let (gltf, _) = parse(path, kept)?;
    let buffers = Buffers::read(&gltf, &folder(path), &mut Vec::new())?;
    let shapes = Shapes::new(&gltf.document, &buffers, placing.moment())?;
    let start = placing.start(&shapes, world_from_object)?;
    let world_from_file = *world_from_object * start.object_from_file;
    Ok(shapes.camera(wanted)?.moved(&world_from_file))
}

/// The transform of a file's contents to the object that they are.
pub fn object_from_file(
    path: &FilePath,
    world_from_object: &DMat4,
    placing: &Placing,
) -> Result<DMat4, Flaw> {
    let kept = OptionalElements {
        animations: placing.time_s.is_some(),
        cameras: false,
    };
    let (gltf, _) = parse(path, kept)?;
    let buffers = Buffers::read(&gltf, &folder(path), &mut Vec::new())?;
    let shapes = Shapes::new(&gltf.document, &buffers, placing.moment())?;
    Ok(placing.start(&shapes, world_from_object)?.object_from_file)
}

/// The lights of a file, in its own frame.
pub fn lights(path: &FilePath) -> Result<Vec<Punctual>, Flaw> {
    lights::read_lights(&parse(path, OptionalElements::default())?.0.document)
}

/// The folder from which a file's own paths start.
fn folder(path: &FilePath) -> FilePath {
    packed::file_of(path).folder()
}

/// A file as glTF.
pub(crate) fn file(path: &FilePath) -> Result<Translated, Flaw> {
    packed::refuse_other_model(path)?;
    let mut bytes = reading::read(path, FileKind::File, FILE_SHARE).map_err(|error| {
        Flaw::new(
            format!("it cannot be read ({error})"),
            "give the path of a .gltf, .glb, .obj or .stl file, relative to the scene file",
        )
    })?;
    drop_order_mark(&mut bytes);
    match OtherFormat::from_path(path) {
        Some(_) if bytes.is_empty() => Err(Flaw::new("it is empty", "must be a whole file")),
        Some(format) => format.translated(path, &bytes),
        None => Ok(Translated {
            bytes,
            ..Translated::default()
        }),
    }
}

/// The text of a file, and its binary chunk.
type GltfChunks<'a> = (Cow<'a, [u8]>, Option<Vec<u8>>);

/// Takes a file apart.
pub(crate) fn chunks(bytes: &[u8]) -> Result<GltfChunks<'_>, Flaw> {
    let right = RIGHT;
    if bytes.is_empty() {
        return Err(Flaw::new("it is empty", right));
    }
    if bytes.starts_with(b"glTF") {
        if bytes.get(4..8) == Some(&[1, 0, 0, 0]) {
            return Err(root::wrong_version("1.0"));
        }
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
    if !bytes.starts_with(b"glTF") {
        return Ok((Cow::Borrowed(bytes), None));
    }
    // Bytes beyond the file's stated length do not belong to it.
    let length = u32::from_le_bytes([bytes[8], bytes[9], bytes[10], bytes[11]]);
    let bytes = &bytes[..bytes.len().min(length as usize)];
    let glb = gltf::binary::Glb::from_slice(bytes).map_err(|error| {
        let found = format!("it is no valid binary glTF ({error})");
        Flaw::new(found, RIGHT)
    })?;
    let mut json = glb.json.into_owned();
    leniency::drop_padding(&mut json);
    Ok((Cow::Owned(json), glb.bin.map(Cow::into_owned)))
}

pub(crate) fn no_model(name: &str) -> Flaw {
    let found = format!("it holds no model called \"{}\"", shown(name));
    Flaw::new(found, "must be one of the names in its HAIRLINE_scratches")
}

/// Reads the text of a file, or that of a model in it; and what else came of its translation, without the bytes.
fn parse(path: &FilePath, kept: OptionalElements) -> Result<(Gltf, Translated), Flaw> {
    let right = RIGHT;
    let part = packed::split(path);
    let mut translated = file(part.as_ref().map_or(path, |(file, _)| file))?;
    let bytes = std::mem::take(&mut translated.bytes);
    let (mut text, blob) = chunks(&bytes)?;
    if let Some((_, name)) = &part {
        text = Cow::Owned(head::alone(&text, name).ok_or_else(|| no_model(name))?);
    }
    let mut json = root::read(&text, kept)?;
    json.extensions_required
        .retain(|name| !extensions::may_be_required(name));
    if let Some(name) = json.extensions_required.first() {
        return Err(Flaw::new(
            format!(
                "it requires the extension {}, which is not supported",
                shown(name)
            ),
            "export it again without that",
        ));
    }
    root::leave_out_what_is_ignored(&mut json, kept);
    root::find_images(&mut json)?;
    root::find_packed_views(&mut json);
    leniency::loosen(&mut json);
    // Checks that the crate's own validation omits.
    let accessors = json.accessors.len();
    let mut primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    if primitives.any(|p| p.attributes.values().any(|a| a.value() >= accessors)) {
        let found = "an attribute refers to an accessor that is not there";
        return Err(Flaw::new(found, right));
    }
    let has_source = |image: &gltf::json::Image| image.buffer_view.is_some() || image.uri.is_some();
    if !json.images.iter().all(has_source) {
        let found = "an image has neither a `uri` nor a `bufferView`";
        return Err(Flaw::new(found, right));
    }
    let document = gltf::Document::from_json(json)
        .map_err(|error| Flaw::new(format!("it is no valid glTF ({error})"), right))?;
    Ok((Gltf { document, blob }, translated))
}
