//! A picture behind a render: it fills the whole, and is seen where the render is transparent.

use image::imageops::{self, FilterType};
use image::{ImageBuffer, Rgb};

use crate::Picture;

/// A picture behind renders. Its colours are those of a display: no exposure and no tone curve changes them.
#[derive(Clone, Debug, PartialEq)]
pub struct Backdrop(Picture);

impl Backdrop {
    /// Of a picture of linear Rec.709 on a display, from 0 to 1.
    pub fn new(picture: Picture) -> Self {
        Self(picture)
    }

    /// The pixels of a picture of that size, row by row: as large as fills it, with the middle in the middle.
    pub(crate) fn resized(&self, size_px: [u32; 2]) -> Vec<[f32; 3]> {
        let own_px = self.0.size_px;
        let scale = |axis: usize| f64::from(size_px[axis]) / f64::from(own_px[axis].max(1));
        let factor = scale(0).max(scale(1));
        let [width, height] = [0, 1].map(|axis| {
            let side = (f64::from(own_px[axis]) * factor).round() as u32;
            side.max(size_px[axis])
        });
        let codes = self.0.rgb.iter().flatten().copied().collect();
        let own = ImageBuffer::<Rgb<f32>, Vec<f32>>::from_raw(own_px[0], own_px[1], codes);
        let filling = imageops::resize(
            &own.unwrap_or_default(),
            width,
            height,
            FilterType::Triangle,
        );
        let [left, top] = [(width - size_px[0]) / 2, (height - size_px[1]) / 2];
        let seen = imageops::crop_imm(&filling, left, top, size_px[0], size_px[1]);
        seen.to_image().pixels().map(|pixel| pixel.0).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_backdrop_fills_a_picture_of_another_shape_from_the_middle() {
        // Black, white, black.
        let mut picture = Picture::new([6, 2]);
        for i in [2, 3, 8, 9] {
            picture.rgb[i] = [1.0; 3];
        }
        let backdrop = Backdrop::new(picture.clone());
        assert_eq!(backdrop.resized([6, 2]), picture.rgb);
        assert_eq!(backdrop.resized([2, 2]), vec![[1.0; 3]; 4]);
        let wide = backdrop.resized([12, 2]);
        assert_eq!((wide.len(), wide[0]), (24, [0.0; 3]));
        assert!((wide[6][0] - 1.0).abs() < 1e-5, "{:?}", wide[6]);
    }
}
