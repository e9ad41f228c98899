//! The textures that shaders look things up in.

use std::collections::HashMap;

use bevy::asset::RenderAssetUsages;
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
};
use hairline_gpu::engine_tables::{self, Texels};
use hairline_gpu::scratch_tree;
use hairline_optics::metal::Metal;
use hairline_optics::table::{COLUMNS, ROWS, ScratchTable};

use crate::{Scratched, Scratches, Settings};

/// Textures of all scratched materials: 0.35 MB, and 8 MB for each metal.
#[derive(Resource)]
pub(crate) struct Shared {
    shapes: Handle<Image>,
    albedo: Handle<Image>,
    curves: Handle<Image>,
    spectra: HashMap<Option<Metal>, Handle<Image>>,
}

impl FromWorld for Shared {
    fn from_world(world: &mut World) -> Self {
        let mut images = world.resource_mut::<Assets<Image>>();
        let mut add = |table: Texels| {
            let values = table.texels.iter().flatten();
            let bytes = values.flat_map(|value| value.to_le_bytes()).collect();
            images.add(image(table.size, bytes, TextureFormat::Rgba32Float))
        };
        Self {
            shapes: add(engine_tables::shapes()),
            albedo: add(engine_tables::albedo()),
            curves: add(engine_tables::curves()),
            spectra: HashMap::new(),
        }
    }
}

/// Makes [`Scratched`]; each spectrum once.
#[derive(SystemParam)]
pub struct ScratchedTextures<'w> {
    images: ResMut<'w, Assets<Image>>,
    shared: ResMut<'w, Shared>,
}

impl ScratchedTextures<'_> {
    /// Makes a material for a mesh, in whose frame `scratches` are. `metal` gives their spectrum, and how its reflectance goes with the
    /// angle; none is a metal or a lacquer by its base colour. Takes 0.1 s for a metal's first.
    pub fn scratched(&mut self, metal: Option<Metal>, scratches: &Scratches) -> Scratched {
        let texels = &scratches.texels;
        let rows = texels.len() / scratch_tree::WIDTH;
        let size = [scratch_tree::WIDTH, rows].map(|n| n as u32);
        let tree = self.images.add(words(size, texels));
        let spectrum = self.shared.spectra.entry(metal).or_insert_with(|| {
            let table =
                ScratchTable::new(|nm| metal.map_or(1.0, |metal| metal.reflectance(1.0, nm)));
            let mut spectrum = words([COLUMNS, ROWS].map(|n| n as u32), &table.texels);
            spectrum.texture_view_descriptor = Some(TextureViewDescriptor {
                dimension: Some(TextureViewDimension::D2Array),
                ..default()
            });
            self.images.add(spectrum)
        });
        Scratched {
            tree,
            tables: spectrum.clone(),
            shapes: self.shared.shapes.clone(),
            albedo: self.shared.albedo.clone(),
            curves: self.shared.curves.clone(),
            settings: Settings {
                curve: engine_tables::curve_of(metal),
                light_radius_m: Scratched::LIGHT_RADIUS_M,
            },
        }
    }
}

/// The base colour of a metal: its reflectance at normal incidence, in daylight.
pub fn metal_color(metal: Metal) -> Color {
    let [red, green, blue] = metal.reflectance_rgb(1.0).map(|channel| channel as f32);
    Color::linear_rgb(red, green, blue)
}

fn words(size: [u32; 2], texels: &[[u32; 4]]) -> Image {
    let bytes = texels.iter().flatten().flat_map(|word| word.to_le_bytes());
    image(size, bytes.collect(), TextureFormat::Rgba32Uint)
}

fn image([width, height]: [u32; 2], bytes: Vec<u8>, format: TextureFormat) -> Image {
    let size = Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    Image::new(
        size,
        TextureDimension::D2,
        bytes,
        format,
        RenderAssetUsages::RENDER_WORLD,
    )
}
