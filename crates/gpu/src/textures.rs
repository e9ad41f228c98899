//! The scene's tables and textures: group 2.

use std::sync::Arc;

use hairline_image::Picture;
use hairline_optics::fresnel::FRESNEL_NODES;
use hairline_optics::lobe_table::{self, LOBE_TABLE_SIZE};
use hairline_optics::metal::MetalIndex;
use hairline_optics::table;
use hairline_scene::environment::level_place;
use hairline_scene::{
    Environment, GratingSpectrum, GrooveShapes, Reflector, ScratchTables, Texture,
};
use half::f16;
use rayon::prelude::*;
use wgpu::TextureFormat;

use crate::bindings::{Layouts, bind};
use crate::error::Error;
use crate::source::Source;
use crate::texture_array::{TextureArray, array_view};
use crate::transfer::{TexturePosition, Transfer};

/// Bind group of the tables and textures, and the data that they were made from.
pub(crate) struct SceneTextures {
    pub group: wgpu::BindGroup,
    /// Each has one table for each shape.
    metals: Vec<Option<MetalIndex>>,
    shapes: GrooveShapes,
    /// Spectra of the gratings' tables, which follow those of the metals.
    grating_spectra: Vec<GratingSpectrum>,
    scratch_tables: wgpu::TextureView,
    /// Reflector of each curve.
    reflectors: Vec<Reflector>,
    curves: wgpu::TextureView,
    lobes: [wgpu::TextureView; 2],
    environment: Option<Environment>,
    maps: [wgpu::TextureView; 2],
    textures: Arc<Vec<Texture>>,
    array: wgpu::TextureView,
}

impl SceneTextures {
    /// Uploads the tables and textures that `last` does not have.
    pub(crate) async fn upload(
        transfer: &mut Transfer<'_>,
        layouts: &Layouts,
        source: &Source<'_>,
        array: &TextureArray,
        last: Option<&Self>,
    ) -> Result<Self, Error> {
        let Source { scene, tables, .. } = *source;
        let scratch_tables = match last.filter(|last| last.has_tables(tables)) {
            Some(last) => last.scratch_tables.clone(),
            None => scratch_tables(transfer, tables).await?,
        };
        let same_curves = |last: &&Self| last.reflectors == tables.reflectors;
        let curves = match last.filter(same_curves) {
            Some(last) => last.curves.clone(),
            None => fresnel_curves(transfer, tables).await?,
        };
        let lobes = match last {
            Some(last) => last.lobes.clone(),
            None => lobes(transfer).await?,
        };
        let environment = scene.environment.as_ref();
        let maps = match last.filter(|last| same_map(last.environment.as_ref(), environment)) {
            Some(last) => last.maps.clone(),
            None => environment_maps(transfer, environment).await?,
        };
        let same_textures = |last: &&Self| Arc::ptr_eq(&last.textures, &scene.textures);
        let array = match last.filter(same_textures) {
            Some(last) => last.array.clone(),
            None => array.upload(transfer, &scene.textures).await?,
        };
        let [albedo, ltc] = &lobes;
        let [background, levels] = &maps;
        let resources = [
            &scratch_tables,
            albedo,
            ltc,
            background,
            levels,
            &array,
            &curves,
        ]
        .map(wgpu::BindingResource::TextureView);
        Ok(Self {
            group: bind(transfer.gpu, "textures", &layouts.textures, &resources),
            metals: tables.metals.clone(),
            shapes: tables.shapes.clone(),
            grating_spectra: tables.grating_spectra.clone(),
            scratch_tables,
            reflectors: tables.reflectors.clone(),
            curves,
            lobes,
            environment: scene.environment.clone(),
            maps,
            textures: Arc::clone(&scene.textures),
            array,
        })
    }

    fn has_tables(&self, tables: &ScratchTables) -> bool {
        (&self.metals, &self.shapes) == (&tables.metals, &tables.shapes)
            && self.grating_spectra == tables.grating_spectra
    }
}

fn same_map(a: Option<&Environment>, b: Option<&Environment>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => a.same_map(b),
        (None, None) => true,
        _ => false,
    }
}

async fn scratch_tables(
    transfer: &mut Transfer<'_>,
    tables: &ScratchTables,
) -> Result<wgpu::TextureView, Error> {
    let what = "scratch tables";
    let size = [table::COLUMNS as u32, table::ROWS as u32];
    let count = tables.tables.len();
    let allowed = transfer.gpu.limits().max_texture_array_layers;
    if count > allowed as usize {
        let (count, allowed) = (count as u64, allowed.into());
        return Err(transfer.gpu.too_large(what, count, allowed, "layers"));
    }
    let layers = transfer.gpu.array_layers(count as u32);
    let texture = transfer
        .texture(what, size, layers, 1, TextureFormat::Rgba32Uint)
        .await?;
    for (layer, table) in (0..).zip(&tables.tables) {
        let place = TexturePosition {
            layer,
            ..TexturePosition::default()
        };
        let texels = bytemuck::cast_slice(&table.texels);
        transfer.write_texture(what, &texture, place, size, texels);
    }
    Ok(array_view(&texture))
}

/// Rows of a curve: its nodes, and four rows of its albedo table in each further one. Twin: fresnel.wgsl, lobe_fresnel.wgsl.
const CURVE_ROWS: usize = 1 + LOBE_TABLE_SIZE * LOBE_TABLE_SIZE / FRESNEL_NODES;

async fn fresnel_curves(
    transfer: &mut Transfer<'_>,
    tables: &ScratchTables,
) -> Result<wgpu::TextureView, Error> {
    let what = "curves of reflectance";
    let rows = tables.curves.len() * CURVE_ROWS;
    let allowed = transfer.gpu.limits().max_texture_dimension_2d;
    if rows > allowed as usize {
        let (rows, allowed) = (rows as u64, allowed.into());
        return Err(transfer.gpu.too_large(what, rows, allowed, "rows"));
    }
    let size = [FRESNEL_NODES as u32, rows as u32];
    let texture = transfer
        .texture(what, size, 1, 1, TextureFormat::Rgba32Float)
        .await?;
    let texels: Vec<[f32; 4]> = tables
        .curves
        .iter()
        .flat_map(|curve| [curve.nodes(), curve.albedo_table().texels()].concat())
        .collect();
    let texels = bytemuck::cast_slice(&texels);
    transfer.write_texture(what, &texture, TexturePosition::default(), size, texels);
    Ok(texture.create_view(&Default::default()))
}

/// Albedos and shapes of lobes.
async fn lobes(transfer: &mut Transfer<'_>) -> Result<[wgpu::TextureView; 2], Error> {
    let albedo = lobe_table::albedo_table().texels();
    Ok([
        lobe(transfer, "albedo table", albedo).await?,
        lobe(transfer, "lobe shapes", lobe_table::shape_texels()).await?,
    ])
}

/// Tables of lobes, one under the other.
async fn lobe(
    transfer: &mut Transfer<'_>,
    what: &'static str,
    texels: &[[f32; 4]],
) -> Result<wgpu::TextureView, Error> {
    let size = [LOBE_TABLE_SIZE, texels.len() / LOBE_TABLE_SIZE].map(|n| n as u32);
    let texture = transfer
        .texture(what, size, 1, 1, TextureFormat::Rgba32Float)
        .await?;
    let texels = bytemuck::cast_slice(texels);
    transfer.write_texture(what, &texture, TexturePosition::default(), size, texels);
    Ok(texture.create_view(&Default::default()))
}

/// Maps for the camera's background and for what is lit; black where there is no environment.
async fn environment_maps(
    transfer: &mut Transfer<'_>,
    environment: Option<&Environment>,
) -> Result<[wgpu::TextureView; 2], Error> {
    let black = [Picture::new([1, 1])];
    let background = environment.map_or(&black[0], |e| e.background());
    let levels = environment.map_or(black.as_slice(), |e| e.prefiltered_levels());
    let format = TextureFormat::Rgba16Float;
    let what = "environment";
    let texture = transfer
        .texture(what, background.size_px, 1, 1, format)
        .await?;
    write_radiance(
        transfer,
        what,
        &texture,
        TexturePosition::default(),
        background,
    );
    let background = texture.create_view(&Default::default());

    let texture = environment_levels(transfer, levels).await?;
    // Below the first level, which has no other beside it. Twin: environment_mean_by_cosine() in environment.wgsl.
    if let Some(environment) = environment {
        let place = TexturePosition {
            row: levels[0].size_px[1],
            ..TexturePosition::default()
        };
        let map = environment.irradiance_map();
        write_radiance(transfer, "irradiance", &texture, place, map);
    }
    Ok([background, texture.create_view(&Default::default())])
}

/// Levels of the same size one above the other. Twin: environment_level_place() in environment.wgsl.
async fn environment_levels(
    transfer: &mut Transfer<'_>,
    levels: &[Picture],
) -> Result<wgpu::Texture, Error> {
    let what = "prefiltered environment";
    let [width, height] = levels[0].size_px;
    let mips = level_place(levels.len() - 1).0 as u32 + 1;
    let texture = transfer
        .texture(
            what,
            [width, 2 * height],
            1,
            mips,
            TextureFormat::Rgba16Float,
        )
        .await?;
    for (i, map) in levels.iter().enumerate() {
        let (mip, is_below) = level_place(i);
        let place = TexturePosition {
            level: mip as u32,
            row: if is_below { map.size_px[1] } else { 0 },
            ..TexturePosition::default()
        };
        write_radiance(transfer, what, &texture, place, map);
    }
    Ok(texture)
}

/// The texels are half floats already.
fn write_radiance(
    transfer: &mut Transfer<'_>,
    what: &'static str,
    texture: &wgpu::Texture,
    place: TexturePosition,
    map: &Picture,
) {
    let half: Vec<[f16; 4]> = map
        .rgb
        .par_iter()
        .with_min_len(1 << 14)
        .map(|[r, g, b]| [*r, *g, *b, 1.0].map(f16::from_f32))
        .collect();
    let texels = bytemuck::cast_slice(&half);
    transfer.write_texture(what, texture, place, map.size_px, texels);
}
