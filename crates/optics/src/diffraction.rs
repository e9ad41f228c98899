//! Diffraction by a slit: sinc^2 and its integrals (docs/model.md, section 4).
//!
//! A groove of width W spreads light across itself as sinc^2(k W q / 2), q being the component of wi + wo across the
//! scratch. Width and angle enter only as u = W q, so one function of u serves every width.

use spec_math::cephes64;
use std::f64::consts::PI;

/// sin(x)/x.
pub fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 {
        1.0 - x * x / 6.0
    } else {
        x.sin() / x
    }
}

/// Sine integral Si(x), the integral of sinc from 0 to x. Odd; pi/2 at infinity.
pub fn sine_integral(x: f64) -> f64 {
    if x.is_infinite() {
        return x.signum() * PI / 2.0;
    }
    cephes64::sici(x).0
}

/// G_lambda(u): the integral of sinc^2(k v / 2) over v from 0 to u, in micrometres. Odd; lambda/2 at infinity.
pub fn sinc_squared_integral(u_um: f64, wavelength_um: f64) -> f64 {
    let k = 2.0 * PI / wavelength_um;
    if u_um.is_infinite() {
        return u_um.signum() * PI / k;
    }
    let x = k * u_um;
    // Below this the two terms cancel; the series of the integrand is exact to 1e-12.
    if x.abs() < 1e-2 {
        return u_um * (1.0 - x * x / 36.0);
    }
    let s = (x / 2.0).sin();
    2.0 * sine_integral(x) / k - 4.0 * s * s / (k * x)
}

/// N(q) of docs/model.md: the integral of sinc^2(k W q' / 2) over q' from 0 to q, dimensionless.
#[cfg(test)]
pub(crate) fn chord_integral(q: f64, width_um: f64, wavelength_um: f64) -> f64 {
    if width_um == 0.0 {
        q
    } else {
        sinc_squared_integral(width_um * q, wavelength_um) / width_um
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simpson's rule, the independent witness.
    fn simpson(f: impl Fn(f64) -> f64, a: f64, b: f64, n: usize) -> f64 {
        let h = (b - a) / n as f64;
        let inner: f64 = (1..n)
            .map(|i| f(a + h * i as f64) * if i % 2 == 1 { 4.0 } else { 2.0 })
            .sum();
        h / 3.0 * (f(a) + inner + f(b))
    }

    #[test]
    fn sine_integral_is_the_integral_of_sinc() {
        for x in [1e-6, 0.01, 0.5, 1.0, 3.0, 4.0, 10.0, 77.0] {
            let expected = simpson(sinc, 0.0, x, 20_000);
            assert!((sine_integral(x) - expected).abs() < 1e-10, "Si({x})");
            assert!((sine_integral(-x) + expected).abs() < 1e-10, "Si(-{x})");
        }
        assert_eq!(sine_integral(f64::INFINITY), PI / 2.0);
    }

    #[test]
    fn chord_integral_is_the_integral_of_sinc_squared() {
        for (q, width, wavelength) in [
            (0.0, 1.0, 0.5),
            (1e-5, 1.0, 0.5),
            (1e-3, 1.2, 0.5),
            (0.3, 2.0, 0.4),
            (-0.7, 6.0, 0.7),
            (2.0, 10.0, 0.38),
            (1.5, 0.0, 0.5),
        ] {
            let k = 2.0 * PI / wavelength;
            let expected = simpson(|v| sinc(k * width * v / 2.0).powi(2), 0.0, q, 20_000);
            let value = chord_integral(q, width, wavelength);
            assert!(
                (value - expected).abs() < 1e-9,
                "N({q}; {width}, {wavelength}) = {value}, quadrature {expected}"
            );
        }
    }

    #[test]
    fn chord_integral_has_its_limit() {
        // The tail beyond q falls as lambda^2/(2 pi^2 W^2 q).
        let (width, wavelength) = (2.0, 0.5);
        let limit = sinc_squared_integral(f64::INFINITY, wavelength) / width;
        assert!((limit - wavelength / (2.0 * width)).abs() < 1e-15);
        let far = chord_integral(1e4, width, wavelength);
        let tail = wavelength * wavelength / (2.0 * PI * PI * width * width * 1e4);
        assert!(((limit - far) / tail - 1.0).abs() < 1e-3);
    }
}
