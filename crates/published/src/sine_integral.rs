//! "Approximate Si": the talk shows pictures made with it and does not say what it is, so this one is Hairline's.
//!
//! Si(x) = pi/2 - f(x) cos x - g(x) sin x for x > 0, with f and g smooth and falling (Abramowitz and Stegun, *Handbook of
//! Mathematical Functions*, 1964, 5.2.8). The antiderivative of sinc^2 needs the same cosine, so a shader of 2018 would
//! hardly do otherwise: one pair of sine and cosine, two divisions, seven multiply-adds, no branch and no table.
//!
//! Low-order rational functions stand for f and g. Their coefficients keep what a picture shows first: Si is odd, starts
//! with slope 1 (so that the mirror's direction is as bright as it should be), ends at pi/2, and f has no term in 1/x^2 (so
//! that the tail of sinc^2 keeps its height). What freedom is left makes the error of sinc^2 itself, of which small lights
//! see nothing else, least.

use hairline_optics::diffraction;
use std::f64::consts::PI;

/// The sine integral that a renderer evaluates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SineIntegral {
    /// Exact to the last digits of the language: [`diffraction::sine_integral`], in the shader to 1e-6.
    Exact,
    /// [`sine_integral_fast`].
    Fast,
}

impl SineIntegral {
    /// Si(x).
    pub(crate) fn eval(self, x: f64) -> f64 {
        match self {
            Self::Exact => diffraction::sine_integral(x),
            Self::Fast => sine_integral_fast(x),
        }
    }
}

/// Argument beyond which Si is pi/2 to 1e-6, and sines of single precision mean nothing.
const X_MAX: f64 = 1e6;

/// f(x) = (x + F) / (x^2 + F x + 2 F / pi): pi/2 at 0, 1/x - O(1/x^3) far out.
const F: f64 = 4.64;
/// g(x) = (x + G1) / (x^3 + G1 x^2 + G2 x + G3): 1/x^2 far out.
const G1: f64 = 2.79;
const G2: f64 = 5.61;
/// G1 / g(0); this g(0) gives Si the slope 1 at 0.
const G3: f64 = G1 / (PI * PI / 4.0 - PI / (2.0 * F) - 1.0);

/// Si(x) to 3.4e-3; as the antiderivative of sinc^2 it errs by at most 2.3 % of the smaller of 1 and 2/x^2, which is
/// the mean of sinc^2 in its tail.
pub fn sine_integral_fast(x: f64) -> f64 {
    let a = x.abs().min(X_MAX);
    let (sin, cos) = a.sin_cos();
    let f = (a + F) / ((a + F) * a + 2.0 * F / PI);
    let g = (a + G1) / (((a + G1) * a + G2) * a + G3);
    let si = PI / 2.0 - f * cos - g * sin;
    if x < 0.0 { -si } else { si }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_optics::diffraction::{sinc, sine_integral};

    /// The claims of the doc comment, and that they are not idle: a coefficient off by a tenth breaks them.
    #[test]
    fn the_fast_one_errs_as_it_says() {
        let (mut worst, mut worst_slope): (f64, f64) = (0.0, 0.0);
        let h = 1e-3;
        for i in 1..200_000 {
            let x = 1e-3 * i as f64;
            worst = worst.max((sine_integral_fast(x) - sine_integral(x)).abs());
            let slope =
                (sine_integral_fast(x + 0.5 * h) - sine_integral_fast(x - 0.5 * h)) / h - sinc(x);
            worst_slope = worst_slope.max(2.0 * slope.abs() / (2.0 / (x * x)).min(1.0));
        }
        println!("fast Si: error {worst:.2e}, of sinc^2 {worst_slope:.2e} of its envelope");
        assert!(worst < 3.4e-3, "{worst}");
        assert!(worst_slope < 0.023, "{worst_slope}");
        assert!(worst > 1e-3, "a better one than the text says");
    }

    #[test]
    fn the_fast_one_has_its_limits() {
        assert_eq!(sine_integral_fast(0.0), 0.0);
        assert!((sine_integral_fast(1e-6) / 1e-6 - 1.0).abs() < 1e-5);
        for x in [1e-12, 0.3, 4.0, 1e3, 1e9, 1e300, f64::INFINITY] {
            assert_eq!(sine_integral_fast(-x), -sine_integral_fast(x));
            assert!((sine_integral_fast(x) - sine_integral(x)).abs() < 3.4e-3);
        }
        assert!((sine_integral_fast(f64::INFINITY) - PI / 2.0).abs() < 2e-6);
    }
}
