//! The filter of the light that rays found: H. Dammertz, D. Sewtz, J. Hanika, H. Lensch, *Edge-Avoiding A-Trous Wavelet Transform for fast Global
//! Illumination Filtering*, 2010, with variances as in C. Schied et al., *Spatiotemporal Variance-Guided Filtering*, 2017.
//!
//! It works on two signals of each layer: the share of the closed form that is seen, and the mean light of other objects. The closed form, its
//! textures and its scratches are as sharp after it as before. Pixels are averaged where they see the same surface and where their difference is
//! noise: as rounds add up, variances fall, and the limit is what rays found.

use rayon::prelude::*;

use crate::tone_map::tone_luminance as luminance;
use crate::traced::{Traced, TracedLight};
use crate::{Image, Noise};
use guides::Guides;
use signals::{Layer, Signals};
use variance::smooth_variance;

mod guides;
mod signals;
mod variance;

pub use guides::{LEAST_ALIKE, OFF_PLANE, OUTLINE_PX};
pub use signals::{MIRROR_STEP_PX, NORMAL_POWER, ROUGH_NORMALS, ROUGH_STEP_PX, noise_std};
pub use variance::{LEAST_AROUND, OUTLIER_STD, VARIANCE_PX};

/// Passes, each with twice the step of the one before.
pub const PASSES: u32 = 5;
/// Weights of three taps, a quarter and a half: the B-spline.
const TAPS: [(i32, f32); 3] = [(-1, 0.25), (0, 0.5), (1, 0.25)];

/// Replaces base and scratches of a picture by the light that rays found, filtered. Nothing changes without rays.
pub fn filter_traced(image: &mut Image) {
    let Some(traced) = image.traced.take() else {
        return;
    };
    let guides = Guides::new(image, &traced);
    let layers = [Layer::Diffuse, Layer::Specular, Layer::Scratches];
    let [diffuse, specular, scratches] = layers.map(|layer| filter_layer(&guides, &traced, layer));
    let light = |i: usize, signals: &[Signals], light: &TracedLight| match signals.get(i) {
        Some(signals) => signals.light(light),
        None => light.light(),
    };
    image
        .base
        .par_iter_mut()
        .zip(image.scratches.par_iter_mut())
        .enumerate()
        .for_each(|(i, (base, on_scratches))| {
            let pixel = &traced.pixels[i];
            let of_body = light(i, &diffuse, &pixel.diffuse);
            let of_surface = light(i, &specular, &pixel.specular);
            *base = std::array::from_fn(|c| pixel.rest[c] + (of_body[c] + of_surface[c]));
            *on_scratches = light(i, &scratches, &pixel.scratches);
        });
    image.traced = Some(traced);
}

impl Traced {
    /// Variances of base and scratches that no filter has changed. Diffuse and specular light share their rays: their standard deviations add up,
    /// which is an upper bound.
    fn noise(&self, image: &Image) -> Noise {
        let mut noise = Noise::new(image.size_px, 1);
        noise.samples.fill(self.rounds);
        for (i, pixel) in self.pixels.iter().enumerate() {
            let [diffuse, specular, scratches] =
                [&pixel.diffuse, &pixel.specular, &pixel.scratches]
                    .map(|light| light.variance(self.rounds));
            noise.base[i] = std::array::from_fn(|c| {
                diffuse[c] + specular[c] + 2.0 * (diffuse[c] * specular[c]).sqrt()
            });
            noise.scratches[i] = scratches;
            noise.beauty[i] = std::array::from_fn(|c| noise.base[i][c] + scratches[c]);
        }
        noise
    }
}

impl Image {
    /// Replaces base and scratches by the light that rays found, without a filter, and sets their variances.
    pub(crate) fn show_traced(&mut self) {
        let Some(traced) = &self.traced else { return };
        for (i, pixel) in traced.pixels.iter().enumerate() {
            [self.base[i], self.scratches[i]] = pixel.light();
        }
        self.noise = (traced.rounds > 1).then(|| traced.noise(self));
    }
}

/// Filters the signals of a layer; empty where the layer has no noise.
fn filter_layer(guides: &Guides, traced: &Traced, layer: Layer) -> Vec<Signals> {
    let rounds = traced.rounds;
    let mut signals: Vec<Signals> = traced
        .pixels
        .par_iter()
        .map(|pixel| Signals::new(layer.light(pixel), rounds))
        .collect();
    let is_noisy = |s: &Signals| {
        s.share[3] > 0.0
            || s.bounced[3] > 0.0
            || (rounds < 2 && (s.share[3] == 0.0 || s.bounced[3] == 0.0))
    };
    if !signals.par_iter().any(is_noisy) {
        return Vec::new();
    }
    // Passes read one and write the other: memory that is new in each pass costs more than the pass where many threads ask for it at once.
    let mut filtered = signals.clone();
    over_pixels(guides, &mut filtered, |i, [x, y]| {
        smooth_variance(guides, layer, &signals, rounds, i, [x, y])
    });
    for pass in 0..PASSES {
        std::mem::swap(&mut signals, &mut filtered);
        over_pixels(guides, &mut filtered, |i, [x, y]| {
            filter_pixel(guides, layer, &signals, (rounds, 1 << pass), i, [x, y])
        });
    }
    filtered
}

/// One pass for a pixel: the mean over nine pixels, `step` apart.
fn filter_pixel(
    guides: &Guides,
    layer: Layer,
    signals: &[Signals],
    (rounds, step): (u32, i32),
    i: usize,
    [x, y]: [i32; 2],
) -> Signals {
    let own = &signals[i];
    let guide = &guides.pixels[i];
    let is_still = own.share[3] <= 0.0 && own.bounced[3] <= 0.0;
    if is_still || guide.object == 0 || !layer.reaches(step, guide) {
        return *own;
    }
    let normal_power = layer.normal_power(guide);
    let mut sums = [Sum::new(rounds), Sum::new(rounds)];
    for (dy, wy) in TAPS {
        for (dx, wx) in TAPS {
            let off = [dx * step, dy * step];
            let Some(j) = guides.index([x + off[0], y + off[1]]) else {
                continue;
            };
            let alike = if i == j {
                1.0
            } else {
                guides.alike(normal_power, guide, &guides.pixels[j], off)
            };
            if alike < LEAST_ALIKE {
                continue;
            }
            let other = &signals[j];
            sums[0].add(&own.share, &other.share, wx * wy * alike);
            sums[1].add(&own.bounced, &other.bounced, wx * wy * alike);
        }
    }
    Signals {
        share: sums[0].mean(&own.share),
        bounced: sums[1].mean(&own.bounced),
    }
}

/// A weighted mean of a signal over pixels.
struct Sum {
    noise_std: f32,
    values: [f32; 3],
    variance: f32,
    weights: f32,
}

impl Sum {
    fn new(rounds: u32) -> Self {
        Self {
            noise_std: noise_std(rounds),
            values: [0.0; 3],
            variance: 0.0,
            weights: 0.0,
        }
    }

    fn add(&mut self, own: &[f32; 4], other: &[f32; 4], weight: f32) {
        if other[3] < 0.0 || own[3] < 0.0 {
            return;
        }
        let difference = luminance([own[0] - other[0], own[1] - other[1], own[2] - other[2]]);
        let noise = (own[3] + other[3]) * (2.0 * self.noise_std * self.noise_std);
        let weight = if difference == 0.0 {
            weight
        } else {
            weight * (-difference * difference / noise.max(1e-20)).exp()
        };
        for (sum, value) in self.values.iter_mut().zip(other) {
            *sum += weight * value;
        }
        self.variance += weight * weight * other[3];
        self.weights += weight;
    }

    fn mean(&self, own: &[f32; 4]) -> [f32; 4] {
        if !(self.weights > 0.0) {
            return *own;
        }
        let [r, g, b] = self.values.map(|v| v / self.weights);
        [r, g, b, self.variance / (self.weights * self.weights)]
    }
}

/// Writes `of` each pixel, by its number and its place, to `into`.
fn over_pixels(
    guides: &Guides,
    into: &mut [Signals],
    of: impl Fn(usize, [i32; 2]) -> Signals + Sync,
) {
    let width = guides.size_px[0].max(1);
    into.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, signals) in row.iter_mut().enumerate() {
            *signals = of(y * width + x, [x as i32, y as i32]);
        }
    });
}
