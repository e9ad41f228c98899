//! What the method of 2018 and its parts look up: the wavelengths of each material, and the scratches of each triangle.
//! Where a method has no use for one, a single texel takes its place, since no binding may be empty.

use hairline_index::ScratchIndex;
use hairline_optics::method::Method;
use hairline_scene::{Scene, ScratchTables};
use wgpu::TextureFormat;

use crate::device::Gpu;
use crate::error::Error;
use crate::textures;

/// A row of wavelengths for each scratch table.
pub(crate) async fn wavelengths(
    gpu: &Gpu,
    _scene: &Scene,
    _tables: &ScratchTables,
    _method: &Method,
) -> Result<wgpu::TextureView, Error> {
    none(gpu, "wavelengths", TextureFormat::Rgba32Float).await
}

/// Where each triangle's list begins, then the lists.
pub(crate) async fn triangle_lists(
    gpu: &Gpu,
    _scene: &Scene,
    _index: &ScratchIndex,
    _method: &Method,
) -> Result<wgpu::TextureView, Error> {
    none(gpu, "triangle lists", TextureFormat::R32Uint).await
}

async fn none(gpu: &Gpu, what: &str, format: TextureFormat) -> Result<wgpu::TextureView, Error> {
    let texture = textures::texture(gpu, what, [1, 1], 1, 1, format).await?;
    Ok(texture.create_view(&Default::default()))
}
