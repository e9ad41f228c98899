//! Legendre's polynomials on [-1, 1]: Gauss's nodes, the series of a function through its values there, and the Fourier
//! integrals of the polynomials, which are spherical Bessel functions.

use super::lanes::Lanes;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// The most terms that a series has.
pub(super) const MOST_TERMS: usize = 16;
/// The most nodes of a rule.
pub(super) const MOST_NODES: usize = 64;

/// Gauss's rule, exact for polynomials of degree 2 n - 1. Not from gauss-quad, which brings nalgebra for twenty lines.
pub(super) struct Rule {
    pub nodes: Vec<Node>,
}

/// A place in [-1, 1], its weight, and the first polynomials there.
pub(super) struct Node {
    pub x: f64,
    pub weight: f64,
    pub polynomials: [f64; MOST_TERMS],
}

/// The rule with `count` nodes, 1 to [`MOST_NODES`].
pub(super) fn rule(count: usize) -> &'static Rule {
    static RULES: LazyLock<Vec<Rule>> = LazyLock::new(|| (1..=MOST_NODES).map(Rule::new).collect());
    &RULES[count - 1]
}

impl Rule {
    fn new(count: usize) -> Self {
        let node = |i: usize| {
            // Newton's method from Tricomi's estimate.
            let n = count as f64;
            let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (value, before) = polynomial(count, x);
                slope = n * (before - x * value) / (1.0 - x * x);
                x -= value / slope;
            }
            Node {
                x,
                weight: 2.0 / ((1.0 - x * x) * slope * slope),
                polynomials: polynomials(x),
            }
        };
        Self {
            nodes: (0..count).map(node).collect(),
        }
    }
}

/// P_n and P_(n-1), n of 1 or more.
fn polynomial(n: usize, x: f64) -> (f64, f64) {
    let (mut value, mut before) = (x, 1.0);
    for m in 1..n {
        let m = m as f64;
        (value, before) = (
            ((2.0 * m + 1.0) * x * value - m * before) / (m + 1.0),
            value,
        );
    }
    (value, before)
}

/// P_0 and on.
pub(super) fn polynomials(x: f64) -> [f64; MOST_TERMS] {
    let mut p = [1.0; MOST_TERMS];
    p[1] = x;
    for n in 1..MOST_TERMS - 1 {
        let m = n as f64;
        p[n + 1] = ((2.0 * m + 1.0) * x * p[n] - m * p[n - 1]) / (m + 1.0);
    }
    p
}

/// Number of terms that the series of exp(-slope u - (bend u)^2/2) needs until `size` times a term is below `tolerance`.
/// Term n is about the n-th derivative, by the recurrence of Hermite's polynomials, over (2n - 1)!!.
pub(super) fn terms_needed(slope: f64, bend: f64, size: f64, tolerance: f64) -> usize {
    let (mut before, mut term) = (size, size * slope.abs());
    let mut n = 2;
    while before.max(term) > tolerance && n < MOST_TERMS {
        let (m, odd) = (n as f64, (2 * n - 1) as f64);
        let next = (slope.abs() * term + (m - 1.0) / (odd - 2.0) * bend * bend * before) / odd;
        (before, term) = (term, next);
        n += 1;
    }
    n
}

/// Least argument from which the recurrence upward from j_0 and j_1 serves: its rounding errors grow as (2n -
/// 1)!!/y^(n+1), and the terms of a window's series fall faster.
const UPWARD: f64 = 1.0;
/// Up to here the power series with [`POWERS`] terms is good to 1e-11.
const SERIES: f64 = 2.4;
const POWERS: i32 = 10;

/// j_0 to j_(count-1), spherical Bessel functions of the first kind, into `out`. The integral of P_n(u) exp(-i y u) over
/// [-1, 1] is 2 (-i)^n j_n(y). Their absolute errors are about 1e-16 (2n - 1)!!: for series whose terms fall as that
/// grows.
#[inline(always)]
pub(super) fn spherical_bessel<const N: usize>(
    y: Lanes<N>,
    count: usize,
    out: &mut [Lanes<N>; MOST_TERMS],
) {
    if y.largest_abs() < SERIES {
        return power_series(y, count, out);
    }
    let (sin, cos) = y.sin_cos();
    let inverse = y.map(|y| if y.abs() < UPWARD { 1.0 } else { 1.0 / y });
    out[0] = sin * inverse;
    out[1] = (out[0] - cos) * inverse;
    for n in 2..count {
        out[n] = inverse * out[n - 1] * (2 * n - 1) as f64 - out[n - 2];
    }
    if y.smallest_abs() < UPWARD {
        let mut small = [Lanes::ZERO; MOST_TERMS];
        let clamped = y.map(|y| if y.abs() < UPWARD { y } else { 0.0 });
        power_series(clamped, count, &mut small);
        for n in 0..count {
            out[n] = Lanes(std::array::from_fn(|i| {
                if y.0[i].abs() < UPWARD {
                    small[n].0[i]
                } else {
                    out[n].0[i]
                }
            }));
        }
    }
}

/// j_n(y) = y^n/(2n+1)!! times the sum over k of (-y^2/2)^k/(k! (2n+3)(2n+5)...(2n+2k+1)).
#[inline(always)]
fn power_series<const N: usize>(y: Lanes<N>, count: usize, out: &mut [Lanes<N>; MOST_TERMS]) {
    let x = y * y * -0.5;
    let mut front = Lanes::splat(1.0);
    for (n, out) in out.iter_mut().enumerate().take(count) {
        let mut sum = Lanes::splat(1.0);
        for k in (1..=POWERS).rev() {
            let k = f64::from(k);
            let step = 1.0 / (k * (2.0 * (n as f64 + k) + 1.0));
            sum = Lanes::splat(1.0) + x * sum * step;
        }
        *out = front * sum;
        front = front * y * (1.0 / (2 * n + 3) as f64);
    }
}

/// The part of (-i)^n that is not (-i)^(n mod 2) turned by i: 1 for n = 0 of 4, -1 for 1 and 2, 1 for 3. With it, even
/// terms add up to the real part of a Fourier integral and odd ones to the imaginary part.
pub(super) fn sign(n: usize) -> f64 {
    if matches!(n % 4, 0 | 3) { 1.0 } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_polynomials() {
        for count in [1, 2, 5, 17, MOST_NODES] {
            let nodes = &rule(count).nodes;
            for power in 0..2 * count {
                let sum: f64 = nodes
                    .iter()
                    .map(|n| n.weight * n.x.powi(power as i32))
                    .sum();
                let exact = if power % 2 == 0 {
                    2.0 / (power + 1) as f64
                } else {
                    0.0
                };
                assert!(
                    (sum - exact).abs() < 1e-14,
                    "{count} {power}: {sum} {exact}"
                );
            }
        }
    }

    #[test]
    fn bessel_functions_are_fourier_integrals() {
        let nodes = &rule(MOST_NODES).nodes;
        let mut double_factorial = [1.0; MOST_TERMS];
        for n in 1..MOST_TERMS {
            double_factorial[n] = double_factorial[n - 1] * (2 * n - 1) as f64;
        }
        for i in -3000..3000 {
            let y = 0.01 * f64::from(i);
            // Together with a far and a near lane.
            let mut out = [Lanes::ZERO; MOST_TERMS];
            spherical_bessel(Lanes([y, 30.0, 1e-3]), MOST_TERMS, &mut out);
            let mut alone = [Lanes::ZERO; MOST_TERMS];
            spherical_bessel(Lanes([y]), MOST_TERMS, &mut alone);
            for n in 0..MOST_TERMS {
                let (mut re, mut im) = (0.0, 0.0);
                for node in nodes {
                    let (s, c) = (y * node.x).sin_cos();
                    re += 0.5 * node.weight * node.polynomials[n] * c;
                    im -= 0.5 * node.weight * node.polynomials[n] * s;
                }
                let exact = sign(n) * if n % 2 == 0 { re } else { im };
                for found in [out[n].0[0], alone[n].0[0]] {
                    let error = (found - exact).abs();
                    assert!(
                        error < 1e-11 + 1e-15 * double_factorial[n],
                        "{n} {y}: {found} {exact}"
                    );
                }
            }
        }
    }
}
