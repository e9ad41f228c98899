//! Images of materials with their mip chains: each level the exact mean of the one below, in linear light.

use std::io::Cursor;

use hairline_image::FilePath;
use hairline_image::tone_map::{linear_from_srgb, srgb_from_linear};
use hairline_memory::{costs, in_words};
use image::{DynamicImage, ImageDecoder, ImageReader, Limits};
use rayon::prelude::*;

use crate::jpeg_end;
use crate::ktx2;
use crate::reading::{self, FileKind};
use crate::text::shown;

const LARGEST_PX: u32 = 16_384;

/// An image with its mip chain; level 0 is `size_px`, each further level is half, rounded down, at least 1.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Width and height of level 0.
    pub size_px: [u32; 2],
    /// Texels of each level, row by row from the top, 8 bits a channel, as stored in the file (sRGB data stays encoded).
    pub levels: Vec<Vec<[u8; 4]>>,
    /// Whether colour channels are sRGB encoded.
    pub srgb: bool,
    /// Sampling of the texture.
    pub sampling: Sampling,
}

/// Sampling of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampling {
    /// Continuation beyond its left and right borders, and beyond the upper and lower ones.
    pub wrap: [Wrap; 2],
    /// Whether its texels, seen large, are rectangles of one value each.
    pub is_sharp: bool,
    /// Whether the texture uses [`Mesh::other_uvs`](crate::mesh::Mesh::other_uvs) in place of
    /// [`Mesh::uvs`](crate::mesh::Mesh::uvs).
    pub by_other_uvs: bool,
}

/// Continuation of a texture beyond a border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The texture repeats.
    #[default]
    Repeat,
    /// The texture's mirror image.
    Mirror,
    /// The texels at the border.
    Clamp,
}

impl Wrap {
    /// Index of the texel, of `count` in a row, at a place of the endless row.
    pub fn texel(self, at: i64, count: i64) -> i64 {
        match self {
            Self::Repeat => at.rem_euclid(count),
            Self::Clamp => at.clamp(0, count - 1),
            Self::Mirror => {
                let at = at.rem_euclid(2 * count);
                at.min(2 * count - 1 - at)
            }
        }
    }
}

/// Meaning of an image's channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channels {
    /// Colours, sRGB encoded.
    Color,
    /// Numbers.
    Linear,
    /// A normal map. In the place of alpha is how far the slopes under a texel spread about that of its normal: their standard deviation in
    /// one direction, the mean of both, 1 at most. A texel of the first level is one normal: 0.
    Normals,
}

/// Reason why an image is no texture.
#[derive(Debug, thiserror::Error)]
pub enum Unusable {
    /// Its decoder refuses it.
    #[error("{0}")]
    Broken(#[from] image::ImageError),
    /// It is a .ktx2 file that is broken or not supported.
    #[error("{0}")]
    Ktx(#[from] ktx2::Broken),
    /// Pixels are missing at its end.
    #[error("it is cut off: its picture ends before the last pixel")]
    CutOff,
    /// It cannot be read.
    #[error(transparent)]
    Unreadable(#[from] std::io::Error),
    /// It does not fit into memory.
    #[error("{}x{} pixels would take about {} of memory, and {} are free", .size_px[0], .size_px[1],
        in_words(texture_bytes(*.size_px)), in_words(.free_bytes.max(0.0)))]
    TooLarge {
        /// Width and height.
        size_px: [u32; 2],
        /// Memory that is free for it.
        free_bytes: f64,
    },
}

/// Memory of a texture.
pub fn texture_bytes([width, height]: [u32; 2]) -> f64 {
    f64::from(width) * f64::from(height) * costs::TEXEL
}

/// Whether a texture of that size may be made where so much of the memory is free.
pub fn check_memory(size_px: [u32; 2], free_bytes: f64) -> Result<(), Unusable> {
    if texture_bytes(size_px) > free_bytes {
        return Err(Unusable::TooLarge {
            size_px,
            free_bytes,
        });
    }
    Ok(())
}

/// Largest share of the free memory for a file.
const SHARE: f64 = 0.25;

/// The picture in a file, upright as its EXIF data says. It may take `free_bytes` as a texture.
///
/// # Errors
/// What was found in the place of a picture.
pub fn read(path: &FilePath, free_bytes: f64) -> Result<Texels, String> {
    let named = |why: String| format!("{}: {why}", shown(&path.to_string_lossy()));
    let bytes = reading::read(path, FileKind::File, SHARE).map_err(|why| named(why.to_string()))?;
    let decoded = decode_turned(&bytes, free_bytes, true);
    decoded.map_err(|why| named(why.to_string()))
}

/// The texels of a PNG, JPEG, WebP or KTX2 file, row by row from the top, and its size. As a texture it may take `free_bytes`. Of glTF files, whose
/// coordinates are of the pixels as they are stored.
pub fn decode(bytes: &[u8], free_bytes: f64) -> Result<Texels, Unusable> {
    decode_turned(bytes, free_bytes, false)
}

fn decode_turned(bytes: &[u8], free_bytes: f64, upright: bool) -> Result<Texels, Unusable> {
    if ktx2::is_ktx(bytes) {
        let size_px = ktx2::size_px(bytes, LARGEST_PX)?;
        check_memory(size_px, free_bytes)?;
        let texels = ktx2::texels(bytes)?;
        return Ok(Texels { size_px, texels });
    }
    let guessed = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let size_px: [u32; 2] = guessed.into_dimensions()?.into();
    check_memory(size_px, free_bytes)?;
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_PX);
    limits.max_image_height = Some(LARGEST_PX);
    reader.limits(limits);
    if jpeg_end::is_cut_off(bytes) {
        return Err(Unusable::CutOff);
    }
    let mut decoder = reader.into_decoder()?;
    let turn = decoder.orientation()?;
    let mut image = DynamicImage::from_decoder(decoder)?;
    if upright {
        image.apply_orientation(turn);
    }
    let image = image.into_rgba8();
    let size_px = [image.width(), image.height()];
    let texels = image.pixels().map(|pixel| pixel.0).collect();
    Ok(Texels { size_px, texels })
}

/// An image as it is stored.
pub struct Texels {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Row by row from the top, 8 bits a channel.
    pub texels: Vec<[u8; 4]>,
}

/// An image with its mip chain; or with the first level alone.
pub fn build_texture(image: Texels, channels: Channels, with_mips: bool) -> Texture {
    let Texels {
        size_px,
        mut texels,
    } = image;
    if channels == Channels::Normals {
        texels.iter_mut().for_each(|texel| texel[3] = 0);
    }
    match with_mips {
        true => self::with_mips(size_px, texels, channels),
        false => Texture {
            size_px,
            levels: vec![texels],
            srgb: channels == Channels::Color,
            sampling: Sampling::default(),
        },
    }
}

impl Texture {
    /// Some thousand texels of the first level, spread over it: enough for a mean.
    pub fn some_texels(&self) -> impl Iterator<Item = &[u8; 4]> + Clone {
        let texels = &self.levels[0];
        texels.iter().step_by(1 + texels.len() / 4096)
    }

    /// Makes a texture of sRGB codes, row by row from the top; it ends at its borders.
    pub fn of_colors(size_px: [u32; 2], texels: Vec<[u8; 4]>) -> Self {
        let mut texture = with_mips(size_px, texels, Channels::Color);
        texture.sampling.wrap = [Wrap::Clamp; 2];
        texture
    }
}

/// A texture from its texels, row by row from the top.
pub fn with_mips(size_px: [u32; 2], texels: Vec<[u8; 4]>, channels: Channels) -> Texture {
    let srgb = channels == Channels::Color;
    let normals = channels == Channels::Normals;
    let to_linear: Vec<f32> = (0..=255u8)
        .map(|code| match srgb {
            true => linear_from_srgb(f32::from(code) / 255.0),
            false => f32::from(code) / 255.0,
        })
        .collect();
    let linear = |texel: &[u8; 4]| {
        let [r, g, b, a] = *texel;
        let [r, g, b] = [r, g, b].map(|code| to_linear[usize::from(code)]);
        let a = if normals {
            slope2([r, g, b])
        } else {
            f32::from(a) / 255.0
        };
        [r, g, b, a]
    };
    let encoded = |texel: &[f32; 4]| {
        let [r, g, b, a] = *texel;
        let code = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
        let a = if normals {
            (0.5 * (a - slope2([r, g, b]))).max(0.0).sqrt()
        } else {
            a
        };
        let [r, g, b] = [r, g, b].map(|x| if srgb { srgb_code(x) } else { code(x) });
        [r, g, b, code(a)]
    };
    let mut size = size_px;
    // Each level is made of the exact one before it, not of its rounded codes.
    let mut level: Vec<[f32; 4]> = texels.par_iter().map(linear).collect();
    let mut levels = vec![texels];
    while size != [1, 1] {
        let half = size.map(|n| (n / 2).max(1));
        level = halved(&level, size, half);
        levels.push(level.par_iter().map(encoded).collect());
        size = half;
    }
    Texture {
        size_px,
        levels,
        srgb,
        sampling: Sampling::default(),
    }
}

/// The squared slope of the surface where a normal map has this texel.
fn slope2([x, y, z]: [f32; 3]) -> f32 {
    let [x, y, z] = [x, y, z].map(|c| 2.0 * c - 1.0);
    // Normals are steeper nowhere than what an 8-bit map is good for.
    (x * x + y * y) / z.max(0.1).powi(2)
}

/// The mean over the area that each of the fewer texels covers.
fn halved(texels: &[[f32; 4]], size: [u32; 2], half: [u32; 2]) -> Vec<[f32; 4]> {
    let columns: Vec<_> = (0..half[0]).map(|x| covered(x, size[0], half[0])).collect();
    (0..half[1])
        .into_par_iter()
        .flat_map_iter(|y| {
            let rows = covered(y, size[1], half[1]);
            columns.iter().map(move |columns| {
                let mut mean = [0.0; 4];
                for &(row, row_share) in &rows {
                    for &(column, column_share) in columns {
                        let texel = texels[(row * size[0] + column) as usize];
                        for channel in 0..4 {
                            mean[channel] += texel[channel] * row_share * column_share;
                        }
                    }
                }
                mean
            })
        })
        .collect()
}

/// Texels of `n` that lie under texel `i` of `half`, with their shares of it: two, or three if `n` is odd.
fn covered(i: u32, n: u32, half: u32) -> Vec<(u32, f32)> {
    // All numbers are whole in units of 1 / half of a texel.
    let (from, to) = (i * n, (i + 1) * n);
    (from / half..to.div_ceil(half))
        .map(|texel| {
            let overlap = to.min((texel + 1) * half) - from.max(texel * half);
            (texel, overlap as f32 / n as f32)
        })
        .collect()
}

/// The code of a linear value.
pub fn srgb_code(linear: f32) -> u8 {
    (srgb_from_linear(linear.clamp(0.0, 1.0)) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_is_averaged_in_linear_light() {
        let checkers = vec![[0, 0, 0, 255], [255, 255, 255, 255]];
        let srgb = with_mips([2, 1], checkers.clone(), Channels::Color);
        // Half the light is code 188, not 128.
        assert_eq!(srgb.levels[1], [[188, 188, 188, 255]]);
        let linear = with_mips([2, 1], checkers, Channels::Linear);
        assert_eq!(linear.levels[1], [[128, 128, 128, 255]]);
    }

    #[test]
    fn coarse_normals_remember_how_they_spread() {
        // Slopes of 0.5 to either side: none in the mean, a spread of 0.5 in one direction.
        let code = |x: f32| ((0.5 * x + 0.5) * 255.0).round() as u8;
        let z = 1.0 / 1.25_f32.sqrt();
        let normal = |x: f32| [code(x * 0.5 * z), 128, code(z), 0];
        let texture = with_mips([2, 1], vec![normal(1.0), normal(-1.0)], Channels::Normals);
        let [x, _, _, spread] = texture.levels[1][0];
        assert!((127..=128).contains(&x));
        let expected = 0.5 / 2.0_f32.sqrt() * 255.0;
        assert!((f32::from(spread) - expected).abs() < 3.0, "{spread}");
        // A slope alone spreads nothing.
        let even = with_mips([2, 1], vec![normal(1.0); 2], Channels::Normals);
        assert!(even.levels[1][0][3] < 3);
    }

    #[test]
    fn every_level_has_the_mean_of_the_first() {
        // Odd sizes in both directions, and levels down to one texel.
        let size = [13, 6];
        let texels: Vec<_> = (0..size[0] * size[1])
            .map(|i| [(i * 37 % 256) as u8, (i * 91 % 256) as u8, 7, 255])
            .collect();
        let texture = with_mips(size, texels, Channels::Linear);
        let sizes: Vec<_> = texture.levels.iter().map(Vec::len).collect();
        assert_eq!(sizes, [78, 18, 3, 1]);
        let mean = |level: &Vec<[u8; 4]>, channel: usize| {
            level.iter().map(|t| f64::from(t[channel])).sum::<f64>() / level.len() as f64
        };
        for level in &texture.levels {
            for channel in 0..4 {
                let error = mean(level, channel) - mean(&texture.levels[0], channel);
                // Each texel is rounded by at most half a code.
                assert!(error.abs() <= 0.5, "{channel}: {error}");
            }
        }
    }
}
