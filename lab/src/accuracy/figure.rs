//! A measured number with its standard error.

use serde::{Deserialize, Serialize};

/// A measured number and its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    pub value: f64,
    pub error: f64,
}

impl Figure {
    /// Mean and standard error of some values.
    pub fn mean(values: impl Iterator<Item = f64> + Clone) -> Self {
        let count = values.clone().count().max(1) as f64;
        let value = values.clone().sum::<f64>() / count;
        let squares: f64 = values.map(|v| (v - value).powi(2)).sum();
        Self {
            value,
            error: (squares / (count - 1.0).max(1.0) / count).sqrt(),
        }
    }

    /// Formats the number with as many digits as its error allows: two digits of the error, and at most
    /// `most` decimals.
    pub fn text(self, scale: f64, most: f64) -> String {
        let (value, error) = (scale * self.value, scale * self.error);
        let decimals = if error > 0.0 {
            (1.0 - error.log10().floor()).clamp(0.0, most) as usize
        } else {
            most as usize
        };
        format!("{value:.decimals$} ± {error:.decimals$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_error() {
        let text = |value, error| Figure { value, error }.text(100.0, 2.0);
        assert_eq!(text(0.012_345, 0.000_67), "1.23 ± 0.07");
        assert_eq!(text(0.5, 0.12), "50 ± 12");
        assert_eq!(text(0.25, 0.0), "25.00 ± 0.00");
    }

    #[test]
    fn the_mean_of_equal_values_is_certain() {
        let figure = Figure::mean([2.0, 2.0, 2.0].into_iter());
        assert_eq!((figure.value, figure.error), (2.0, 0.0));
    }
}
