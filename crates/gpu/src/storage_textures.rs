//! What a software driver reads texel by texel, it is given as storage textures.
//!
//! It reads those in place. For a sampled texture it calls a function that finds the level and its size for each lane by
//! itself, which takes several times as long, and saves all registers around it.

use wgpu::{BindingType, StorageTextureAccess, TextureFormat, TextureSampleType};

use crate::device::Gpu;
use crate::variant::is_bounded;

/// Of whole texels: four words each.
pub(crate) const TEXEL_FORMAT: TextureFormat = TextureFormat::Rgba32Uint;

/// With the scratch tables as many as WebGPU allows a stage. The look-up of the tables knows its texture as an argument, and is
/// told by its layer.
const STORED: [&str; 3] = ["scratch_nodes", "scratch_segments", "tile_lists"];

/// Whether the device is given storage textures. By way of OpenGL they cannot be arguments of functions.
pub(crate) fn are_used(gpu: &Gpu) -> bool {
    is_bounded(gpu) && gpu.adapter.backend != "gl"
}

/// The binding of one of them.
pub(crate) fn binding(gpu: &Gpu, view_dimension: wgpu::TextureViewDimension) -> BindingType {
    if are_used(gpu) {
        BindingType::StorageTexture {
            access: StorageTextureAccess::ReadOnly,
            format: TEXEL_FORMAT,
            view_dimension,
        }
    } else {
        BindingType::Texture {
            sample_type: TextureSampleType::Uint,
            view_dimension,
            multisampled: false,
        }
    }
}

/// A shader's text that reads scratches, their tables and their lists from storage textures.
pub(crate) fn in_text(text: &str) -> String {
    let mut stored = text.replace(
        "texture_2d_array<u32>",
        "texture_storage_2d_array<rgba32uint, read>",
    );
    for name in STORED {
        stored = stored.replace(
            &format!("var {name}: texture_2d<u32>"),
            &format!("var {name}: texture_storage_2d<rgba32uint, read>"),
        );
    }
    // They have one level, and it is not named.
    let mut calls = stored.split("textureLoad(");
    let mut text = calls.next().unwrap_or_default().to_owned();
    for call in calls {
        text.push_str("textureLoad(");
        let end = end_of_arguments(call);
        let (arguments, rest) = call.split_at(end);
        let is_stored =
            arguments.contains(" layer, ") || STORED.iter().any(|name| arguments.starts_with(name));
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
        assert!(
            text.matches("texture_storage_2d_array<rgba32uint, read>")
                .count()
                > 1
        );
        let others = text.matches("texture_storage_2d<rgba32uint, read>").count();
        assert_eq!(others, STORED.len());
        assert!(!text.contains("texture_2d_array<u32>"));
    }
}
