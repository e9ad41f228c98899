//! The properties that elements of a glTF file may have: the specification's (section 5), and those of the extensions that are read.

use gltf::json::Value;

use crate::mesh_file::extensions::Scope;

/// An element: an object of the file.
struct Element {
    /// Name of the element in messages.
    name: &'static str,
    /// Names of the properties of the element that are values.
    values: &'static [&'static str],
    /// Names of the properties that are elements, or lists of elements.
    parts: &'static [(&'static str, &'static Element)],
}

/// Calls `tell` for each property that neither the specification nor an extension defines, with the name of its element. What
/// surfaces look like is passed over where `with_looks` is false.
pub(super) fn unknown(root: &Value, with_looks: bool, tell: &mut impl FnMut(&str, &str)) {
    let is_told = |name: &str| with_looks || Scope::File.within(name) != Scope::Look;
    for (name, value) in members(root).filter(|it| is_told(it.0)) {
        member(&FILE, name, value, tell);
    }
}

fn visit(element: &Element, value: &Value, tell: &mut impl FnMut(&str, &str)) {
    for each in value.as_array().into_iter().flatten() {
        visit(element, each, tell);
    }
    for (name, value) in members(value) {
        member(element, name, value, tell);
    }
}

fn member(of: &Element, name: &str, value: &Value, tell: &mut impl FnMut(&str, &str)) {
    if name == "extensions" {
        for (name, value) in members(value) {
            if let Some((_, extension)) = EXTENSIONS.iter().find(|it| it.0 == name) {
                visit(extension, value, tell);
            }
        }
    } else if let Some((_, part)) = of.parts.iter().find(|it| it.0 == name) {
        visit(part, value, tell);
    } else if !of.values.contains(&name) && !EVERYWHERE.contains(&name) {
        tell(name, of.name);
    }
}

fn members(value: &Value) -> impl Iterator<Item = (&str, &Value)> {
    let members = value.as_object().into_iter().flatten();
    members.map(|(name, value)| (name.as_str(), value))
}

/// Properties that every element may have. `extras` are an application's own, of any form.
const EVERYWHERE: [&str; 2] = ["name", "extras"];

const FILE: Element = Element {
    name: "the file",
    values: &["extensionsUsed", "extensionsRequired", "scene"],
    parts: &[
        ("accessors", &ACCESSOR),
        ("animations", &ANIMATION),
        (
            "asset",
            &leaf(
                "asset",
                &["copyright", "generator", "version", "minVersion"],
            ),
        ),
        ("buffers", &leaf("buffers", &["uri", "byteLength"])),
        (
            "bufferViews",
            &leaf(
                "bufferViews",
                &["buffer", "byteOffset", "byteLength", "byteStride", "target"],
            ),
        ),
        ("cameras", &CAMERA),
        (
            "images",
            &leaf("images", &["uri", "mimeType", "bufferView"]),
        ),
        ("materials", &MATERIAL),
        ("meshes", &MESH),
        (
            "nodes",
            &leaf(
                "nodes",
                &[
                    "camera",
                    "children",
                    "skin",
                    "matrix",
                    "mesh",
                    "rotation",
                    "scale",
                    "translation",
                    "weights",
                ],
            ),
        ),
        (
            "samplers",
            &leaf("samplers", &["magFilter", "minFilter", "wrapS", "wrapT"]),
        ),
        ("scenes", &leaf("scenes", &["nodes"])),
        (
            "skins",
            &leaf("skins", &["inverseBindMatrices", "skeleton", "joints"]),
        ),
        ("textures", &leaf("textures", &["sampler", "source"])),
    ],
};

const ACCESSOR: Element = Element {
    name: "accessors",
    values: &[
        "bufferView",
        "byteOffset",
        "componentType",
        "normalized",
        "count",
        "type",
        "max",
        "min",
    ],
    parts: &[(
        "sparse",
        &Element {
            name: "sparse",
            values: &["count"],
            parts: &[
                (
                    "indices",
                    &leaf(
                        "indices of sparse",
                        &["bufferView", "byteOffset", "componentType"],
                    ),
                ),
                (
                    "values",
                    &leaf("values of sparse", &["bufferView", "byteOffset"]),
                ),
            ],
        },
    )],
};

const ANIMATION: Element = Element {
    name: "animations",
    values: &[],
    parts: &[
        (
            "channels",
            &Element {
                name: "channels",
                values: &["sampler"],
                parts: &[("target", &leaf("target of channels", &["node", "path"]))],
            },
        ),
        (
            "samplers",
            &leaf(
                "samplers of animations",
                &["input", "interpolation", "output"],
            ),
        ),
    ],
};

const CAMERA: Element = Element {
    name: "cameras",
    values: &["type"],
    parts: &[
        (
            "orthographic",
            &leaf("orthographic", &["xmag", "ymag", "zfar", "znear"]),
        ),
        (
            "perspective",
            &leaf("perspective", &["aspectRatio", "yfov", "zfar", "znear"]),
        ),
    ],
};

const MATERIAL: Element = Element {
    name: "materials",
    values: &["emissiveFactor", "alphaMode", "alphaCutoff", "doubleSided"],
    parts: &[
        (
            "pbrMetallicRoughness",
            &Element {
                name: "pbrMetallicRoughness",
                values: &["baseColorFactor", "metallicFactor", "roughnessFactor"],
                parts: &[
                    ("baseColorTexture", &TEXTURE),
                    ("metallicRoughnessTexture", &TEXTURE),
                ],
            },
        ),
        ("normalTexture", &NORMAL_TEXTURE),
        (
            "occlusionTexture",
            &leaf("occlusionTexture", &["index", "texCoord", "strength"]),
        ),
        ("emissiveTexture", &TEXTURE),
    ],
};

const TEXTURE: Element = leaf("a material's texture", &["index", "texCoord"]);
const NORMAL_TEXTURE: Element = leaf("normalTexture", &["index", "texCoord", "scale"]);

const MESH: Element = Element {
    name: "meshes",
    values: &["weights"],
    // Attributes are told by their names.
    parts: &[(
        "primitives",
        &leaf(
            "primitives",
            &["attributes", "indices", "material", "mode", "targets"],
        ),
    )],
};

const MESHOPT: Element = leaf(
    "meshopt_compression",
    &[
        "buffer",
        "byteOffset",
        "byteLength",
        "byteStride",
        "count",
        "mode",
        "filter",
        "fallback",
    ],
);

/// Extensions that are read.
const EXTENSIONS: [(&str, &Element); 15] = [
    (
        "EXT_mesh_gpu_instancing",
        &leaf("EXT_mesh_gpu_instancing", &["attributes"]),
    ),
    ("EXT_meshopt_compression", &MESHOPT),
    ("EXT_texture_webp", &leaf("EXT_texture_webp", &["source"])),
    (
        "KHR_draco_mesh_compression",
        &leaf("KHR_draco_mesh_compression", &["bufferView", "attributes"]),
    ),
    (
        "KHR_lights_punctual",
        &Element {
            name: "KHR_lights_punctual",
            values: &["light"],
            parts: &[(
                "lights",
                &Element {
                    name: "lights",
                    values: &["color", "intensity", "type", "range"],
                    parts: &[("spot", &leaf("spot", &["innerConeAngle", "outerConeAngle"]))],
                },
            )],
        },
    ),
    (
        "KHR_materials_anisotropy",
        &Element {
            name: "KHR_materials_anisotropy",
            values: &["anisotropyStrength", "anisotropyRotation"],
            parts: &[("anisotropyTexture", &TEXTURE)],
        },
    ),
    (
        "KHR_materials_clearcoat",
        &Element {
            name: "KHR_materials_clearcoat",
            values: &["clearcoatFactor", "clearcoatRoughnessFactor"],
            parts: &[
                ("clearcoatTexture", &TEXTURE),
                ("clearcoatRoughnessTexture", &TEXTURE),
                ("clearcoatNormalTexture", &NORMAL_TEXTURE),
            ],
        },
    ),
    (
        "KHR_materials_emissive_strength",
        &leaf("KHR_materials_emissive_strength", &["emissiveStrength"]),
    ),
    ("KHR_materials_ior", &leaf("KHR_materials_ior", &["ior"])),
    (
        "KHR_materials_pbrSpecularGlossiness",
        &Element {
            name: "KHR_materials_pbrSpecularGlossiness",
            values: &["diffuseFactor", "specularFactor", "glossinessFactor"],
            parts: &[
                ("diffuseTexture", &TEXTURE),
                ("specularGlossinessTexture", &TEXTURE),
            ],
        },
    ),
    (
        "KHR_materials_specular",
        &Element {
            name: "KHR_materials_specular",
            values: &["specularFactor", "specularColorFactor"],
            parts: &[
                ("specularTexture", &TEXTURE),
                ("specularColorTexture", &TEXTURE),
            ],
        },
    ),
    ("KHR_meshopt_compression", &MESHOPT),
    (
        "KHR_node_visibility",
        &leaf("KHR_node_visibility", &["visible"]),
    ),
    (
        "KHR_texture_basisu",
        &leaf("KHR_texture_basisu", &["source"]),
    ),
    (
        "KHR_texture_transform",
        &leaf(
            "KHR_texture_transform",
            &["offset", "rotation", "scale", "texCoord"],
        ),
    ),
];

const fn leaf(name: &'static str, values: &'static [&'static str]) -> Element {
    Element {
        name,
        values,
        parts: &[],
    }
}
