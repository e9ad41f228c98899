//! Materials of a scene in the words of glTF.

use hairline_model::gltf_file::GltfFile;
use hairline_model::text::shown;
use hairline_scene::{AlphaRule, Base, GLTF_DIELECTRIC_F0, Material};
use serde_json::{Value, json};

/// Adds a material without its textures, and returns its number.
pub(crate) fn write(material: &Material, file: &mut GltfFile, notes: &mut Vec<String>) -> usize {
    let mut written = json!({ "name": material.name, "pbrMetallicRoughness": base(material) });
    write_alpha_rule(material, &mut written);
    let brightest = material.emission.into_iter().fold(0.0, f64::max);
    if brightest > 0.0 {
        written["emissiveFactor"] = json!(material.emission.map(|c| c / brightest.max(1.0)));
    }
    let mut extend = |name: &str, value: Value| {
        written["extensions"][name] = value;
        file.use_extension(name);
    };
    if brightest > 1.0 {
        let strength = json!({ "emissiveStrength": brightest });
        extend("KHR_materials_emissive_strength", strength);
    }
    if material.is_unlit {
        extend("KHR_materials_unlit", json!({}));
    }
    if let Base::MetallicRoughness { .. } = material.base {
        let specular = &material.specular;
        extend(
            "KHR_materials_specular",
            json!({ "specularFactor": specular.weight, "specularColorFactor": specular.color }),
        );
    }
    if let Some(ior) = ior(material) {
        extend("KHR_materials_ior", json!({ "ior": ior }));
    }
    if let Some(coat) = &material.coat {
        extend(
            "KHR_materials_clearcoat",
            json!({ "clearcoatFactor": coat.weight, "clearcoatRoughnessFactor": coat.roughness }),
        );
    }
    if let Some(drawn) = &material.anisotropy {
        extend(
            "KHR_materials_anisotropy",
            json!({
                "anisotropyStrength": drawn.strength,
                "anisotropyRotation": drawn.direction_deg.to_radians(),
            }),
        );
    }
    if let Base::Covered { .. } = material.base {
        let name = shown(&material.name);
        notes.push(format!(
            "material \"{name}\": other programs show no plate over it"
        ));
    }
    file.push("materials", written)
}

fn base(material: &Material) -> Value {
    let (color, metallic) = material.base.color_and_metallic();
    let [r, g, b] = color.map(|c| c.clamp(0.0, 1.0));
    let alpha = material.cutout.map_or(1.0, |it| it.alpha);
    json!({
        "baseColorFactor": [r, g, b, alpha],
        "metallicFactor": metallic,
        "roughnessFactor": material.base_roughness(),
    })
}

fn write_alpha_rule(material: &Material, written: &mut Value) {
    match material.cutout.map(|it| it.rule) {
        Some(AlphaRule::AtLeast(least)) => {
            written["alphaMode"] = json!("MASK");
            written["alphaCutoff"] = json!(least);
        }
        Some(AlphaRule::Share) => written["alphaMode"] = json!("BLEND"),
        None => {}
    }
}

/// The refractive index that is written for a material, if it is another than readers take by themselves.
fn ior(material: &Material) -> Option<f64> {
    match material.base {
        Base::Dielectric { ior, .. } => Some(ior),
        Base::MetallicRoughness { .. } => {
            let root = material.dielectric_f0.sqrt();
            let is_usual = material.dielectric_f0 == GLTF_DIELECTRIC_F0;
            (!is_usual).then(|| (1.0 + root) / (1.0 - root))
        }
        _ => None,
    }
}
