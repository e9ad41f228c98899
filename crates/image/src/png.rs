//! PNG: pictures as a display shows them, 8 or 16 bits a channel, sRGB.

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::tone_map::{Display, display_code, dither_offset, linear_from_srgb, srgb_from_linear};
use crate::{Backdrop, Error, Image, Picture};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::sync::Arc;

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

/// What a PNG has besides the colours of a render.
#[derive(Clone, Debug, Default)]
pub struct Finish {
    /// Whether it has 16 bits a channel in place of 8.
    pub is_deep: bool,
    /// A picture behind a render that has alpha, which it has no more then.
    pub behind: Option<Arc<Backdrop>>,
}

/// Tone-maps and encodes a render, with its alpha if it has one and nothing is behind it: the bytes of a PNG file.
///
/// # Errors
/// Why it cannot be encoded, in words: a picture without pixels, another number of shares than of pixels.
pub fn encode_image(image: &Image, display: &Display, finish: &Finish) -> Result<Vec<u8>, String> {
    let has_alpha = image.alpha.is_some() && finish.behind.is_none();
    if !finish.is_deep {
        let color = match has_alpha {
            false => ExtendedColorType::Rgb8,
            true => ExtendedColorType::Rgba8,
        };
        return encoded(
            &quantize_finished(image, display, finish)?,
            image.size_px,
            color,
        );
    }
    let color = match has_alpha {
        false => ExtendedColorType::Rgb16,
        true => ExtendedColorType::Rgba16,
    };
    let shown = shown(image, display, finish)?;
    let code = |share: f32| (share.clamp(0.0, 1.0) * 65535.0).round() as u16;
    let pixels = shown.rgb.iter().enumerate();
    let codes = pixels.flat_map(|(i, rgb)| {
        let alpha = shown.alpha.map(|alpha| alpha[i]);
        rgb.iter().copied().chain(alpha)
    });
    let bytes: Vec<u8> = codes.flat_map(|share| code(share).to_ne_bytes()).collect();
    encoded(&bytes, image.size_px, color)
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
    quantize_finished(image, display, &Finish::default())
}

/// The same with a picture behind it.
pub(crate) fn quantize_finished(
    image: &Image,
    display: &Display,
    finish: &Finish,
) -> Result<Vec<u8>, String> {
    let shown = shown(image, display, finish)?;
    let codes = dithered(&shown.rgb, image.size_px[0]);
    let Some(alpha) = shown.alpha else {
        return Ok(codes);
    };
    let pixels = codes.chunks_exact(3).zip(alpha);
    let with_alpha = pixels.flat_map(|(rgb, &share)| {
        let code = (share.clamp(0.0, 1.0) * 255.0).round() as u8;
        // A transparent pixel has no colour, dithered or not.
        let rgb = if code == 0 { &[0; 3] } else { rgb };
        [rgb[0], rgb[1], rgb[2], code]
    });
    Ok(with_alpha.collect())
}

/// A render as a display shows it.
struct Shown<'i> {
    /// sRGB, encoded, from 0 to 1; not multiplied by alpha.
    rgb: Vec<[f32; 3]>,
    alpha: Option<&'i [f32]>,
}

/// Divides the colours by alpha, applies the tone curve, and puts the picture behind.
fn shown<'i>(image: &'i Image, display: &Display, finish: &Finish) -> Result<Shown<'i>, String> {
    let mut picture = image.beauty();
    let Some(alpha) = &image.alpha else {
        return Ok(Shown {
            rgb: picture.rgb.iter().map(|rgb| display.apply(*rgb)).collect(),
            alpha: None,
        });
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
    let mut rgb: Vec<[f32; 3]> = picture.rgb.iter().map(|rgb| display.apply(*rgb)).collect();
    let Some(behind) = &finish.behind else {
        let alpha = Some(&alpha[..]);
        return Ok(Shown { rgb, alpha });
    };
    // Light adds up on the display as it does in a lens, before it is encoded.
    let behind = behind.resized(image.size_px);
    for (rgb, (share, behind)) in rgb.iter_mut().zip(alpha.iter().zip(behind)) {
        let share = share.clamp(0.0, 1.0);
        *rgb = std::array::from_fn(|c| {
            let own = share * linear_from_srgb(rgb[c]);
            srgb_from_linear(own + (1.0 - share) * behind[c])
        });
    }
    Ok(Shown { rgb, alpha: None })
}

/// The 8-bit sRGB codes of a picture, three bytes a pixel.
pub fn quantize(picture: &Picture, display: &Display) -> Vec<u8> {
    let shown: Vec<_> = picture.rgb.iter().map(|rgb| display.apply(*rgb)).collect();
    dithered(&shown, picture.size_px[0])
}

/// The 8-bit codes of encoded values.
fn dithered(shown: &[[f32; 3]], width: u32) -> Vec<u8> {
    let width = width.max(1) as usize;
    let pixels = shown.iter().enumerate();
    let codes = pixels.flat_map(|(i, rgb)| {
        let dither = dither_offset((i % width) as u32, (i / width) as u32);
        rgb.map(|encoded| display_code(encoded, dither))
    });
    codes.collect()
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
        let bytes = encode_image(&image, &display, &Finish::default()).unwrap();
        let decoded = image::load_from_memory(&bytes).unwrap().into_rgba8();
        let pixels: Vec<[u8; 4]> = decoded.pixels().map(|pixel| pixel.0).collect();
        assert_eq!(pixels, [[255, 0, 255, 255], [255, 0, 255, 64], [0; 4]]);
        let deep = Finish {
            is_deep: true,
            ..Finish::default()
        };
        let bytes = encode_image(&image, &display, &deep).unwrap();
        let decoded = image::load_from_memory(&bytes).unwrap();
        assert_eq!(decoded.color(), image::ColorType::Rgba16);
        let pixels: Vec<[u16; 4]> = decoded
            .into_rgba16()
            .pixels()
            .map(|pixel| pixel.0)
            .collect();
        assert_eq!(pixels[0], [65535, 0, 65535, 65535]);
        assert_eq!(pixels[1], [65535, 0, 65535, 16384]);
        image.alpha = Some(vec![1.0]);
        let refused = encode_image(&image, &display, &Finish::default()).unwrap_err();
        assert_eq!(refused, "1 values of alpha for 3 pixels");
    }

    /// A quarter of a pixel of red over white: light adds up, whatever the exposure.
    #[test]
    fn a_picture_behind_keeps_its_colours_and_shines_through() {
        let mut image = Image::new([3, 1]);
        image.base[1] = [0.125, 0.0, 0.0];
        image.base[2] = [0.5, 0.0, 0.0];
        image.alpha = Some(vec![0.0, 0.25, 1.0]);
        let display = Display {
            exposure_ev: 1.0,
            tone_map: ToneMap::None,
        };
        let mut white = Picture::new([3, 1]);
        white.rgb.fill([0.5; 3]);
        let finish = Finish {
            is_deep: true,
            behind: Some(Arc::new(Backdrop::new(white))),
        };
        let bytes = encode_image(&image, &display, &finish).unwrap();
        let decoded = image::load_from_memory(&bytes).unwrap();
        assert_eq!(decoded.color(), image::ColorType::Rgb16);
        let linear = |code: u16| linear_from_srgb(f32::from(code) / 65535.0);
        let pixels = decoded.into_rgb16();
        let pixels: Vec<[f32; 3]> = pixels.pixels().map(|it| it.0.map(linear)).collect();
        let right = [[0.5, 0.5, 0.5], [0.625, 0.375, 0.375], [1.0, 0.0, 0.0]];
        for (pixel, right) in pixels.iter().zip(right) {
            assert!(
                (0..3).all(|c| (pixel[c] - right[c]).abs() < 1e-4),
                "{pixel:?}"
            );
        }
    }
}
