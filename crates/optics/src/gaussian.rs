//! The normal distribution from tables, for the inner loop: a scratch under a light asks for it a dozen times. Twins:
//! `gaussian_cdf` and `gaussian_quantile` in gaussian.wgsl.

use spec_math::cephes64::{ndtr, ndtri};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// The tables.
pub struct Gaussian {
    /// The share beyond a place, and its slope times the step: cubic between nodes.
    tail: [[f64; 2]; CDF_COUNT],
    /// Distance at which a tail of a given share begins, and the slope of that times the step.
    quantile: [[f64; 2]; QUANTILE_COUNT],
}

/// Nodes per unit.
const CDF_NODES: f64 = 32.0;
/// Distance beyond which the tail, 6e-16, counts as nothing.
const CDF_REACH: f64 = 8.0;
const CDF_COUNT: usize = (CDF_NODES * CDF_REACH) as usize + 1;

/// Shares from 2^-20 to 1/2, a part for each power of two.
const QUANTILE_OCTAVES: u64 = 19;
/// Nodes in each, as bits of the mantissa.
const QUANTILE_BITS: u32 = 4;
const QUANTILE_COUNT: usize = ((QUANTILE_OCTAVES + 1) << QUANTILE_BITS) as usize;
/// Number of low bits of a share that do not select the node.
const REST_BITS: u32 = f64::MANTISSA_DIGITS - 1 - QUANTILE_BITS;
/// The least share.
const SHARE_MIN: f64 = 1.0 / (1u64 << (QUANTILE_OCTAVES + 1)) as f64;

static TABLES: LazyLock<Gaussian> = LazyLock::new(|| {
    let density = |x: f64| (-0.5 * x * x).exp() / (2.0 * PI).sqrt();
    Gaussian {
        tail: std::array::from_fn(|i| {
            let x = i as f64 / CDF_NODES;
            [ndtr(-x), -density(x) / CDF_NODES]
        }),
        quantile: std::array::from_fn(|i| {
            let share = quantile_node(i as u64);
            let x = -ndtri(share);
            [x, -1.0 / density(x)]
        }),
    }
});

/// The share at a node of the quantile's table: nodes are even in the bits of a number, and so about even in its logarithm.
fn quantile_node(i: u64) -> f64 {
    f64::from_bits(SHARE_MIN.to_bits() + (i << REST_BITS))
}

/// The tables.
pub fn gaussian() -> &'static Gaussian {
    &TABLES
}

impl Gaussian {
    /// The share of a standard normal distribution below `x`: within 1.5e-9, differences within 3e-5 of themselves up to five
    /// standard deviations.
    #[inline]
    pub(crate) fn cdf(&self, x: f64) -> f64 {
        let at = x.abs().min(CDF_REACH) * CDF_NODES;
        let node = (at as usize).min(CDF_COUNT - 2);
        let tail = hermite(self.tail[node], self.tail[node + 1], at - node as f64);
        if x < 0.0 { tail } else { 1.0 - tail }
    }

    /// The share from `low` to `high`.
    #[inline]
    pub fn integral(&self, low: f64, high: f64) -> f64 {
        self.cdf(high) - self.cdf(low)
    }

    /// Quantile: the place below which a share lies, for shares within [1e-6, 1 - 1e-6], with an error of at most 1e-7.
    #[inline]
    pub fn quantile(&self, share: f64) -> f64 {
        let tail = share.min(1.0 - share).clamp(SHARE_MIN, 0.5);
        let node = ((tail.to_bits() - SHARE_MIN.to_bits()) >> REST_BITS) as usize;
        let node = node.min(QUANTILE_COUNT - 2);
        let (low, high) = (quantile_node(node as u64), quantile_node(node as u64 + 1));
        let step = high - low;
        let [[x0, s0], [x1, s1]] = [self.quantile[node], self.quantile[node + 1]];
        let out = hermite([x0, s0 * step], [x1, s1 * step], (tail - low) / step);
        if share < 0.5 { -out } else { out }
    }
}

/// The cubic with a value and a slope at either end of [0, 1].
#[inline]
fn hermite([v0, s0]: [f64; 2], [v1, s1]: [f64; 2], f: f64) -> f64 {
    let rise = v1 - v0;
    v0 + f * (s0 + f * (3.0 * rise - 2.0 * s0 - s1 + f * (s0 + s1 - 2.0 * rise)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_equals_the_function() {
        let table = gaussian();
        let (mut worst, mut relative) = (0f64, 0f64);
        for i in -9000..=9000 {
            let x = 1e-3 * f64::from(i) + 3e-4;
            worst = worst.max((table.cdf(x) - ndtr(x)).abs());
            for step in [1e-4, 0.1, 2.0] {
                if x < 0.0 && x > -5.0 {
                    let exact = ndtr(x + step) - ndtr(x);
                    relative = relative.max((table.integral(x, x + step) / exact - 1.0).abs());
                }
            }
        }
        println!("gaussian, cdf: {worst:.1e} at worst, differences {relative:.1e} of themselves");
        assert!(worst < 1.5e-9 && relative < 3e-5);
        assert_eq!(
            (table.cdf(-1e300), table.cdf(1e300)),
            (table.cdf(-8.0), table.cdf(8.0))
        );
    }

    #[test]
    fn quantiles_undo_shares() {
        let table = gaussian();
        let mut worst = 0f64;
        for i in 1..400_000 {
            // Even in the middle, and dense in both tails.
            let x = -4.75 + 9.5 * f64::from(i) / 400_000.0;
            for share in [ndtr(x), f64::from(i) / 400_000.0] {
                worst = worst.max((table.quantile(share) - ndtri(share)).abs());
            }
        }
        println!("gaussian, quantile: {worst:.1e} at worst");
        assert!(worst < 1e-7);
        assert_eq!(table.quantile(0.5), 0.0);
        assert!(table.quantile(0.0).is_finite() && table.quantile(1.0).is_finite());
    }
}
