//! The picture on the soft box of `scenes/lamps.toml`: a lamp behind cloth, a frame with a cross, and a dark hem.

use std::io::Cursor;

use anyhow::{Context, Result};
use image::{ImageFormat, Rgb, RgbImage};

const SIZE_PX: [u32; 2] = [192, 64];

/// A PNG, sRGB.
pub fn cloth() -> Result<Vec<u8>> {
    let [width, height] = SIZE_PX;
    let image = RgbImage::from_fn(width, height, |x, y| {
        let at = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
        let (x, y) = (at(x, width), at(y, height));
        let hem = if x.abs().max(y.abs()) > 0.94 {
            0.15
        } else {
            1.0
        };
        let cross = if x.abs() < 0.02 || y.abs() < 0.06 {
            0.7
        } else {
            1.0
        };
        let lamp = 0.3 + 0.7 * libm::exp(-3.0 * (x * x + 0.5 * y * y));
        let linear = [1.0, 0.96, 0.9].map(|c| c * lamp * hem * cross);
        Rgb(linear.map(|c| (255.0 * libm::pow(c, 1.0 / 2.2)).round() as u8))
    });
    let mut bytes = Cursor::new(Vec::new());
    let written = image.write_to(&mut bytes, ImageFormat::Png);
    written.context("write the soft box")?;
    Ok(bytes.into_inner())
}
