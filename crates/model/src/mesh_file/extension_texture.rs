//! Textures in extensions of materials that the gltf crate does not read.

use gltf::Document;
use gltf::json::Value;

use super::uv::{self, UvMapping};
use crate::flaw::{Flaw, RIGHT};

/// The texture of a use, and its mapping; `of` names its owner.
pub(super) fn used<'a>(
    document: &'a Document,
    used: Option<&Value>,
    of: &str,
) -> Result<Option<(gltf::Texture<'a>, UvMapping)>, Flaw> {
    let Some((used, mapping)) = used.and_then(|used| Some((used, uv::of_json(used)?))) else {
        return Ok(None);
    };
    let index = used.get("index").and_then(Value::as_u64);
    let index = index.and_then(|index| usize::try_from(index).ok());
    let known = index.and_then(|index| document.textures().nth(index));
    let texture =
        known.ok_or_else(|| Flaw::new(format!("a texture of its {of} is not there"), RIGHT))?;
    Ok(Some((texture, mapping)))
}

/// [`used`] for two textures.
pub(super) fn both_used<'a>(
    document: &'a Document,
    [first, second]: [Option<&Value>; 2],
    of: &str,
) -> Result<[Option<(gltf::Texture<'a>, UvMapping)>; 2], Flaw> {
    Ok([used(document, first, of)?, used(document, second, of)?])
}
