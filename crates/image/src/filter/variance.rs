//! Variances before the filter, and outliers.

use super::guides::{Guides, LEAST_ALIKE};
use super::signals::{Layer, Signals, noise_std};
use crate::tone_map::tone_luminance as luminance;

/// Pixels to each side over which variances are averaged.
pub const VARIANCE_PX: i32 = 2;
/// Bounced light is an outlier beyond so many standard deviations of the pixels around: with fewer, light that few rays find would be lost.
pub const OUTLIER_STD: f32 = 12.0;
/// Least sum of how alike the pixels around are: fewer tell nothing of outliers.
pub const LEAST_AROUND: f32 = 2.0;

/// Variances of few rounds are noisy themselves: each becomes the mean over the pixels around. After one round alone they are those of the
/// values there. Outliers of bounced light go first.
pub(super) fn smooth_variance(
    guides: &Guides,
    layer: Layer,
    signals: &[Signals],
    rounds: u32,
    i: usize,
    [x, y]: [i32; 2],
) -> Signals {
    let guide = &guides.pixels[i];
    let mut own = signals[i];
    if guide.object == 0 {
        return own;
    }
    let normal_power = layer.normal_power(guide);
    let mut around = [Around::default(); 2];
    for dy in -VARIANCE_PX..=VARIANCE_PX {
        for dx in -VARIANCE_PX..=VARIANCE_PX {
            let Some(j) = guides.index([x + dx, y + dy]) else {
                continue;
            };
            if i == j {
                continue;
            }
            let alike = guides.alike(normal_power, guide, &guides.pixels[j], [dx, dy]);
            if alike >= LEAST_ALIKE {
                let other = &signals[j];
                around[0].add(&other.share, alike);
                around[1].add(&other.bounced, alike);
            }
        }
    }
    own.bounced = around[1].without_outlier(own.bounced, rounds);
    for (signal, mut around) in [&mut own.share, &mut own.bounced].into_iter().zip(around) {
        around.add(signal, 1.0);
        signal[3] = around.smoothed(signal[3], rounds);
    }
    own
}

/// Weighted sums of a signal over the pixels around.
#[derive(Clone, Copy, Default)]
struct Around {
    weights: f32,
    variances: f32,
    /// Weighted sum of the luminance.
    values: f32,
    squares: f32,
}

impl Around {
    fn add(&mut self, &[r, g, b, variance]: &[f32; 4], weight: f32) {
        if variance >= 0.0 {
            let value = luminance([r, g, b]);
            self.weights += weight;
            self.variances += weight * variance;
            self.values += weight * value;
            self.squares += weight * value * value;
        }
    }

    fn mean(&self) -> f32 {
        self.values / self.weights
    }

    /// The variance of the values.
    fn spread(&self) -> f32 {
        let mean = self.mean();
        (self.squares / self.weights - mean * mean).max(0.0)
    }

    /// A signal no brighter than the pixels around make likely, as far as its own noise may be what makes it so. Else a single ray that meets a lamp's
    /// mirror image would become a bright star, as wide as the filter. The limit of many rounds is the signal.
    fn without_outlier(&self, own: [f32; 4], rounds: u32) -> [f32; 4] {
        let [r, g, b, variance] = own;
        if variance < 0.0 || self.weights < LEAST_AROUND {
            return own;
        }
        let value = luminance([r, g, b]);
        // One round gives no variance.
        let noise = if rounds > 1 { variance.sqrt() } else { value };
        let likely = self.mean() + OUTLIER_STD * self.spread().sqrt();
        let most = likely.max(value - noise_std(rounds) * noise);
        if value <= most {
            return own;
        }
        let less = most / value;
        [r * less, g * less, b * less, variance * less * less]
    }

    /// Variance averaged over the neighbours; `own` is the pixel's.
    fn smoothed(&self, own: f32, rounds: u32) -> f32 {
        if own < 0.0 || !(self.weights > 0.0) {
            return own;
        }
        match rounds {
            0 | 1 => self.spread(),
            // A firefly knows that it is one.
            _ => own.max(self.variances / self.weights),
        }
    }
}
