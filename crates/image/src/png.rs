//! PNG: what a display shows, 8 bits a channel, sRGB.

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::tone_map::{Display, display_code, dither_offset, linear_from_srgb};
use crate::{Error, Picture};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Tone-maps and encodes a picture: the bytes of a PNG file.
///
/// # Errors
/// Why it cannot be encoded, in words: a picture without pixels.
pub fn encode(picture: &Picture, display: &Display) -> Result<Vec<u8>, String> {
    let bytes = quantize(picture, display);
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Default, FilterType::Adaptive)
        .write_image(
            &bytes,
            picture.size_px[0],
            picture.size_px[1],
            ExtendedColorType::Rgb8,
        )
        .map_err(|e| e.to_string())?;
    Ok(png)
}

/// Tone-maps and encodes a picture whose colours are multiplied by `alpha`; in the file they are not.
pub(crate) fn encode_with_alpha(
    picture: &Picture,
    alpha: &[f32],
    display: &Display,
) -> Result<Vec<u8>, String> {
    let straight = |(rgb, &share): (&[f32; 3], &f32)| match share > 0.0 {
        true => rgb.map(|c| c / share),
        false => [0.0; 3],
    };
    let straight = Picture {
        size_px: picture.size_px,
        rgb: picture.rgb.iter().zip(alpha).map(straight).collect(),
    };
    let codes = quantize(&straight, display);
    let bytes: Vec<u8> = codes
        .chunks_exact(3)
        .zip(alpha)
        .flat_map(|(rgb, &share)| {
            let code = (share.clamp(0.0, 1.0) * 255.0).round() as u8;
            // What is not seen has no colour, dithered or not.
            let rgb = if code == 0 { &[0; 3] } else { rgb };
            [rgb[0], rgb[1], rgb[2], code]
        })
        .collect();
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Default, FilterType::Adaptive)
        .write_image(
            &bytes,
            picture.size_px[0],
            picture.size_px[1],
            ExtendedColorType::Rgba8,
        )
        .map_err(|e| e.to_string())?;
    Ok(png)
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

/// Reads an sRGB picture (PNG, 8 or 16 bits) back to linear Rec.709; the tone map stays in it. Grey becomes R = G = B,
/// transparency is dropped.
///
/// # Errors
/// [`Error::CannotRead`], [`Error::Unusable`].
pub fn read_picture(path: &Path) -> Result<Picture, Error> {
    let file = File::open(path).map_err(|e| Error::cannot_read(path, &e))?;
    let decoded = image::load(BufReader::new(file), image::ImageFormat::Png).map_err(|e| {
        Error::Unusable {
            path: path.to_owned(),
            reason: format!("not a PNG file that can be read: {e}"),
        }
    })?;
    // 8-bit codes times 257 are the 16-bit codes of the same values, so that one way serves both.
    let decoded = decoded.into_rgb16();
    Ok(Picture {
        size_px: [decoded.width(), decoded.height()],
        rgb: decoded
            .pixels()
            .map(|p| p.0.map(|code| linear_from_srgb(f32::from(code) / 65535.0)))
            .collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ToneMap;

    #[test]
    fn alpha_divides_the_colours_and_nothing_is_black() {
        let picture = Picture {
            size_px: [3, 1],
            rgb: vec![[1.0, 0.0, 1.0], [0.25, 0.0, 0.25], [0.0; 3]],
        };
        let display = Display {
            exposure_ev: 0.0,
            tone_map: ToneMap::None,
        };
        let bytes = encode_with_alpha(&picture, &[1.0, 0.25, 0.0], &display).unwrap();
        let decoded = image::load_from_memory(&bytes).unwrap().into_rgba8();
        let pixels: Vec<[u8; 4]> = decoded.pixels().map(|pixel| pixel.0).collect();
        assert_eq!(pixels, [[255, 0, 255, 255], [255, 0, 255, 64], [0; 4]]);
    }
}
