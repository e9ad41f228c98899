//! The scratches under a footprint as sums over directions (docs/model.md, section 7). Where a footprint covers many it lights one
//! scratch for each direction; how much lies in which direction it reads from a grid that is fine against it or, where even the
//! finest is too coarse, adds up scratch by scratch.
//!
//! The number of vertices under a footprint and of directions is bounded, whatever the number of scratches. From single
//! scratches to sums, from those to the finest grid and from each grid to the next one, weights go over smoothly.

mod directions;
mod tally;
mod vertices;

use crate::closed_form::Prepared;
use crate::light_view::LightViews;
use crate::scratches::{Pixel, Work};
use crate::surface::SurfacePoint;
use directions::Directions;
use hairline_index::bundles::{Bundles, ObjectBundles, Side};
use hairline_optics::mask::ScratchSums;
use hairline_optics::method::Gather;

/// A footprint's least standard deviation is at least so many cells of the grids that it reads: from here on their sum over its
/// Gaussian is an integral to 1e-3, the tents' variance taken off.
const LEAST_CELLS: f64 = 0.9;
/// The footprint's size goes up by this factor while one grid takes over from another, as a power of two.
const HAND_OVER: f64 = 0.35;

/// Adds up all scratches of an object under the point's footprint; `gather` is any but [`Gather::Exact`].
pub(crate) fn gather_bundles(
    prepared: &Prepared,
    point: &SurfacePoint,
    object: usize,
    list: Option<&[u32]>,
    views: &LightViews,
    gather: Gather,
    work: &mut Work,
) -> ScratchSums {
    let pixel = Pixel::new(point);
    let many = Many::new(prepared, &pixel, object, views);
    let (mut sums, single_share) = many.grids(work);
    if single_share > 0.0 {
        let singles = many.one_by_one(list, gather == Gather::Tally, work);
        add_scaled(&mut sums, &singles, single_share);
    }
    sums
}

/// What grids have of the scratches of an object under the point's footprint, and the share that they leave to single ones.
pub(crate) fn gather_grids(
    prepared: &Prepared,
    point: &SurfacePoint,
    object: usize,
    views: &LightViews,
    work: &mut Work,
) -> (ScratchSums, f64) {
    Many::new(prepared, &Pixel::new(point), object, views).grids(work)
}

/// What the scratches of an object under a pixel are added up from.
struct Many<'a> {
    prepared: &'a Prepared<'a>,
    bundles: &'a Bundles,
    grids: &'a ObjectBundles,
    pixel: &'a Pixel<'a>,
    object: usize,
    views: &'a LightViews<'a>,
    /// How much wider the footprint is than the finest grid wants, as a power of two.
    octave: f64,
    /// The same where scratches may be long.
    dense_octave: f64,
}

impl<'a> Many<'a> {
    fn new(
        prepared: &'a Prepared<'a>,
        pixel: &'a Pixel<'a>,
        object: usize,
        views: &'a LightViews<'a>,
    ) -> Self {
        let bundles = prepared.bundles();
        let grids = &bundles.index.objects[object];
        let std_um = least_std_um(pixel);
        let octave = |cell_m: f32| (std_um / (LEAST_CELLS * f64::from(cell_m) * 1e6)).log2();
        Self {
            prepared,
            bundles,
            grids,
            pixel,
            object,
            views,
            octave: octave(grids.cell_m),
            dense_octave: octave(grids.dense_cell_m),
        }
    }

    /// What the grids have, and the share that they leave to single scratches.
    fn grids(&self, work: &mut Work) -> (ScratchSums, f64) {
        let mut sums = ScratchSums::default();
        if self.grids.classes.is_empty() {
            return (sums, 0.0);
        }
        if !(self.octave > 0.0) {
            return (sums, 1.0);
        }
        let level = (self.octave as usize).min(self.grids.level_count - 1);
        let over = smooth((self.octave - level as f64) / HAND_OVER);
        add_scaled(&mut sums, &self.by_grid(level, work), over);
        if level > 0 && over < 1.0 {
            add_scaled(&mut sums, &self.by_grid(level - 1, work), 1.0 - over);
        }
        (sums, if level > 0 { 0.0 } else { 1.0 - over })
    }

    /// What all sides' grids of a level have.
    fn by_grid(&self, level: usize, work: &mut Work) -> ScratchSums {
        let mut sums = ScratchSums::default();
        for side in Side::ALL {
            if let Some(directions) = vertices::read(self, level, side, work) {
                directions.add_mask(self, &mut sums);
                let radiance = directions.radiance(self, work);
                (0..3).for_each(|c| sums.radiance[c] += radiance[c]);
            }
        }
        sums
    }
}

/// From 0 to 1 without a kink, between those places.
fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Adds so many times as much.
pub(crate) fn add_scaled(sums: &mut ScratchSums, more: &ScratchSums, weight: f64) {
    sums.share += weight * more.share;
    sums.share_by_line += weight * more.share_by_line;
    for c in 0..3 {
        sums.radiance[c] += weight * more.radiance[c];
        sums.energy[c] += weight * more.energy[c];
    }
}

/// The least standard deviation of footprint and window together in any direction.
fn least_std_um(pixel: &Pixel) -> f64 {
    let c = pixel.frame.covariance_um2;
    let (mean, half) = (0.5 * (c.x + c.z), 0.5 * (c.x - c.z));
    ((mean - half.hypot(c.y)).max(0.0) + pixel.frame.window_um2).sqrt()
}

#[cfg(test)]
mod tests;
