//! Pictures that say of each place of a surface how much of something there is.

use glam::DVec2;
use hairline_image::FilePath;

use hairline_model::texture;

/// A picture of shares from 0 to 1, which is repeated beyond its borders.
#[derive(Clone, Debug)]
pub(crate) struct GreyMap {
    size_px: [u32; 2],
    /// Row by row from the top.
    values: Vec<u8>,
}

/// Value of a texel: the mean of its colours, times its alpha where it has one.
pub(crate) fn share([r, g, b, a]: &[u8; 4]) -> u8 {
    let sum = u32::from(*r) + u32::from(*g) + u32::from(*b);
    // Rounded, and exact for white and black.
    ((sum * u32::from(*a) + 382) / 765) as u8
}

impl GreyMap {
    /// Makes a map of texels, row by row from the top; none where they are no whole rows.
    pub(crate) fn new(width_px: u32, texels: &[[u8; 4]]) -> Option<Self> {
        let height_px = texels.len() as u32 / width_px.max(1);
        let is_whole = !texels.is_empty() && (width_px * height_px) as usize == texels.len();
        is_whole.then(|| Self {
            size_px: [width_px, height_px],
            values: texels.iter().map(share).collect(),
        })
    }

    /// Reads a .png, .jpg or .webp, which may take `free_bytes`. Its values are those of its codes, 1 for the lightest.
    ///
    /// # Errors
    /// What was found in the place of a picture.
    pub(crate) fn read(path: &FilePath, free_bytes: f64) -> Result<Self, String> {
        let image = texture::read(path, free_bytes)?;
        Ok(Self {
            size_px: image.size_px,
            values: image.texels.iter().map(share).collect(),
        })
    }

    /// Width and height in texels.
    pub(crate) fn size(&self) -> DVec2 {
        DVec2::new(self.size_px[0].into(), self.size_px[1].into())
    }

    /// Value of the map at a place, bilinear between the four texels about it. (0, 0) is the upper left corner.
    pub(crate) fn value(&self, uv: DVec2) -> f64 {
        let [width, height] = self.size_px.map(i64::from);
        let at = uv * self.size() - 0.5;
        let corner = at.floor();
        let share = at - corner;
        let texel = |dx: i64, dy: i64| {
            let x = (corner.x as i64 + dx).rem_euclid(width);
            let y = (corner.y as i64 + dy).rem_euclid(height);
            f64::from(self.values[(y * width + x) as usize]) / 255.0
        };
        let row = |dy| texel(0, dy) * (1.0 - share.x) + texel(1, dy) * share.x;
        row(0) * (1.0 - share.y) + row(1) * share.y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgba, RgbaImage};

    #[test]
    fn values_are_codes_and_lie_as_the_picture_does() {
        let dir = tempfile::tempdir().unwrap();
        let path = FilePath::from(dir.path()).join("corners.png");
        let mut picture = RgbaImage::from_pixel(2, 2, Rgba([0, 0, 0, 255]));
        picture.put_pixel(1, 0, Rgba([255; 4]));
        picture.put_pixel(0, 1, Rgba([255, 255, 255, 51]));
        picture.save(&path).unwrap();
        let map = GreyMap::read(&path, 1e9).unwrap();
        // The middles of the four texels, then of the whole.
        for (u, v, expected) in [
            (0.25, 0.25, 0.0),
            (0.75, 0.25, 1.0),
            (0.25, 0.75, 0.2),
            (0.75, 0.75, 0.0),
            (1.75, -0.75, 1.0),
            (0.5, 0.5, 0.3),
        ] {
            let value = map.value(DVec2::new(u, v));
            assert!((value - expected).abs() < 1e-9, "{u} {v}: {value}");
        }
        std::fs::write(&path, "no picture").unwrap();
        assert!(GreyMap::read(&path, 1e9).is_err());
    }
}
