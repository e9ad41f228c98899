//! Differences measured by their noise, alone and in blocks of pixels.
//!
//! * David L. Wallace, "Bounds on Normal Approximations to Student's and the Chi-Square Distributions", 1959.

use std::ops::AddAssign;

use super::estimate::{Estimate, Residual, residual};

/// Width and height of a block. Its z shows a common error of an eighth of the noise, and a scratch crosses few blocks.
const BLOCK_PX: u32 = 8;

/// Differences that are rounding, relative to the value or to the picture's mean.
const ROUNDING: f64 = 1e-4;

/// A value in a block; no residual where its variance is unknown or it is not finite.
struct Member {
    pixel: usize,
    residual: Option<Residual>,
}

/// The values of a block, channel by channel, the same pixels in each.
type Block = [Vec<Member>; 3];

/// Two layers in blocks. These are made as they are needed: all together would be many times as large as the layers.
pub(super) struct Blocks<'a> {
    pub width: u32,
    pub height: u32,
    pub image: &'a Estimate<'a>,
    pub reference: &'a Estimate<'a>,
    /// True where a pixel counts.
    pub mask: Option<&'a [bool]>,
}

impl Blocks<'_> {
    fn iter(&self) -> impl Iterator<Item = Block> + '_ {
        let columns = self.width.div_ceil(BLOCK_PX);
        (0..self.height.div_ceil(BLOCK_PX))
            .flat_map(move |row| (0..columns).map(move |column| self.block(column, row)))
    }

    fn block(&self, column: u32, row: u32) -> Block {
        let [x, y] = [column, row].map(|n| n * BLOCK_PX);
        let mut block = Block::default();
        for v in y..(y + BLOCK_PX).min(self.height) {
            for u in x..(x + BLOCK_PX).min(self.width) {
                let pixel = v as usize * self.width as usize + u as usize;
                if self.mask.is_none_or(|mask| mask[pixel]) {
                    for (c, channel) in block.iter_mut().enumerate() {
                        channel.push(Member {
                            pixel,
                            residual: residual(self.image, self.reference, pixel, c),
                        });
                    }
                }
            }
        }
        block
    }
}

/// The normal number that is as likely as `t` under Student's distribution (Wallace 1959): normal noise gets
/// a mean square of 0.98 at 2 degrees of freedom, of 0.93 at one. Not by the distributions of statrs: their tails round to 0 and 1
/// where a fault has its largest scores.
fn normal_score(t: f64, degrees_of_freedom: f64) -> f64 {
    // Beyond this the two distributions are one, and the logarithm would lose digits.
    if degrees_of_freedom > 1e6 {
        return t;
    }
    let n = degrees_of_freedom;
    let size = (8.0 * n + 1.0) / (8.0 * n + 3.0) * (n * (t * t / n).ln_1p()).sqrt();
    size.copysign(t)
}

/// Sums over single values.
#[derive(Default)]
pub(super) struct Single {
    pub values: usize,
    pub left_out: usize,
    pub z: f64,
    pub z2: f64,
    pub beyond_3: usize,
}

impl Single {
    pub(crate) fn from_blocks(blocks: &Blocks) -> Self {
        let mut sums = Self::default();
        for member in blocks.iter().flatten().flatten() {
            match &member.residual {
                Some(r) if r.variance > 0.0 => {
                    let z = normal_score(r.difference / r.variance.sqrt(), r.degrees_of_freedom);
                    sums.values += 1;
                    sums.z += z;
                    sums.z2 += z * z;
                    sums.beyond_3 += usize::from(z.abs() > 3.0);
                }
                _ => sums.left_out += 1,
            }
        }
        sums
    }
}

/// Sums over the values of a block's channel.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    difference: f64,
    variance: f64,
    /// Sum of variance^2 over degrees of freedom.
    spread: f64,
    /// Sum of variance^2.
    variance_squares: f64,
}

impl AddAssign<&Residual> for Sums {
    fn add_assign(&mut self, r: &Residual) {
        self.count += 1.0;
        self.difference += r.difference;
        self.variance += r.variance;
        let variance_square = r.variance * r.variance;
        self.spread += variance_square / r.degrees_of_freedom;
        self.variance_squares += variance_square;
    }
}

impl Sums {
    fn from_channel(channel: &[Member]) -> Self {
        let mut sums = Self::default();
        for residual in channel.iter().filter_map(|member| member.residual.as_ref()) {
            sums += residual;
        }
        sums
    }

    /// The summed difference over the root of the summed variance, as a normal number.
    fn z(&self) -> f64 {
        let square = self.variance * self.variance;
        // Satterthwaite's degrees of freedom again; infinite for variances that are known exactly. But where a few values
        // have most of the noise, few samples found much light, and their number is a matter of chance too. Twice the
        // number of such values makes z as likely as a Poisson count that is as far out.
        let freedom = if self.spread > 0.0 {
            (square / self.spread).min(2.0 * square / self.variance_squares)
        } else {
            f64::INFINITY
        };
        normal_score(self.difference / self.variance.sqrt(), freedom)
    }
}

/// Variance that is added to the neighbours' noise, a hundredth of the median block's mean variance, so that a pixel whose
/// neighbours have hardly any does not outweigh the picture.
fn variance_floor(blocks: &Blocks) -> f64 {
    let mut means: Vec<f64> = blocks
        .iter()
        .flatten()
        .map(|channel| Sums::from_channel(&channel))
        .filter(|sums| sums.variance > 0.0)
        .map(|sums| sums.variance / sums.count)
        .collect();
    if means.is_empty() {
        return 0.0;
    }
    let middle = means.len() / 2;
    0.01 * *means.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Figures of whole blocks.
pub(super) struct Pooled {
    pub blocks: usize,
    pub mean_z2: f64,
    pub mean_z2_error: f64,
    pub max_z: f64,
}

impl Pooled {
    pub(crate) fn from_blocks(blocks: &Blocks) -> Self {
        let mut count = 0;
        let mut max_z = 0.0_f64;
        // Sums are taken over blocks, since a block's channels are not independent.
        let mut of_blocks = Vec::new();
        for block in blocks.iter() {
            let (mut z2, mut channels) = (0.0, 0.0);
            for channel in &block {
                let sums = Sums::from_channel(channel);
                if sums.variance > 0.0 {
                    let z = sums.z();
                    z2 += z * z;
                    channels += 1.0;
                    max_z = max_z.max(z.abs());
                    count += 1;
                }
            }
            if channels > 0.0 {
                of_blocks.push(z2 / channels);
            }
        }
        let n = of_blocks.len().max(1) as f64;
        let mean = of_blocks.iter().sum::<f64>() / n;
        let squares = of_blocks.iter().map(|z2| (z2 - mean).powi(2)).sum::<f64>();
        // A few blocks may agree by chance; the square of a normal number has a variance of 2 whatever they do.
        let error = (squares / n).max(2.0).sqrt() / n.sqrt();
        Self {
            blocks: count,
            mean_z2: mean,
            mean_z2_error: error,
            max_z,
        }
    }
}

/// Figures in which each value is divided by the noise of its neighbours.
pub(super) struct Weighed {
    pub ratio: f64,
    pub ratio_error: f64,
    pub z: f64,
}

impl Weighed {
    pub(crate) fn from_blocks(blocks: &Blocks) -> Self {
        let floor = variance_floor(blocks);
        let mut of_channels = [Sums::default(); 3];
        // Weighed squares and variances of each block, and what the spread of the squares is at least.
        let mut of_blocks = Vec::new();
        let mut least_spread = 0.0;
        for block in blocks.iter() {
            let whole = [0, 1, 2].map(|c| Sums::from_channel(&block[c]));
            let (mut squares, mut variances) = (0.0, 0.0);
            for k in 0..block[0].len() {
                let (mut variance, mut freedom) = (0.0, f64::INFINITY);
                for (c, channel) in block.iter().enumerate() {
                    let Some(r) = &channel[k].residual else {
                        continue;
                    };
                    let others = (whole[c].variance - r.variance).max(0.0);
                    let neighbours = others / (whole[c].count - 1.0).max(1.0) + floor;
                    if !(neighbours > 0.0) {
                        continue;
                    }
                    let weighed = Residual {
                        difference: r.difference / neighbours.sqrt(),
                        variance: r.variance / neighbours,
                        degrees_of_freedom: r.degrees_of_freedom,
                    };
                    of_channels[c] += &weighed;
                    squares += weighed.difference * weighed.difference;
                    variances += weighed.variance;
                    variance += weighed.variance;
                    freedom = freedom.min(r.degrees_of_freedom);
                }
                // Variance of a normal number's square plus that of the variance's estimate, as in `BeyondNoise`.
                least_spread += 2.0 * variance * variance * (1.0 + 1.0 / freedom);
            }
            of_blocks.push((squares, variances));
        }
        let total: f64 = of_blocks.iter().map(|(_, variances)| variances).sum();
        let z = of_channels
            .iter()
            .filter(|sums| sums.variance > 0.0)
            .map(Sums::z)
            .fold(0.0_f64, |far, z| if z.abs() > far.abs() { z } else { far });
        if !(total > 0.0) {
            return Self {
                ratio: 1.0,
                ratio_error: f64::INFINITY,
                z,
            };
        }
        let ratio = of_blocks.iter().map(|(squares, _)| squares).sum::<f64>() / total;
        let spread: f64 = of_blocks
            .iter()
            .map(|(squares, variances)| (squares - ratio * variances).powi(2))
            .sum();
        Self {
            ratio,
            ratio_error: spread.max(least_spread).sqrt() / total,
            z,
        }
    }
}

/// The share of values that differ in blocks where no pixel has noise.
pub(super) fn share_without_noise(blocks: &Blocks) -> f64 {
    let value = |c: usize, member: &Member| f64::from(blocks.reference.values[member.pixel][c]);
    let (mut count, mut sum) = (0_usize, 0.0);
    for block in blocks.iter() {
        for (c, channel) in block.iter().enumerate() {
            for member in channel.iter().filter(|m| m.residual.is_some()) {
                count += 1;
                sum += value(c, member).abs();
            }
        }
    }
    let mean = sum / count.max(1) as f64;
    let mut differ = 0_usize;
    for block in blocks.iter() {
        for (c, channel) in block.iter().enumerate() {
            if Sums::from_channel(channel).variance > 0.0 {
                continue;
            }
            for member in channel {
                let rounding = ROUNDING * value(c, member).abs().max(mean);
                differ += usize::from(
                    member
                        .residual
                        .is_some_and(|r| r.difference.abs() > rounding),
                );
            }
        }
    }
    differ as f64 / count.max(1) as f64
}
