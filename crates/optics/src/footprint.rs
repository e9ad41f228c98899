//! Anti-aliasing by the pixel's Gaussian footprint (docs/model.md, section 6).
//!
//! The footprint replaces |eta_s|^2 by its average over a Gaussian on the surface, in closed form. What remains of a
//! scratch is a line density across (a normal distribution) times a length share along (a difference of two erf).

use crate::gaussian::gaussian;
use spec_math::cephes64::erf;
use std::f64::consts::{FRAC_1_PI, PI};

/// Covariance of a footprint in a scratch's own axes, um^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Variance across the scratch, a = n' Sigma n.
    pub across_um2: f64,
    /// Variance along the scratch, b = t' Sigma t.
    pub along_um2: f64,
    /// Covariance, c = n' Sigma t.
    pub cross_um2: f64,
}

/// A smooth interval that stands for the square of a finite scratch's longitudinal integral, E^2, with the exact
/// integral and variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothInterval {
    /// Distance by which each free end moves inwards.
    pub shrink_um: f64,
    /// Standard deviation s of the Gaussian that smooths each end.
    pub blur_um: f64,
}

/// Ends of a scratch of the given whole length. With x = l/(2 sigma): M = integral of E^2, and the variance of E^2
/// about the centre, both from moments of a Gaussian of variance 2 sigma^2 over [0, l].
pub fn ends(length_um: f64, coherence_um: f64) -> SmoothInterval {
    let (l, s) = (length_um, coherence_um);
    if l < 0.05 * s {
        // E^2 tends to a Gaussian of variance sigma^2/2 whose integral is l^2/(2 sqrt(pi) sigma).
        let m = l * l / (2.0 * PI.sqrt() * s);
        return SmoothInterval {
            shrink_um: 0.5 * (l - m),
            blur_um: s * 0.5f64.sqrt(),
        };
    }
    let v = 2.0 * s * s;
    let gauss = (-l * l / (2.0 * v)).exp();
    let density = gauss / (2.0 * PI * v).sqrt();
    let i0 = 0.5 * erf(l / (2.0 * s));
    let i1 = s / PI.sqrt() * (1.0 - gauss);
    let i2 = v * (i0 - l * density);
    let i3 = v * (2.0 * i1 - l * l * density);
    let m = 2.0 * (l * i0 - i1);
    let third = 2.0 * (l.powi(3) * i0 - 3.0 * l * l * i1 + 3.0 * l * i2 - i3);
    let variance = 0.5 * s * s + third / (12.0 * m);
    SmoothInterval {
        shrink_um: 0.5 * (l - m),
        blur_um: (variance - m * m / 12.0).max(0.0).sqrt(),
    }
}

/// Result of [`scratch_share`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScratchShare {
    /// The share of the coherence window that the segment covers, rho.
    pub segment: f64,
    /// The share that an endless scratch along the segment's line covers.
    pub line: f64,
    /// Factor on both where scratches cover one another: 1 but for parts of wide grooves, [`cover_of_part`](crate::section::cover_of_part).
    pub cover: f64,
}

/// Where the part of a segment lies that a footprint sees: mean and standard deviation of the place along the segment, in standard
/// deviations of the footprint along it. A normal variable between two ends; docs/model.md, (23a).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPart {
    /// Mean place.
    pub mean: f64,
    /// Standard deviation of the place.
    pub std: f64,
}

impl SeenPart {
    /// The part between two ends, given in standard deviations of the footprint.
    pub fn new([low, high]: [f64; 2]) -> Self {
        // Nothing is seen farther away.
        let (low, high) = (low.clamp(-8.0, 8.0), high.clamp(-8.0, 8.0));
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let even = half * half / 3.0;
        if half < 0.5 {
            // The footprint's density is nearly a line there, and a difference of its integrals would cancel.
            return Self {
                mean: middle * (1.0 - even),
                std: even.sqrt(),
            };
        }
        let density = |z: f64| (-0.5 * z * z).exp() * (0.5 * FRAC_1_PI).sqrt();
        let per_within = 1.0 / gaussian().integral(low, high).max(1e-9);
        let mean = ((density(low) - density(high)) * per_within).clamp(low, high);
        let second = 1.0 + (low * density(low) - high * density(high)) * per_within;
        let variance = (second - mean * mean).clamp(0.0, even.min(1.0));
        Self {
            mean,
            std: variance.sqrt(),
        }
    }
}

/// The share of the footprint-averaged coherence window that a scratch segment covers: rho of docs/model.md, which is
/// W I/(2 pi^1.5 sigma^3). `offset_um` is the signed distance p_n from the footprint's centre to the segment's line,
/// along n; `start_um` and `end_um` are the segment's ends along t from that centre, moved inwards where they are free.
pub fn scratch_share(
    width_um: f64,
    offset_um: f64,
    start_um: f64,
    end_um: f64,
    blur_um: f64,
    footprint: Footprint,
    coherence_um: f64,
) -> ScratchShare {
    let variance = footprint.across_um2 + 0.5 * coherence_um * coherence_um;
    let per_variance = 1.0 / variance;
    let across = (-0.5 * offset_um * offset_um * per_variance).exp()
        * (per_variance * (1.0 / (2.0 * PI))).sqrt();
    // A slanted footprint: its part on the scratch is displaced along the scratch.
    let shift = offset_um * footprint.cross_um2 * per_variance;
    let along_variance = footprint.along_um2
        - footprint.cross_um2 * footprint.cross_um2 * per_variance
        + blur_um * blur_um;
    let per_std = 1.0 / along_variance.max(0.0).sqrt().max(1e-6);
    let line = width_um * across;
    // Pieces of a scratch still add up to the whole: the table's value at a joint counts once up and once down.
    let along = gaussian().integral((start_um - shift) * per_std, (end_um - shift) * per_std);
    ScratchShare {
        segment: line * along,
        line,
        cover: 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::{window_overlap_um2, window_share};

    /// Average of the exact share over a Gaussian footprint of covariance Sigma, by a product trapezoid rule in whitened
    /// coordinates, spectrally accurate for smooth integrands.
    fn quadrature(width: f64, offset: f64, start: f64, end: f64, f: Footprint, sigma: f64) -> f64 {
        let (n, reach) = (160, 6.0);
        let h = 2.0 * reach / n as f64;
        let sa = f.across_um2.sqrt();
        let lower = if sa > 0.0 { f.cross_um2 / sa } else { 0.0 };
        let rest = (f.along_um2 - lower * lower).max(0.0).sqrt();
        let mut sum = 0.0;
        for i in 0..=n {
            for j in 0..=n {
                let (g0, g1) = (-reach + h * i as f64, -reach + h * j as f64);
                let (dn, dt) = (sa * g0, lower * g0 + rest * g1);
                let weight = (-0.5 * (g0 * g0 + g1 * g1)).exp() / (2.0 * PI) * h * h;
                sum += weight
                    * window_share(
                        width,
                        window_overlap_um2(offset - dn, start - dt, end - dt, sigma),
                        sigma,
                    );
            }
        }
        sum
    }

    /// Test of the figure in docs/model.md: rms error below 0.5 % for pixels from 5 to 320 um.
    #[test]
    fn the_closed_form_equals_quadrature() {
        let sigma = 20.0;
        let mut worst: f64 = 0.0;
        for pixel_um in [5.0f64, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0] {
            let (mut error2, mut value2) = (0.0, 0.0);
            for (i, length) in [15.0, 60.0, 200.0, 1000.0, 5000.0].into_iter().enumerate() {
                for (j, slant) in [0.0, 0.4, -0.8].into_iter().enumerate() {
                    for k in 0..12 {
                        // A golden-ratio sequence scatters the scratch over the footprint, its middle and both ends.
                        let golden =
                            (0.618_033_988_749_895 * (k + 12 * (j + 3 * i)) as f64).fract();
                        let stretch = 1.0 + 2.0 * golden;
                        let (a, b) = ((0.5 * pixel_um).powi(2), (0.5 * pixel_um * stretch).powi(2));
                        let f = Footprint {
                            across_um2: a,
                            along_um2: b,
                            cross_um2: slant * (a * b).sqrt(),
                        };
                        let offset = (golden - 0.5) * 2.0 * (a + sigma * sigma).sqrt();
                        let center = ((3.7 * golden).fract() - 0.5) * (length + 2.0 * b.sqrt());
                        let e = ends(length, sigma);
                        let half = 0.5 * length;
                        let value = scratch_share(
                            2.0,
                            offset,
                            center - half + e.shrink_um,
                            center + half - e.shrink_um,
                            e.blur_um,
                            f,
                            sigma,
                        )
                        .segment;
                        let expected =
                            quadrature(2.0, offset, center - half, center + half, f, sigma);
                        error2 += (value - expected).powi(2);
                        value2 += expected.powi(2);
                    }
                }
            }
            let rms = (error2 / value2).sqrt();
            println!(
                "footprint: pixel {pixel_um} um, relative rms error {:.3} %",
                100.0 * rms
            );
            worst = worst.max(rms);
        }
        assert!(worst < 5e-3, "{worst}");
    }

    #[test]
    fn ends_keep_the_integral_and_the_variance() {
        let sigma = 20.0;
        for length in [2.0, 10.0, 40.0, 100.0, 1000.0] {
            let e = ends(length, sigma);
            let h = 0.25;
            let (mut m, mut second) = (0.0, 0.0);
            for i in -8000..=8000 {
                let y = h * i as f64;
                let root2_s = 2f64.sqrt() * sigma;
                let value = (0.5
                    * (erf((length / 2.0 - y) / root2_s) - erf((-length / 2.0 - y) / root2_s)))
                .powi(2);
                m += value * h;
                second += y * y * value * h;
            }
            assert!(
                ((length - 2.0 * e.shrink_um) / m - 1.0).abs() < 1e-3,
                "M({length})"
            );
            let blur = (second / m - m * m / 12.0).sqrt();
            assert!(
                (e.blur_um / blur - 1.0).abs() < 1e-3,
                "s({length}): {} {blur}",
                e.blur_um
            );
        }
        assert!(
            (ends(1e4, sigma).blur_um / sigma - 0.825).abs() < 1e-3,
            "the long limit that docs/model.md states"
        );
    }

    /// The part that is seen is a normal variable between two ends, however near or far they are.
    #[test]
    fn a_seen_part_has_its_mean_and_its_deviation() {
        for ends in [
            [-9.0f64, 9.0],
            [-0.2, 3.0],
            [1.0, 1.5],
            [-3.0, -2.2],
            [0.3, 0.31],
            [2.0, 40.0],
        ] {
            let steps = 20_000;
            let step = (ends[1].min(9.0) - ends[0]) / f64::from(steps);
            let places = (0..steps).map(|i| ends[0] + step * (f64::from(i) + 0.5));
            let mut moments = [0.0; 3];
            for z in places {
                let density = (-0.5 * z * z).exp();
                moments[0] += density;
                moments[1] += density * z;
                moments[2] += density * z * z;
            }
            let mean = moments[1] / moments[0];
            let std = (moments[2] / moments[0] - mean * mean).sqrt();
            let part = SeenPart::new(ends);
            let off = (part.mean - mean).abs().max((part.std - std).abs());
            // A part of a footprint, at its far end where little is seen.
            assert!(off < 0.03, "{ends:?}: {part:?}, not {mean} {std}");
        }
    }

    /// Joined ends are not shrunk: pieces sum to the whole, however many they are.
    #[test]
    fn a_hundred_pieces_are_one_scratch() {
        let (sigma, length) = (20.0, 700.0);
        let f = Footprint {
            across_um2: 30.0,
            along_um2: 90.0,
            cross_um2: 10.0,
        };
        let e = ends(length, sigma);
        let (start, end) = (-200.0 + e.shrink_um, -200.0 + length - e.shrink_um);
        let whole = scratch_share(2.0, 5.0, start, end, e.blur_um, f, sigma).segment;
        let step = (end - start) / 100.0;
        let pieces: f64 = (0..100)
            .map(|i| {
                scratch_share(
                    2.0,
                    5.0,
                    start + step * i as f64,
                    start + step * (i + 1) as f64,
                    e.blur_um,
                    f,
                    sigma,
                )
                .segment
            })
            .sum();
        assert!((pieces / whole - 1.0).abs() < 1e-12);
    }
}
