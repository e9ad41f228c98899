//! The textures of materials in one array.

use hairline_scene::{Sampling, Scene, Texture, Wrap};
use wgpu::{TextureFormat, TextureViewDimension};

use crate::error::Error;
use crate::transfer::{TexturePosition, Transfer};

/// All textures of the materials in one array: a layer each, every texture in its own size in the upper left corner, so
/// that no texel is resampled.
pub(crate) struct TextureArray {
    size_px: [u32; 2],
    levels: u32,
    /// First level of each texture that is uploaded.
    first_levels: Vec<u32>,
    packed: Vec<[u32; 2]>,
}

/// Largest size of an array. Larger ones start their largest textures at a coarser level: details that a picture rarely
/// resolves are not worth more.
const ARRAY_MAX_BYTES: u64 = 1 << 30;
/// Largest side of a texture on every WebGPU device.
const TEXTURE_MAX_PX: u32 = 8192;

impl TextureArray {
    pub(crate) fn new(scene: &Scene) -> Self {
        let mut side_px = TEXTURE_MAX_PX;
        loop {
            let array = Self::limited_to(&scene.textures, side_px);
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
    fn limited_to(textures: &[Texture], side_px: u32) -> Self {
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
                layer as u32
                    | levels << 16
                    | u32::from(texture.srgb) << 24
                    | sampling(&texture.sampling) << 25,
            ]);
        }
        array
    }

    /// Shader's reference to a texture; zeros stand for none.
    pub(crate) fn packed(&self, texture: Option<usize>) -> [u32; 2] {
        texture.map_or([0; 2], |i| self.packed[i])
    }

    pub(crate) async fn upload(
        &self,
        transfer: &mut Transfer<'_>,
        textures: &[Texture],
    ) -> Result<wgpu::TextureView, Error> {
        let what = "textures";
        let layers = transfer.gpu.array_layers(textures.len() as u32);
        let format = TextureFormat::Rgba8Unorm;
        let array = transfer
            .texture(what, self.size_px, layers, self.levels, format)
            .await?;
        for (layer, texture) in (0..).zip(textures) {
            let first = self.first_levels[layer as usize];
            for level in first..texture.levels.len() as u32 {
                let texels = bytemuck::cast_slice(&texture.levels[level as usize]);
                let place = TexturePosition {
                    level: level - first,
                    layer,
                    row: 0,
                };
                let size = level_size(texture, level);
                transfer.write_texture(what, &array, place, size, texels);
            }
        }
        Ok(array_view(&array))
    }
}

/// Two bits for each wrap, then one for sharp texels and one for the other coordinates. Twin: scene.wgsl.
fn sampling(sampling: &Sampling) -> u32 {
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => 0,
        Wrap::Mirror => 1,
        Wrap::Clamp => 2,
    };
    let [x, y] = sampling.wrap.map(wrap);
    x | y << 2 | u32::from(sampling.is_sharp) << 4 | u32::from(sampling.by_other_uvs) << 5
}

fn level_size(texture: &Texture, level: u32) -> [u32; 2] {
    texture.size_px.map(|n| (n >> level).max(1))
}

/// View of a texture as an array, whatever the number of its layers.
pub(crate) fn array_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    let dimension = Some(TextureViewDimension::D2Array);
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension,
        ..Default::default()
    })
}
