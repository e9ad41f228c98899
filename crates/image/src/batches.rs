//! A picture that comes together from batches of its samples: their mean, with the variance of that mean. It can be stopped after any
//! batch.

use std::ops::Range;

use crate::{Image, Noise, filter_traced};

/// Samples in a batch of [`Batches`] whose pictures are averaged.
pub const BATCH_SAMPLES: u32 = 4;
/// Largest number of rounds of rays in a batch: the closed forms are computed once for each batch.
const BATCH_ROUNDS: u32 = 16;

/// Rounds of the first batch while somebody looks: of fewer, filtered, a picture is worse than one without.
const FIRST_ROUNDS: u32 = 8;

/// Rounds of the batch after so many. Batches begin at multiples of their size, where samples are spread best.
fn rounds_after(first: u32) -> u32 {
    match first < BATCH_ROUNDS {
        true => FIRST_ROUNDS,
        false => BATCH_ROUNDS,
    }
}

/// Some of the samples of each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Batch {
    /// Number of the batch's first sample.
    pub first: u32,
    /// Number of samples in the batch.
    pub count: u32,
}

impl Batch {
    /// The batch of all `samples`.
    pub fn all(samples: u32) -> Self {
        Self {
            first: 0,
            count: samples,
        }
    }

    /// Batches in which `samples`, at least 1, are averaged; more than a batch are rounded up to whole ones.
    pub fn split(samples: u32) -> impl Iterator<Item = Self> {
        let count = samples.clamp(1, BATCH_SAMPLES);
        let batches = samples.max(1).div_ceil(count);
        (0..batches).map(move |batch| Self {
            first: batch * count,
            count,
        })
    }

    /// Batches in which `samples` rounds of rays add up while somebody looks: the first one is soon there, and later ones are as large as can be.
    pub fn growing(samples: u32) -> impl Iterator<Item = Self> {
        let after = move |first: u32| {
            (first < samples).then(|| Self {
                first,
                count: rounds_after(first).min(samples - first),
            })
        };
        std::iter::successors(after(0), move |batch| after(batch.first + batch.count))
    }

    /// Their numbers.
    pub fn range(self) -> Range<u32> {
        self.first..self.first + self.count
    }
}

/// The mean of the batches that were added so far. What rays found in them ([`crate::Traced`]) adds up: then the mean is that of all their rays.
///
/// ```
/// use hairline_image::{Batches, Image};
///
/// let mut batches = Batches::new(8);
/// while let Some(batch) = batches.next() {
///     let mut part = Image::new([1, 1]);
///     part.base[0] = [batch.first as f32; 3];
///     batches.add(part);
/// }
/// let image = batches.image().unwrap();
/// assert_eq!(image.base[0], [2.0; 3]);
/// // Of means 0 and 4: their variance, 8, over their number.
/// assert_eq!(image.noise.as_ref().unwrap().base[0], [4.0; 3]);
/// ```
#[derive(Clone, Debug)]
pub struct Batches {
    image: Option<Image>,
    samples: u32,
    size: u32,
    done: u32,
    /// Batches.
    added: u32,
    /// Whether the light that rays found adds up; else pictures are averaged.
    adds_traced: bool,
    is_filtered: bool,
}

impl Batches {
    /// Starts a picture of `samples` rounds of rays for each pixel, at least 1: the batches are as large as can be, but for the first of several,
    /// after which the picture can be stopped.
    pub fn of_rounds(samples: u32) -> Self {
        Self {
            image: None,
            samples: samples.max(1),
            size: BATCH_ROUNDS,
            adds_traced: true,
            ..Self::new(samples)
        }
    }

    /// Averages pictures as they are: see [`Self::add`].
    pub fn unfiltered(self) -> Self {
        Self {
            is_filtered: false,
            ..self
        }
    }

    /// Starts a picture of `samples` for each pixel, at least 1; more than a batch are rounded up to whole ones.
    pub fn new(samples: u32) -> Self {
        let size = samples.clamp(1, BATCH_SAMPLES);
        Self {
            image: None,
            samples: samples.max(1).next_multiple_of(size),
            size,
            done: 0,
            added: 0,
            adds_traced: false,
            is_filtered: true,
        }
    }

    /// The samples that each pixel is to have.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// The samples that each pixel has.
    pub fn done(&self) -> u32 {
        self.done
    }

    /// Batch to be added next; none if all are there.
    pub fn next(&self) -> Option<Batch> {
        let size = match self.adds_traced && self.samples > BATCH_ROUNDS {
            true => rounds_after(self.done),
            false => self.size,
        };
        (self.done < self.samples).then_some(Batch {
            first: self.done,
            count: size.min(self.samples - self.done),
        })
    }

    /// Mean of the batches until now. It says how sure it is where there is more than one batch to come.
    pub fn image(&self) -> Option<&Image> {
        self.image.as_ref()
    }

    /// Returns the picture without copying it.
    pub fn into_image(self) -> Option<Image> {
        self.image
    }

    /// Adds the batch that was next: a picture of its samples alone. Pictures that are averaged, as those of the points of a lens, see other edges
    /// each: they are filtered by themselves, unless [`Self::unfiltered`] was asked for.
    ///
    /// # Panics
    /// If it has another size than those before it.
    pub fn add(&mut self, mut batch: Image) {
        if !self.adds_traced {
            if self.is_filtered {
                filter_traced(&mut batch);
            }
            batch.traced = None;
        }
        let traced = batch.traced.as_ref().map(|traced| traced.rounds);
        let before = self.added;
        self.added += 1;
        self.done += traced.unwrap_or(self.size);
        let Some(image) = &mut self.image else {
            self.image = Some(self.first(batch));
            return;
        };
        assert_eq!(image.size_px, batch.size_px, "a batch of another size");
        if let (Some(traced), Some(more)) = (&mut image.traced, &batch.traced) {
            traced.add(more);
            add_surfaces(image, &batch, before);
            image.show_traced();
            return;
        }
        let (size, size_px) = (self.size, image.size_px);
        let noise = (image.noise).get_or_insert_with(|| noise_of_one(size_px, size));
        for i in 0..batch.base.len() {
            let wide = |rgb: [f32; 3]| rgb.map(f64::from);
            let sum = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|c| a[c] + b[c]);
            let mut beauty = sum(image.base[i], image.scratches[i]);
            let added = sum(batch.base[i], batch.scratches[i]);
            add_batch(&mut beauty, &mut noise.beauty[i], wide(added), before);
            let layers = [
                (&mut image.base, &mut noise.base, &batch.base),
                (&mut image.scratches, &mut noise.scratches, &batch.scratches),
                (&mut image.density, &mut noise.density, &batch.density),
            ];
            for (means, variances, added) in layers {
                add_batch(&mut means[i], &mut variances[i], wide(added[i]), before);
            }
            noise.samples[i] += size;
        }
        add_surfaces(image, &batch, before);
    }

    fn first(&self, mut image: Image) -> Image {
        if image.traced.is_some() {
            image.show_traced();
        } else if self.samples > self.size {
            image.noise = Some(noise_of_one(image.size_px, self.size));
        }
        image
    }
}

/// Noise of the first batch of so many samples, whose variance nobody knows.
fn noise_of_one(size_px: [u32; 2], size: u32) -> Noise {
    let mut noise = Noise::new(size_px, size);
    noise.samples.fill(size);
    noise
}

/// Adds the surfaces of a batch; `before` batches came before.
fn add_surfaces(image: &mut Image, batch: &Image, before: u32) {
    for i in 0..batch.depth_m.len() {
        // Only batches that see a surface know of its depth.
        let depth_m = &mut image.depth_m[i];
        match (*depth_m, batch.depth_m[i]) {
            (0.0, added) => *depth_m = added,
            (_, 0.0) => {}
            (mean, added) => *depth_m += (added - mean) / (before + 1) as f32,
        }
        if image.normal[i] != batch.normal[i] {
            let sum = [0, 1, 2].map(|c| image.normal[i][c] * before as f32 + batch.normal[i][c]);
            let length = sum.iter().map(|x| x * x).sum::<f32>().sqrt();
            image.normal[i] = sum.map(|x| x / length.max(f32::MIN_POSITIVE));
        }
    }
}

/// Takes a batch's mean into a pixel's mean and into the variance of that mean, `batches` of which came before (B. P. Welford,
/// *Note on a Method for Calculating Corrected Sums of Squares and Products*, 1962). Both are rounded to what a file
/// holds after every batch, so that a picture read back goes on as the one in memory.
pub fn add_batch(mean: &mut [f32; 3], variance: &mut [f32; 3], batch: [f64; 3], batches: u32) {
    let n = f64::from(batches);
    for c in 0..3 {
        let before = f64::from(mean[c]);
        let after = before + (batch[c] - before) / (n + 1.0);
        let squares =
            f64::from(variance[c]) * n * (n - 1.0) + (batch[c] - before) * (batch[c] - after);
        mean[c] = after as f32;
        variance[c] = if batches > 0 {
            (squares / (n * (n + 1.0))) as f32
        } else {
            0.0
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn added(samples: u32, values: &[f32]) -> Batches {
        let mut batches = Batches::new(samples);
        for &value in values {
            assert!(batches.next().is_some());
            let mut batch = Image::new([1, 1]);
            batch.base[0] = [value; 3];
            batch.scratches[0] = [2.0 * value; 3];
            batch.depth_m[0] = value;
            batch.normal[0] = if value > 0.0 {
                [0.0, 0.0, 1.0]
            } else {
                [0.0; 3]
            };
            batches.add(batch);
        }
        batches
    }

    #[test]
    fn more_than_a_batch_are_whole_batches() {
        for (asked, all, first) in [(0, 1, 1), (1, 1, 1), (3, 3, 3), (4, 4, 4), (5, 8, 4)] {
            let batches = Batches::new(asked);
            assert_eq!(batches.samples(), all, "{asked}");
            assert_eq!(batches.next().unwrap(), Batch::all(first), "{asked}");
        }
    }

    #[test]
    fn batches_grow_to_all_samples() {
        let counts = |samples| -> Vec<u32> { Batch::growing(samples).map(|b| b.count).collect() };
        assert_eq!(counts(64), [8, 8, 16, 16, 16]);
        assert_eq!(counts(3), [3]);
        assert_eq!(Batch::growing(64).last().unwrap().range().end, 64);
    }

    #[test]
    fn the_first_of_many_rounds_are_soon_there() {
        let first = |rounds| Batches::of_rounds(rounds).next().unwrap().count;
        assert_eq!([4, 16, 17, 512].map(first), [4, 16, 8, 8]);
    }

    #[test]
    fn means_and_variances_are_those_of_the_batches() {
        let batches = added(12, &[1.0, 2.0, 6.0]);
        assert_eq!(batches.next(), None);
        let image = batches.image().unwrap();
        let noise = image.noise.as_ref().unwrap();
        assert!((image.base[0][0] - 3.0).abs() < 1e-6);
        // Squares 4, 1 and 9 over 2, over 3.
        assert!((noise.base[0][0] - 14.0 / 6.0).abs() < 1e-6);
        assert!((noise.beauty[0][0] - 9.0 * 14.0 / 6.0).abs() < 1e-5);
        assert_eq!((noise.samples[0], noise.batch), (12, 4));
    }

    #[test]
    fn what_all_batches_agree_on_stays_to_the_bit() {
        let image = added(64, &[0.1; 16]).into_image().unwrap();
        assert_eq!((image.base[0], image.depth_m[0]), ([0.1; 3], 0.1));
        assert_eq!(image.noise.unwrap().beauty[0], [0.0; 3]);
    }

    #[test]
    fn depth_and_normal_are_those_of_batches_that_see_a_surface() {
        let image = added(12, &[0.0, 2.0, 0.0]).into_image().unwrap();
        assert_eq!((image.depth_m[0], image.normal[0]), (2.0, [0.0, 0.0, 1.0]));
    }

    /// One batch alone gives no variance.
    #[test]
    fn a_single_batch_is_the_picture() {
        assert_eq!(added(4, &[1.0]).image().unwrap().noise, None);
    }
}
