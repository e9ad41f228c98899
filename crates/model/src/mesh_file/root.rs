//! The text of a glTF file made ready for the crate that validates it: ignored contents cannot make a file unusable, and the reason
//! of an unusable one is named.

use gltf::json::deserialize::{from_slice, from_value};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, Value};

use super::channels;
use super::draco;
use super::leniency;
use crate::flaw::{Flaw, RIGHT};
use crate::text::shown;

/// Reads the text of a file; contents that are not kept may be broken.
pub(super) fn read(text: &[u8], kept: OptionalElements) -> Result<Root, Flaw> {
    let invalid = |error: &dyn std::fmt::Display| {
        Flaw::new(
            format!("it is no valid glTF ({})", shown(&error.to_string())),
            RIGHT,
        )
    };
    if let Ok(root) = from_slice::<Root>(text)
        && !(kept.animations && has_unknown_paths(&root))
    {
        check_version(&root.asset.version)?;
        check_least_version(root.asset.min_version.as_deref())?;
        return Ok(root);
    }
    let mut value: Value = from_slice(text).map_err(|error| invalid(&error))?;
    leniency::loosen_text(&mut value);
    let of_asset = |name| value.get("asset")?.get(name)?.as_str();
    check_version(of_asset("version").unwrap_or("1.0"))?;
    check_least_version(of_asset("minVersion"))?;
    channels::keep_of_nodes(&mut value);
    let error = match from_value::<Root>(value.clone()) {
        Ok(root) => return Ok(root),
        Err(error) => error,
    };
    // Animations may have any form if the model is at rest.
    let Some(members) = value
        .as_object_mut()
        .filter(|it| !kept.animations && it.contains_key("animations"))
    else {
        return Err(invalid(&error));
    };
    members.remove("animations");
    from_value(value).map_err(|error| invalid(&error))
}

/// Whether a channel has a target that the specification has no name for.
fn has_unknown_paths(root: &Root) -> bool {
    let mut channels = root.animations.iter().flat_map(|it| &it.channels);
    channels.any(|it| matches!(it.target.path, Checked::Invalid))
}

/// Checks the version. All files of version 2 are made so that a reader of 2.0 can read them.
fn check_version(version: &str) -> Result<(), Flaw> {
    match version.split('.').next() {
        Some("2") => Ok(()),
        _ => Err(wrong_version(version)),
    }
}

/// Checks the least glTF version that a reader must support (glTF 2.0, section 3.2).
fn check_least_version(least: Option<&str>) -> Result<(), Flaw> {
    match least {
        None | Some("2.0") => Ok(()),
        Some(least) => Err(Flaw::new(
            format!("it needs a reader of glTF {}", shown(least)),
            "must need no more than glTF 2.0: export it again",
        )),
    }
}

pub(super) fn wrong_version(version: &str) -> Flaw {
    Flaw::new(
        format!("it is a file of glTF {}", shown(version)),
        "must be glTF 2.0: export it again, or convert it (glTF-Pipeline does)",
    )
}

/// Elements of a file that are kept because the scene uses them: an error in one of them makes the file unusable.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct OptionalElements {
    pub animations: bool,
    pub cameras: bool,
}

/// Removes the animations and cameras that are not kept.
pub(super) fn leave_out_what_is_ignored(root: &mut Root, kept: OptionalElements) {
    if !kept.animations {
        root.animations.clear();
    }
    if !kept.cameras {
        root.cameras.clear();
        for node in &mut root.nodes {
            node.camera = None;
        }
    }
}

/// Extensions that give a texture its image.
const IMAGES_BY: [&str; 2] = ["EXT_texture_webp", "KHR_texture_basisu"];

/// Sets the image of each texture, which may be named by an extension.
pub(super) fn find_images(root: &mut Root) -> Result<(), Flaw> {
    let images = root.images.len();
    for (i, texture) in root.textures.iter_mut().enumerate() {
        let others = texture
            .extensions
            .as_ref()
            .map(|extensions| &extensions.others);
        let named = |extension: &str| {
            let source = others?.get(extension)?.get("source")?.as_u64()?;
            u32::try_from(source)
                .ok()
                .filter(|source| (*source as usize) < images)
        };
        if texture.source.value() < images {
            continue;
        }
        if let Some(source) = IMAGES_BY.into_iter().find_map(named) {
            texture.source = Index::new(source);
            continue;
        }
        // A texture whose image is not read is reported with the image's extension.
        let mut others = others.into_iter().flatten();
        let other = others.find(|it| !IMAGES_BY.contains(&it.0.as_str()) && named(it.0).is_some());
        return Err(match other {
            Some((name, _)) => Flaw::new(
                format!(
                    "its texture {i} has an image by the extension {} alone, which is not supported",
                    shown(name)
                ),
                "must have a PNG, JPEG, WebP or KTX2 image (ETC1S or UASTC)",
            ),
            None => Flaw::new(
                format!("its texture {i} has no image that is there"),
                "must have a `source` below the number of images",
            ),
        });
    }
    Ok(())
}

/// Sets the view of the accessors whose values Draco packs: the crate knows none without a view.
pub(super) fn find_packed_views(root: &mut Root) {
    let mut packed = Vec::new();
    for primitive in root.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let extensions = primitive.extensions.as_ref();
        let Some(extension) = extensions.and_then(|it| it.others.get(draco::NAME)) else {
            continue;
        };
        let view = extension.get("bufferView").and_then(Value::as_u64);
        let Some(view) = view.and_then(|view| u32::try_from(view).ok()) else {
            continue;
        };
        let attributes = primitive.attributes.iter().filter(|(semantic, _)| {
            let names = extension.get("attributes");
            names.is_some_and(|names| names.get(semantic.to_string()).is_some())
        });
        let accessors = attributes
            .map(|(_, accessor)| accessor)
            .chain(&primitive.indices);
        packed.extend(accessors.map(|accessor| (accessor.value(), view)));
    }
    for (accessor, view) in packed {
        if let Some(accessor) = root.accessors.get_mut(accessor)
            && accessor.sparse.is_none()
        {
            accessor.buffer_view.get_or_insert(Index::new(view));
        }
    }
}
