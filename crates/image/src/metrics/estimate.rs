//! Values with their variances, where they are known.

/// A layer whose values are known exactly or as Monte Carlo estimates.
#[derive(Clone, Copy, Debug)]
pub struct Estimate<'a> {
    /// Three a pixel.
    pub values: &'a [[f32; 3]],
    /// The variance of each value; `None` for values without noise.
    pub variance: Option<&'a [[f32; 3]]>,
    /// Complete batches behind each pixel's variances; `None` for variances that are known exactly.
    pub batches: Option<&'a [u32]>,
}

impl<'a> Estimate<'a> {
    /// Values without noise.
    pub fn exact(values: &'a [[f32; 3]]) -> Self {
        Self {
            values,
            variance: None,
            batches: None,
        }
    }

    /// The variance of value `c` of pixel `i` with its degrees of freedom (infinite where it is known exactly); `None`
    /// where nothing is known of it.
    pub fn variance_at(&self, i: usize, c: usize) -> Option<(f64, f64)> {
        let Some(variance) = self.variance else {
            return Some((0.0, f64::INFINITY));
        };
        let variance = f64::from(variance[i][c]);
        if !(variance >= 0.0 && variance.is_finite()) {
            return None;
        }
        match self.batches.map(|batches| batches[i]) {
            None => Some((variance, f64::INFINITY)),
            Some(0 | 1) => None,
            Some(batches) => Some((variance, f64::from(batches - 1))),
        }
    }
}

/// Noise below this share of a value is none: a constant background's batches scatter by rounding alone, which says
/// nothing of the rounding between two renderers.
const NOISE_MIN: f64 = 1e-5;

/// Difference of a value from a reference, and the variance that noise gives it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residual {
    /// Image minus reference.
    pub difference: f64,
    /// Variance of the difference.
    pub variance: f64,
    /// Degrees of freedom of the variance.
    pub degrees_of_freedom: f64,
}

/// The residual of value `c` of pixel `i`, where both values are finite and both variances known.
pub(super) fn residual(a: &Estimate, b: &Estimate, i: usize, c: usize) -> Option<Residual> {
    let (x, y) = (f64::from(a.values[i][c]), f64::from(b.values[i][c]));
    if !x.is_finite() || !y.is_finite() {
        return None;
    }
    let (va, na) = a.variance_at(i, c)?;
    let (vb, nb) = b.variance_at(i, c)?;
    let variance = va + vb;
    let rounding = NOISE_MIN * x.abs().max(y.abs());
    if !(variance > rounding * rounding) {
        return Some(Residual {
            difference: x - y,
            variance: 0.0,
            degrees_of_freedom: f64::INFINITY,
        });
    }
    // Satterthwaite 1946: the degrees of freedom of a sum of estimated variances.
    let spread = va * va / na + vb * vb / nb;
    Some(Residual {
        difference: x - y,
        variance,
        degrees_of_freedom: if spread > 0.0 {
            variance * variance / spread
        } else {
            // Variances that are known exactly.
            f64::INFINITY
        },
    })
}

/// Panics where two layers and a mask are not of one size: that is a mistake of the caller.
pub(super) fn assert_same_length(a: &Estimate, b: &Estimate, mask: Option<&[bool]>) {
    let count = a.values.len();
    assert_eq!(count, b.values.len(), "images of different sizes");
    for estimate in [a, b] {
        assert!(estimate.variance.is_none_or(|v| v.len() == count));
        assert!(estimate.batches.is_none_or(|n| n.len() == count));
    }
    assert!(
        mask.is_none_or(|mask| mask.len() == count),
        "a mask of a different size"
    );
}
