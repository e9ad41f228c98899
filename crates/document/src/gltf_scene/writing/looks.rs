//! Materials of a scene in the words of glTF.

use hairline_model::gltf_file::GltfFile;
use hairline_model::text::shown;
use hairline_optics::metal::MetalIndex;
use serde_json::{Value, json};

use crate::description::{Material, MaterialKind, MetalColor};

/// Adds a material, and returns its number.
pub(super) fn write(material: &Material, file: &mut GltfFile, notes: &mut Vec<String>) -> usize {
    let (color, metallic) = match &material.kind {
        MaterialKind::Metal(MetalColor::Measured(metal)) => (metal.reflectance_rgb(1.0), 1.0),
        MaterialKind::Metal(MetalColor::Own(rows)) => {
            (MetalIndex::own(rows).reflectance_rgb(1.0), 1.0)
        }
        MaterialKind::Metal(MetalColor::Color(color)) => (*color, 1.0),
        MaterialKind::Dielectric { base_color, .. } => (*base_color, 0.0),
        MaterialKind::MetallicRoughness {
            base_color,
            metallic,
            ..
        } => (*base_color, *metallic),
        MaterialKind::Mirror => ([1.0; 3], 1.0),
    };
    let [r, g, b] = color.map(|c| c.clamp(0.0, 1.0));
    let is_mirror = material.kind == MaterialKind::Mirror;
    let mut written = json!({
        "name": material.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0],
            "metallicFactor": metallic,
            "roughnessFactor": if is_mirror { 0.0 } else { material.roughness },
        },
    });
    let mut extend = |name: &str, value: Value| {
        written["extensions"][name] = value;
        file.use_extension(name);
    };
    match &material.kind {
        MaterialKind::Dielectric { ior, .. } => {
            extend("KHR_materials_ior", json!({ "ior": ior }));
        }
        MaterialKind::MetallicRoughness { specular, .. } => extend(
            "KHR_materials_specular",
            json!({ "specularFactor": specular.weight, "specularColorFactor": specular.color }),
        ),
        _ => {}
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
    if material.cover.is_some() {
        let name = shown(&material.name);
        notes.push(format!(
            "material \"{name}\": other programs show no plate over it"
        ));
    }
    file.push("materials", written)
}
