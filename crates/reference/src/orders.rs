//! Distribution of q over the orders to which a grating sends the wavelengths of a sample.

use super::interval::{CutCauchy, CutNormal};
use super::wavelengths::Spectrum;
use hairline_optics::grating::Grating as Row;

/// Probability of drawing q from the rest's distribution, which serves the light of single grooves and all that the
/// orders do not cover.
const REST_SHARE: f64 = 0.2;

/// Half width of the rest's distribution over u = W q: wider than a slit's, as displaced grooves send light further out.
const REST_HALF_WIDTH_UM: f64 = 0.4;

/// Orders of less than this share of the light are left to the rest.
const LEAST_WEIGHT: f64 = 1e-6;

/// Mixture of the orders' peaks and a distribution that covers all directions, cut to an interval.
pub(super) struct Orders {
    /// Peaks of the orders: cumulative sum of the weights, middle of the peak, and distribution about that.
    peaks: Vec<(f64, f64, CutNormal)>,
    rest: CutCauchy,
}

impl Orders {
    /// Makes the mixture; none if the interval is empty. `weight` is that of an order.
    pub(super) fn new(
        row: &Row,
        weight: impl Fn(i32) -> f64,
        nm: &Spectrum<f64>,
        band_std: &Spectrum<f64>,
        low: f64,
        high: f64,
    ) -> Option<Self> {
        let rest = CutCauchy::new(REST_HALF_WIDTH_UM / row.width_um, low, high)?;
        let mut peaks = Vec::new();
        let mut sum = 0.0;
        for (nm, std) in nm.iter().zip(band_std) {
            let reach = 5.0 * std;
            let first = ((low - reach) / row.order_q(1, *nm)).ceil() as i32;
            let last = ((high + reach) / row.order_q(1, *nm)).floor() as i32;
            for order in first..=last {
                let weight = weight(order);
                if order == 0 || weight < LEAST_WEIGHT {
                    continue;
                }
                let middle = row.order_q(order, *nm);
                if let Some(peak) = CutNormal::new(*std, low - middle, high - middle) {
                    sum += weight * peak.share();
                    peaks.push((sum, middle, peak));
                }
            }
        }
        Some(Self { peaks, rest })
    }

    fn total(&self) -> f64 {
        self.peaks.last().map_or(0.0, |(sum, ..)| *sum)
    }

    fn rest_share(&self) -> f64 {
        if self.total() > 0.0 { REST_SHARE } else { 1.0 }
    }

    pub(super) fn sample(&self, v: f64) -> f64 {
        let rest = self.rest_share();
        if v < rest {
            return self.rest.sample(v / rest);
        }
        let at = (v - rest) / (1.0 - rest) * self.total();
        let i = self.peaks.partition_point(|(sum, ..)| *sum <= at);
        let i = i.min(self.peaks.len() - 1);
        let before = if i > 0 { self.peaks[i - 1].0 } else { 0.0 };
        let (sum, middle, peak) = &self.peaks[i];
        middle + peak.sample(((at - before) / (sum - before)).clamp(1e-9, 1.0 - 1e-9))
    }

    pub(super) fn pdf(&self, q: f64) -> f64 {
        let rest = self.rest_share();
        let mut before = 0.0;
        let mut by_peaks = 0.0;
        for (sum, middle, peak) in &self.peaks {
            by_peaks += (sum - before) * peak.pdf(q - middle);
            before = *sum;
        }
        rest * self.rest.pdf(q) + (1.0 - rest) * by_peaks / self.total().max(1e-300)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wavelengths::Wavelengths;
    use hairline_optics::spectrum::Observer;

    #[test]
    fn samples_follow_their_density() {
        let row = Row {
            pitch_um: 1.6,
            width_um: 0.6,
            depth_nm: 110.0,
            depth_spread: 0.0,
            jitter_um: 0.05,
        };
        let Wavelengths { nm, .. } = Wavelengths::new(Observer::eye(), 0.4);
        let std = [0.01; 8];
        for (low, high) in [(-1.2, 1.4), (0.3, 0.36), (1.9, 1.95)] {
            let orders =
                Orders::new(&row, |order| row.order_weight(order), &nm, &std, low, high).unwrap();
            let (count, bins) = (200_000, 20);
            let mut found = [0.0; 20];
            for i in 0..count {
                let q = orders.sample((f64::from(i) + 0.5) / f64::from(count));
                assert!((low..=high).contains(&q));
                let bin = ((q - low) / (high - low) * 20.0) as usize;
                found[bin.min(bins - 1)] += 1.0 / f64::from(count);
            }
            for (bin, found) in found.into_iter().enumerate() {
                let width = (high - low) / bins as f64;
                let middle = |i: usize| low + width * (bin as f64 + (i as f64 + 0.5) / 200.0);
                let expected: f64 = (0..200)
                    .map(|i| orders.pdf(middle(i)) * width / 200.0)
                    .sum();
                assert!(
                    (found - expected).abs() < 2e-3,
                    "{low} {bin}: {found} {expected}"
                );
            }
        }
    }
}
