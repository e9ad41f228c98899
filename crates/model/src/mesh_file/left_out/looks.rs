//! Images of a glTF file's materials that lie on the surface in another way than the file says.

use gltf::json::Value;

use crate::mesh_file::uv::{self, UvMapping};
use crate::mesh_file::{anisotropy, coat, spec_gloss, specular};

/// Contents that are left out, the number of times, and the effect.
pub(super) type Omission = (&'static str, usize, &'static str);

/// Contents of a material that are left out.
pub(super) fn of_material(root: &Value, material: &Value) -> Vec<Omission> {
    let meaning = "a third way to place images on one surface; they lie as the first one";
    // A vertex has places for two.
    let mut told = vec![(
        "texCoord",
        mappings(material).len().saturating_sub(2),
        meaning,
    )];
    let older = extension(material, spec_gloss::NAME);
    let [diffuse, specular] = spec_gloss::TEXTURES.map(|name| older?.get(name));
    if let (Some(diffuse), Some(specular)) = (diffuse, specular)
        && (uv::of_json(diffuse) != uv::of_json(specular)
            || sampler(root, diffuse) != sampler(root, specular))
    {
        let meaning = "it has those of diffuseTexture";
        let what = "texture coordinates and sampler of specularGlossinessTexture";
        told.push((what, 1, meaning));
    }
    told
}

/// Directions of a primitive that its file does not give and that follow the texture coordinates of another image.
pub(super) fn of_primitive(root: &Value, primitive: &Value) -> Vec<Omission> {
    let has = |name: &str| {
        let attributes = primitive.get("attributes");
        attributes.is_some_and(|it| it.get(name).is_some())
    };
    let material = primitive.get("material").and_then(Value::as_u64);
    let material = material.and_then(|i| root.get("materials")?.get(usize::try_from(i).ok()?));
    let Some(material) = material.filter(|it| extension(it, "KHR_materials_unlit").is_none())
    else {
        return Vec::new();
    };
    // Tangents without normals are not read.
    if has("TANGENT") && has("NORMAL") {
        return Vec::new();
    }
    let first = mappings(material).first().copied();
    let is_other = |texture: Option<&Value>| {
        let mapping = texture.and_then(uv::of_json);
        mapping.is_some() && mapping != first
    };
    let mut told = Vec::new();
    if is_other(of_coat(material, coat::NORMALS)) {
        let meaning = "its bumps turn by the texture coordinates of normalTexture";
        told.push(("tangents of clearcoatNormalTexture", 1, meaning));
    }
    if let Some(extension) = brushed(material) {
        let set = first.map_or(0, |mapping| mapping.set);
        if !has(&format!("TEXCOORD_{set}")) {
            let meaning = "there are neither tangents nor texture coordinates; highlights are drawn out any way";
            told.push(("direction of KHR_materials_anisotropy", 1, meaning));
        } else if is_other(extension.get(anisotropy::TEXTURE)) {
            let meaning = "its directions turn by the texture coordinates of another image";
            told.push(("tangents of anisotropyTexture", 1, meaning));
        }
    }
    told
}

/// The different ways of the images that are read, in the order of [`uv::UvMappings`].
fn mappings(material: &Value) -> Vec<UvMapping> {
    let pbr = material.get("pbrMetallicRoughness");
    let of_pbr = ["baseColorTexture", "metallicRoughnessTexture"].map(|name| pbr?.get(name));
    let own = ["emissiveTexture", "occlusionTexture"].map(|name| material.get(name));
    let older = extension(material, spec_gloss::NAME);
    let older = spec_gloss::TEXTURES.map(|name| older?.get(name));
    let of_layer = coat::TEXTURES.map(|name| of_coat(material, name));
    let of_anisotropy = brushed(material).and_then(|it| it.get(anisotropy::TEXTURE));
    let specular = extension(material, specular::NAME);
    let specular = specular::TEXTURES.map(|name| specular?.get(name));
    let normals_of_coat = of_coat(material, coat::NORMALS);
    let first = material.get("normalTexture").or(normals_of_coat);
    let uses = [first].into_iter().chain(of_pbr).chain(own).chain(older);
    let uses = uses.chain(of_layer).chain([of_anisotropy]).chain(specular);
    let mut mappings = Vec::new();
    for mapping in uses
        .chain([normals_of_coat])
        .flatten()
        .filter_map(uv::of_json)
    {
        if !mappings.contains(&mapping) {
            mappings.push(mapping);
        }
    }
    mappings
}

fn extension<'a>(material: &'a Value, name: &str) -> Option<&'a Value> {
    material.get("extensions")?.get(name)
}

/// A texture of a layer that is there.
fn of_coat<'a>(material: &'a Value, name: &str) -> Option<&'a Value> {
    let coat = extension(material, coat::NAME)?;
    is_positive(coat.get("clearcoatFactor")).then(|| coat.get(name))?
}

/// An anisotropy that is there.
fn brushed(material: &Value) -> Option<&Value> {
    let extension = extension(material, anisotropy::NAME)?;
    is_positive(extension.get("anisotropyStrength")).then_some(extension)
}

fn is_positive(number: Option<&Value>) -> bool {
    number.and_then(Value::as_f64).is_some_and(|x| x > 0.0)
}

/// Repetition of a texture, and whether its texels are sharp.
fn sampler(root: &Value, texture: &Value) -> ([u64; 2], bool) {
    let element = |list: &str, index: Option<&Value>| {
        let index = usize::try_from(index?.as_u64()?).ok()?;
        root.get(list)?.get(index)
    };
    let texture = element("textures", texture.get("index"));
    let sampler = texture.and_then(|it| element("samplers", it.get("sampler")));
    let number = |name: &str| sampler.and_then(|it| it.get(name)?.as_u64());
    // Defaults of the specification: 10497 is REPEAT; 9728 is NEAREST.
    let wrap = ["wrapS", "wrapT"].map(|name| number(name).unwrap_or(10497));
    (wrap, number("magFilter") == Some(9728))
}
