//! The talk's anti-aliasing: a blend of the pixel's two limits, and the density that masks the base.
//!
//! The talk writes |eta_phi|^2 as the sum of two terms: a times the integral over the plane of |eta_s|^2 for the contained
//! length, and (1 - a) A_phi |eta_s|^2, with a = min(A_phi/(2 A_c), 1). Both are integrals over the pixel, in um^4: the
//! first where the pixel is far larger than the window (an endless scratch has 2 pi^1.5 sigma^3 per unit of length), the
//! second where it is far smaller. What shading needs is the mean over the pixel. So here both are divided by A_phi, and
//! by 2 pi^1.5 sigma^3 / W to become the share rho of [`hairline_optics::scratch::window_share`].
//!
//! A_c, the coherence area, is taken to be pi sigma^2, the integral of the window's square by which the talk normalises
//! its BRDF. Off, no footprint at all, is [`hairline_optics::footprint::scratch_share`] under a footprint of zero.

use std::f64::consts::PI;

use glam::DVec2;
use spec_math::cephes64::erf;

/// A pixel's parallelogram on the surface, about the shading point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelFootprint {
    /// Step on the surface from one pixel to the next on the right; x along the scratch, y across it, um.
    pub right_um: DVec2,
    /// Step on the surface to the next pixel below, um.
    pub down_um: DVec2,
}

impl PixelFootprint {
    /// A_phi.
    pub(crate) fn area_um2(&self) -> f64 {
        self.right_um.perp_dot(self.down_um).abs()
    }
}

/// Result of [`published_share`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PublishedShare {
    /// The share of the coherence window that the segment covers, mean over the pixel: in the place of rho of (20).
    pub share: f64,
    /// Density of the scratch in rho_phi of the talk's mask: the base keeps max(1 - sum, 0).
    pub density: f64,
}

/// The length of a segment within the pixel. `offset_um` is where the segment's line lies across, `start_um` and `end_um`
/// its ends along, from the pixel's centre.
pub(crate) fn contained_length_um(
    offset_um: f64,
    start_um: f64,
    end_um: f64,
    pixel: PixelFootprint,
) -> f64 {
    let half_area = 0.5 * pixel.area_um2();
    let (mut low, mut high) = (start_um, end_um);
    for side in [pixel.right_um, pixel.down_um] {
        // Within the strip along `side`, |side x (s, offset)| is at most half the area.
        let (slope, at_zero) = (-side.y, side.x * offset_um);
        // A strip along the scratch holds all of it or nothing.
        let slope = if slope.abs() < SLOPE_MIN_UM {
            SLOPE_MIN_UM
        } else {
            slope
        };
        let (one, other) = (
            (-half_area - at_zero) / slope,
            (half_area - at_zero) / slope,
        );
        low = low.max(one.min(other));
        high = high.min(one.max(other));
    }
    (high - low).max(0.0)
}

/// Least component of a pixel's side across the scratch; less is none.
const SLOPE_MIN_UM: f64 = 1e-9;
/// Smaller pixels have this area where it divides.
const AREA_MIN_UM2: f64 = 1e-6;

/// The talk's blend for one segment. `blur_um` smooths its ends as in [`hairline_optics::footprint::scratch_share`], which keeps
/// joints between straight pieces of one scratch invisible; the talk's own |eta_s|^2 knows whole scratches only.
pub fn published_share(
    width_um: f64,
    offset_um: f64,
    start_um: f64,
    end_um: f64,
    blur_um: f64,
    pixel: PixelFootprint,
    coherence_um: f64,
) -> PublishedShare {
    let area = pixel.area_um2();
    let twice_coherence_area = 2.0 * PI * coherence_um * coherence_um;
    let length = contained_length_um(offset_um, start_um, end_um, pixel);
    let z = (std::f64::consts::SQRT_2 * blur_um).max(1e-6);
    let p = offset_um / coherence_um;
    let at_the_point =
        (-p * p).exp() / (PI.sqrt() * coherence_um) * 0.5 * (erf(end_um / z) - erf(start_um / z));
    let blend = (area / twice_coherence_area).min(1.0);
    // blend / area, where the area may be 0.
    let per_length = 1.0 / area.max(twice_coherence_area);
    PublishedShare {
        share: width_um * (per_length * length + (1.0 - blend) * at_the_point),
        density: 2.0 * width_um * length / area.max(AREA_MIN_UM2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat2;
    use hairline_optics::footprint::{Footprint, SmoothInterval, ends, scratch_share};
    use hairline_optics::scratch::{window_overlap_um2, window_share};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;
    use rayon::prelude::*;

    const SIGMA_UM: f64 = 20.0;

    /// A straight scratch of width 1 at random near a pixel.
    struct Groove {
        offset_um: f64,
        start_um: f64,
        end_um: f64,
        turn_rad: f64,
    }

    impl Groove {
        /// Lengths from 15 um to 5 mm, wherever the pixel's mean may notice it.
        fn random(random: &mut Pcg64Mcg, pixel_um: f64) -> Self {
            let reach = 0.5f64.sqrt() * pixel_um + 2.0 * SIGMA_UM;
            let length = 15.0 * (5000.0 / 15.0f64).powf(random.random_range(0.0..1.0));
            let center = (0.5 * length + reach) * random.random_range(-1.0..1.0);
            Self {
                offset_um: reach * random.random_range(-1.0..1.0),
                start_um: center - 0.5 * length,
                end_um: center + 0.5 * length,
                turn_rad: random.random_range(0.0..PI),
            }
        }

        /// The share at a place of the pixel, in its axes.
        fn share_at(&self, x_um: f64, y_um: f64) -> f64 {
            let (sin, cos) = self.turn_rad.sin_cos();
            let (along, across) = (x_um * cos + y_um * sin, y_um * cos - x_um * sin);
            let overlap = window_overlap_um2(
                self.offset_um - across,
                self.start_um - along,
                self.end_um - along,
                SIGMA_UM,
            );
            window_share(1.0, overlap, SIGMA_UM)
        }

        /// Mean over a square pixel, by Gauss-Legendre rules of three points in cells well below the window.
        fn mean_over_square(&self, pixel_um: f64) -> f64 {
            let cells = (pixel_um / (0.6 * SIGMA_UM)).ceil() as usize;
            let nodes: Vec<(f64, f64)> = (0..cells)
                .flat_map(|i| {
                    [
                        (-0.774_596_669_241_483, 5.0 / 18.0),
                        (0.0, 8.0 / 18.0),
                        (0.774_596_669_241_483, 5.0 / 18.0),
                    ]
                    .map(|(x, w)| {
                        let x = (i as f64 + 0.5 + 0.5 * x) / cells as f64 - 0.5;
                        (x * pixel_um, w / cells as f64)
                    })
                })
                .collect();
            self.mean_over(&nodes)
        }

        /// Mean over places and their weights, the same along both axes.
        fn mean_over(&self, nodes: &[(f64, f64)]) -> f64 {
            let row = |&(y, wy): &(f64, f64)| -> f64 {
                nodes
                    .iter()
                    .map(|&(x, wx)| wx * wy * self.share_at(x, y))
                    .sum()
            };
            nodes.iter().map(row).sum()
        }

        /// Mean over a Gaussian pixel, by the trapezoid rule.
        fn mean_over_gaussian(&self, std_um: f64) -> f64 {
            let cells = (12.0 * std_um / (0.5 * SIGMA_UM).min(0.5 * std_um)).ceil() as usize;
            let nodes: Vec<(f64, f64)> = (0..=cells)
                .map(|i| {
                    let x = 12.0 * (i as f64 / cells as f64 - 0.5);
                    let weight = (-0.5 * x * x).exp() / (2.0 * PI).sqrt() * 12.0 / cells as f64;
                    (x * std_um, weight)
                })
                .collect();
            self.mean_over(&nodes)
        }

        fn effective(&self) -> (f64, f64, SmoothInterval) {
            let ends = ends(self.end_um - self.start_um, SIGMA_UM);
            (
                self.start_um + ends.shrink_um,
                self.end_um - ends.shrink_um,
                ends,
            )
        }

        fn square(&self, pixel_um: f64) -> PixelFootprint {
            let (sin, cos) = self.turn_rad.sin_cos();
            PixelFootprint {
                right_um: DVec2::new(cos, -sin) * pixel_um,
                down_um: DVec2::new(sin, cos) * pixel_um,
            }
        }

        fn published(&self, pixel_um: f64) -> f64 {
            let (start, end, ends) = self.effective();
            let pixel = self.square(pixel_um);
            published_share(
                1.0,
                self.offset_um,
                start,
                end,
                ends.blur_um,
                pixel,
                SIGMA_UM,
            )
            .share
        }

        /// The formula as the talk has it, for a whole scratch and for any coherence area. `window_ends`: the integral
        /// over the plane of a scratch of the contained length, which its two ends shorten, rather than of that length
        /// of an endless one.
        fn talk(&self, pixel_um: f64, coherence_area_um2: f64, window_ends: bool) -> f64 {
            let pixel = self.square(pixel_um);
            let mut length = contained_length_um(self.offset_um, self.start_um, self.end_um, pixel);
            if window_ends && length > 0.0 {
                length -= 2.0 * ends(length, SIGMA_UM).shrink_um;
            }
            let blend = (0.5 * pixel.area_um2() / coherence_area_um2).min(1.0);
            blend * length / pixel.area_um2() + (1.0 - blend) * self.share_at(0.0, 0.0)
        }

        fn gaussian(&self, std_um: f64) -> f64 {
            let (start, end, ends) = self.effective();
            let round = Footprint {
                across_um2: std_um * std_um,
                along_um2: std_um * std_um,
                cross_um2: 0.0,
            };
            scratch_share(
                1.0,
                self.offset_um,
                start,
                end,
                ends.blur_um,
                round,
                SIGMA_UM,
            )
            .segment
        }
    }

    /// Relative rms of `value` against `expected` over random scratches.
    fn relative_rms(
        grooves: &[Groove],
        value: impl Fn(&Groove) -> f64 + Sync,
        expected: impl Fn(&Groove) -> f64 + Sync,
    ) -> f64 {
        let pairs: Vec<(f64, f64)> = grooves
            .par_iter()
            .map(|g| (value(g), expected(g)))
            .collect();
        let square = |f: fn(&(f64, f64)) -> f64| pairs.iter().map(|p| f(p).powi(2)).sum::<f64>();
        (square(|(value, expected)| value - expected) / square(|(_, expected)| *expected)).sqrt()
    }

    fn grooves(pixel_um: f64, count: usize) -> Vec<Groove> {
        let mut random = Pcg64Mcg::seed_from_u64(3);
        (0..count)
            .map(|_| Groove::random(&mut random, pixel_um))
            .collect()
    }

    #[test]
    fn the_blend_errs_by_so_much() {
        println!("square pixels, sigma 20 um, % rms:");
        println!(
            "published_share; the talk to the letter, with the integral of a scratch that ends,"
        );
        println!(
            "with twice the coherence area, with half of it; no footprint; the default's Gaussian"
        );
        let area = PI * SIGMA_UM * SIGMA_UM;
        let mut published = Vec::new();
        for pixel_um in [5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0, 640.0] {
            let grooves = grooves(pixel_um, 500);
            let means: Vec<f64> = grooves
                .par_iter()
                .map(|g| g.mean_over_square(pixel_um))
                .collect();
            let rms = |value: &(dyn Fn(&Groove) -> f64 + Sync)| {
                let error2: f64 = grooves
                    .iter()
                    .zip(&means)
                    .map(|(g, mean)| (value(g) - mean).powi(2))
                    .sum();
                (error2 / means.iter().map(|m| m * m).sum::<f64>()).sqrt()
            };
            let errors = [
                rms(&|g| g.published(pixel_um)),
                rms(&|g| g.talk(pixel_um, area, false)),
                rms(&|g| g.talk(pixel_um, area, true)),
                rms(&|g| g.talk(pixel_um, 2.0 * area, false)),
                rms(&|g| g.talk(pixel_um, 0.5 * area, false)),
                rms(&|g| g.share_at(0.0, 0.0)),
            ];
            let std_um = pixel_um / 12f64.sqrt();
            let gaussian = relative_rms(
                &grooves[..100],
                |g| g.gaussian(std_um),
                |g| g.mean_over_gaussian(std_um),
            );
            println!(
                "pixel {pixel_um:3} um: {}; {:.2}",
                errors.map(|e| format!("{:4.1}", 100.0 * e)).join("  "),
                100.0 * gaussian
            );
            assert!(gaussian < 5e-3, "{gaussian}");
            published.push(errors[0]);
        }
        // Right in both limits, worst where the pixel is as large as the window.
        assert!(published[0] < 0.05 && published[7] < 0.03, "{published:?}");
        assert!((0.3..0.45).contains(&published[3]), "{published:?}");
    }

    #[test]
    fn both_limits_are_the_mean_over_the_pixel() {
        let small = relative_rms(
            &grooves(0.5, 200),
            |g| g.published(0.5),
            |g| g.mean_over_square(0.5),
        );
        // A scratch's margin of two windows is then small against the pixel.
        let large = relative_rms(
            &grooves(3000.0, 100),
            |g| g.published(3000.0),
            |g| g.mean_over_square(3000.0),
        );
        println!("limits: {small:.1e} at 0.5 um, {large:.1e} at 3 mm");
        assert!(small < 5e-3 && large < 5e-3, "{small} {large}");
        // An integral over the pixel in the place of its mean would be found.
        let integral = relative_rms(
            &grooves(0.5, 200),
            |g| g.published(0.5) * 0.25,
            |g| g.mean_over_square(0.5),
        );
        assert!(integral > 0.5);
    }

    #[test]
    fn contained_lengths_equal_sampling() {
        let mut random = Pcg64Mcg::seed_from_u64(5);
        let (mut inside, mut flipped) = (0, 0);
        for _ in 0..2000 {
            let mut side = || {
                DVec2::new(
                    random.random_range(-9.0..9.0),
                    random.random_range(-9.0..9.0),
                )
            };
            let pixel = PixelFootprint {
                right_um: side(),
                down_um: side(),
            };
            let offset = random.random_range(-6.0..6.0);
            let start = random.random_range(-12.0..6.0);
            let end = start + random.random_range(0.0..12.0);
            // The inverse of the parallelogram's matrix, which the strips do not use.
            let inverse = DMat2::from_cols(pixel.right_um, pixel.down_um).inverse();
            let steps = 2000;
            let step = (end - start) / steps as f64;
            let expected = (0..steps)
                .map(|i| DVec2::new(start + step * (i as f64 + 0.5), offset))
                .filter(|&p| (inverse * p).abs().max_element() <= 0.5)
                .count() as f64
                * step;
            let value = contained_length_um(offset, start, end, pixel);
            assert!(
                (value - expected).abs() <= 1.01 * step,
                "{value} {expected}"
            );
            inside += (value > 0.0) as u32;
            // The mirror image of the line is another line.
            let mirrored = contained_length_um(-offset, start, end, pixel);
            flipped += ((mirrored - expected).abs() > 2.0 * step) as u32;
        }
        assert!(inside > 500 && flipped > 300, "{inside} {flipped}");
    }

    #[test]
    fn density_is_the_area_of_the_grooves_twice() {
        // A groove of width 3 right across a square of 60: 5 % of it.
        let pixel = PixelFootprint {
            right_um: DVec2::new(60.0, 0.0),
            down_um: DVec2::new(0.0, 60.0),
        };
        let share = published_share(3.0, 10.0, -500.0, 500.0, 16.0, pixel, SIGMA_UM);
        assert!((share.density - 2.0 * 3.0 / 60.0).abs() < 1e-12);
        // Beside the pixel it counts for nothing, though the window sees it.
        let beside = published_share(3.0, 31.0, -500.0, 500.0, 16.0, pixel, SIGMA_UM);
        assert_eq!(beside.density, 0.0);
    }
}
