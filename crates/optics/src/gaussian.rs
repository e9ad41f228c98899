//! The normal distribution function from a table, for the inner loop: bands are weighed by it eight times for each scratch and
//! light. Twin: `gaussian_cdf` in gaussian.wgsl.

use spec_math::cephes64::ndtr;
use std::sync::LazyLock;

/// Nodes per unit.
const NODES: f64 = 32.0;
/// Beyond this there is nothing: 6e-16.
const REACH: f64 = 8.0;
const COUNT: usize = (NODES * REACH) as usize + 1;

/// Values at nodes, and their slopes times the step: cubic between them.
static TABLE: LazyLock<GaussianCdf> = LazyLock::new(|| GaussianCdf {
    nodes: std::array::from_fn(|i| {
        let x = i as f64 / NODES;
        let density = (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
        // The upper tail keeps its digits where the share below is close to one.
        [ndtr(-x), -density / NODES]
    }),
});

/// The shares of a standard normal distribution: within 1.5e-9, and differences of them within 3e-5 of themselves up to five
/// standard deviations.
pub struct GaussianCdf {
    nodes: [[f64; 2]; COUNT],
}

/// The table.
pub fn gaussian_cdf() -> &'static GaussianCdf {
    &TABLE
}

impl GaussianCdf {
    /// The share below `x`.
    #[inline]
    pub fn below(&self, x: f64) -> f64 {
        let at = x.abs().min(REACH) * NODES;
        let node = (at as usize).min(COUNT - 2);
        let f = at - node as f64;
        let [[v0, s0], [v1, s1]] = [self.nodes[node], self.nodes[node + 1]];
        let rise = v1 - v0;
        // Hermite, as a polynomial in f.
        let tail = v0 + f * (s0 + f * (3.0 * rise - 2.0 * s0 - s1 + f * (s0 + s1 - 2.0 * rise)));
        if x < 0.0 { tail } else { 1.0 - tail }
    }

    /// The share from `low` to `high`.
    #[inline]
    pub fn between(&self, low: f64, high: f64) -> f64 {
        self.below(high) - self.below(low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_equals_the_function() {
        let cdf = gaussian_cdf();
        let (mut worst, mut relative) = (0f64, 0f64);
        for i in -9000..=9000 {
            let x = 1e-3 * f64::from(i) + 3e-4;
            worst = worst.max((cdf.below(x) - ndtr(x)).abs());
            for step in [1e-4, 0.1, 2.0] {
                if x < 0.0 && x > -5.0 {
                    let exact = ndtr(x + step) - ndtr(x);
                    relative = relative.max((cdf.between(x, x + step) / exact - 1.0).abs());
                }
            }
        }
        println!("gaussian_cdf: {worst:.1e} at worst, differences {relative:.1e} of themselves");
        assert!(worst < 1.5e-9 && relative < 3e-5);
        assert_eq!(
            (cdf.below(-1e300), cdf.below(1e300)),
            (cdf.below(-8.0), cdf.below(8.0))
        );
    }
}
