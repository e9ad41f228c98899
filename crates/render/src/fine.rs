//! A picture with many samples in every pixel. The renderers take several at edges only, since the closed forms average over the
//! rest of a pixel; here they average over a sample's share of it.

use hairline_gpu::Error;
use hairline_image::Image;
use hairline_scene::Scene;

use crate::rows::{Piece, Rows};

/// Samples along each side of a pixel.
const SIDE: u32 = 8;
/// Number of samples in each pixel.
pub const FINE_SAMPLES: u32 = SIDE * SIDE;
/// Rows of the picture that are rendered together: enough for all threads, and little memory.
const BAND_ROWS: u32 = 8;

/// The scene with a picture so many times larger, whose pixels are the samples.
pub(crate) fn enlarged(scene: &Scene) -> Scene {
    let mut large = scene.clone();
    large.render.size_px = scene.render.size_px.map(|side| SIDE * side);
    // The square of all samples of a pixel has a part of the variance.
    let variance = scene.render.filter_std_px.powi(2);
    let own = (variance - 1.0 / 12.0).max(0.25 * variance).sqrt();
    large.render.filter_std_px = f64::from(SIDE) * own;
    large
}

/// Averages the samples of a picture; `large` are rows of the [`enlarged`] one.
pub(crate) async fn averaged(
    size_px: [u32; 2],
    progress: &(dyn Fn(f64) + Sync),
    large: &mut Rows<'_>,
) -> Result<Image, Error> {
    let [width, height] = size_px;
    let mut image = Image::new(size_px);
    for first in (0..height).step_by(BAND_ROWS as usize) {
        let rows = first..(first + BAND_ROWS).min(height);
        let told = |share: f64| {
            let done = f64::from(rows.start) + share * f64::from(rows.end - rows.start);
            progress(done / f64::from(height));
            true
        };
        let piece = Piece {
            samples: 1,
            batch: None,
            rows: SIDE * rows.start..SIDE * rows.end,
        };
        let (samples, _) = large.render(piece, &told).await?;
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
