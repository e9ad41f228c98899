//! The filter of the light that rays found: H. Dammertz, D. Sewtz, J. Hanika, H. Lensch, *Edge-Avoiding A-Trous Wavelet Transform for fast Global
//! Illumination Filtering*, 2010, with variances as in C. Schied et al., *Spatiotemporal Variance-Guided Filtering*, 2017.
//!
//! It works on two signals of each layer: the share of the closed form that is seen, and the mean light of other objects. The closed form, its
//! textures and its scratches are as sharp after it as before. Pixels are averaged where they see the same surface and where their difference is
//! noise: as rounds add up, variances fall, and the limit is what rays found.

use rayon::prelude::*;

use crate::tone_map::tone_luminance as luminance;
use crate::traced::{Traced, TracedLight, TracedPixel, left};
use crate::{Image, Noise};

/// Passes, each with twice the step of the one before.
pub const PASSES: u32 = 5;
/// Weights of three taps, a quarter and a half: the B-spline.
const TAPS: [(i32, f32); 3] = [(-1, 0.25), (0, 0.5), (1, 0.25)];
/// Differences of so many standard deviations of the noise count for little after one round. Chosen by measured error.
const NOISE_STD: f32 = 1.5;
/// The number of rounds that halves them: what many rounds still differ by is mostly the picture. Chosen by measured error.
const SHARPENING_ROUNDS: f32 = 64.0;
/// Largest distance of a surface from the plane of a pixel, as a share of depth, at which both are averaged.
pub const OFF_PLANE: f32 = 0.01;
/// The power of the cosine between normals of mirrors.
pub const NORMAL_POWER: f32 = 64.0;
/// Factor n by which the power falls with the roughness r, as 1 / (1 + (n r)²): a wide lobe reflects nearly the same light at normals that differ.
/// Chosen by measured error.
pub const ROUGH_NORMALS: f32 = 3.0;
/// The longest step in a mirror, pixels: a mirror image has edges that no guide knows.
pub const MIRROR_STEP_PX: f32 = 4.0;
/// Increase of that step by a rough surface, for each unit of roughness.
pub const ROUGH_STEP_PX: f32 = 40.0;
/// Distance, in pixels, over which an outline is averaged with the surfaces to both sides of it.
pub const OUTLINE_PX: i32 = 2;
/// Pixels to each side over which variances are averaged.
pub const VARIANCE_PX: i32 = 2;
/// Bounced light is an outlier beyond so many standard deviations of the pixels around: with fewer, light that few rays find would be lost.
pub const OUTLIER_STD: f32 = 12.0;
/// Least sum of how alike the pixels around are: fewer tell nothing of outliers.
pub const LEAST_AROUND: f32 = 2.0;
/// Pixels that are less alike do not count.
pub const LEAST_ALIKE: f32 = 1e-3;

/// Differences that count for little after a number of rounds, in standard deviations of the noise.
#[must_use]
pub fn noise_std(rounds: u32) -> f32 {
    NOISE_STD / (1.0 + rounds as f32 / SHARPENING_ROUNDS)
}

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

/// A layer of a pixel.
#[derive(Clone, Copy, PartialEq)]
enum Layer {
    Diffuse,
    Specular,
    Scratches,
}

impl Layer {
    fn light(self, pixel: &TracedPixel) -> &TracedLight {
        match self {
            Self::Diffuse => &pixel.diffuse,
            Self::Specular => &pixel.specular,
            Self::Scratches => &pixel.scratches,
        }
    }

    /// The power of the cosine between normals.
    fn normal_power(self, guide: &Guide) -> f32 {
        let roughness = match self {
            Self::Diffuse => 1.0,
            Self::Specular => guide.roughness,
            Self::Scratches => 0.0,
        };
        NORMAL_POWER / (1.0 + (ROUGH_NORMALS * roughness).powi(2))
    }

    /// Whether a pass is taken.
    fn reaches(self, step: i32, guide: &Guide) -> bool {
        self != Self::Specular || step as f32 <= MIRROR_STEP_PX + ROUGH_STEP_PX * guide.roughness
    }
}

/// Signals of a layer of a pixel that are filtered: one for each channel and, last, the variance of the luminance; below 0 where there is no signal.
#[derive(Clone, Copy, Default)]
struct Signals {
    /// The share that is seen.
    share: [f32; 4],
    /// The mean light of other objects.
    bounced: [f32; 4],
}

const NOTHING: [f32; 4] = [0.0, 0.0, 0.0, -1.0];

impl Signals {
    fn new(light: &TracedLight, rounds: u32) -> Self {
        let [r, g, b] = light.share();
        let [share_variance, bounced_variance] = light.variances(rounds);
        let of_share = if luminance(light.open) > 0.0 {
            [r, g, b, share_variance]
        } else {
            NOTHING
        };
        let of_bounced = if luminance(light.around) > 0.0 {
            let [r, g, b] = std::array::from_fn(|c| {
                if light.around[c] > 0.0 {
                    light.bounced[c] / light.around[c]
                } else {
                    0.0
                }
            });
            [r, g, b, bounced_variance]
        } else {
            NOTHING
        };
        Self {
            share: of_share,
            bounced: of_bounced,
        }
    }

    /// Light of a closed form by these signals.
    fn light(&self, of: &TracedLight) -> [f32; 3] {
        let [r, g, b, _] = self.share;
        let left = left(of.open, [r, g, b]);
        std::array::from_fn(|c| left[c] + of.around[c] * self.bounced[c])
    }
}

/// Guides by which pixels of one surface are found.
struct Guides {
    size_px: [usize; 2],
    pixels: Vec<Guide>,
}

#[derive(Clone, Copy)]
struct Guide {
    object: u32,
    normal: [f32; 3],
    /// The reciprocal of depth, which is linear over the picture of a plane, and how it changes to the right and down.
    per_depth: f32,
    slope: [f32; 2],
    roughness: f32,
}

impl Guides {
    fn new(image: &Image, traced: &Traced) -> Self {
        let size_px = image.size_px.map(|n| n as usize);
        let [width, height] = size_px;
        let per_depth = |i: usize| match image.depth_m[i] {
            z if z > 0.0 => 1.0 / z,
            _ => 0.0,
        };
        // Takes the side with the smaller change: the other side may lie beyond an edge.
        let slope = |i: usize, before: Option<usize>, after: Option<usize>| {
            let object = traced.pixels[i].object;
            let step = |from: usize, to: usize, other: usize| {
                (traced.pixels[other].object == object).then(|| per_depth(to) - per_depth(from))
            };
            let before = before.and_then(|b| step(b, i, b));
            let after = after.and_then(|a| step(i, a, a));
            match (before, after) {
                (Some(a), Some(b)) => {
                    if a.abs() < b.abs() {
                        a
                    } else {
                        b
                    }
                }
                (Some(a), None) | (None, Some(a)) => a,
                (None, None) => 0.0,
            }
        };
        let pixels = (0..width * height)
            .into_par_iter()
            .map(|i| {
                let (x, y) = (i % width, i / width);
                Guide {
                    object: traced.pixels[i].object,
                    normal: image.normal[i],
                    per_depth: per_depth(i),
                    slope: [
                        slope(i, (x > 0).then(|| i - 1), (x + 1 < width).then(|| i + 1)),
                        slope(
                            i,
                            (y > 0).then(|| i - width),
                            (y + 1 < height).then(|| i + width),
                        ),
                    ],
                    roughness: traced.pixels[i].roughness,
                }
            })
            .collect();
        Self { size_px, pixels }
    }

    /// Similarity of the surfaces that two pixels see, from 0 to 1; (dx, dy) leads from one to the other.
    fn alike(&self, normal_power: f32, p: &Guide, q: &Guide, [dx, dy]: [i32; 2]) -> f32 {
        // An outline sees what both of its sides see; its own samples are few.
        if p.object == TracedPixel::SEVERAL_OBJECTS {
            let is_near = dx.abs().max(dy.abs()) <= OUTLINE_PX;
            return f32::from(is_near && q.object != 0);
        }
        if p.object != q.object || p.object == 0 {
            return 0.0;
        }
        let cos: f32 = (0..3).map(|c| p.normal[c] * q.normal[c]).sum();
        if cos <= 0.5 {
            return 0.0;
        }
        let on_plane = p.per_depth + p.slope[0] * dx as f32 + p.slope[1] * dy as f32;
        let off = (q.per_depth - on_plane).abs() / p.per_depth;
        let off = off / OFF_PLANE;
        let bent = if cos >= 1.0 {
            1.0
        } else {
            cos.powf(normal_power)
        };
        bent / (1.0 + off * off)
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

/// Variances of few rounds are noisy themselves: each becomes the mean over the pixels around. After one round alone they are those of the
/// values there. Outliers of bounced light go first.
fn smooth_variance(
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

impl Guides {
    fn index(&self, [x, y]: [i32; 2]) -> Option<usize> {
        let [width, height] = self.size_px;
        let is_in = x >= 0 && y >= 0 && (x as usize) < width && (y as usize) < height;
        is_in.then(|| y as usize * width + x as usize)
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
