// The normal distribution in single precision, which WGSL lacks.
// Milton Abramowitz and Irene Stegun, "Handbook of Mathematical Functions", 1964, 7.1.28 (erf, absolute error 3e-7);
// Mike Giles, "Approximating the erfinv function", GPU Computing Gems, 2011.

// The error function.
fn gaussian_erf(x: f32) -> f32 {
    let a = min(abs(x), 9.0);
    let p = a * (0.0705230784 + a * (0.0422820123 + a * (0.0092705272 + a * (0.0001520143 + a * (0.0002765672 + a * 0.0000430638)))));
    let p2 = (1.0 + p) * (1.0 + p);
    let p4 = p2 * p2;
    let p8 = p4 * p4;
    return sign(x) * (1.0 - 1.0 / (p8 * p8));
}

// Powers of e do not go below minus this: the square of what comes out is still a normal number, and processors take a hundred
// times as long for those that are not.
const GAUSSIAN_TAIL: f32 = 35.0;

// erf(high) - erf(low). Where the two are close, the difference of two rounded values would be noise.
fn gaussian_erf_difference(low: f32, high: f32) -> f32 {
    let step = high - low;
    let middle = 0.5 * (low + high);
    if abs(step) < 0.02 {
        return 1.1283791671 * step * exp(-min(middle * middle, GAUSSIAN_TAIL));
    }
    return gaussian_erf(high) - gaussian_erf(low);
}

// The share of a standard normal distribution below x.
fn gaussian_cdf(x: f32) -> f32 {
    return 0.5 + 0.5 * gaussian_erf(x * 0.70710678);
}

// The inverse of gaussian_cdf, for shares within [1e-6, 1 - 1e-6].
fn gaussian_quantile(share: f32) -> f32 {
    let x = 2.0 * share - 1.0;
    var w = -log(max((1.0 - x) * (1.0 + x), 1e-12));
    var p: f32;
    if w < 5.0 {
        w -= 2.5;
        p = 2.81022636e-08;
        p = 3.43273939e-07 + p * w;
        p = -3.5233877e-06 + p * w;
        p = -4.39150654e-06 + p * w;
        p = 0.00021858087 + p * w;
        p = -0.00125372503 + p * w;
        p = -0.00417768164 + p * w;
        p = 0.246640727 + p * w;
        p = 1.50140941 + p * w;
    } else {
        w = sqrt(w) - 3.0;
        p = -0.000200214257;
        p = 0.000100950558 + p * w;
        p = 0.00134934322 + p * w;
        p = -0.00367342844 + p * w;
        p = 0.00573950773 + p * w;
        p = -0.0076224613 + p * w;
        p = 0.00943887047 + p * w;
        p = 1.00167406 + p * w;
        p = 2.83297682 + p * w;
    }
    return 1.41421356 * p * x;
}
