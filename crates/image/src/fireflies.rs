//! Fireflies: pixels in which few rays found much light. What noise alone explains of them goes to the pixels around, so that the
//! picture's mean stays as it is, and nothing is taken from pixels that are sure of their light.

use rayon::prelude::*;

use crate::Image;

/// Pixels to each side among which a firefly stands out.
const NEAR_PX: i32 = 2;
/// Pixels to each side that its light goes to.
const FAR_PX: i32 = 8;
/// Standard deviation of the weights by which its light is spread, pixels.
const SPREAD_PX: f32 = 3.5;
/// The least number of similar pixels about one, of 24, that it can stand out among.
const LEAST_NEAR: usize = 4;
/// The share of a pixel's excess over its surroundings that its standard error must reach: light that one batch of many found has an
/// error as large as itself, light that nine found a third of it.
const NOISY: f32 = 0.35;

/// Spreads the fireflies of a picture's base over what is similar around them. More samples leave less to spread: the limit is the
/// picture itself. Scratches are left as they are, and so is [`Image::noise`]. Without known noise ([`crate::Noise::is_known`]) nothing
/// changes.
pub fn spread_fireflies(image: &mut Image) {
    let Some(noise) = &image.noise else { return };
    let surfaces = Surfaces(image);
    let base: Vec<f32> = image.base.iter().map(|&c| luminance(c)).collect();
    let error = |i: usize| luminance(noise.base[i].map(|v| v.max(0.0).sqrt()));
    let spread = |i: usize| {
        let is_noisy = noise.is_known(i) && error(i) > 0.0;
        let all = is_noisy.then(|| surfaces.upper_quartile(i, &base))??;
        let excess = base[i] - all;
        (excess > 0.0 && error(i) > NOISY * excess).then(|| (i, excess / base[i]))
    };
    let fireflies: Vec<(usize, f32)> = (0..base.len()).into_par_iter().filter_map(spread).collect();
    let mut sums = image.base.clone();
    for (i, share) in fireflies {
        let near = surfaces.similar(i, FAR_PX);
        let weighted: Vec<(usize, f32)> = near.map(|(j, d2)| (j, weight(d2))).collect();
        let all: f32 = weighted.iter().map(|(_, weight)| weight).sum::<f32>() + 1.0;
        let light = image.base[i].map(|c| c * share);
        add(&mut sums[i], light, 1.0 / all - 1.0);
        for (j, weight) in weighted {
            add(&mut sums[j], light, weight / all);
        }
    }
    image.base = sums;
}

fn weight(distance2_px: i32) -> f32 {
    (-0.5 * distance2_px as f32 / (SPREAD_PX * SPREAD_PX)).exp()
}

fn add(sum: &mut [f32; 3], light: [f32; 3], times: f32) {
    for c in 0..3 {
        sum[c] += times * light[c];
    }
}

fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// What the pixels of an image see.
struct Surfaces<'a>(&'a Image);

impl Surfaces<'_> {
    /// The pixels that lie about pixel `i`, itself left out, and see a surface like its own, with their squared distances.
    fn similar(&self, i: usize, reach_px: i32) -> impl Iterator<Item = (usize, i32)> {
        let [width, height] = self.0.size_px.map(|n| n as i32);
        let (x, y) = (i as i32 % width, i as i32 / width);
        let rows = (y - reach_px).max(0)..(y + reach_px + 1).min(height);
        let columns = (x - reach_px).max(0)..(x + reach_px + 1).min(width);
        rows.flat_map(move |row| columns.clone().map(move |column| (row, column)))
            .map(move |(row, column)| {
                let distance2_px = (row - y) * (row - y) + (column - x) * (column - x);
                ((row * width + column) as usize, distance2_px)
            })
            .filter(move |&(j, _)| j != i && self.is_alike(i, j))
    }

    fn is_alike(&self, i: usize, j: usize) -> bool {
        let (depth_m, normal) = (&self.0.depth_m, &self.0.normal);
        let cos: f32 = (0..3).map(|c| normal[i][c] * normal[j][c]).sum();
        cos > 0.95 && (depth_m[i] - depth_m[j]).abs() < 0.05 * depth_m[i]
    }

    /// What a quarter of the pixels about one exceed.
    fn upper_quartile(&self, i: usize, values: &[f32]) -> Option<f32> {
        let mut around: Vec<f32> = self.similar(i, NEAR_PX).map(|(j, _)| values[j]).collect();
        let count = around.len();
        (count >= LEAST_NEAR).then(|| {
            *around
                .select_nth_unstable_by(3 * count / 4, f32::total_cmp)
                .1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Batches;

    const SIZE: usize = 24;
    const MIDDLE: usize = SIZE * SIZE / 2 + SIZE / 2;

    /// A flat surface of light 1 but for one pixel, which has `found` in some batches of 16.
    fn picture(found: f32, batches: std::ops::Range<usize>) -> Image {
        let mut sum = Batches::new(64);
        for batch in 0..16 {
            let mut image = Image::new([SIZE as u32; 2]);
            image.base.fill([1.0; 3]);
            image.depth_m.fill(1.0);
            image.normal.fill([0.0, 0.0, 1.0]);
            if batches.contains(&batch) {
                image.base[MIDDLE] = [found; 3];
            }
            sum.add(image);
        }
        sum.into_image().unwrap()
    }

    fn red(image: &Image) -> f64 {
        image.base.iter().map(|c| f64::from(c[0])).sum()
    }

    #[test]
    fn what_one_batch_found_is_spread_and_stays_in_the_picture() {
        let before = picture(1000.0, 3..4);
        let mut after = before.clone();
        spread_fireflies(&mut after);
        assert!(before.base[MIDDLE][0] > 60.0 && after.base[MIDDLE][0] < 3.0);
        assert!((red(&after) / red(&before) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn what_all_batches_found_stays_to_the_bit() {
        for before in [picture(1000.0, 0..16), picture(1.0, 0..0)] {
            let mut after = before.clone();
            spread_fireflies(&mut after);
            assert_eq!(before, after);
        }
    }

    #[test]
    fn light_does_not_leave_a_surface() {
        let mut before = picture(1000.0, 3..4);
        // The right half is another surface, the left one the firefly's but for its column.
        for i in (0..SIZE * SIZE).filter(|i| i % SIZE > SIZE / 2) {
            before.normal[i] = [1.0, 0.0, 0.0];
        }
        let mut after = before.clone();
        spread_fireflies(&mut after);
        assert_ne!(before, after);
        for i in (0..SIZE * SIZE).filter(|i| i % SIZE > SIZE / 2) {
            assert_eq!(before.base[i], after.base[i]);
        }
    }
}
