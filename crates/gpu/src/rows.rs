//! Arrays that lie in textures, 16 bytes a texel, row after row. Twins: `shaders/physics/texels.wgsl`, `shaders/scene/rows.wgsl`.

use wgpu::TextureFormat;

use crate::device::Gpu;
use crate::error::Error;
use crate::transfer::{TexturePosition, Transfer};

/// Texels to a row. Twin: texels.wgsl.
pub const ROW_TEXELS: u32 = 1 << 12;
const TEXEL_BYTES: usize = 16;

/// Bytes of a texture that holds `count` elements of `stride` bytes, and the largest number of bytes that the
/// device allows.
pub(crate) fn bytes_and_allowed(gpu: &Gpu, count: usize, stride: usize) -> (u64, u64) {
    let row_bytes = u64::from(ROW_TEXELS) * TEXEL_BYTES as u64;
    let rows = (count as u64 * stride as u64).div_ceil(row_bytes).max(1);
    let allowed_rows = u64::from(gpu.limits().max_texture_dimension_2d);
    (rows * row_bytes, allowed_rows * row_bytes)
}

/// A texture with `elements`, whose size is a multiple of a texel's; zeros follow them.
///
/// # Errors
/// [`Error::TooLarge`], [`Error::OutOfMemory`].
pub(crate) async fn upload<T: bytemuck::Pod>(
    transfer: &mut Transfer<'_>,
    what: &'static str,
    elements: &[T],
) -> Result<wgpu::TextureView, Error> {
    const { assert!(size_of::<T>().is_multiple_of(TEXEL_BYTES)) };
    let bytes: &[u8] = bytemuck::cast_slice(elements);
    let row_bytes = ROW_TEXELS as usize * TEXEL_BYTES;
    let whole_rows = bytes.len() / row_bytes;
    let rows = bytes.len().div_ceil(row_bytes).max(1);
    let size = [ROW_TEXELS, rows as u32];
    let texture = transfer
        .texture(what, size, 1, 1, TextureFormat::Rgba32Uint)
        .await?;
    let (whole, rest) = bytes.split_at(whole_rows * row_bytes);
    if whole_rows > 0 {
        let size = [ROW_TEXELS, whole_rows as u32];
        transfer.write_texture(what, &texture, TexturePosition::default(), size, whole);
    }
    if !rest.is_empty() {
        let row = whole_rows as u32;
        let place = TexturePosition {
            row,
            ..TexturePosition::default()
        };
        let size = [(rest.len() / TEXEL_BYTES) as u32, 1];
        transfer.write_texture(what, &texture, place, size, rest);
    }
    Ok(texture.create_view(&Default::default()))
}
