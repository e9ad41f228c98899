//! KHR_materials_clearcoat: a clear layer over a material, by two factors and two textures.

use gltf::Document;
use gltf::json::Value;
use gltf::material::Material;

use super::flaw::Flaw;
use super::uv::{self, Way};
use crate::scene::Coat;

const NAME: &str = "KHR_materials_clearcoat";
/// As in [`crate::scene::Material::coat_textures`].
const TEXTURES: [&str; 2] = ["clearcoatTexture", "clearcoatRoughnessTexture"];

/// The factors; none where there is no layer.
pub(super) fn coat(material: &Material) -> Option<Coat> {
    let extension = material.extension_value(NAME)?;
    let factor = |name: &str| {
        let value = extension.get(name).and_then(Value::as_f64);
        value.unwrap_or(0.0).clamp(0.0, 1.0)
    };
    let coat = Coat {
        weight: factor("clearcoatFactor"),
        roughness: factor("clearcoatRoughnessFactor"),
    };
    (coat.weight > 0.0).then_some(coat)
}

/// The textures on the factors, and how each lies.
pub(super) fn textures<'a>(
    document: &'a Document,
    material: &Material,
) -> Result<[Option<(gltf::Texture<'a>, Way)>; 2], Flaw> {
    let mut textures = [None, None];
    for (texture, name) in textures.iter_mut().zip(TEXTURES) {
        let used = material.extension_value(NAME).and_then(|it| it.get(name));
        let Some((used, way)) = used.and_then(|used| Some((used, uv::of_json(used)?))) else {
            continue;
        };
        let index = used.get("index").and_then(Value::as_u64);
        let index = index.and_then(|index| usize::try_from(index).ok());
        let known = index.and_then(|index| document.textures().nth(index));
        let known = known.ok_or_else(|| {
            let found = format!("a {name} is a texture that is not there");
            Flaw::new(found, super::RIGHT)
        })?;
        *texture = Some((known, way));
    }
    Ok(textures)
}

/// How the textures of a layer lie.
pub(super) fn ways(material: &Material) -> impl Iterator<Item = Way> {
    let extension = material
        .extension_value(NAME)
        .filter(|_| coat(material).is_some());
    TEXTURES
        .into_iter()
        .filter_map(move |name| uv::of_json(extension?.get(name)?))
}
