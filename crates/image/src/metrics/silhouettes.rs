//! Pixels where a surface is seen whole.

use crate::Image;

/// A mask that leaves silhouettes out: true where the pixel and its eight neighbours all hit a surface or all missed,
/// in both images, and neighbouring depths differ by less than `relative_depth` of the depth.
///
/// # Panics
/// If the sizes differ.
pub fn away_from_silhouettes(a: &Image, b: &Image, relative_depth: f32) -> Vec<bool> {
    assert_eq!(a.size_px, b.size_px, "images of different sizes");
    let [width, height] = a.size_px;
    let mut mask = Vec::with_capacity(a.pixel_count());
    for y in 0..height {
        for x in 0..width {
            let here = a.depth_m[a.index(x, y)];
            let mut smooth = true;
            for v in y.saturating_sub(1)..=(y + 1).min(height - 1) {
                for u in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                    let i = a.index(u, v);
                    for depth in [a.depth_m[i], b.depth_m[i]] {
                        // Zero is a miss: equal misses pass, a miss beside a hit differs by the whole depth.
                        smooth &= (depth - here).abs() <= relative_depth * here.max(depth);
                    }
                }
            }
            mask.push(smooth);
        }
    }
    mask
}
