//! Maps in other sizes, with each texel weighted by the solid angle that it stands for: the light that a map holds is the same in every size.

use std::f64::consts::{PI, TAU};

use hairline_image::Picture;
use rayon::prelude::*;

use hairline_scene::environment::lookup::over_the_pole;

/// The solid angle of a whole row of an equirectangular map of `height` rows.
pub(super) fn row_solid_angle(y: u32, height: u32) -> f64 {
    let edge = |y: u32| (PI * f64::from(y) / f64::from(height)).cos();
    TAU * (edge(y) - edge(y + 1))
}

/// A mean that is exact where all values are equal, as the sum divided by the weight is not.
#[derive(Clone, Copy, Default)]
pub(super) struct WeightedMean {
    pub mean: [f32; 3],
    weight: f32,
}

impl WeightedMean {
    pub(crate) fn add(&mut self, value: [f32; 3], weight: f32) {
        self.weight += weight;
        let share = weight / self.weight;
        for (mean, value) in self.mean.iter_mut().zip(value) {
            *mean += (value - *mean) * share;
        }
    }
}

/// Resamples a map to another size: the mean over the area of each new texel where it is larger than the old ones, linear interpolation where
/// it is smaller. Beyond a pole the map goes on with the row on its other side.
pub(super) fn resample(map: &Picture, size_px: [u32; 2]) -> Picture {
    let [old_width, old_height] = map.size_px;
    let [width, height] = size_px;
    let columns = taps(old_width, width, |_| 1.0);
    let rows = taps(old_height, height, |y| row_solid_angle(y, old_height));
    let narrowed: Vec<[f32; 3]> = map
        .rgb
        .par_chunks(old_width as usize)
        .flat_map_iter(|row| {
            let texel = |x: i32| row[x.rem_euclid(old_width as i32) as usize];
            columns.iter().map(move |taps| mean(taps, texel))
        })
        .collect();
    let rgb = rows
        .par_iter()
        .flat_map_iter(|taps| {
            let narrowed = &narrowed;
            (0..width).map(move |x| {
                mean(taps, |y| {
                    let size = [width as i32, old_height as i32];
                    let [x, y] = over_the_pole(size, x as i32, y);
                    narrowed[(y * width as i32 + x) as usize]
                })
            })
        })
        .collect();
    Picture { size_px, rgb }
}

fn mean(taps: &[(i32, f32)], value: impl Fn(i32) -> [f32; 3]) -> [f32; 3] {
    let mut mean = WeightedMean::default();
    for &(i, weight) in taps {
        mean.add(value(i), weight);
    }
    mean.mean
}

/// Returns the old samples that make up each new one, with their weights, among them the one before the first and the one after the last.
/// `density` weighs an old sample in a mean.
fn taps(old: u32, new: u32, density: impl Fn(u32) -> f64) -> Vec<Vec<(i32, f32)>> {
    let ratio = f64::from(old) / f64::from(new);
    (0..new)
        .map(|i| {
            if ratio < 1.0 {
                let at = (f64::from(i) + 0.5) * ratio - 0.5;
                let t = at - at.floor();
                let pair = [
                    (at.floor() as i32, (1.0 - t) as f32),
                    (at.floor() as i32 + 1, t as f32),
                ];
                return pair.into_iter().filter(|tap| tap.1 > 0.0).collect();
            }
            let (from, to) = (f64::from(i) * ratio, f64::from(i + 1) * ratio);
            (from.floor() as u32..(to.ceil() as u32).min(old))
                .filter_map(|j| {
                    let covered = to.min(f64::from(j + 1)) - from.max(f64::from(j));
                    // Rounding leaves slivers of a neighbour.
                    (covered > 1e-9).then(|| (j as i32, (covered * density(j)) as f32))
                })
                .collect()
        })
        .collect()
}
