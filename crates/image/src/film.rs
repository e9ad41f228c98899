//! Images in memory: the layers of a render, and plain pictures.

use std::ops::Range;

use crate::traced::{Traced, TracedPixel};

/// Picture of a renderer: one value a pixel in each layer, row by row from the top. All layers are equally long.
///
/// The beauty is not stored: it is [`Image::base`] plus [`Image::scratches`] by construction.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Light off the base and of the background, less the energy that the scratches take from the base. Linear Rec.709 radiance.
    pub base: Vec<[f32; 3]>,
    /// Light off the scratches. Linear Rec.709 radiance.
    pub scratches: Vec<[f32; 3]>,
    /// The share of the base's energy that the scratches took, from 0 to 1 for each of R, G and B.
    pub density: Vec<[f32; 3]>,
    /// Distance from the pinhole along the view axis in metres, averaged over the pixel's samples that hit a surface.
    /// **0 where none did**: no surface can be there, and unlike an infinity it survives averages and differences, and
    /// exists in WGSL.
    pub depth_m: Vec<f32>,
    /// Unit shading normal in world space; (0, 0, 0) where nothing was hit.
    pub normal: Vec<[f32; 3]>,
    /// The share of each pixel that surfaces cover, from 0 to 1: of a picture before a transparent background. There is nothing behind
    /// the surfaces then, so the colours are multiplied by the shares.
    pub alpha: Option<Vec<f32>>,
    /// Variances of the colours, where they are Monte Carlo estimates.
    pub noise: Option<Noise>,
    /// Light that rays found, where there were any: for pictures of further rays, and for the filter. No file holds it.
    pub traced: Option<Traced>,
}

/// Variances of a Monte Carlo estimate. All vectors are as long as the image's layers.
///
/// The variances come from the scatter of batches: a pixel's samples are averaged by the batch, and the variance of the
/// batches' means over their number is the variance of the pixel's mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// Variance of each pixel's mean, channel by channel, in squared radiance. Not the sum of the next two: base and
    /// scratches come from the same samples and are correlated.
    pub beauty: Vec<[f32; 3]>,
    /// Variance of [`Image::base`].
    pub base: Vec<[f32; 3]>,
    /// Variance of [`Image::scratches`].
    pub scratches: Vec<[f32; 3]>,
    /// Variance of [`Image::density`].
    pub density: Vec<[f32; 3]>,
    /// Samples that each pixel has had.
    pub samples: Vec<u32>,
    /// Samples in a batch. Two batches must be complete before a variance can be known; it is stored as 0 until then.
    pub batch: u32,
}

impl Noise {
    /// Noise of a picture without samples yet, in batches of `batch` samples.
    pub fn new(size_px: [u32; 2], batch: u32) -> Self {
        let count = pixel_count(size_px);
        Self {
            beauty: vec![[0.0; 3]; count],
            base: vec![[0.0; 3]; count],
            scratches: vec![[0.0; 3]; count],
            density: vec![[0.0; 3]; count],
            samples: vec![0; count],
            batch,
        }
    }

    /// Whether the variances of pixel `i` mean something: it has had two batches or more.
    pub fn is_known(&self, i: usize) -> bool {
        self.batches(i) >= 2
    }

    /// The complete batches of pixel `i`: its variances have one degree of freedom less.
    pub fn batches(&self, i: usize) -> u32 {
        self.samples[i].checked_div(self.batch).unwrap_or(0)
    }

    /// The variances of a layer; `None` for depth, normal and alpha, which are not estimated.
    pub fn variance(&self, layer: Layer) -> Option<&[[f32; 3]]> {
        match layer {
            Layer::Beauty => Some(&self.beauty),
            Layer::Base => Some(&self.base),
            Layer::Scratches => Some(&self.scratches),
            Layer::Density => Some(&self.density),
            Layer::Depth | Layer::Normal | Layer::Alpha => None,
        }
    }
}

crate::listed! {
    /// A layer of an [`Image`].
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Layer {
        /// Base plus scratches.
        Beauty = "beauty";
        /// [`Image::base`].
        Base = "base";
        /// [`Image::scratches`].
        Scratches = "scratches";
        /// [`Image::density`].
        Density = "density";
        /// [`Image::depth_m`], the same in all three components.
        Depth = "depth";
        /// [`Image::normal`].
        Normal = "normal";
        /// [`Image::alpha`], the same in all three components; 1 of a picture without.
        Alpha = "alpha";
    }
    /// The name, in lower case.
    fn name;
}

impl Image {
    /// An image that is black and empty everywhere.
    pub fn new(size_px: [u32; 2]) -> Self {
        let count = pixel_count(size_px);
        Self {
            size_px,
            base: vec![[0.0; 3]; count],
            scratches: vec![[0.0; 3]; count],
            density: vec![[0.0; 3]; count],
            depth_m: vec![0.0; count],
            normal: vec![[0.0; 3]; count],
            alpha: None,
            noise: None,
            traced: None,
        }
    }

    /// Width times height.
    pub fn pixel_count(&self) -> usize {
        pixel_count(self.size_px)
    }

    /// Index in each layer of the pixel in column `x` and row `y` (from the top).
    pub fn index(&self, x: u32, y: u32) -> usize {
        debug_assert!(x < self.size_px[0] && y < self.size_px[1]);
        y as usize * self.size_px[0] as usize + x as usize
    }

    /// A copy of some rows, without alpha, noise and what rays found.
    pub fn rows(&self, rows: Range<u32>) -> Self {
        let width = self.size_px[0];
        let pixels = (rows.start * width) as usize..(rows.end * width) as usize;
        Self {
            size_px: [width, rows.len() as u32],
            base: self.base[pixels.clone()].to_vec(),
            scratches: self.scratches[pixels.clone()].to_vec(),
            density: self.density[pixels.clone()].to_vec(),
            depth_m: self.depth_m[pixels.clone()].to_vec(),
            normal: self.normal[pixels].to_vec(),
            alpha: None,
            noise: None,
            traced: None,
        }
    }

    /// Puts rows of the picture in their place, from row `first` on, with what rays found in them.
    ///
    /// # Panics
    /// Beyond the last row.
    pub fn put_rows(&mut self, first: u32, part: &Self) {
        let start = (first * self.size_px[0]) as usize;
        let pixels = start..start + part.pixel_count();
        self.base[pixels.clone()].copy_from_slice(&part.base);
        self.scratches[pixels.clone()].copy_from_slice(&part.scratches);
        self.density[pixels.clone()].copy_from_slice(&part.density);
        self.depth_m[pixels.clone()].copy_from_slice(&part.depth_m);
        self.normal[pixels.clone()].copy_from_slice(&part.normal);
        if let Some(of_part) = &part.traced {
            let count = self.pixel_count();
            let found = self.traced.get_or_insert_with(|| Traced {
                rounds: of_part.rounds,
                pixels: vec![TracedPixel::default(); count],
            });
            found.pixels[pixels].copy_from_slice(&of_part.pixels);
        }
    }

    /// The picture: base plus scratches.
    pub fn beauty(&self) -> Picture {
        let rgb = self
            .base
            .iter()
            .zip(&self.scratches)
            .map(|(base, scratches)| std::array::from_fn(|i| base[i] + scratches[i]))
            .collect();
        Picture {
            size_px: self.size_px,
            rgb,
        }
    }

    /// A copy of one layer, three components a pixel.
    pub fn layer(&self, layer: Layer) -> Vec<[f32; 3]> {
        match layer {
            Layer::Beauty => self.beauty().rgb,
            Layer::Base => self.base.clone(),
            Layer::Scratches => self.scratches.clone(),
            Layer::Density => self.density.clone(),
            Layer::Depth => self.depth_m.iter().map(|&z| [z; 3]).collect(),
            Layer::Normal => self.normal.clone(),
            Layer::Alpha => match &self.alpha {
                Some(alpha) => alpha.iter().map(|&a| [a; 3]).collect(),
                None => vec![[1.0; 3]; self.pixel_count()],
            },
        }
    }

    /// The variance of each pixel's mean in a layer, where the image is an estimate of it; see [`Noise`].
    pub fn variance(&self, layer: Layer) -> Option<&[[f32; 3]]> {
        self.noise.as_ref()?.variance(layer)
    }
}

/// A plain picture: linear Rec.709, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height.
    pub size_px: [u32; 2],
    /// One value a pixel.
    pub rgb: Vec<[f32; 3]>,
}

impl Picture {
    /// A black picture.
    pub fn new(size_px: [u32; 2]) -> Self {
        Self {
            size_px,
            rgb: vec![[0.0; 3]; pixel_count(size_px)],
        }
    }

    /// The pixel in column `x` and row `y` from the top.
    pub fn pixel(&self, x: u32, y: u32) -> [f32; 3] {
        debug_assert!(x < self.size_px[0] && y < self.size_px[1]);
        self.rgb[y as usize * self.size_px[0] as usize + x as usize]
    }
}

fn pixel_count(size_px: [u32; 2]) -> usize {
    size_px[0] as usize * size_px[1] as usize
}
