// The sine integral, in full and as the method of 2018 may have approximated it. Twins: optics/src/diffraction.rs
// (sine_integral) and src/sine_integral.rs (sine_integral_fast), which explains it.
// Si(x) = pi/2 - f(x) cos x - g(x) sin x for x > 0.

// Beyond this Si is pi/2 to 1e-6.
const SINE_INTEGRAL_X_MAX: f32 = 1e6;

// Si of x in [0, 1e6], given its sine and cosine, to 1e-6. From 1 on by the rational f and g of Milton Abramowitz and Irene
// Stegun, "Handbook of Mathematical Functions", 1964, 5.2.38 and 5.2.39 (absolute errors 5e-7 and 3e-7); the series below.
fn sine_integral_of(x: f32, sin_x: f32, cos_x: f32) -> f32 {
    if x < 1.0 {
        let s = x * x;
        return x * (1.0 + s * (-1.0 / 18.0 + s * (1.0 / 600.0 + s * (-1.0 / 35280.0 + s * (1.0 / 3265920.0)))));
    }
    // In powers of 1/x^2: those of x leave single precision.
    let v = 1.0 / (x * x);
    let f = (1.0 + v * (38.027264 + v * (265.187033 + v * (335.677320 + v * 38.102495))))
        / (x * (1.0 + v * (40.021433 + v * (322.624911 + v * (570.236280 + v * 157.105423)))));
    let g = v * (1.0 + v * (42.242855 + v * (302.757865 + v * (352.018498 + v * 21.821899))))
        / (1.0 + v * (48.196927 + v * (482.485984 + v * (1114.978885 + v * 449.690326))));
    return 1.57079633 - f * cos_x - g * sin_x;
}

const SINE_INTEGRAL_F: f32 = 4.64;
const SINE_INTEGRAL_G1: f32 = 2.79;
const SINE_INTEGRAL_G2: f32 = 5.61;
const SINE_INTEGRAL_G3: f32 = 2.47150372;

// sine_integral_of() to 3.4e-3.
fn sine_integral_fast_of(x: f32, sin_x: f32, cos_x: f32) -> f32 {
    let f = (x + SINE_INTEGRAL_F) / ((x + SINE_INTEGRAL_F) * x + 0.636619772 * SINE_INTEGRAL_F);
    let g = (x + SINE_INTEGRAL_G1) / (((x + SINE_INTEGRAL_G1) * x + SINE_INTEGRAL_G2) * x + SINE_INTEGRAL_G3);
    return 1.57079633 - f * cos_x - g * sin_x;
}

fn sine_integral(x: f32) -> f32 {
    let a = min(abs(x), SINE_INTEGRAL_X_MAX);
    return sign(x) * sine_integral_of(a, sin(a), cos(a));
}

fn sine_integral_fast(x: f32) -> f32 {
    let a = min(abs(x), SINE_INTEGRAL_X_MAX);
    return sign(x) * sine_integral_fast_of(a, sin(a), cos(a));
}
