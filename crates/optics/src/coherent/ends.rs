//! Fourier integral of the window along a groove, as [`super::window_fourier`] has it, at several wavelengths.
//!
//! J. A. C. Weideman, *Computation of the Complex Error Function* (1994), where the Faddeeva function is not yet its
//! asymptotic series.

use super::lanes::{Complexes, Lanes};
use super::{TOLERANCE, window::REACH};
use std::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};
use std::sync::LazyLock;

/// Terms of Weideman's series: off by 8e-11 at most.
const TERMS: usize = 24;
/// Least argument from which the asymptotic series is good to 2e-10.
const FAR: f64 = 8.0;
const ASYMPTOTIC: [f64; 6] = [1.0, 0.5, 0.75, 1.875, 6.5625, 29.53125];

/// An interval of a line: the whole Gaussian or nothing, with its ends' tails taken off or added.
#[derive(Clone, Debug)]
pub(super) struct IntervalEnds {
    whole: bool,
    ends: [Option<IntervalEnd>; 2],
    coherence_um: f64,
}

/// One end that the window reaches. Its tail goes on to infinity, away from the middle.
#[derive(Clone, Copy, Debug)]
struct IntervalEnd {
    place_um: f64,
    /// Distance from the middle in units of sqrt(2) sigma, 0 or more.
    x: f64,
    /// -1 for a tail to the right, 1 for one to the left: the sign of a in w's argument.
    side: f64,
    /// Half the window there, with the sign that the tail counts by.
    amplitude: f64,
}

impl IntervalEnds {
    pub(crate) fn new(low_um: f64, high_um: f64, coherence_um: f64) -> Self {
        let end = |place_um: f64, side: f64, sign: f64| {
            let x = place_um.abs() * FRAC_1_SQRT_2 / coherence_um;
            let amplitude = 0.5 * sign * (-x * x).exp();
            (x < REACH && amplitude.abs() > TOLERANCE).then_some(IntervalEnd {
                place_um,
                x,
                side,
                amplitude,
            })
        };
        let ends = if low_um >= 0.0 {
            [end(low_um, -1.0, 1.0), end(high_um, -1.0, -1.0)]
        } else if high_um <= 0.0 {
            [end(low_um, 1.0, -1.0), end(high_um, 1.0, 1.0)]
        } else {
            [end(low_um, 1.0, -1.0), end(high_um, -1.0, -1.0)]
        };
        Self {
            whole: low_um < 0.0 && high_um > 0.0,
            ends,
            coherence_um,
        }
    }

    /// Fourier integral relative to the window's, or None if it is nowhere above [`TOLERANCE`] over `weight`.
    #[inline(always)]
    pub(crate) fn fourier<const N: usize>(
        &self,
        kappa_per_um: Lanes<N>,
        weight: f64,
    ) -> Option<Complexes<N>> {
        let a = kappa_per_um * (self.coherence_um * FRAC_1_SQRT_2);
        let nearest = a.smallest_abs();
        let mut sum = None;
        if self.whole && weight * (-nearest * nearest).exp() > TOLERANCE {
            sum = Some(Complexes {
                re: a.map(|a| (-a * a).exp()),
                im: Lanes::ZERO,
            });
        }
        for end in self.ends.iter().flatten() {
            // |w| is at most 1, and 0.56/|z| far off.
            if weight * end.amplitude.abs() * (0.8 / nearest).min(1.0) < TOLERANCE {
                continue;
            }
            let phase = Complexes::turned_back(kappa_per_um * end.place_um);
            let tail = phase * faddeeva(a * end.side, end.x) * end.amplitude;
            sum = Some(sum.unwrap_or(Complexes::ZERO) + tail);
        }
        sum
    }
}

/// w(a + i x), x of 0 or more, off by 2e-10 at most.
#[inline(always)]
fn faddeeva<const N: usize>(a: Lanes<N>, x: f64) -> Complexes<N> {
    let nearest = a.smallest_abs();
    if nearest * nearest + x * x > FAR * FAR {
        // i/(sqrt(pi) z) (1 + 1/(2 z^2) + 3/(4 z^4) + ...)
        let inverse = Complexes {
            re: a,
            im: Lanes::splat(x),
        }
        .recip();
        let u = inverse * inverse;
        let series = horner(&ASYMPTOTIC, u);
        let front = Complexes {
            re: -inverse.im,
            im: inverse.re,
        };
        return front * series * (1.0 / PI.sqrt());
    }
    let weideman = &*WEIDEMAN;
    // L - i z and L + i z.
    let inverse = Complexes {
        re: Lanes::splat(weideman.scale + x),
        im: -a,
    }
    .recip();
    let above = Complexes {
        re: Lanes::splat(weideman.scale - x),
        im: a,
    };
    let series = horner(&weideman.coefficients, above * inverse) * 2.0;
    let mut sum = series * inverse;
    sum.re = sum.re + Lanes::splat(1.0 / PI.sqrt());
    sum * inverse
}

#[inline(always)]
fn horner<const N: usize>(coefficients: &[f64], z: Complexes<N>) -> Complexes<N> {
    let mut sum = Complexes::ZERO;
    for &c in coefficients.iter().rev() {
        sum = sum * z;
        sum.re = sum.re + Lanes::splat(c);
    }
    sum
}

/// w(z) = 2 p(Z)/(L - iz)^2 + 1/(sqrt(pi) (L - iz)), Z = (L + iz)/(L - iz).
struct Weideman {
    /// L
    scale: f64,
    /// Coefficients of p, from the constant term on.
    coefficients: [f64; TERMS],
}

static WEIDEMAN: LazyLock<Weideman> = LazyLock::new(|| {
    let half = 2 * TERMS as i32;
    let scale = (TERMS as f64 / SQRT_2).sqrt();
    // The Fourier series of exp(-t^2) (L^2 + t^2) in the angle that t = L tan(angle/2) has.
    let coefficient = |n: usize| {
        let samples = (1 - half..half).map(|k| {
            let angle = PI * f64::from(k) / f64::from(half);
            let t = scale * (0.5 * angle).tan();
            (-t * t).exp() * (scale * scale + t * t) * ((n + 1) as f64 * angle).cos()
        });
        samples.sum::<f64>() / f64::from(2 * half)
    };
    Weideman {
        scale,
        coefficients: std::array::from_fn(coefficient),
    }
});

#[cfg(test)]
mod tests {
    use super::*;
    use errorfunctions::ComplexErrorFunctions;
    use num_complex::Complex64;

    #[test]
    fn the_faddeeva_function_is_that_of_the_crate() {
        let mut worst = 0.0_f64;
        for i in -1200..=1200 {
            for j in 0..60 {
                let (a, x) = (0.01 * f64::from(i), 0.1 * f64::from(j));
                let found = faddeeva(Lanes([a, 1.7 * a]), x);
                for (lane, a) in [a, 1.7 * a].into_iter().enumerate() {
                    let exact = Complex64::new(a, x).w();
                    let found = Complex64::new(found.re.0[lane], found.im.0[lane]);
                    worst = worst.max((found - exact).norm());
                }
            }
        }
        println!("Faddeeva function: {worst:.1e}");
        assert!(worst < 3e-10, "{worst:e}");
    }
}
