//! FLIP's errors of two pictures in codes of a display, in steps that the paper names: what the eye resolves, differences of colour, edges
//! and points.
//!
//! * Pontus Andersson, Jim Nilsson, Tomas Akenine-Moller, Magnus Oskarsson, Kalle Astrom, Mark D. Fairchild, "FLIP: A
//!   Difference Evaluator for Alternating Images", 2020.
//!
//! Written here because its authors' program is C++, for which a machine would need a second compiler.

use crate::Primaries;
use crate::primaries::{Matrix, inverse, times};
use crate::tone_map::linear_from_srgb;
use rayon::prelude::*;
use std::f32::consts::PI;
use std::iter::repeat_n;

/// The authors' default: a 0.7 m wide display of 3840 pixels, seen from 0.7 m.
const PIXELS_PER_DEGREE: f32 = 67.0;
/// Exponent of a difference of colours.
const COLOR_EXPONENT: f32 = 0.7;
/// Share of the largest difference up to which differences take [`COMMON_ERRORS`] of the scale.
const COMMON_SHARE: f32 = 0.4;
const COMMON_ERRORS: f32 = 0.95;
/// Width of a feature that the eye detects, degrees.
const FEATURE_DEG: f32 = 0.082;
const FEATURE_EXPONENT: f32 = 0.5;

type Rgb = [f32; 3];

/// Conversions of linear RGB by way of CIE XYZ over that of white.
struct Space {
    xyz_of_rgb: Matrix,
    rgb_of_xyz: Matrix,
}

impl Space {
    fn new() -> Self {
        let spans = "the primaries of Rec.709 span colours";
        let xyz_of_rgb = Primaries::REC_709.to_xyz().expect(spans).map(|row| {
            let of_white: f64 = row.iter().sum();
            row.map(|c| c / of_white)
        });
        Self {
            xyz_of_rgb,
            rgb_of_xyz: inverse(&xyz_of_rgb).expect(spans),
        }
    }

    fn xyz(&self, rgb: Rgb) -> Rgb {
        times(&self.xyz_of_rgb, rgb.map(f64::from)).map(|c| c as f32)
    }

    /// The linear opponent space of the paper.
    fn opponent(&self, rgb: Rgb) -> Rgb {
        let [x, y, z] = self.xyz(rgb);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// Linear RGB of a colour of [`Space::opponent`], clamped to what a display shows.
    fn shown(&self, [y, cx, cz]: Rgb) -> Rgb {
        let y = (y + 16.0) / 116.0;
        let xyz = [cx / 500.0 + y, y, y - cz / 200.0];
        times(&self.rgb_of_xyz, xyz.map(f64::from)).map(|c| c.clamp(0.0, 1.0) as f32)
    }

    /// CIELAB, its colours weaker in the dark (Hunt).
    fn hunt_lab(&self, rgb: Rgb) -> Rgb {
        const LEAST: f32 = 6.0 / 29.0;
        let [x, y, z] = self.xyz(rgb).map(|t| {
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
}

/// Distance of colours of [`Space::hunt_lab`], for large distances too (HyAB).
fn distance(a: Rgb, b: Rgb) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// A channel of a picture, row by row.
struct Plane {
    size: [usize; 2],
    values: Vec<f32>,
}

impl Plane {
    /// Filters rows with `across`, then columns with `down`, both of an odd length. Beyond the picture its border repeats.
    fn filtered(&self, across: &[f32], down: &[f32]) -> Self {
        self.filtered_across(across).filtered_down(down)
    }

    fn filtered_across(&self, kernel: &[f32]) -> Self {
        let radius = kernel.len() / 2;
        self.sums(|y, sums| {
            let row = self.row(y);
            let (first, last) = (row[0], row[row.len() - 1]);
            let padded: Vec<f32> = repeat_n(first, radius)
                .chain(row.iter().copied())
                .chain(repeat_n(last, radius))
                .collect();
            for (i, weight) in kernel.iter().enumerate() {
                add(sums, &padded[i..], *weight);
            }
        })
    }

    fn filtered_down(&self, kernel: &[f32]) -> Self {
        let radius = kernel.len() / 2;
        let last = self.size[1].saturating_sub(1);
        self.sums(|y, sums| {
            for (i, weight) in kernel.iter().enumerate() {
                add(
                    sums,
                    self.row((y + i).saturating_sub(radius).min(last)),
                    *weight,
                );
            }
        })
    }

    fn row(&self, y: usize) -> &[f32] {
        let width = self.size[0];
        &self.values[y * width..][..width]
    }

    /// A plane of this size whose rows, first zero, `sum` fills.
    fn sums(&self, sum: impl Fn(usize, &mut [f32]) + Sync) -> Self {
        let mut values = vec![0.0; self.values.len()];
        let rows = values.par_chunks_mut(self.size[0].max(1)).enumerate();
        rows.for_each(|(y, row)| sum(y, row));
        Self {
            size: self.size,
            values,
        }
    }
}

/// Adds weighted values, as many as there are sums.
fn add(sums: &mut [f32], values: &[f32], weight: f32) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

/// A picture's codes as linear light.
fn linear(codes: &[[u8; 3]]) -> Vec<Rgb> {
    let of_code: [f32; 256] = std::array::from_fn(|code| linear_from_srgb(code as f32 / 255.0));
    let decoded = |rgb: &[u8; 3]| rgb.map(|code| of_code[usize::from(code)]);
    codes.iter().map(decoded).collect()
}

/// Amplitude and width of the Gaussians of the eye's sensitivity to contrast (the paper's table 1) for the channels of [`Space::opponent`]:
/// lightness, red to green, blue to yellow.
const SENSITIVITIES: [&[[f32; 2]]; 3] = [
    &[[1.0, 0.0047]],
    &[[1.0, 0.0053]],
    &[[34.1, 0.04], [13.5, 0.025]],
];
/// Largest width among them.
const WIDEST: f32 = 0.04;

/// What the eye resolves of a channel of [`Space::opponent`].
fn resolved(channel: &Plane, sensitivity: &[[f32; 2]]) -> Vec<f32> {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    let parts: Vec<(f32, Vec<f32>)> = (sensitivity.iter())
        .map(|[amplitude, width]| {
            let weight = |i: i32| {
                let deg = i as f32 / PIXELS_PER_DEGREE;
                (-(PI * deg).powi(2) / width).exp()
            };
            let kernel: Vec<f32> = (-radius..=radius).map(weight).collect();
            let sum: f32 = kernel.iter().sum();
            let share = amplitude * (PI / width).sqrt() * sum * sum;
            (share, kernel.iter().map(|w| w / sum).collect())
        })
        .collect();
    let all: f32 = parts.iter().map(|(share, _)| share).sum();
    let mut values = vec![0.0; channel.values.len()];
    for (share, kernel) in parts {
        let part = channel.filtered(&kernel, &kernel);
        add(&mut values, &part.values, share / all);
    }
    values
}

/// Colours of [`Space::hunt_lab`] that the eye resolves.
fn perceived(space: &Space, picture: &[Rgb], size: [usize; 2]) -> Vec<Rgb> {
    let opponent: Vec<Rgb> = picture.par_iter().map(|rgb| space.opponent(*rgb)).collect();
    let channels = [0, 1, 2].map(|c| {
        let values = opponent.iter().map(|color| color[c]).collect();
        resolved(&Plane { size, values }, SENSITIVITIES[c])
    });
    let color = |i: usize| space.hunt_lab(space.shown([0, 1, 2].map(|c| channels[c][i])));
    (0..picture.len()).into_par_iter().map(color).collect()
}

/// Strengths of the edge and of the point at each pixel.
fn features(space: &Space, picture: &[Rgb], size: [usize; 2]) -> Vec<[f32; 2]> {
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
    let values = picture.par_iter().map(|rgb| space.xyz(*rgb)[1]).collect();
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
    let space = Space::new();
    let pictures = [reference, image].map(linear);
    let [colors, other_colors] = [0, 1].map(|i| perceived(&space, &pictures[i], size));
    let [found, other_found] = [0, 1].map(|i| features(&space, &pictures[i], size));
    let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|rgb| space.hunt_lab(rgb));
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
