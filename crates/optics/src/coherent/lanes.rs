//! Numbers at several wavelengths at once: arrays that compilers turn into vector instructions, and the few functions of
//! them that the field needs. No step of them differs between machines.

use std::array::from_fn;
use std::ops::{Add, Mul, Neg, Sub};

/// Largest angle in radians that is reduced here: beyond it the quarter turns no longer count exactly, and the standard
/// library serves.
const LARGEST_RAD: f64 = 1e6;
/// 1.5 * 2^52: a number that is added to it is rounded to a whole one, whose last bits are those of the sum.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// pi/2 in three parts: 33 bits, 33 bits, the rest. Up to 2^20 times the first two are exact.
const QUARTER_TURN: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];
/// Taylor's series about 0 of sin(r)/r and cos(r) in r^2, good to 1e-16 up to a quarter of pi.
const SIN: [f64; 8] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];
const COS: [f64; 9] = [
    1.0,
    -0.5,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
];

/// One number for each wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lanes<const N: usize>(pub [f64; N]);

/// One complex number for each wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Complexes<const N: usize> {
    pub re: Lanes<N>,
    pub im: Lanes<N>,
}

impl<const N: usize> Lanes<N> {
    pub(crate) const ZERO: Self = Self([0.0; N]);

    #[inline(always)]
    pub(crate) fn splat(x: f64) -> Self {
        Self([x; N])
    }

    #[inline(always)]
    pub(crate) fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(from_fn(|i| f(self.0[i])))
    }

    #[inline(always)]
    pub(crate) fn recip(self) -> Self {
        self.map(|x| 1.0 / x)
    }

    #[inline(always)]
    pub(crate) fn largest_abs(self) -> f64 {
        self.0
            .iter()
            .fold(0.0, |m, x| if x.abs() > m { x.abs() } else { m })
    }

    #[inline(always)]
    pub(crate) fn smallest_abs(self) -> f64 {
        let least = |m: f64, x: &f64| if x.abs() < m { x.abs() } else { m };
        self.0.iter().fold(f64::INFINITY, least)
    }

    #[inline(always)]
    pub(crate) fn sin_cos(self) -> (Self, Self) {
        if !(self.largest_abs() < LARGEST_RAD) {
            return (self.map(f64::sin), self.map(f64::cos));
        }
        let quarters = self.map(|x| x * std::f64::consts::FRAC_2_PI + ROUND);
        let [a, b, c] = QUARTER_TURN;
        let r = Self(from_fn(|i| {
            let n = quarters.0[i] - ROUND;
            ((self.0[i] - n * a) - n * b) - n * c
        }));
        let r2 = r * r;
        let (s, c) = (r * polynomial(&SIN, r2), polynomial(&COS, r2));
        // Odd quarters swap both, two of four turn the sign. Bits, as lanes have no branches.
        let part = |shift: u64, even: Self, odd: Self| {
            Self(from_fn(|i| {
                let n = quarters.0[i].to_bits();
                let swap = (n & 1).wrapping_neg();
                let sign = ((n.wrapping_add(shift)) & 2) << 62;
                let bits = (even.0[i].to_bits() & !swap) | (odd.0[i].to_bits() & swap);
                f64::from_bits(bits ^ sign)
            }))
        };
        (part(0, s, c), part(1, c, s))
    }
}

/// Horner's rule, from the constant term on.
#[inline(always)]
fn polynomial<const N: usize>(coefficients: &[f64], x: Lanes<N>) -> Lanes<N> {
    let mut sum = Lanes::ZERO;
    for &c in coefficients.iter().rev() {
        sum = sum * x + Lanes::splat(c);
    }
    sum
}

impl<const N: usize> Complexes<N> {
    pub(crate) const ZERO: Self = Self {
        re: Lanes::ZERO,
        im: Lanes::ZERO,
    };

    /// exp(-i x).
    #[inline(always)]
    pub(crate) fn turned_back(x: Lanes<N>) -> Self {
        let (sin, cos) = x.sin_cos();
        Self { re: cos, im: -sin }
    }

    #[inline(always)]
    pub(crate) fn recip(self) -> Self {
        let scale = (self.re * self.re + self.im * self.im).recip();
        Self {
            re: self.re * scale,
            im: -self.im * scale,
        }
    }
}

impl<const N: usize> Add for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl<const N: usize> Sub for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl<const N: usize> Mul for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] * other.0[i]))
    }
}

impl<const N: usize> Mul<f64> for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.map(|x| x * other)
    }
}

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl<const N: usize> Add for Complexes<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }
}

impl<const N: usize> Sub for Complexes<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            re: self.re - other.re,
            im: self.im - other.im,
        }
    }
}

impl<const N: usize> Mul for Complexes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

impl<const N: usize> Mul<f64> for Complexes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        Self {
            re: self.re * other,
            im: self.im * other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sin_and_cos_are_the_standard_librarys() {
        let mut worst = 0.0_f64;
        for i in -200_000..200_000_i64 {
            // Small, large, close to and at quarter turns.
            let n = i as f64;
            let x = Lanes([n * 1e-5, n * 3.7, n * std::f64::consts::FRAC_PI_2, n * 0.01]);
            let (sin, cos) = x.sin_cos();
            for lane in 0..4 {
                let (s, c) = x.0[lane].sin_cos();
                worst = worst
                    .max((sin.0[lane] - s).abs())
                    .max((cos.0[lane] - c).abs());
            }
        }
        assert!(worst < 4e-16, "{worst:e}");
        for x in [1e7, -1e300, 0.0, -0.0] {
            let (sin, cos) = Lanes([x]).sin_cos();
            assert_eq!((sin.0[0], cos.0[0]), x.sin_cos());
        }
    }
}
