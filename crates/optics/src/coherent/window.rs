//! A Gaussian window over an interval: its Fourier integral (the exact eta) and its share of energy.

use errorfunctions::ComplexErrorFunctions;
use num_complex::Complex64;
use spec_math::cephes64::{erf, erfc};
use std::f64::consts::SQRT_2;

/// Radius of the window, in sqrt(2) sigma: beyond 8.5 sigma it holds 2e-17 of its integral.
pub(super) const REACH: f64 = 6.0;

/// The Fourier integral of the window over an interval, relative to its whole integral:
/// 1/(sqrt(2 pi) sigma) times the integral of exp(-s^2/(2 sigma^2) - i kappa s) over s from `low_um` to `high_um`, either
/// of which may be infinite. `kappa_per_um` is k xi, `coherence_um` sigma, above 0.
///
/// In terms of erf of a complex argument this is exp(-a^2)/2 [erf(x + ia)] between the ends, with a = kappa sigma/sqrt(2);
/// erf overflows from a = 27 on, and a reaches hundreds. So the tails beyond the ends are taken off the whole instead,
/// each by way of the Faddeeva function, which stays below 1.
pub fn window_fourier(
    low_um: f64,
    high_um: f64,
    coherence_um: f64,
    kappa_per_um: f64,
) -> Complex64 {
    let unit = 1.0 / (SQRT_2 * coherence_um);
    let (low, high) = (low_um * unit, high_um * unit);
    let a = kappa_per_um * coherence_um / SQRT_2;
    // Two ends on one side: the difference of their tails keeps its relative precision however far out they lie.
    if low >= 0.0 {
        tail(low, a) - tail(high, a)
    } else if high <= 0.0 {
        (tail(-high, a) - tail(-low, a)).conj()
    } else {
        (-a * a).exp() - tail(high, a) - tail(-low, a).conj()
    }
}

/// 1/sqrt(pi) times the integral of exp(-v^2 - 2 i a v) over v from x to infinity, x at or above 0:
/// exp(-x^2 - 2 i a x) w(-a + i x) / 2, w the Faddeeva function.
fn tail(x: f64, a: f64) -> Complex64 {
    if x > REACH {
        return Complex64::ZERO;
    }
    Complex64::from_polar(0.5 * (-x * x).exp(), -2.0 * a * x) * Complex64::new(-a, x).w()
}

/// The share of exp(-s^2/sigma^2) between two places.
pub(super) fn energy_share(low_um: f64, high_um: f64, coherence_um: f64) -> f64 {
    let (low, high) = (low_um / coherence_um, high_um / coherence_um);
    0.5 * if low >= 0.0 {
        erfc(low) - erfc(high)
    } else if high <= 0.0 {
        erfc(-high) - erfc(-low)
    } else {
        erf(high) - erf(low)
    }
}
