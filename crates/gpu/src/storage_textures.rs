//! What a software driver reads texel by texel, it is given as storage textures.
//!
//! It reads those in place. For a sampled texture it calls a function that finds the level and its size for each lane by
//! itself, which takes several times as long, and saves all registers around it.

use wgpu::{
    BindingType, StorageTextureAccess, TextureFormat, TextureSampleType, TextureViewDimension,
};

use crate::device::Gpu;
use crate::variant::is_bounded;

/// A texture of one level that shaders read by whole texels.
struct Texels {
    /// In WGSL: of the binding, or of an argument that stands for one.
    name: &'static str,
    format: TextureFormat,
    dimension: TextureViewDimension,
}

const fn texels(name: &'static str, format: TextureFormat) -> Texels {
    Texels {
        name,
        format,
        dimension: TextureViewDimension::D2,
    }
}

const fn layers(name: &'static str) -> Texels {
    Texels {
        name,
        format: TextureFormat::Rgba32Uint,
        dimension: TextureViewDimension::D2Array,
    }
}

/// As many textures as WebGPU allows a stage, those that are read most. `spectra` stands for the tables.
const FEW: [Texels; 5] = [
    layers("scratch_tables"),
    layers("spectra"),
    texels("scratch_nodes", TextureFormat::Rgba32Uint),
    texels("scratch_segments", TextureFormat::Rgba32Uint),
    texels("tile_lists", TextureFormat::Rgba32Uint),
];

/// The others, and what stands for tables of lobes.
const REST: [Texels; 15] = [
    texels("lights", TextureFormat::Rgba32Uint),
    texels("light_vertices", TextureFormat::Rgba32Uint),
    texels("visibility", TextureFormat::Rg32Uint),
    texels("tile_visibility", TextureFormat::Rg32Uint),
    texels("tile_entries", TextureFormat::Rgba32Uint),
    texels("triangle_lists", TextureFormat::R32Uint),
    texels("bundle_rows", TextureFormat::Rgba32Uint),
    texels("published_wavelengths", TextureFormat::Rgba32Float),
    texels("lobe_albedo", TextureFormat::Rgba32Float),
    texels("lobe_ltc", TextureFormat::Rgba32Float),
    texels("lobe_sptd", TextureFormat::Rgba32Float),
    texels("nodes", TextureFormat::Rgba32Float),
    texels("albedo_table", TextureFormat::Rgba32Float),
    texels("ltc_table", TextureFormat::Rgba32Float),
    texels("sptd_table", TextureFormat::Rgba32Float),
];

/// In the layout of any pass, with what it writes.
pub(crate) const STAGE_MOST: u32 = 13;

/// Which textures a device is given as storage textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stored {
    None,
    Few,
    All,
}

impl Stored {
    pub fn on(gpu: &Gpu) -> Self {
        // By way of OpenGL they cannot be arguments of functions, and not all formats can be read.
        let is_gl = gpu.adapter.backend == "gl";
        match gpu.limits().max_storage_textures_per_shader_stage {
            _ if !is_bounded(gpu) || is_gl => Self::None,
            0..STAGE_MOST => Self::Few,
            _ => Self::All,
        }
    }

    fn textures(self) -> impl Iterator<Item = &'static Texels> {
        let (few, rest): (&[Texels], &[Texels]) = match self {
            Self::None => (&[], &[]),
            Self::Few => (&FEW, &[]),
            Self::All => (&FEW, &REST),
        };
        few.iter().chain(rest)
    }

    /// Whether textures of a format may be bound so.
    pub fn has(self, format: TextureFormat) -> bool {
        self.textures().any(|texels| texels.format == format)
    }

    /// The binding of the texture that has this name in WGSL.
    ///
    /// # Panics
    /// If there is none.
    pub fn binding(self, name: &str) -> BindingType {
        let of_name = |texels: &&Texels| texels.name == name;
        if let Some(texels) = self.textures().find(of_name) {
            return BindingType::StorageTexture {
                access: StorageTextureAccess::ReadOnly,
                format: texels.format,
                view_dimension: texels.dimension,
            };
        }
        let texels = Self::All.textures().find(of_name);
        let texels = texels.unwrap_or_else(|| panic!("no texture is called {name}"));
        BindingType::Texture {
            sample_type: match texels.format {
                TextureFormat::Rgba32Float => TextureSampleType::Float { filterable: false },
                _ => TextureSampleType::Uint,
            },
            view_dimension: texels.dimension,
            multisampled: false,
        }
    }

    /// A shader's text that reads these from storage textures.
    pub fn in_text(self, text: &str) -> String {
        let mut stored = text.to_owned();
        for texels in self.textures() {
            let (sampled, storage) = types(texels);
            for before in ["var ", "(", " "] {
                stored = stored.replace(
                    &format!("{before}{}: {sampled}", texels.name),
                    &format!("{before}{}: {storage}", texels.name),
                );
            }
        }
        // They have one level, and it is not named.
        let mut calls = stored.split("textureLoad(");
        let mut text = calls.next().unwrap_or_default().to_owned();
        for call in calls {
            text.push_str("textureLoad(");
            let (arguments, rest) = call.split_at(end_of_arguments(call));
            let name = arguments.split(',').next();
            let is_stored = self.textures().any(|texels| Some(texels.name) == name);
            let level = if is_stored { ", 0" } else { "" };
            text.push_str(arguments.strip_suffix(level).unwrap_or(arguments));
            text.push_str(rest);
        }
        text
    }
}

/// Of a texture in WGSL: as it is written, and as storage.
fn types(texels: &Texels) -> (String, String) {
    let (of, format) = match texels.format {
        TextureFormat::Rgba32Float => ("f32", "rgba32float"),
        TextureFormat::Rg32Uint => ("u32", "rg32uint"),
        TextureFormat::R32Uint => ("u32", "r32uint"),
        _ => ("u32", "rgba32uint"),
    };
    let dimension = match texels.dimension {
        TextureViewDimension::D2Array => "2d_array",
        _ => "2d",
    };
    (
        format!("texture_{dimension}<{of}>"),
        format!("texture_storage_{dimension}<{format}, read>"),
    )
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
    use crate::shaders::{ALL, SHADE_PUBLISHED, SHADE_TILES, assert_valid, compose};

    #[test]
    fn each_module_is_valid_with_them() {
        for module in ALL {
            for stored in [Stored::Few, Stored::All] {
                assert_valid(module, &stored.in_text(&compose(&[module])));
            }
        }
    }

    #[test]
    fn all_of_them_are_found() {
        for (module, stored, expected) in [
            (&SHADE_TILES, Stored::None, 0),
            // The tables in their binding and as an argument of four functions, and three others.
            (&SHADE_TILES, Stored::Few, 8),
            (&SHADE_TILES, Stored::All, 0),
            (&SHADE_PUBLISHED, Stored::All, 0),
        ] {
            let text = stored.in_text(&compose(&[module]));
            let count = text.matches("texture_storage_2d").count();
            if stored == Stored::All {
                // Nothing else is an array of integers or a table.
                assert!(
                    !text.contains("<u32>;")
                        && !text.contains("table: texture_2d<f32>")
                        && !text.contains("nodes: texture_2d<f32>")
                );
                assert!(count > 12, "{count}");
            } else {
                assert_eq!(count, expected, "{stored:?}");
            }
        }
    }
}
