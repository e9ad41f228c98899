//! Values on a grid over a picture.

use glam::Vec3;

/// A grid over a picture; positions are from 0 to 1 over the picture.
pub(super) struct Cells<T> {
    size: [usize; 2],
    /// Values of the cells, row by row.
    pub values: Vec<T>,
}

impl<T: Copy> Cells<T> {
    /// Makes the grid from a function of the cell's index.
    pub fn new(size: [u32; 2], value: impl Fn(usize) -> T) -> Self {
        let size = size.map(|side| side as usize);
        Self {
            size,
            values: (0..size[0] * size[1]).map(value).collect(),
        }
    }

    /// Position of a cell's middle.
    pub fn middle(&self, i: usize) -> [f32; 2] {
        let at = [i % self.size[0], i / self.size[0]];
        [0, 1].map(|c| (at[c] as f32 + 0.5) / self.size[c] as f32)
    }

    /// Value of the cell at a position.
    pub fn get_mut(&mut self, at: [f32; 2]) -> &mut T {
        let [x, y] = [0, 1].map(|c| ((at[c] * self.size[c] as f32) as usize).min(self.size[c] - 1));
        &mut self.values[y * self.size[0] + x]
    }

    /// Computes each cell from its 3 x 3 neighbourhood.
    fn around<U: Copy>(&self, of: impl Fn(usize, &mut dyn Iterator<Item = T>) -> U) -> Cells<U> {
        let [width, height] = self.size;
        let near = |at: usize, side: usize| at.saturating_sub(1)..(at + 2).min(side);
        let value = |i: usize| {
            let (x, y) = (i % width, i / width);
            let cells = near(y, height).flat_map(|y| near(x, width).map(move |x| y * width + x));
            of(i, &mut cells.map(|j| self.values[j]))
        };
        Cells {
            size: self.size,
            values: (0..self.values.len()).map(value).collect(),
        }
    }
}

impl Cells<Vec3> {
    /// Means over each cell's 3 x 3 neighbourhood.
    pub fn smooth(&self) -> Self {
        self.around(|_, cells| {
            let (sum, count) = cells.fold((Vec3::ZERO, 0.0), |(s, n), it| (s + it, n + 1.0));
            sum / count
        })
    }
}

impl Cells<Vec3> {
    /// Limits each value to the third largest of its 3 x 3 neighbourhood.
    pub fn without_spikes(&self) -> Self {
        self.around(|i, cells| {
            let mut largest = [Vec3::NEG_INFINITY; 3];
            for mut value in cells {
                for kept in &mut largest {
                    (*kept, value) = (kept.max(value), kept.min(value));
                }
            }
            self.values[i].min(largest[2])
        })
    }
}

impl<const N: usize> Cells<[Vec3; N]> {
    /// Bilinear value at a position.
    pub fn at(&self, at: [f32; 2]) -> [Vec3; N] {
        let [(x0, x1, u), (y0, y1, v)] = [0, 1].map(|c| {
            let at = (at[c] * self.size[c] as f32 - 0.5).clamp(0.0, (self.size[c] - 1) as f32);
            (
                at as usize,
                (at as usize + 1).min(self.size[c] - 1),
                at.fract(),
            )
        });
        let row = |y: usize| {
            let [a, b] = [x0, x1].map(|x| &self.values[y * self.size[0] + x]);
            std::array::from_fn::<_, N, _>(|i| a[i].lerp(b[i], u))
        };
        let (above, below) = (row(y0), row(y1));
        std::array::from_fn(|i| above[i].lerp(below[i], v))
    }
}

impl<const N: usize> Cells<Option<[Vec3; N]>> {
    /// Fills cells without a value by the mean of their neighbours, step by step; with zeros if there is no value at
    /// all.
    pub fn filled(mut self) -> Cells<[Vec3; N]> {
        while self.values.iter().any(Option::is_none) && self.values.iter().any(Option::is_some) {
            self = self.around(|i, cells| {
                self.values[i].or_else(|| {
                    let (mut sum, mut count) = ([Vec3::ZERO; N], 0.0);
                    for value in cells.flatten() {
                        sum = std::array::from_fn(|i| sum[i] + value[i]);
                        count += 1.0;
                    }
                    (count > 0.0).then(|| sum.map(|it| it / count))
                })
            });
        }
        Cells {
            size: self.size,
            values: (self.values.into_iter())
                .map(|it| it.unwrap_or([Vec3::ZERO; N]))
                .collect(),
        }
    }
}
