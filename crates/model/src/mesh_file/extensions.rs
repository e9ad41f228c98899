//! The extensions of glTF: those that are read, and the effect on the picture of not reading the
//! others.

use super::elements::is_extension;

/// Extensions that are read besides those whose properties are listed. Quantization needs nothing done: the accessors read every
/// component type.
const READ: [&str; 3] = [
    "HAIRLINE_scratches",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
];

/// Whether an extension is read: a file may require it, and its contents are in the picture.
pub(super) fn is_read(name: &str) -> bool {
    READ.contains(&name) || is_extension(name)
}

/// Whether a file may require an extension: those that are read, and those that leave a picture as the
/// file's own, with other looks to choose from or data about it.
pub(super) fn may_be_required(name: &str) -> bool {
    is_read(name) || name == "KHR_materials_variants" || IS_DATA.contains(&name)
}

/// Data about the file, not of the picture.
const IS_DATA: [&str; 7] = [
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "EXT_instance_features",
    "FB_geometry_metadata",
    "AGI_stk_metadata",
];

/// Part of a file that an extension belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scope {
    /// All other contents of the file.
    File,
    /// The look of surfaces: materials and their images.
    Look,
}

impl Scope {
    /// Scope of a member of this name.
    pub(super) fn of_member(self, name: &str) -> Self {
        match name {
            "materials" | "textures" | "images" | "samplers" => Self::Look,
            _ => self,
        }
    }
}

/// Returns the effect on the picture of not reading an extension, and whether the picture differs from
/// one with it.
pub(super) fn meaning(name: &str) -> (&'static str, bool) {
    let matters = |meaning| (meaning, true);
    let harmless = |meaning| (meaning, false);
    match name {
        "EXT_lights_area" => matters("its area lights do not shine"),
        "KHR_materials_sheen" => matters("cloth misses its sheen"),
        "KHR_materials_iridescence" => matters("thin films have no colours"),
        "KHR_materials_transmission"
        | "KHR_materials_volume"
        | "KHR_materials_diffuse_transmission"
        | "KHR_materials_volume_scatter"
        | "KHR_materials_dispersion" => matters("what is clear is shown opaque"),
        "KHR_materials_variants" => matters("the file's first look is shown"),
        "MSFT_texture_dds" | "EXT_texture_avif" => harmless("the texture's other image is shown"),
        "MESHOPT_compression" => harmless("the same data are there uncompressed"),
        "MSFT_lod" | "MSFT_screencoverage" => harmless("the finest level is shown"),
        "KHR_animation_pointer" => harmless("the model is at rest"),
        name if IS_DATA.contains(&name) => harmless("data about the file, not of the picture"),
        "KHR_audio" | "KHR_audio_emitter" | "MSFT_audio_emitter" => {
            harmless("it is heard, not seen")
        }
        "CESIUM_RTC" => harmless("where on the earth it stands"),
        _ => matters("Hairline does not know it"),
    }
}
