//! Random numbers that cover their space evenly: Owen-scrambled Sobol points (B. Burley, *Practical Hash-based Owen
//! Scrambling*, 2020), a batch of them for each pixel and batch number, padded to any number of dimensions.

/// Samples in a batch.
pub const BATCH_SAMPLES: u32 = 64;

/// Use of a set of four numbers. Sets of different uses are independent; those of one use are even over a batch.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose {
    /// The place in the pixel's filter (2) and the wavelength (1).
    Camera,
    /// A direction by the lobes of the base (2) and the choice between them (1).
    BaseLobe,
    /// A direction to a light for the base (2).
    Light(u32),
    /// A direction in the environment for the base (2).
    Environment,
    /// A direction from a groove to a light (2); several draws.
    GrooveLight { groove: u32, light: u32, draw: u32 },
    /// A direction from a groove to the environment (2); several draws.
    GrooveEnvironment { groove: u32, draw: u32 },
    /// A direction of the coherent field to a light: which component (1), where (2); several draws.
    FieldLight { light: u32, draw: u32 },
    /// A direction of the field to the environment.
    FieldEnvironment { draw: u32 },
    /// Continuation of a path off scratches: the choice of one, or of one of the field's draws (1), and the direction
    /// (2).
    Bounce,
    /// The grating at a point (1), its grooves' angle (1) and place (1).
    Row,
    /// The displacement of a groove of a grating (1) and its depth (1).
    RowGroove(u32),
    /// A point of the lens (2).
    Lens,
}

impl Purpose {
    fn key(self) -> [u32; 3] {
        match self {
            Self::Camera => [0, 0, 0],
            Self::BaseLobe => [1, 0, 0],
            Self::Light(light) => [2, light, 0],
            Self::Environment => [3, 0, 0],
            Self::GrooveLight {
                groove,
                light,
                draw,
            } => [4 + 16 * draw, groove, light],
            Self::GrooveEnvironment { groove, draw } => [5, groove, draw],
            Self::FieldLight { light, draw } => [6, light, draw],
            Self::FieldEnvironment { draw } => [7, draw, 0],
            Self::Bounce => [8, 0, 0],
            Self::Row => [9, 0, 0],
            Self::RowGroove(groove) => [10, groove, 0],
            Self::Lens => [11, 0, 0],
        }
    }
}

/// The numbers of one sample of a batch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Random {
    stream: u64,
    sample: u32,
    vertex: u32,
}

impl Random {
    /// Sample `sample` of batch `batch` of a pixel.
    pub(crate) fn new(seed: u64, pixel: u64, batch: u32, sample: u32) -> Self {
        debug_assert!(sample < BATCH_SAMPLES);
        let stream = mix(mix(mix(seed) ^ pixel) ^ u64::from(batch));
        Self {
            stream,
            sample,
            vertex: 0,
        }
    }

    /// The numbers of the path's next vertex.
    pub(crate) fn next_vertex(self) -> Self {
        Self {
            vertex: self.vertex + 1,
            ..self
        }
    }

    /// Four numbers in (0, 1).
    pub(crate) fn four(&self, purpose: Purpose) -> [f64; 4] {
        let [a, b, c] = purpose.key();
        let key = mix(self.stream ^ (u64::from(self.vertex) << 32 | u64::from(a)));
        let key = mix(key ^ (u64::from(b) << 32 | u64::from(c)));
        // Singles on a grid of 2^-24: half a step keeps 0 out, of which logarithms and quantiles know nothing.
        sobol_burley::sample_4d(self.sample, 0, (key >> 32) as u32)
            .map(|x| f64::from(x) + 0.5 / f64::from(1 << 24))
    }
}

/// The finaliser of SplitMix64 (G. Steele, D. Lea, C. Flood, *Fast Splittable Pseudorandom Number Generators*, 2014).
fn mix(x: u64) -> u64 {
    let mut z = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_batch_covers_the_square_evenly_and_batches_differ() {
        let purpose = Purpose::GrooveLight {
            groove: 3,
            light: 1,
            draw: 0,
        };
        let cells = |batch: u32| -> Vec<usize> {
            (0..BATCH_SAMPLES)
                .map(|i| {
                    let [x, y, ..] = Random::new(7, 11, batch, i).four(purpose);
                    assert!(x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0);
                    (x * 8.0) as usize * 8 + (y * 8.0) as usize
                })
                .collect()
        };
        let mut seen = cells(0);
        seen.sort_unstable();
        assert_eq!(seen, (0..64).collect::<Vec<_>>(), "one in each cell");
        assert_ne!(cells(0), cells(1));
    }

    #[test]
    fn purposes_and_vertices_are_independent() {
        let batches = 200;
        type Pair = fn(&Random) -> (f64, f64);
        let pairs: [Pair; 3] = [
            |r| (r.four(Purpose::Camera)[0], r.four(Purpose::BaseLobe)[0]),
            |r| (r.four(Purpose::Light(0))[1], r.four(Purpose::Light(1))[1]),
            |r| {
                let next = r.next_vertex();
                (r.four(Purpose::Camera)[0], next.four(Purpose::Camera)[0])
            },
        ];
        for pair in pairs {
            let mut covariance = 0.0;
            for batch in 0..batches {
                for i in 0..BATCH_SAMPLES {
                    let (x, y) = pair(&Random::new(1, 2, batch, i));
                    covariance += (x - 0.5) * (y - 0.5);
                }
            }
            let count = f64::from(batches * BATCH_SAMPLES);
            // Five standard deviations of the covariance of independent numbers, 1/12/sqrt(count) each.
            assert!((covariance / count).abs() < 5.0 / 12.0 / count.sqrt());
        }
    }
}
