//! FLIP's errors of two pictures in codes of a display, in steps that the paper names: what the eye resolves, differences of colour, edges
//! and points.
//!
//! * Pontus Andersson, Jim Nilsson, Tomas Akenine-Moller, Magnus Oskarsson, Kalle Astrom, Mark D. Fairchild, "FLIP: A
//!   Difference Evaluator for Alternating Images", 2020.
//!
//! Own code, as its authors' program is C++: nothing else here needs a second compiler.

use rayon::prelude::*;
use std::f32::consts::PI;

/// The authors' default: a 0.7 m wide display of 3840 pixels, seen from 0.7 m.
const PIXELS_PER_DEGREE: f32 = 67.0;
/// sRGB to CIE XYZ.
const XYZ_OF_RGB: [[f64; 3]; 3] = [
    [
        10_135_552.0 / 24_577_794.0,
        8_788_810.0 / 24_577_794.0,
        4_435_075.0 / 24_577_794.0,
    ],
    [
        2_613_072.0 / 12_288_897.0,
        8_788_810.0 / 12_288_897.0,
        887_015.0 / 12_288_897.0,
    ],
    [
        1_425_312.0 / 73_733_382.0,
        8_788_810.0 / 73_733_382.0,
        70_074_185.0 / 73_733_382.0,
    ],
];
/// CIE XYZ to sRGB: the inverse.
const RGB_OF_XYZ: [[f64; 3]; 3] = [
    [3.241_003_2, -1.537_398_9, -0.498_615_9],
    [-0.969_224_3, 1.875_929_9, 0.041_554_2],
    [0.055_639_4, -0.204_011_2, 1.057_149],
];
/// Exponent of a difference of colours.
const COLOR_EXPONENT: f32 = 0.7;
/// Share of the largest difference up to which differences take [`COMMON_ERRORS`] of the scale.
const COMMON_SHARE: f32 = 0.4;
const COMMON_ERRORS: f32 = 0.95;
/// Width of a feature that the eye detects, degrees.
const FEATURE_DEG: f32 = 0.082;
const FEATURE_EXPONENT: f32 = 0.5;

type Rgb = [f32; 3];

fn times(matrix: &[[f64; 3]; 3], v: Rgb) -> Rgb {
    matrix.map(|row| (0..3).map(|i| row[i] * f64::from(v[i])).sum::<f64>() as f32)
}

fn white() -> Rgb {
    XYZ_OF_RGB.map(|row| row.iter().sum::<f64>() as f32)
}

/// CIE XYZ over that of white.
fn relative_xyz(rgb: Rgb) -> Rgb {
    let (xyz, white) = (times(&XYZ_OF_RGB, rgb), white());
    [0, 1, 2].map(|i| xyz[i] / white[i])
}

/// The linear opponent space of the paper.
fn opponent(rgb: Rgb) -> Rgb {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Back from [`opponent`], within what a display shows.
fn shown([y, cx, cz]: Rgb) -> Rgb {
    let y = (y + 16.0) / 116.0;
    let (relative, white) = ([cx / 500.0 + y, y, y - cz / 200.0], white());
    times(&RGB_OF_XYZ, [0, 1, 2].map(|i| relative[i] * white[i])).map(|c| c.clamp(0.0, 1.0))
}

/// CIELAB, its colours weaker in the dark (Hunt).
fn hunt_lab(rgb: Rgb) -> Rgb {
    const LEAST: f32 = 6.0 / 29.0;
    let [x, y, z] = relative_xyz(rgb).map(|t| {
        if t > LEAST.powi(3) {
            t.cbrt()
        } else {
            t / (3.0 * LEAST * LEAST) + 4.0 / 29.0
        }
    });
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// Distance of colours by [`hunt_lab`], for large distances too (HyAB).
fn distance(a: Rgb, b: Rgb) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// A plane of numbers, row by row.
struct Plane {
    size: [usize; 2],
    values: Vec<f32>,
}

impl Plane {
    /// Correlates rows with `across`, then columns with `down`, both of an odd length; the border goes on outside.
    fn filtered(&self, across: &[f32], down: &[f32]) -> Self {
        self.along(across, [1, 0]).along(down, [0, 1])
    }

    fn along(&self, kernel: &[f32], step: [isize; 2]) -> Self {
        let [width, height] = self.size;
        let radius = (kernel.len() / 2) as isize;
        let at = |x: isize, y: isize| {
            let x = x.clamp(0, width as isize - 1) as usize;
            let y = y.clamp(0, height as isize - 1) as usize;
            self.values[y * width + x]
        };
        let mut values = vec![0.0; self.values.len()];
        let rows = values.par_chunks_mut(width.max(1)).enumerate();
        rows.for_each(|(y, row)| {
            for (x, value) in row.iter_mut().enumerate() {
                *value = (-radius..=radius)
                    .zip(kernel)
                    .map(|(i, weight)| {
                        weight * at(x as isize + i * step[0], y as isize + i * step[1])
                    })
                    .sum();
            }
        });
        Self {
            size: self.size,
            values,
        }
    }
}

/// A picture's codes as linear light.
fn linear(codes: &[[u8; 3]]) -> Vec<Rgb> {
    let decoded = |code: u8| {
        let c = f32::from(code) / 255.0;
        if c <= 0.04045 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        }
    };
    codes.iter().map(|rgb| rgb.map(decoded)).collect()
}

/// A Gaussian bell of the eye's sensitivity to contrast, for a channel of [`opponent`]: amplitude and width as in the paper's table 1.
#[derive(Clone, Copy)]
struct Bell {
    amplitude: f32,
    width: f32,
}

/// Of lightness, red to green, and blue to yellow.
const SENSITIVITIES: [&[Bell]; 3] = [
    &[Bell {
        amplitude: 1.0,
        width: 0.0047,
    }],
    &[Bell {
        amplitude: 1.0,
        width: 0.0053,
    }],
    &[
        Bell {
            amplitude: 34.1,
            width: 0.04,
        },
        Bell {
            amplitude: 13.5,
            width: 0.025,
        },
    ],
];
const WIDEST: f32 = 0.04;

/// What the eye resolves of a channel of [`opponent`].
fn resolved(channel: &Plane, bells: &[Bell]) -> Plane {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    let parts: Vec<_> = (bells.iter())
        .map(|bell| {
            let weight = |i: i32| {
                let deg = i as f32 / PIXELS_PER_DEGREE;
                (-(PI * deg).powi(2) / bell.width).exp()
            };
            let kernel: Vec<f32> = (-radius..=radius).map(weight).collect();
            let sum: f32 = kernel.iter().sum();
            let share = bell.amplitude * (PI / bell.width).sqrt() * sum * sum;
            (share, kernel.iter().map(|w| w / sum).collect::<Vec<f32>>())
        })
        .collect();
    let all: f32 = parts.iter().map(|(share, _)| share).sum();
    let mut values = vec![0.0; channel.values.len()];
    for (share, kernel) in parts {
        let part = channel.filtered(&kernel, &kernel);
        for (value, part) in values.iter_mut().zip(part.values) {
            *value += share / all * part;
        }
    }
    Plane {
        size: channel.size,
        values,
    }
}

/// Colours that the eye resolves, by [`hunt_lab`].
fn perceived(picture: &[Rgb], size: [usize; 2]) -> Vec<Rgb> {
    let channels = [0, 1, 2].map(|c| {
        let values = picture.iter().map(|rgb| opponent(*rgb)[c]).collect();
        resolved(&Plane { size, values }, SENSITIVITIES[c]).values
    });
    let at = |i: usize| hunt_lab(shown([0, 1, 2].map(|c| channels[c][i])));
    (0..picture.len()).into_par_iter().map(at).collect()
}

/// Strengths of the edge and of the point at each pixel.
fn features(picture: &[Rgb], size: [usize; 2]) -> Vec<[f32; 2]> {
    let std = 0.5 * FEATURE_DEG * PIXELS_PER_DEGREE;
    let radius = (3.0 * std).ceil() as i32;
    let of = |weight: &dyn Fn(f32) -> f32| -> Vec<f32> {
        let bell = |i: i32| {
            let x = i as f32;
            weight(x) * (-x * x / (2.0 * std * std)).exp()
        };
        let kernel: Vec<f32> = (-radius..=radius).map(bell).collect();
        // What is positive adds up to 1, and what is negative to -1.
        let sum = |sign: f32| (kernel.iter()).map(|w| (sign * w).max(0.0)).sum::<f32>();
        let sums = [sum(1.0), sum(-1.0)];
        (kernel.iter())
            .map(|w| w / sums[usize::from(*w < 0.0)])
            .collect()
    };
    let bell = of(&|_| 1.0);
    let kernels = [of(&|x| -x), of(&|x| x * x / (std * std) - 1.0)];
    let values = picture.iter().map(|rgb| relative_xyz(*rgb)[1]).collect();
    let lightness = Plane { size, values };
    let strengths = kernels.map(|kernel| {
        let across = lightness.filtered(&kernel, &bell);
        let down = lightness.filtered(&bell, &kernel);
        let both = across.values.into_iter().zip(down.values);
        both.map(|(x, y)| x.hypot(y)).collect::<Vec<f32>>()
    });
    (0..picture.len())
        .map(|i| [strengths[0][i], strengths[1][i]])
        .collect()
}

/// The error of each pixel, 0 to 1, of two pictures of `size` pixels.
pub(super) fn errors(reference: &[[u8; 3]], image: &[[u8; 3]], size: [usize; 2]) -> Vec<f32> {
    let pictures = [reference, image].map(linear);
    let [colors, other_colors] = [0, 1].map(|i| perceived(&pictures[i], size));
    let [found, other_found] = [0, 1].map(|i| features(&pictures[i], size));
    let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(hunt_lab);
    let largest = distance(green, blue).powf(COLOR_EXPONENT);
    let common = COMMON_SHARE * largest;
    let of_color = |i: usize| {
        let error = distance(colors[i], other_colors[i]).powf(COLOR_EXPONENT);
        if error < common {
            error * COMMON_ERRORS / common
        } else {
            COMMON_ERRORS + (error - common) / (largest - common) * (1.0 - COMMON_ERRORS)
        }
    };
    let of_feature = |i: usize| {
        let [edge, point] = [0, 1].map(|f| (found[i][f] - other_found[i][f]).abs());
        (edge.max(point) / 2.0_f32.sqrt()).powf(FEATURE_EXPONENT)
    };
    let error = |i: usize| {
        of_color(i)
            .powf(1.0 - of_feature(i).min(1.0))
            .clamp(0.0, 1.0)
    };
    (0..reference.len()).into_par_iter().map(error).collect()
}
