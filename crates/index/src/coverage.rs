//! Chooses which of the surfaces that cover a part of what lies behind them a ray meets: over many rays, the share is that part. E.
//! Enderton et al., "Stochastic Transparency", 2010. Twin: gpu/shaders/scene/coverage.wgsl.

use glam::DVec3;
use hairline_optics::word_hash::word_hash;

/// Rule by which a ray meets a surface that covers a part of what lies behind it, or passes through it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// The ray meets each surface that covers anything at all.
    Any,
    /// The ray meets such surfaces of one object, and passes through all others.
    Only(u32),
    /// The ray meets each such surface at random, with the probability of its alpha.
    Drawn {
        /// Key of the random numbers.
        key: u32,
        /// Numbers of neighbouring rounds of one key are spread evenly.
        round: u32,
    },
}

impl Coverage {
    /// Coverage of one of many samples of a pixel: together they meet a surface as often as its alpha says, within one of them.
    pub fn of_sample([x, y]: [u32; 2], sample: u32) -> Self {
        Self::Drawn {
            key: word_hash(x ^ word_hash(y)),
            round: sample,
        }
    }

    /// Coverage of a ray that is drawn by chance itself.
    pub(crate) fn of_ray(origin_m: DVec3, direction: DVec3) -> Self {
        let words = [origin_m, direction].map(|v| v.to_array()).concat();
        let mixed = words.iter().fold(0, |key, &word| {
            let bits = word.to_bits();
            word_hash(key ^ word_hash(bits as u32 ^ (bits >> 32) as u32))
        });
        Self::Drawn {
            key: mixed,
            round: 0,
        }
    }

    /// Whether the ray meets a surface of an alpha, on a triangle of the scene and an object.
    pub(crate) fn meets(self, alpha: f64, triangle: u32, object: u32) -> bool {
        match self {
            Self::Any => alpha > 0.0,
            Self::Only(own) => alpha > 0.0 && object == own,
            Self::Drawn { key, round } => alpha >= drawn(round, key ^ word_hash(triangle + 1)),
        }
    }
}

/// A number in (0, 1) of a round: the first of the pairs of gpu/shaders/physics/sobol.wgsl, as both renderers must see the same. The crate
/// sobol_burley has points of this kind, but other ones.
fn drawn(round: u32, seed: u32) -> f64 {
    let mixed = word_hash(seed);
    let index = scramble(round.reverse_bits(), mixed).reverse_bits();
    let x = scramble(index, word_hash(mixed ^ 0x9e37_79b9)).reverse_bits();
    (f64::from(x >> 8) + 0.5) / 16_777_216.0
}

/// Owen's scrambling of a number whose bits are reversed.
fn scramble(reversed: u32, seed: u32) -> u32 {
    let mut x = reversed;
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_meet_a_surface_as_often_as_its_alpha_says() {
        for alpha in [0.0, 0.1, 0.3, 0.77, 1.0] {
            let mut all = 0;
            for pixel in 0..1000 {
                let met = (0..16).filter(|&sample| {
                    Coverage::of_sample([pixel, 7], sample).meets(alpha, pixel % 5, 0)
                });
                let met = met.count();
                // The number of hits of sixteen samples is within one of its expectation, in each pixel.
                assert!((met as f64 - 16.0 * alpha).abs() < 1.0, "{alpha}: {met}");
                all += met;
            }
            let mean = all as f64 / 16_000.0;
            // Less than a sixteenth to and fro, over 1000 pixels: 4 sigma.
            assert!((mean - alpha).abs() < 4.0 * 0.5 / 16.0 / 1000f64.sqrt());
        }
    }

    #[test]
    fn layers_and_rays_do_not_know_of_each_other() {
        let count = 20_000;
        let rays = (0..count).map(|i| {
            let direction = DVec3::new(f64::from(i), 1.0, 2.0).normalize();
            Coverage::of_ray(DVec3::ZERO, direction)
        });
        let samples = (0..count).map(|i| Coverage::of_sample([i / 16, 3], i % 16));
        for coverages in [rays.collect::<Vec<_>>(), samples.collect()] {
            let both = coverages
                .iter()
                .filter(|it| it.meets(0.4, 11, 0) && it.meets(0.5, 12, 0));
            let share = both.count() as f64 / f64::from(count);
            assert!((share - 0.2).abs() < 0.012, "{share}");
        }
    }

    #[test]
    fn one_object_alone_is_met() {
        assert!(Coverage::Only(3).meets(0.01, 0, 3));
        assert!(!Coverage::Only(3).meets(0.99, 0, 2));
        assert!(!Coverage::Any.meets(0.0, 0, 2));
    }
}
