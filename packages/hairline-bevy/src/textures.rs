//! The textures that shaders look things up in.

use std::sync::{Arc, Mutex, PoisonError};

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
};
use hairline_engine::base_tables::{self, Texels};
use hairline_engine::{GratingTexels, ScratchTexels, scratch_table, scratch_tree};
use hairline_optics::coat::COAT_IOR;
use hairline_optics::fresnel::dielectric_ior;
use hairline_optics::metal::Metal;
use hairline_optics::section::GrooveShape;
use hairline_optics::table::ENGINE_COLUMNS;

use crate::{MOST_GRATINGS, Scratched, ScratchedMaterial, Scratches, Settings};

/// Makes [`ScratchedMaterial`]s, with textures of 0.9 MB for all. Each metal has 0.3 to 4 MB for each shape of its grooves, by the deepest of them, and
/// each grating up to 4 MB. All are made once.
#[derive(Resource, Clone)]
pub struct ScratchedTextures(Arc<Shared>);

struct Shared {
    server: AssetServer,
    shapes: Handle<Image>,
    albedo: Handle<Image>,
    curves: Handle<Image>,
    spectra: Mutex<Vec<Spectrum>>,
}

/// The tables of a metal, one layer for each shape of grooves, then those of gratings.
struct Spectrum {
    metal: Option<Metal>,
    shapes: Vec<GrooveShape>,
    table_rows: usize,
    gratings: Vec<Arc<Vec<[u32; 4]>>>,
    image: Handle<Image>,
}

impl FromWorld for ScratchedTextures {
    fn from_world(world: &mut World) -> Self {
        let server = world.resource::<AssetServer>().clone();
        let add = |table: Texels| {
            let values = table.texels.iter().flatten();
            let bytes = values.flat_map(|value| value.to_le_bytes()).collect();
            server.add(image(table.size, bytes, TextureFormat::Rgba32Float))
        };
        Self(Arc::new(Shared {
            shapes: add(base_tables::shapes()),
            albedo: add(base_tables::albedo()),
            curves: add(base_tables::curves()),
            spectra: Mutex::default(),
            server,
        }))
    }
}

impl ScratchedTextures {
    /// Makes a material for a mesh, in whose frame `scratches` are. A `metal` gives colour, spectrum, and how reflectance goes with the angle; none is a
    /// metal or a lacquer by `base_color`, `metallic` and `reflectance` as they are here. Where the base has a clear coat, scratches lie in it. Takes 0.1 s for a metal's first.
    pub fn material(
        &self,
        metal: Option<Metal>,
        base: StandardMaterial,
        scratches: &Scratches,
    ) -> ScratchedMaterial {
        let extension = self.extension(metal, base.clearcoat > 0.0, scratches);
        of_metal(metal, base, extension)
    }

    pub(crate) fn extension(
        &self,
        metal: Option<Metal>,
        is_coated: bool,
        scratches: &Scratches,
    ) -> Scratched {
        let texels = &scratches.texels;
        let rows = texels.tree.len() / scratch_tree::WIDTH;
        let size = [scratch_tree::WIDTH, rows].map(|n| n as u32);
        let gratings = &scratches.gratings[..scratches.gratings.len().min(MOST_GRATINGS)];
        if gratings.len() < scratches.gratings.len() {
            let found = scratches.gratings.len();
            warn!("found {found} gratings; must be {MOST_GRATINGS} at most: the first are drawn");
        }
        let mut settings = Settings {
            metres_from_mesh: Mat4::IDENTITY,
            gratings: [Mat4::ZERO; MOST_GRATINGS],
            grating_count: gratings.len() as u32,
            curve: base_tables::curve_of(metal),
            coat_curve: base_tables::dielectric_curve(COAT_IOR),
            light_radius_m: Scratched::LIGHT_RADIUS_M,
        };
        for (i, (numbers, grating)) in settings.gratings.iter_mut().zip(gratings).enumerate() {
            *numbers = Mat4::from_cols_array(&grating.numbers);
            numbers.w_axis.z = (texels.shapes.len() + i) as f32;
        }
        // What lies in a coat has no colour of its own.
        let spectrum = metal.filter(|_| !is_coated);
        Scratched {
            tree: self.0.server.add(words(size, &texels.tree)),
            tables: self.tables(spectrum, texels, gratings),
            shapes: self.0.shapes.clone(),
            albedo: self.0.albedo.clone(),
            curves: self.0.curves.clone(),
            settings,
        }
    }

    /// Adds an asset from any thread.
    pub(crate) fn add<A: Asset>(&self, asset: A) -> Handle<A> {
        self.0.server.add(asset)
    }

    fn tables(
        &self,
        metal: Option<Metal>,
        scratches: &ScratchTexels,
        gratings: &[GratingTexels],
    ) -> Handle<Image> {
        let spectra = self.0.spectra.lock();
        let mut spectra = spectra.unwrap_or_else(PoisonError::into_inner);
        let ScratchTexels {
            ref shapes,
            table_rows,
            ..
        } = *scratches;
        let of_gratings = || gratings.iter().map(|it| &it.texels);
        let is_known = |spectrum: &&Spectrum| {
            let is_of_scratches = spectrum.shapes == *shapes && spectrum.table_rows == table_rows;
            spectrum.metal == metal && is_of_scratches && spectrum.gratings.iter().eq(of_gratings())
        };
        if let Some(known) = spectra.iter().find(is_known) {
            return known.image.clone();
        }
        // Layers are as high as the highest.
        let rows = gratings.iter().map(GratingTexels::rows).max();
        let rows = rows.unwrap_or(0).max(table_rows);
        let mut texels = Vec::new();
        let layers = shapes
            .iter()
            .map(|shape| scratch_table(metal, shape, table_rows));
        for layer in layers.chain(of_gratings().map(|it| it.to_vec())) {
            texels.extend(layer);
            texels.resize(texels.len().next_multiple_of(rows * ENGINE_COLUMNS), [0; 4]);
        }
        let mut tables = words([ENGINE_COLUMNS, rows].map(|n| n as u32), &texels);
        tables.texture_view_descriptor = Some(TextureViewDescriptor {
            dimension: Some(TextureViewDimension::D2Array),
            ..default()
        });
        let image = self.0.server.add(tables);
        spectra.push(Spectrum {
            metal,
            shapes: shapes.clone(),
            table_rows,
            gratings: of_gratings().cloned().collect(),
            image: image.clone(),
        });
        image
    }
}

/// Material of a metal, or of what its standard material says.
pub(crate) fn of_metal(
    metal: Option<Metal>,
    mut base: StandardMaterial,
    mut extension: Scratched,
) -> ScratchedMaterial {
    if let Some(metal) = metal {
        let [red, green, blue] = metal.reflectance_rgb(1.0).map(|channel| channel as f32);
        base.base_color = Color::linear_rgb(red, green, blue);
        base.metallic = 1.0;
    } else if base.metallic < 1.0 || base.metallic_roughness_texture.is_some() {
        // As Bevy has it: 0.5 is glass.
        let f0 = 0.16 * f64::from(base.reflectance).powi(2);
        let ior = dielectric_ior(f0).expect("a reflectance is 1 at most");
        extension.settings.curve = base_tables::dielectric_curve(ior);
    }
    ScratchedMaterial { base, extension }
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
