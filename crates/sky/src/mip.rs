//! A map by lines of one channel, and sums of blurred ones.

use hairline_image::Picture;
use hairline_optics::vectors::with_widest;
use rayon::prelude::*;

/// Weights with which a row of a map adds to all texels of another row.
pub(super) struct RowTaps {
    pub row: usize,
    /// First texel to which the first weight belongs, up to a width to the left of the row's start.
    pub first: isize,
    pub weights: Vec<f32>,
}

/// A map with a weight for each row, which is 1 before anything is added up.
pub(super) struct Mip {
    width: usize,
    height: usize,
    /// Rows of one channel: by row, by channel.
    lines: Vec<f32>,
    /// A weight for each row.
    weights: Vec<f32>,
}

/// Channels of a texel.
const CHANNELS: usize = 3;

impl Mip {
    pub(super) fn from_picture(map: &Picture) -> Self {
        let [width, height] = map.size_px.map(|n| n as usize);
        let rows = map.rgb.chunks_exact(width);
        let lines = rows.flat_map(|row| (0..CHANNELS).flat_map(|c| row.iter().map(move |t| t[c])));
        Self {
            width,
            height,
            lines: lines.collect(),
            weights: vec![1.0; height],
        }
    }

    pub(super) fn empty(size_px: [u32; 2]) -> Self {
        let [width, height] = size_px.map(|n| n as usize);
        Self {
            width,
            height,
            lines: vec![0.0; width * height * CHANNELS],
            weights: vec![0.0; height],
        }
    }

    fn line(&self, row: usize, line: usize) -> &[f32] {
        let first = (row * CHANNELS + line) * self.width;
        &self.lines[first..first + self.width]
    }

    /// Returns the weighted means: sums over weights.
    pub(super) fn picture(&self) -> Picture {
        let texels = (0..self.height).flat_map(|y| {
            let lines: [&[f32]; CHANNELS] = std::array::from_fn(|c| self.line(y, c));
            (0..self.width).map(move |x| lines.map(|line| line[x] / self.weights[y]))
        });
        Picture {
            size_px: [self.width as u32, self.height as u32],
            rgb: texels.collect(),
        }
    }

    /// Adds a mip that is as fine or finer, blurred. `taps` are what the row at a v takes from the rows of a map of a size, which has so many
    /// texels for one of the row's.
    pub(super) fn add(
        &mut self,
        mip: &Self,
        taps: impl Fn([usize; 2], f64, usize) -> Vec<RowTaps> + Sync,
    ) {
        let (width, height) = (self.width, self.height);
        let strided = Strided::new(mip, mip.width / width);
        let rows = self.lines.par_chunks_mut(width * CHANNELS);
        let rows = rows.zip(&mut self.weights).enumerate();
        rows.for_each(|(y, (lines, weight))| {
            let v = (y as f64 + 0.5) / height as f64;
            for taps in taps([mip.width, mip.height], v, strided.stride) {
                *weight += taps.weights.iter().sum::<f32>();
                let places = strided.places(&taps);
                for (i, sums) in lines.chunks_exact_mut(width).enumerate() {
                    strided.add(taps.row * CHANNELS + i, &places, sums);
                }
            }
        });
    }

    /// Twice as wide and high, linear between texels. Beyond a pole lies the row on its other side.
    pub(super) fn doubled(&self) -> Self {
        let (width, height) = (self.width, self.height);
        let at = |x: isize, y: isize, line: usize| {
            let is_beyond = y < 0 || y >= height as isize;
            let y = y.clamp(0, height as isize - 1) as usize;
            let x = if is_beyond { x + width as isize / 2 } else { x };
            self.line(y, line)[x.rem_euclid(width as isize) as usize]
        };
        // A quarter of a texel from the middle of one.
        let near = |i: usize| {
            let i = i as isize;
            (i / 2, if i % 2 == 0 { i / 2 - 1 } else { i / 2 + 1 })
        };
        let lines = (0..2 * height * CHANNELS)
            .into_par_iter()
            .flat_map_iter(|row| {
                let ((y0, y1), line) = (near(row / CHANNELS), row % CHANNELS);
                (0..2 * width).map(move |x| {
                    let (x0, x1) = near(x);
                    let across = |y: isize| 0.75 * at(x0, y, line) + 0.25 * at(x1, y, line);
                    0.75 * across(y0) + 0.25 * across(y1)
                })
            })
            .collect();
        let weight = |y: isize| self.weights[y.clamp(0, height as isize - 1) as usize];
        let weights = (0..2 * height).map(|row| {
            let (y0, y1) = near(row);
            0.75 * weight(y0) + 0.25 * weight(y1)
        });
        Self {
            width: 2 * width,
            height: 2 * height,
            weights: weights.collect(),
            lines,
        }
    }
}

/// Lines of a map, each as lines of every so manieth texel, so that what neighbours take lies side by side.
struct Strided {
    stride: usize,
    /// Length of a part.
    width: usize,
    /// By line, by the part's first texel. Each part stands there twice, as lines run around the map.
    parts: Vec<f32>,
}

impl Strided {
    fn new(mip: &Mip, stride: usize) -> Self {
        let width = mip.width / stride;
        let mut parts = vec![0.0; 2 * mip.lines.len()];
        let lines = mip.lines.par_chunks(mip.width);
        parts
            .par_chunks_mut(2 * mip.width)
            .zip(lines)
            .for_each(|(parts, line)| {
                for (first, part) in parts.chunks_exact_mut(2 * width).enumerate() {
                    let texels = line[first..].iter().step_by(stride);
                    for (x, texel) in texels.enumerate() {
                        part[x] = *texel;
                        part[x + width] = *texel;
                    }
                }
            });
        Self {
            stride,
            width,
            parts,
        }
    }

    /// Where the texels of each weight begin in a line's parts, and the weight. Where the part of a lobe has not begun there are zeros, which are
    /// left out.
    fn places(&self, taps: &RowTaps) -> Vec<(usize, f32)> {
        let (stride, width) = (self.stride, self.width);
        let first = taps.first.rem_euclid((stride * width) as isize) as usize;
        let place = |i: usize| {
            let texel = first + i;
            2 * (texel % stride) * width + (texel / stride) % width
        };
        let taps = taps.weights.iter().enumerate();
        let taps = taps.filter(|(_, weight)| **weight != 0.0);
        taps.map(|(i, weight)| (place(i), *weight)).collect()
    }

    /// Adds what a line gives to a line of sums.
    fn add(&self, line: usize, places: &[(usize, f32)], sums: &mut [f32]) {
        let length = 2 * self.stride * self.width;
        let parts = &self.parts[line * length..][..length];
        with_widest(|| add_weighted(parts, places, sums));
    }
}

/// Adds to each sum the values that lie as far from these places as it lies from the first sum, with their weights.
#[inline(always)]
fn add_weighted(values: &[f32], places: &[(usize, f32)], sums: &mut [f32]) {
    // So many sums stay in registers.
    const SIDE: usize = 32;
    let done = sums.len() / SIDE * SIDE;
    let (blocks, rest) = sums.as_chunks_mut::<SIDE>();
    for (block, sums) in blocks.iter_mut().enumerate() {
        let mut all = *sums;
        for (place, weight) in places {
            let values = &values[place + block * SIDE..][..SIDE];
            for (sum, value) in all.iter_mut().zip(values) {
                *sum += value * weight;
            }
        }
        *sums = all;
    }
    for (place, weight) in places {
        for (sum, value) in rest.iter_mut().zip(&values[place + done..]) {
            *sum += value * weight;
        }
    }
}
