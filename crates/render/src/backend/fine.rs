//! A picture with many samples in every pixel. The renderers take several at edges only, since the closed forms average over the
//! rest of a pixel; here they average over a sample's share of it.

use std::ops::Range;

use hairline_image::Image;
use hairline_scene::Scene;

/// Samples along each side of a pixel.
const SIDE: u32 = 8;
/// Number of samples in each pixel.
pub const FINE_SAMPLES: u32 = SIDE * SIDE;
/// Rows of the picture that are rendered together: enough for all threads, and little memory.
const BAND_ROWS: u32 = 8;

/// Some rows of a scene's picture, one sample a pixel.
pub(super) type RenderRows<'a, E> =
    dyn FnMut(&Scene, Range<u32>, &(dyn Fn(f64) + Sync)) -> Result<Image, E> + 'a;

/// Renders with [`FINE_SAMPLES`] in every pixel: by a picture so many times larger, whose pixels are the samples.
pub(super) fn render<E>(
    scene: &Scene,
    render_rows: &mut RenderRows<E>,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Image, E> {
    let [width, height] = scene.render.size_px;
    let mut large = scene.clone();
    large.render.size_px = [SIDE * width, SIDE * height];
    // The square of all samples of a pixel has a part of the variance.
    let variance = scene.render.filter_std_px.powi(2);
    let own = (variance - 1.0 / 12.0).max(0.25 * variance).sqrt();
    large.render.filter_std_px = f64::from(SIDE) * own;
    let mut image = Image::new([width, height]);
    for first in (0..height).step_by(BAND_ROWS as usize) {
        let rows = first..(first + BAND_ROWS).min(height);
        let told = |share: f64| {
            let done = f64::from(rows.start) + share * f64::from(rows.end - rows.start);
            progress(done / f64::from(height));
        };
        let samples = render_rows(&large, SIDE * rows.start..SIDE * rows.end, &told)?;
        let mut at = image.index(0, rows.start);
        for y in 0..rows.end - rows.start {
            for x in 0..width {
                average(&samples, [x, y], &mut image, at);
                at += 1;
            }
        }
    }
    Ok(image)
}

fn average(samples: &Image, [x, y]: [u32; 2], image: &mut Image, at: usize) {
    let mut hits = 0;
    let share = 1.0 / FINE_SAMPLES as f32;
    for (dx, dy) in (0..SIDE).flat_map(|dy| (0..SIDE).map(move |dx| (dx, dy))) {
        let i = samples.index(SIDE * x + dx, SIDE * y + dy);
        for c in 0..3 {
            image.base[at][c] += share * samples.base[i][c];
            image.scratches[at][c] += share * samples.scratches[i][c];
            image.density[at][c] += share * samples.density[i][c];
            image.normal[at][c] += samples.normal[i][c];
        }
        if samples.depth_m[i] > 0.0 {
            hits += 1;
            image.depth_m[at] += samples.depth_m[i];
        }
    }
    image.depth_m[at] /= hits.max(1) as f32;
    let normal = glam::Vec3::from(image.normal[at]);
    image.normal[at] = normal.normalize_or_zero().to_array();
}
