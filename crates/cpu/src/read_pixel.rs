//! Reading of one pixel and of the surface under it.

use crate::counts::Counts;
use crate::options::RenderOptions;
use crate::prepared::Prepared;
use crate::silhouettes::is_smooth;
use crate::tile::Tile;
use hairline_image::Image;
use hairline_index::Hit;

/// A pixel of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelReading {
    /// Layers of the pixel: an image of one pixel, equal to that pixel of the whole picture.
    pub image: Image,
    /// Hit of the ray through the pixel's centre.
    pub hit: Option<Hit>,
    /// Segments of scratches with a share in it; the mean over its samples where it has an edge.
    pub segments: f64,
    /// Samples that it took: 1 where there is no edge.
    pub samples: u32,
}

impl Prepared<'_> {
    /// Renders one pixel, in column `x` and row `y` from the top; none outside of the picture. It costs what lists of one row
    /// of tiles cost, some milliseconds.
    pub fn read_pixel(&self, options: &RenderOptions, [x, y]: [u32; 2]) -> Option<PixelReading> {
        let [width, height] = self.scene.render.size_px;
        if x >= width || y >= height {
            return None;
        }
        let (picture, _) = self.picture(options, y..y + 1, &|| false);
        let [column, row] = [x as usize, y as usize];
        let samples = match options.samples.max(1) {
            1 => 1,
            _ if is_smooth(&picture.visibility, &picture.camera, column, row) => 1,
            many => many,
        };
        let mut tile = Tile::new(&picture, &|| false);
        let sample = tile.render_pixel(column, row);
        let [base, scratches] = sample.traced().light();
        let Counts { pairs, .. } = tile.counts;
        Some(PixelReading {
            image: Image {
                size_px: [1, 1],
                base: vec![base],
                scratches: vec![scratches],
                density: vec![sample.density.as_vec3().to_array()],
                depth_m: vec![sample.depth_m as f32],
                normal: vec![sample.normal.as_vec3().to_array()],
                alpha: None,
                noise: None,
                traced: None,
            },
            hit: picture.visibility.hit(column, row).copied(),
            segments: pairs as f64 / f64::from(samples),
            samples,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_fixtures::SceneFile;

    #[test]
    fn a_pixel_is_that_of_the_picture() {
        let scene = SceneFile::seen_from([0.0, -0.5, 0.3])
            .fov_y_deg(30.0)
            .size_px([40, 24])
            .metal("steel", "steel")
            .object("disk", "steel", "disk = { radius_m = 0.1 }")
            .random("disk", 400)
            .with_lines("seed = 1\nlength_m = { mean = 0.05, spread = 0.3 }")
            .with_lines("width_um = { mean = 5.0, spread = 0.1 }\ndepth_nm = { mean = 180.0, spread = 0.1 }")
            .sphere([0.0, 0.3, 0.2], 0.02, 50.0)
            .scene();
        let prepared = Prepared::new(&scene);
        let options = RenderOptions {
            samples: 8,
            ..RenderOptions::default()
        };
        let picture = prepared.render(&options, &|_| {});
        let (mut edges, mut scratched) = (0, 0);
        for i in (0..40 * 24).step_by(7) {
            let at = [i as u32 % 40, i as u32 / 40];
            let reading = prepared.read_pixel(&options, at).unwrap();
            assert_eq!(reading.image.base[0], picture.base[i], "{at:?}");
            assert_eq!(reading.image.scratches[0], picture.scratches[i], "{at:?}");
            assert_eq!(reading.image.depth_m[0], picture.depth_m[i], "{at:?}");
            edges += u32::from(reading.samples > 1);
            scratched += u32::from(reading.segments > 0.0);
        }
        assert!(edges > 3 && scratched > 3, "{edges} {scratched}");
        assert!(prepared.read_pixel(&options, [40, 0]).is_none());
    }
}
