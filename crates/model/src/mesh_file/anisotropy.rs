//! KHR_materials_anisotropy: highlights that are drawn out one way, by two factors and a texture.

use gltf::json::Value;
use gltf::material::Material;

use crate::material::Anisotropy;

pub(super) const NAME: &str = "KHR_materials_anisotropy";
pub(super) const TEXTURE: &str = "anisotropyTexture";

/// The factors; none where highlights are alike in all directions.
pub(super) fn anisotropy(material: &Material) -> Option<Anisotropy> {
    let extension = material.extension_value(NAME)?;
    let number = |name: &str| {
        let value = extension.get(name).and_then(Value::as_f64);
        value.filter(|x| x.is_finite()).unwrap_or(0.0)
    };
    let anisotropy = Anisotropy {
        strength: number("anisotropyStrength").clamp(0.0, 1.0),
        direction_deg: number("anisotropyRotation").to_degrees(),
    };
    (anisotropy.strength > 0.0).then_some(anisotropy)
}

/// Returns the JSON of the texture of a material's anisotropy, if it has one.
pub(super) fn texture<'a>(material: &'a Material<'a>) -> Option<&'a Value> {
    anisotropy(material)?;
    material.extension_value(NAME)?.get(TEXTURE)
}
