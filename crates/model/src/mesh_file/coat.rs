//! KHR_materials_clearcoat: a clear layer over a material, by two factors, two textures and a normal map.

use gltf::json::Value;
use gltf::material::Material;

use crate::material::Coat;

pub(super) const NAME: &str = "KHR_materials_clearcoat";
/// Names of the textures, in the order of [`crate::scene::Material::coat_textures`].
pub(super) const TEXTURES: [&str; 2] = ["clearcoatTexture", "clearcoatRoughnessTexture"];
pub(super) const NORMALS: &str = "clearcoatNormalTexture";

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

/// Returns the JSON of each texture on the factors of a layer, if there is a layer.
pub(super) fn uses<'a>(material: &'a Material<'a>) -> [Option<&'a Value>; 2] {
    TEXTURES.map(|name| of_layer(material)?.get(name))
}

/// Returns the JSON of the layer's normal map.
pub(super) fn normals<'a>(material: &'a Material<'a>) -> Option<&'a Value> {
    of_layer(material)?.get(NORMALS)
}

/// The factor on x and y of that map.
pub(super) fn normal_scale(normals: &Value) -> f64 {
    let scale = normals.get("scale").and_then(Value::as_f64);
    scale.filter(|x| x.is_finite()).unwrap_or(1.0)
}

fn of_layer<'a>(material: &'a Material<'a>) -> Option<&'a Value> {
    coat(material).and_then(|_| material.extension_value(NAME))
}
