//! Random numbers that are the same on every platform: own conversions to f64, and elementary functions from `libm` in place
//! of the system's.
//!
//! The generator is PCG XSL RR 128/64: Melissa O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
//! Algorithms for Random Number Generation", 2014. Streams are told apart by SplitMix64: Guy Steele, Doug Lea, Christine
//! Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014.

use std::f64::consts::PI;

use rand::Rng;
use rand_pcg::Pcg64;

/// The random numbers of one scratch.
pub struct Stream(Pcg64);

impl Stream {
    /// The stream of a scratch: streams with different arguments have nothing to do with each other. `number` tells layers of
    /// one object and one seed apart.
    pub fn new(seed: u64, number: u64, index: u64) -> Self {
        // PCG's own streams are correlated when their numbers are, so the state is scrambled too.
        let low = mixed(mixed(mixed(seed) ^ number) ^ index);
        let high = mixed(low ^ seed);
        let state = (u128::from(high) << 64) | u128::from(low);
        Self(Pcg64::new(
            state,
            (u128::from(number) << 64) | u128::from(index),
        ))
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1u64 << 53) as f64;
        (self.0.next_u64() >> 11) as f64 * STEP
    }

    /// Standard normal, by the transform of Box and Muller (1958). At most 8.6 in size.
    pub fn normal(&mut self) -> f64 {
        // In (0, 1], so that the logarithm is finite.
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.uniform()));
        radius * libm::cos(2.0 * PI * self.uniform())
    }
}

/// SplitMix64's output function.
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws one number from each of many streams, as the scratches of a layer do.
    fn first_draws<T>(draw: impl Fn(&mut Stream) -> T) -> Vec<T> {
        (0..100_000)
            .map(|index| draw(&mut Stream::new(1, 0, index)))
            .collect()
    }

    #[test]
    fn neighbouring_streams_are_uniform_together() {
        // Pairs of draws in a 16 x 16 grid: chi-square of 255 degrees of freedom exceeds 340 once in 3000 times.
        let pairs = first_draws(|stream| (stream.uniform(), stream.uniform()));
        let mut cells = [0u32; 256];
        for (x, y) in &pairs {
            cells[(x * 16.0) as usize * 16 + (y * 16.0) as usize] += 1;
        }
        let expected = pairs.len() as f64 / 256.0;
        let chi2: f64 = cells
            .iter()
            .map(|&n| (f64::from(n) - expected).powi(2) / expected)
            .sum();
        assert!(chi2 < 340.0, "{chi2}");
        // The correlation of neighbours has the standard deviation 1 / sqrt(n) = 0.003.
        let correlation: f64 = pairs
            .windows(2)
            .map(|w| 12.0 * (w[0].0 - 0.5) * (w[1].0 - 0.5))
            .sum::<f64>()
            / pairs.len() as f64;
        assert!(correlation.abs() < 0.013, "{correlation}");
    }

    /// Pins the sequence: a change here changes everybody's scratches.
    #[test]
    fn the_sequence_is_fixed() {
        let mut stream = Stream::new(1, 2, 3);
        let draws = [stream.uniform(), stream.uniform(), stream.normal()];
        assert_eq!(draws, PINNED);
    }

    const PINNED: [f64; 3] = [0.5644990543670257, 0.49522470857084855, 0.6356300826044985];
}
