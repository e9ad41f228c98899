//! What a software driver reads texel by texel, it is given as storage textures.
//!
//! It reads those in place. For a sampled texture it calls a function that finds the level and its size for each lane by
//! itself, which takes several times as long, and saves all registers around it.

use wgpu::{BindingType, StorageTextureAccess, TextureFormat, TextureSampleType};

use crate::device::Gpu;
use crate::variant::is_bounded;

/// Of whole texels: four words each.
pub(crate) const TEXEL_FORMAT: TextureFormat = TextureFormat::Rgba32Uint;

/// Of numbers that come as such.
pub(crate) const NUMBERS_FORMAT: TextureFormat = TextureFormat::Rgba32Float;

/// Names and formats. Tables of lobes are arguments of functions as well, by other names; so are scratch tables, which are told by
/// their layer.
const STORED: [(&str, &str); 12] = [
    ("materials", "rgba32uint"),
    ("lights", "rgba32uint"),
    ("scratch_nodes", "rgba32uint"),
    ("scratch_segments", "rgba32uint"),
    ("tile_lists", "rgba32uint"),
    ("lobe_albedo", "rgba32float"),
    ("lobe_ltc", "rgba32float"),
    ("lobe_sptd", "rgba32float"),
    ("albedo_table", "rgba32float"),
    ("ltc_table", "rgba32float"),
    ("sptd_table", "rgba32float"),
    ("table", "rgba32float"),
];

/// As many of them as a stage binds: more than WebGPU allows one unless it is asked.
pub(crate) const STORAGE_TEXTURES: u32 = 9;

/// Whether the device is given storage textures. By way of OpenGL they cannot be arguments of functions.
pub(crate) fn are_used(gpu: &Gpu) -> bool {
    is_bounded(gpu)
        && !gpu.adapter.is_opengl()
        && gpu.limits().max_storage_textures_per_shader_stage >= STORAGE_TEXTURES
}

/// The binding of one of them.
pub(crate) fn binding(
    gpu: &Gpu,
    format: TextureFormat,
    view_dimension: wgpu::TextureViewDimension,
) -> BindingType {
    if are_used(gpu) {
        BindingType::StorageTexture {
            access: StorageTextureAccess::ReadOnly,
            format,
            view_dimension,
        }
    } else {
        BindingType::Texture {
            sample_type: if format == NUMBERS_FORMAT {
                TextureSampleType::Float { filterable: false }
            } else {
                TextureSampleType::Uint
            },
            view_dimension,
            multisampled: false,
        }
    }
}

/// A shader's text that reads them from storage textures.
pub(crate) fn in_text(text: &str) -> String {
    let mut stored = text.replace(
        "texture_2d_array<u32>",
        "texture_storage_2d_array<rgba32uint, read>",
    );
    for (name, format) in STORED {
        let numbers = if format.ends_with("float") {
            "f32"
        } else {
            "u32"
        };
        for before in [" ", "("] {
            stored = stored.replace(
                &format!("{before}{name}: texture_2d<{numbers}>"),
                &format!("{before}{name}: texture_storage_2d<{format}, read>"),
            );
        }
    }
    // They have one level, and it is not named.
    let mut calls = stored.split("textureLoad(");
    let mut text = calls.next().unwrap_or_default().to_owned();
    for call in calls {
        text.push_str("textureLoad(");
        let end = end_of_arguments(call);
        let (arguments, rest) = call.split_at(end);
        let texture = arguments.split(',').next().unwrap_or_default();
        let is_stored =
            arguments.contains(" layer, ") || STORED.iter().any(|(name, _)| *name == texture);
        let level = if is_stored { ", 0" } else { "" };
        text.push_str(arguments.strip_suffix(level).unwrap_or(arguments));
        text.push_str(rest);
    }
    text
}

/// Where the bracket closes that was opened before `call`.
fn end_of_arguments(call: &str) -> usize {
    let mut open = 1;
    call.find(|c| {
        open += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        open == 0
    })
    .unwrap_or(call.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::{ALL, SHADE_TILES, assert_valid, compose};

    #[test]
    fn each_module_is_valid_with_them() {
        for module in ALL {
            assert_valid(module, &in_text(&compose(&[module])));
        }
    }

    #[test]
    fn all_of_them_are_found() {
        let text = in_text(&compose(&[&SHADE_TILES]));
        // The tables in their binding and as an argument, and the others.
        let tables = text.matches("texture_storage_2d_array<rgba32uint, read>");
        assert!(tables.count() > 1);
        assert!(!text.contains("texture_2d_array<u32>"));
        let bound = text
            .lines()
            .filter(|line| line.contains("@binding") && line.contains(": texture_storage"));
        assert_eq!(bound.count(), STORAGE_TEXTURES as usize);
    }
}
