//! Numbers that are drawn anew for each scratch.

use serde::{Serialize, Serializer};

use super::ranges::{Check, Numbers, Take};

/// A number that is drawn anew for each scratch: `{ mean = .., spread = .. }`, or a plain number for no spread.
///
/// For a log-normal quantity `mean` is the mean itself and `spread` the standard deviation of the natural logarithm; for a
/// normal one `spread` is the standard deviation, in the unit of the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution {
    /// The mean.
    pub mean: f64,
    /// Spread of the values, not negative.
    pub spread: f64,
}

impl Distribution {
    /// The value that lies `normal` standard deviations from the mean.
    pub(crate) fn normal_at(&self, normal: f64) -> f64 {
        self.mean + self.spread * normal
    }

    /// The value whose logarithm lies `normal` standard deviations from the logarithm's mean.
    pub(crate) fn log_normal_at(&self, normal: f64) -> f64 {
        let log_mean = -self.spread * self.spread / 2.0;
        self.mean * libm::exp(log_mean + self.spread * normal)
    }
}

impl Numbers for Distribution {
    fn each(&self, take: &mut Take) -> Check {
        if self.spread == 0.0 {
            return take("", self.mean, false);
        }
        take(".mean", self.mean, false)?;
        take(".spread", self.spread, true)
    }
}

impl Serialize for Distribution {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        if self.spread == 0.0 {
            return self.mean.serialize(serializer);
        }
        let mut table = serializer.serialize_struct("Distribution", 2)?;
        table.serialize_field("mean", &self.mean)?;
        table.serialize_field("spread", &self.spread)?;
        table.end()
    }
}

#[cfg(test)]
mod tests {
    use hairline_laying::Stream;

    use super::*;

    #[test]
    fn distributions_have_the_mean_and_spread_they_promise() {
        let drawn = Distribution {
            mean: 200.0,
            spread: 0.4,
        };
        let draw = |index| drawn.log_normal_at(Stream::new(1, 0, index).normal());
        let values: Vec<_> = (0..100_000).map(draw).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        // The standard error is 200 x 0.417 / sqrt(n) = 0.26.
        assert!((mean - 200.0).abs() < 1.1, "{mean}");
        let logs: Vec<_> = values.iter().map(|v| v.ln()).collect();
        let log_mean = logs.iter().sum::<f64>() / n;
        let variance = logs.iter().map(|l| (l - log_mean).powi(2)).sum::<f64>() / n;
        assert!((variance.sqrt() - 0.4).abs() < 0.004, "{}", variance.sqrt());
    }
}
