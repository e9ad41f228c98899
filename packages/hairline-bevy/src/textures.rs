//! The textures that shaders look things up in.

use bevy::asset::RenderAssetUsages;
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
};
use hairline_gpu::engine_tables::{self, Texels};
use hairline_gpu::scratch_tree;
use hairline_optics::metal::Metal;
use hairline_optics::section::GrooveShape;
use hairline_optics::table::{COLUMNS, ROWS, ScratchTable};

use crate::{Scratched, Scratches, Settings};

/// Textures of all scratched materials: 0.35 MB, and 8 MB for each metal and shape of grooves.
#[derive(Resource)]
pub(crate) struct Shared {
    shapes: Handle<Image>,
    albedo: Handle<Image>,
    curves: Handle<Image>,
    spectra: Vec<Spectrum>,
}

/// The tables of a metal, one layer for each shape of grooves.
struct Spectrum {
    metal: Option<Metal>,
    shapes: Vec<GrooveShape>,
    image: Handle<Image>,
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
            spectra: Vec::new(),
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
        let mut spectra = self.shared.spectra.iter();
        let known = spectra.find(|it| it.metal == metal && it.shapes == scratches.shapes);
        let spectrum = match known {
            Some(known) => known.image.clone(),
            None => {
                let reflectance =
                    |nm| metal.map_or(1.0, |metal: Metal| metal.reflectance(1.0, nm));
                let shapes = scratches.shapes.iter();
                let texels: Vec<[u32; 4]> = shapes
                    .flat_map(|shape| ScratchTable::of_shape(shape, reflectance).texels)
                    .collect();
                let mut spectrum = words([COLUMNS, ROWS].map(|n| n as u32), &texels);
                spectrum.texture_view_descriptor = Some(TextureViewDescriptor {
                    dimension: Some(TextureViewDimension::D2Array),
                    ..default()
                });
                let image = self.images.add(spectrum);
                self.shared.spectra.push(Spectrum {
                    metal,
                    shapes: scratches.shapes.clone(),
                    image: image.clone(),
                });
                image
            }
        };
        Scratched {
            tree,
            tables: spectrum,
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

/// An image of as many layers as there are bytes for; both formats have 16 a texel.
fn image([width, height]: [u32; 2], bytes: Vec<u8>, format: TextureFormat) -> Image {
    let size = Extent3d {
        width,
        height,
        depth_or_array_layers: bytes.len() as u32 / (16 * width * height),
    };
    Image::new(
        size,
        TextureDimension::D2,
        bytes,
        format,
        RenderAssetUsages::RENDER_WORLD,
    )
}
