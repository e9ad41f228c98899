//! Uploads the tables of a method that is not Hairline's own.

use glam::DVec3;
use wgpu::TextureFormat;

use crate::error::Error;
use crate::method::{Table, TableSource, Texels};
use crate::source::Source;
use crate::transfer::{TexturePosition, Transfer};

/// Uploads all tables, of positions relative to an origin. Hairline's own method has none.
pub(crate) async fn upload(
    transfer: &mut Transfer<'_>,
    source: &Source<'_>,
    origin_m: DVec3,
) -> Result<Vec<wgpu::TextureView>, Error> {
    let mut views = Vec::new();
    let Some(method) = &source.method.other else {
        return Ok(views);
    };
    let table_source = TableSource {
        scene: source.scene,
        index: source.index,
        tables: source.tables,
        origin_m,
    };
    for table in method.tables(&table_source) {
        views.push(upload_table(transfer, &table).await?);
    }
    Ok(views)
}

async fn upload_table(
    transfer: &mut Transfer<'_>,
    table: &Table,
) -> Result<wgpu::TextureView, Error> {
    let Table { what, width, .. } = *table;
    let (format, texel_bytes, texels): (_, _, &[u8]) = match &table.texels {
        Texels::Floats(texels) => (TextureFormat::Rgba32Float, 16, bytemuck::cast_slice(texels)),
        Texels::Integers(texels) => (TextureFormat::Rgba32Uint, 16, bytemuck::cast_slice(texels)),
        Texels::Words(texels) => (TextureFormat::R32Uint, 4, bytemuck::cast_slice(texels)),
    };
    let row_bytes = width as usize * texel_bytes;
    // No texture may be empty.
    let rows = texels.len().div_ceil(row_bytes).max(1);
    let allowed = transfer.gpu.limits().max_texture_dimension_2d;
    if rows > allowed as usize {
        let bytes = |rows: u64| rows * row_bytes as u64;
        let (rows, allowed) = (bytes(rows as u64), bytes(allowed.into()));
        return Err(transfer.gpu.too_large(what, rows, allowed, "bytes"));
    }
    let mut bytes = texels.to_vec();
    bytes.resize(rows * row_bytes, 0);
    let size = [width, rows as u32];
    let texture = transfer.texture(what, size, 1, 1, format).await?;
    transfer.write_texture(what, &texture, TexturePosition::default(), size, &bytes);
    Ok(texture.create_view(&Default::default()))
}
