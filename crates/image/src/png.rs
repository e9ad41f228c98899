//! PNG: pictures as a display shows them, 8 bits a channel, sRGB.

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::tone_map::{Display, display_code, dither_offset, linear_from_srgb};
use crate::{Error, Image, Picture};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Tone-maps and encodes a picture: the bytes of a PNG file.
///
/// # Errors
/// Why it cannot be encoded, in words: a picture without pixels.
pub fn encode(picture: &Picture, display: &Display) -> Result<Vec<u8>, String> {
    encoded(
        &quantize(picture, display),
        picture.size_px,
        ExtendedColorType::Rgb8,
    )
}

/// Tone-maps and encodes a render, with its alpha if it has one: the bytes of a PNG file.
///
/// # Errors
/// Why it cannot be encoded, in words: a picture without pixels, another number of shares than of pixels.
pub fn encode_image(image: &Image, display: &Display) -> Result<Vec<u8>, String> {
    let color = match image.alpha {
        None => ExtendedColorType::Rgb8,
        Some(_) => ExtendedColorType::Rgba8,
    };
    encoded(&quantize_image(image, display)?, image.size_px, color)
}

fn encoded(codes: &[u8], size_px: [u32; 2], color: ExtendedColorType) -> Result<Vec<u8>, String> {
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Default, FilterType::Adaptive)
        .write_image(codes, size_px[0], size_px[1], color)
        .map_err(|e| e.to_string())?;
    Ok(png)
}

/// The 8-bit sRGB codes of a render: three bytes a pixel, or four with the share that surfaces cover. Colours are not multiplied by it.
///
/// # Errors
/// In words: another number of shares than of pixels.
pub fn quantize_image(image: &Image, display: &Display) -> Result<Vec<u8>, String> {
    let mut picture = image.beauty();
    let Some(alpha) = &image.alpha else {
        return Ok(quantize(&picture, display));
    };
    if alpha.len() != picture.rgb.len() {
        let (shares, pixels) = (alpha.len(), picture.rgb.len());
        return Err(format!("{shares} values of alpha for {pixels} pixels"));
    }
    for (rgb, &share) in picture.rgb.iter_mut().zip(alpha) {
        *rgb = match share > 0.0 {
            true => rgb.map(|c| c / share),
            false => [0.0; 3],
        };
    }
    let codes = quantize(&picture, display);
    let pixels = codes.chunks_exact(3).zip(alpha);
    let with_alpha = pixels.flat_map(|(rgb, &share)| {
        let code = (share.clamp(0.0, 1.0) * 255.0).round() as u8;
        // A transparent pixel has no colour, dithered or not.
        let rgb = if code == 0 { &[0; 3] } else { rgb };
        [rgb[0], rgb[1], rgb[2], code]
    });
    Ok(with_alpha.collect())
}

/// The 8-bit sRGB codes of a picture, three bytes a pixel.
pub fn quantize(picture: &Picture, display: &Display) -> Vec<u8> {
    let width = picture.size_px[0].max(1) as usize;
    picture
        .rgb
        .iter()
        .enumerate()
        .flat_map(|(i, &rgb)| {
            let dither = dither_offset((i % width) as u32, (i / width) as u32);
            display
                .apply(rgb)
                .map(|encoded| display_code(encoded, dither))
        })
        .collect()
}

/// Reads an sRGB picture (PNG, 8 or 16 bits) back to linear Rec.709; the tone map stays in it. Grey becomes R = G = B, and what is
/// transparent is black by as much.
///
/// # Errors
/// [`Error::CannotRead`], [`Error::Unusable`].
pub fn read_picture(path: &Path) -> Result<Picture, Error> {
    Ok(read_with_alpha(path)?.0)
}

/// Reads the picture, with its alpha if it has one.
pub(crate) fn read_with_alpha(path: &Path) -> Result<(Picture, Option<Vec<f32>>), Error> {
    let file = File::open(path).map_err(|e| Error::cannot_read(path, &e))?;
    let decoded = image::load(BufReader::new(file), image::ImageFormat::Png).map_err(|e| {
        Error::Unusable {
            path: path.to_owned(),
            reason: format!("not a PNG file that can be read: {e}"),
        }
    })?;
    // 8-bit codes times 257 are the 16-bit codes of the same values, so that one way serves both.
    let has_alpha = decoded.color().has_alpha();
    let decoded = decoded.into_rgba16();
    let share = |code: u16| f32::from(code) / 65535.0;
    let picture = Picture {
        size_px: [decoded.width(), decoded.height()],
        rgb: decoded
            .pixels()
            .map(|p| {
                let [r, g, b, a] = p.0.map(share);
                [r, g, b].map(|code| linear_from_srgb(code) * a)
            })
            .collect(),
    };
    let alpha = has_alpha.then(|| decoded.pixels().map(|p| share(p.0[3])).collect());
    Ok((picture, alpha))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ToneMap;

    #[test]
    fn alpha_divides_the_colours_and_nothing_is_black() {
        let mut image = Image::new([3, 1]);
        image.base = vec![[0.5, 0.0, 0.5], [0.25, 0.0, 0.25], [0.0; 3]];
        image.scratches[0] = [0.5, 0.0, 0.5];
        image.alpha = Some(vec![1.0, 0.25, 0.0]);
        let display = Display {
            exposure_ev: 0.0,
            tone_map: ToneMap::None,
        };
        let bytes = encode_image(&image, &display).unwrap();
        let decoded = image::load_from_memory(&bytes).unwrap().into_rgba8();
        let pixels: Vec<[u8; 4]> = decoded.pixels().map(|pixel| pixel.0).collect();
        assert_eq!(pixels, [[255, 0, 255, 255], [255, 0, 255, 64], [0; 4]]);
        image.alpha = Some(vec![1.0]);
        let refused = encode_image(&image, &display).unwrap_err();
        assert_eq!(refused, "1 values of alpha for 3 pixels");
    }
}
