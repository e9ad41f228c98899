//! Maps of one size, and sums of blurred ones.

use glam::Vec4;
use hairline_image::Picture;
use rayon::prelude::*;

/// Weights with which a row of a map adds to all texels of another row.
pub(super) struct RowTaps {
    pub row: usize,
    /// First texel to which the first weight belongs, up to a width to the left of the row's start.
    pub first: isize,
    pub weights: Vec<f32>,
}

/// Maps of one size, with a weight for each texel, which is 1 before anything is added up. A row of one map follows that of another.
pub(super) struct Mip {
    width: usize,
    height: usize,
    pub(super) maps: usize,
    texels: Vec<Vec4>,
}

impl Mip {
    pub(super) fn of(maps: &[Picture]) -> Self {
        let [width, height] = maps[0].size_px.map(|n| n as usize);
        let rows = (0..height).flat_map(|y| maps.iter().map(move |map| &map.rgb[y * width..]));
        let texels = rows.flat_map(|row| &row[..width]);
        Self {
            width,
            height,
            maps: maps.len(),
            texels: texels.map(|t| Vec4::new(t[0], t[1], t[2], 1.0)).collect(),
        }
    }

    pub(super) fn empty(size_px: [u32; 2], maps: usize) -> Self {
        let [width, height] = size_px.map(|n| n as usize);
        Self {
            width,
            height,
            maps,
            texels: vec![Vec4::ZERO; width * height * maps],
        }
    }

    fn row(&self, y: usize, map: usize) -> &[Vec4] {
        let first = (y * self.maps + map) * self.width;
        &self.texels[first..first + self.width]
    }

    /// Returns the weighted means: sums over weights.
    pub(super) fn pictures(&self) -> Vec<Picture> {
        let picture = |map: usize| Picture {
            size_px: [self.width as u32, self.height as u32],
            rgb: (0..self.height)
                .flat_map(|y| self.row(y, map))
                .map(|t| (t.truncate() / t.w).to_array())
                .collect(),
        };
        (0..self.maps).map(picture).collect()
    }

    /// Adds a mip that is as fine or finer, blurred. `taps` are what the row at a v takes from the rows of a map of a size, which has so many
    /// texels for one of the row's.
    pub(super) fn add(
        &mut self,
        mip: &Self,
        taps: impl Fn([usize; 2], f64, usize) -> Vec<RowTaps> + Sync,
    ) {
        let (width, height) = (self.width, self.height);
        let stride = mip.width / width;
        let rows = self.texels.par_chunks_mut(width * self.maps).enumerate();
        rows.for_each(|(y, rows)| {
            let v = (y as f64 + 0.5) / height as f64;
            for taps in taps([mip.width, mip.height], v, stride) {
                for (map, sums) in rows.chunks_mut(width).enumerate() {
                    let row = mip.row(taps.row, map);
                    for (x, sum) in sums.iter_mut().enumerate() {
                        let first = (x * stride) as isize + taps.first;
                        let first = first.rem_euclid(mip.width as isize) as usize;
                        *sum += around(row, first, &taps.weights);
                    }
                }
            }
        });
    }

    /// Twice as wide and high, linear between texels. Beyond a pole lies the row on its other side.
    pub(super) fn doubled(&self) -> Self {
        let (width, height) = (self.width, self.height);
        let at = |x: isize, y: isize, map: usize| {
            let is_beyond = y < 0 || y >= height as isize;
            let y = y.clamp(0, height as isize - 1) as usize;
            let x = if is_beyond { x + width as isize / 2 } else { x };
            self.row(y, map)[x.rem_euclid(width as isize) as usize]
        };
        // A quarter of a texel from the middle of one.
        let near = |i: usize| {
            let i = i as isize;
            (i / 2, if i % 2 == 0 { i / 2 - 1 } else { i / 2 + 1 })
        };
        let texels = (0..2 * height * self.maps)
            .into_par_iter()
            .flat_map_iter(|row| {
                let ((y0, y1), map) = (near(row / self.maps), row % self.maps);
                (0..2 * width).map(move |x| {
                    let (x0, x1) = near(x);
                    let across = |y: isize| 0.75 * at(x0, y, map) + 0.25 * at(x1, y, map);
                    0.75 * across(y0) + 0.25 * across(y1)
                })
            })
            .collect();
        Self {
            width: 2 * width,
            height: 2 * height,
            maps: self.maps,
            texels,
        }
    }
}

/// The sum over texels from `first` on, around the map, with these weights: no more than there are texels.
fn around(row: &[Vec4], first: usize, weights: &[f32]) -> Vec4 {
    let before = weights.len().min(row.len() - first);
    let (left, right) = weights.split_at(before);
    weighted(&row[first..first + before], left) + weighted(&row[..right.len()], right)
}

fn weighted(texels: &[Vec4], weights: &[f32]) -> Vec4 {
    // Four sums at once: each addition would wait for the one before it.
    let mut sums = [Vec4::ZERO; 4];
    let (fours, rest) = texels.as_chunks::<4>();
    let (weight_fours, weight_rest) = weights.as_chunks::<4>();
    for (texels, weights) in fours.iter().zip(weight_fours) {
        for i in 0..4 {
            sums[i] += texels[i] * weights[i];
        }
    }
    for (texel, weight) in rest.iter().zip(weight_rest) {
        sums[0] += *texel * *weight;
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
