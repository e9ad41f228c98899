//! A picture that is finished in part: its last rows are those of the coarser picture before it, enlarged.

use std::sync::Arc;

use egui::{Color32, ColorImage};
use hairline_image::{Display, Image, png};

use super::frame::Picture;

/// A coarse picture as large as the fine one that is to cover it.
pub(super) struct Backdrop {
    pixels: Vec<Color32>,
    size_px: [u32; 2],
    display: Display,
}

impl Backdrop {
    /// Enlarges `coarse` as a texture would be.
    pub fn new(coarse: &Image, size_px: [u32; 2], display: &Display) -> Self {
        let rgb = png::quantize(&coarse.beauty(), display);
        let [from_x, from_y] = coarse.size_px.map(|side| side as usize);
        let texel = |x: usize, y: usize, c: usize| f32::from(rgb[3 * (y * from_x + x) + c]);
        let columns: Vec<_> = (0..size_px[0])
            .map(|x| linear_taps(x, size_px[0], from_x))
            .collect();
        let mut pixels = Vec::with_capacity(size_px[0] as usize * size_px[1] as usize);
        for y in 0..size_px[1] {
            let (y0, y1, v) = linear_taps(y, size_px[1], from_y);
            for &(x0, x1, u) in &columns {
                let [r, g, b] = [0, 1, 2].map(|c| {
                    let above = texel(x0, y0, c) * (1.0 - u) + texel(x1, y0, c) * u;
                    let below = texel(x0, y1, c) * (1.0 - u) + texel(x1, y1, c) * u;
                    (above * (1.0 - v) + below * v).round() as u8
                });
                pixels.push(Color32::from_rgb(r, g, b));
            }
        }
        Self {
            pixels,
            size_px,
            display: *display,
        }
    }

    /// The picture whose first `rows` are there.
    pub fn composite(&self, fine: &Image, rows: u32) -> Picture {
        let part = fine.rows(0..rows);
        let rgb = png::quantize(&part.beauty(), &self.display);
        let mut pixels = self.pixels.clone();
        for (pixel, rgb) in pixels.iter_mut().zip(rgb.chunks_exact(3)) {
            *pixel = Color32::from_rgb(rgb[0], rgb[1], rgb[2]);
        }
        let size = self.size_px.map(|side| side as usize);
        Picture::Pixels(Arc::new(ColorImage::new(size, pixels)))
    }
}

/// The two texels of `from` next to pixel `at` of `to`, and the weight of the second.
fn linear_taps(at: u32, to: u32, from: usize) -> (usize, usize, f32) {
    let place = (at as f32 + 0.5) * from as f32 / to as f32 - 0.5;
    let place = place.clamp(0.0, (from - 1) as f32);
    let first = place.floor() as usize;
    (first, (first + 1).min(from - 1), place.fract())
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_image::ToneMap;

    #[test]
    fn rows_that_are_there_are_those_of_the_fine_picture_and_the_rest_of_the_coarse_one() {
        let display = Display {
            exposure_ev: 0.0,
            tone_map: ToneMap::default(),
        };
        let mut coarse = Image::new([2, 2]);
        coarse.base.fill([0.1; 3]);
        let mut fine = Image::new([5, 6]);
        fine.base.fill([0.6; 3]);
        let backdrop = Backdrop::new(&coarse, [5, 6], &display);
        let Picture::Pixels(shown) = backdrop.composite(&fine, 2) else {
            panic!("no pixels");
        };
        assert_eq!(shown.size, [5, 6]);
        let (there, rest) = shown.pixels.split_at(10);
        assert!(there.iter().all(|pixel| pixel.g() > 150), "{there:?}");
        assert!(rest.iter().all(|pixel| pixel.g() < 120), "{rest:?}");
    }
}
