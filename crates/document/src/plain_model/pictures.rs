//! Textures as PNG files.

use hairline_model::texture::Texture;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

/// The first level of a texture as a PNG file. Alpha is in it where it says something: that of normals is a figure of Hairline's own.
pub(super) fn png(texture: &Texture, are_normals: bool) -> Vec<u8> {
    let texels = texture.levels[0].iter();
    let is_opaque = are_normals || texels.clone().all(|texel| texel[3] == u8::MAX);
    let (channels, kind) = match is_opaque {
        true => (3, ExtendedColorType::Rgb8),
        false => (4, ExtendedColorType::Rgba8),
    };
    let bytes: Vec<u8> = texels
        .flat_map(|texel| &texel[..channels])
        .copied()
        .collect();
    let [width, height] = texture.size_px;
    let mut png = Vec::new();
    // Writing into memory cannot fail, and the number of bytes is right.
    let _ = PngEncoder::new(&mut png).write_image(&bytes, width, height, kind);
    png
}
