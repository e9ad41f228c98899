//! KHR_materials_specular and KHR_materials_ior: reflection of the part of a material that is no
//! metal.

use gltf::json::Value;
use gltf::material::Material;

use crate::material::{GLTF_DIELECTRIC_F0, Specular};

pub(super) const NAME: &str = "KHR_materials_specular";
/// Names of the textures, in the order of [`crate::scene::Material::specular_textures`].
pub(super) const TEXTURES: [&str; 2] = ["specularTexture", "specularColorTexture"];

/// Reflectance at normal incidence from the file's refractive index.
pub(super) fn f0(material: &Material) -> f64 {
    let extension = material.extension_value("KHR_materials_ior");
    let ior = extension.and_then(|it| it.get("ior")?.as_f64());
    ior.map_or(GLTF_DIELECTRIC_F0, |ior| {
        // 0 is the extension's sign for a mirror under its own colour: 1.
        let ior = ior.max(0.0);
        ((ior - 1.0) / (ior + 1.0)).powi(2)
    })
}

/// The factors.
pub(super) fn specular(material: &Material) -> Specular {
    let extension = material.extension_value(NAME);
    let or_full = |value: Option<&Value>| value.and_then(Value::as_f64).unwrap_or(1.0);
    let color = extension.and_then(|it| it.get("specularColorFactor"));
    Specular {
        weight: or_full(extension.and_then(|it| it.get("specularFactor"))).clamp(0.0, 1.0),
        color: [0, 1, 2].map(|i| or_full(color.and_then(|it| it.get(i))).max(0.0)),
    }
}

/// Returns the JSON of each texture on the factors.
pub(super) fn uses<'a>(material: &'a Material<'a>) -> [Option<&'a Value>; 2] {
    let extension = material.extension_value(NAME);
    TEXTURES.map(|name| extension?.get(name))
}
