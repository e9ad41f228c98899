//! The scene's tables and textures: group 2.

use hairline_image::Picture;
use hairline_index::ScratchIndex;
use hairline_optics::lobe_table::{self, LOBE_TABLE_SIZE, LobeTable};
use hairline_optics::method::Method;
use hairline_optics::table;
use hairline_scene::{Scene, ScratchTables, Texture};
use half::f16;
use wgpu::{TextureFormat, TextureUsages, TextureViewDimension};

use crate::bindings::{Layouts, bind};
use crate::device::Gpu;
use crate::error::Error;
use crate::published;

/// All textures of the materials in one array: a layer each, every texture in its own size in the upper left corner, so
/// that no texel is resampled.
pub(crate) struct TextureArray {
    size_px: [u32; 2],
    levels: u32,
    /// For each texture, the first level that is uploaded.
    first_levels: Vec<u32>,
    packed: Vec<[u32; 2]>,
}

/// Larger arrays start their largest textures at a coarser level: what a picture rarely resolves is not worth more.
const ARRAY_MAX_BYTES: u64 = 1 << 30;
/// What every WebGPU device can hold.
const TEXTURE_MAX_PX: u32 = 8192;

impl TextureArray {
    pub fn new(scene: &Scene) -> Self {
        let mut side_px = TEXTURE_MAX_PX;
        loop {
            let array = Self::within(&scene.textures, side_px);
            let [width, height] = array.size_px.map(u64::from);
            // Four bytes a texel, and a third more for the levels.
            if side_px == 1
                || width * height * scene.textures.len() as u64 * 16 / 3 <= ARRAY_MAX_BYTES
            {
                return array;
            }
            side_px /= 2;
        }
    }

    /// The array in which no texture is wider or higher than `side_px`.
    fn within(textures: &[Texture], side_px: u32) -> Self {
        let mut array = Self {
            size_px: [1, 1],
            levels: 1,
            first_levels: Vec::new(),
            packed: Vec::new(),
        };
        for (layer, texture) in textures.iter().enumerate() {
            let last = texture.levels.len() as u32 - 1;
            let first = (0..last)
                .find(|level| level_size(texture, *level).iter().all(|n| *n <= side_px))
                .unwrap_or(last);
            let [width, height] = level_size(texture, first);
            let levels = last - first + 1;
            array.size_px = [array.size_px[0].max(width), array.size_px[1].max(height)];
            array.levels = array.levels.max(levels);
            array.first_levels.push(first);
            // Twin: scene_texture() in scene.wgsl.
            array.packed.push([
                width | height << 16,
                layer as u32 | levels << 16 | u32::from(texture.srgb) << 24,
            ]);
        }
        array
    }

    /// How the shader knows a texture; zeros stand for none.
    pub fn packed(&self, texture: Option<usize>) -> [u32; 2] {
        texture.map_or([0; 2], |i| self.packed[i])
    }

    async fn upload(&self, gpu: &Gpu, textures: &[Texture]) -> Result<wgpu::TextureView, Error> {
        let layers = textures.len().max(1) as u32;
        let array = texture(
            gpu,
            "textures",
            self.size_px,
            layers,
            self.levels,
            TextureFormat::Rgba8Unorm,
        )
        .await?;
        for (layer, texture) in textures.iter().enumerate() {
            let first = self.first_levels[layer];
            for level in first..texture.levels.len() as u32 {
                let texels = bytemuck::cast_slice(&texture.levels[level as usize]);
                write(
                    gpu,
                    &array,
                    level - first,
                    layer as u32,
                    level_size(texture, level),
                    texels,
                );
            }
        }
        Ok(array_view(&array))
    }
}

fn level_size(texture: &Texture, level: u32) -> [u32; 2] {
    texture.size_px.map(|n| (n >> level).max(1))
}

/// Uploads all tables and textures, and binds them.
pub(crate) async fn bind_textures(
    gpu: &Gpu,
    layouts: &Layouts,
    scene: &Scene,
    index: &ScratchIndex,
    tables: &ScratchTables,
    array: &TextureArray,
    method: &Method,
) -> Result<wgpu::BindGroup, Error> {
    let black = [Picture::new([1, 1])];
    let environment = scene.environment.as_ref();
    let background = environment.map_or(&black[0], |e| e.background());
    let levels = environment.map_or(black.as_slice(), |e| e.prefiltered_levels());
    let views = [
        scratch_tables(gpu, tables).await?,
        lobe(gpu, "albedo table", lobe_table::albedo_table()).await?,
        lobe(gpu, "polygon lobe table", lobe_table::ltc_table()).await?,
        lobe(gpu, "sphere lobe table", lobe_table::sptd_table()).await?,
        radiance_map(gpu, "environment", std::slice::from_ref(background)).await?,
        radiance_map(gpu, "prefiltered environment", levels).await?,
        array.upload(gpu, &scene.textures).await?,
        published::wavelengths(gpu, scene, tables, method).await?,
        published::triangle_lists(gpu, scene, index, method).await?,
    ];
    let resources = views.each_ref().map(wgpu::BindingResource::TextureView);
    Ok(bind(gpu, "textures", &layouts.textures, &resources))
}

async fn scratch_tables(gpu: &Gpu, tables: &ScratchTables) -> Result<wgpu::TextureView, Error> {
    let size = [table::COLUMNS as u32, table::ROWS as u32];
    let layers = tables.tables.len().max(1) as u32;
    let texture = texture(
        gpu,
        "scratch tables",
        size,
        layers,
        1,
        TextureFormat::Rgba32Uint,
    )
    .await?;
    for (layer, table) in tables.tables.iter().enumerate() {
        write(
            gpu,
            &texture,
            0,
            layer as u32,
            size,
            bytemuck::cast_slice(&table.texels),
        );
    }
    Ok(array_view(&texture))
}

async fn lobe(gpu: &Gpu, what: &str, table: &LobeTable) -> Result<wgpu::TextureView, Error> {
    let size = [LOBE_TABLE_SIZE as u32; 2];
    let texture = texture(gpu, what, size, 1, 1, TextureFormat::Rgba32Float).await?;
    write(
        gpu,
        &texture,
        0,
        0,
        size,
        bytemuck::cast_slice(table.texels()),
    );
    Ok(texture.create_view(&Default::default()))
}

/// Level by level, each half the size of the one before. The texels are half floats already.
async fn radiance_map(
    gpu: &Gpu,
    what: &str,
    levels: &[Picture],
) -> Result<wgpu::TextureView, Error> {
    let size = levels[0].size_px;
    let texture = texture(
        gpu,
        what,
        size,
        1,
        levels.len() as u32,
        TextureFormat::Rgba16Float,
    )
    .await?;
    for (level, map) in levels.iter().enumerate() {
        let half: Vec<[f16; 4]> = map
            .rgb
            .iter()
            .map(|[r, g, b]| [*r, *g, *b, 1.0].map(f16::from_f32))
            .collect();
        write(
            gpu,
            &texture,
            level as u32,
            0,
            map.size_px,
            bytemuck::cast_slice(&half),
        );
    }
    Ok(texture.create_view(&Default::default()))
}

pub(crate) async fn texture(
    gpu: &Gpu,
    what: &str,
    [width, height]: [u32; 2],
    layers: u32,
    levels: u32,
    format: TextureFormat,
) -> Result<wgpu::Texture, Error> {
    let descriptor = wgpu::TextureDescriptor {
        label: Some(what),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: layers,
        },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    };
    gpu.texture(what, &descriptor).await
}

fn array_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    let dimension = Some(TextureViewDimension::D2Array);
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension,
        ..Default::default()
    })
}

pub(crate) fn write(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    level: u32,
    layer: u32,
    [width, height]: [u32; 2],
    texels: &[u8],
) {
    write_at(gpu, texture, level, [0, layer], [width, height], texels);
}

/// Some rows of a texture without layers and levels.
pub(crate) fn write_rows(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    first_row: u32,
    size: [u32; 2],
    texels: &[u8],
) {
    write_at(gpu, texture, 0, [first_row, 0], size, texels);
}

fn write_at(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    level: u32,
    [row, layer]: [u32; 2],
    [width, height]: [u32; 2],
    texels: &[u8],
) {
    let destination = wgpu::TexelCopyTextureInfo {
        texture,
        mip_level: level,
        origin: wgpu::Origin3d {
            x: 0,
            y: row,
            z: layer,
        },
        aspect: wgpu::TextureAspect::All,
    };
    let rows = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some((texels.len() / height as usize) as u32),
        rows_per_image: None,
    };
    let extent = wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    gpu.queue.write_texture(destination, texels, rows, extent);
}
