//! The irradiance from a map as nine spherical harmonics.
//!
//! Ravi Ramamoorthi and Pat Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001.

use std::f64::consts::PI;

use glam::DVec2;
use hairline_image::Picture;
use rayon::prelude::*;

use super::lookup::{environment_dir, environment_sh_basis};
use super::resample::row_solid_angle;

/// Coefficients for [`super::lookup::environment_irradiance`].
pub(super) fn project(map: &Picture) -> [[f32; 3]; 9] {
    let [width, height] = map.size_px;
    let rows: Vec<[[f64; 3]; 9]> = (0..height)
        .into_par_iter()
        .map(|y| row_moments(map, y))
        .collect();
    let mut moments = [[0.0; 3]; 9];
    for (y, row) in (0..height).zip(rows) {
        let solid_angle = row_solid_angle(y, height) / f64::from(width);
        for (moment, sum) in moments.iter_mut().zip(row) {
            for c in 0..3 {
                moment[c] += sum[c] * solid_angle;
            }
        }
    }
    let factors = factors();
    std::array::from_fn(|i| moments[i].map(|m| (m * factors[i]) as f32))
}

/// The sums of a row's texels times each polynomial.
fn row_moments(map: &Picture, y: u32) -> [[f64; 3]; 9] {
    let [width, height] = map.size_px.map(f64::from);
    let mut sums = [[0.0; 3]; 9];
    for x in 0..map.size_px[0] {
        let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let basis = environment_sh_basis(environment_dir(at / DVec2::new(width, height)));
        let texel = map.pixel(x, y);
        for (sum, basis) in sums.iter_mut().zip(basis) {
            for c in 0..3 {
                sum[c] += f64::from(texel[c]) * basis;
            }
        }
    }
    sums
}

/// Square of each polynomial's norm, times the cosine's eigenvalue for its degree: pi, 2 pi / 3, pi / 4.
fn factors() -> [f64; 9] {
    let degree_0 = 1.0 / (4.0 * PI) * PI;
    let degree_1 = 3.0 / (4.0 * PI) * (2.0 * PI / 3.0);
    let degree_2 = |norm_squared: f64| norm_squared * (PI / 4.0);
    let mixed = degree_2(15.0 / (4.0 * PI));
    let axial = degree_2(5.0 / (16.0 * PI));
    let difference = degree_2(15.0 / (16.0 * PI));
    [
        degree_0, degree_1, degree_1, degree_1, mixed, mixed, axial, mixed, difference,
    ]
}
