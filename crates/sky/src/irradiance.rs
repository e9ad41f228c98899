//! The irradiance from a map: the map blurred by the cosine.

use std::f64::consts::PI;

use hairline_image::Picture;

use super::half_texels::round_to_half;
use super::mip::{Mip, RowTaps};
use super::resample::{resample, row_solid_angle};

/// Width and height of `blur`'s map, and of its source: texels of 1.4 degrees. Linear between them a cosine is within 0.01 %; where it ends,
/// at the horizon, the light of a source of 5 degrees is within 0.15 % of the most that it sends. Twin: environment.wgsl.
pub(crate) const IRRADIANCE_SIZE_PX: [u32; 2] = [256, 128];

/// Computes the mean of radiance over the hemisphere of each normal, weighted by the cosine: irradiance over pi.
pub(super) fn blur(map: &Picture) -> Picture {
    let source = resample(map, IRRADIANCE_SIZE_PX);
    if source.rgb.iter().all(|texel| *texel == source.rgb[0]) {
        return source;
    }
    let mut sums = Mip::empty(IRRADIANCE_SIZE_PX);
    sums.add(&Mip::from_picture(&source), |size, v, _| row_taps(size, v));
    let mut blurred = sums.picture();
    round_to_half(&mut blurred);
    blurred
}

/// Weights of each row of a map for a normal at `v`: the cosine over the solid angle of each texel, from half a turn to its left on.
fn row_taps([width, height]: [usize; 2], v: f64) -> Vec<RowTaps> {
    let (sin, cos) = (v * PI).sin_cos();
    let texel_rad = PI / height as f64;
    (0..height)
        .filter_map(|row| {
            let (row_sin, row_cos) = ((row as f64 + 0.5) * texel_rad).sin_cos();
            let solid_angle = row_solid_angle(row as u32, height as u32) / width as f64;
            let cosine = |turn: f64| cos * row_cos + sin * row_sin * (turn * texel_rad).cos();
            let weight = |turn: i32| {
                let middle = cosine(f64::from(turn));
                // A texel that the horizon crosses is seen in part.
                let mean = match middle.abs() < texel_rad {
                    true => over_texel([sin, cos], row, f64::from(turn), texel_rad),
                    false => middle.max(0.0),
                };
                (mean * solid_angle) as f32
            };
            let half = width as i32 / 2;
            let weights: Vec<f32> = (-half..half).map(weight).collect();
            // The same to both sides: what is not seen lies at the ends.
            let first = weights.iter().position(|w| *w > 0.0)?;
            let end = weights.len() - weights.iter().rev().position(|w| *w > 0.0)?;
            Some(RowTaps {
                row,
                first: first as isize - half as isize,
                weights: weights[first..end].to_vec(),
            })
        })
        .collect()
}

/// Mean over a texel of the part of the cosine above the horizon.
fn over_texel([sin, cos]: [f64; 2], row: usize, turn: f64, texel_rad: f64) -> f64 {
    const STEPS: u32 = 4;
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS) - 0.5;
    let of_row = |y: u32| {
        let (row_sin, row_cos) = ((row as f64 + 0.5 + place(y)) * texel_rad).sin_cos();
        let seen = |x: u32| {
            let turned = ((turn + place(x)) * texel_rad).cos();
            (cos * row_cos + sin * row_sin * turned).max(0.0)
        };
        (0..STEPS).map(seen).sum::<f64>()
    };
    (0..STEPS).map(of_row).sum::<f64>() / f64::from(STEPS * STEPS)
}
