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
    let bundles = prepared.bundles();
    let many = Many {
        prepared,
        bundles,
        grids: &bundles.index.objects[object],
        pixel: &Pixel::new(point),
        object,
        list,
        views,
        may_tally: gather == Gather::Tally,
    };
    let cell_um = many.grids.cell_m as f64 * 1e6;
    let octave = (least_std_um(many.pixel) / (LEAST_CELLS * cell_um)).log2();
    if many.grids.classes.is_empty() {
        return ScratchSums::default();
    }
    if !(octave > 0.0) {
        return many.one_by_one(octave, work);
    }
    let level = (octave as usize).min(many.grids.level_count - 1);
    let over = smooth((octave - level as f64) / HAND_OVER);
    let mut sums = ScratchSums::default();
    add_scaled(&mut sums, &many.by_grid(level, work), over);
    if over < 1.0 {
        let finer = match level {
            0 => many.one_by_one(octave, work),
            _ => many.by_grid(level - 1, work),
        };
        add_scaled(&mut sums, &finer, 1.0 - over);
    }
    sums
}

/// What the scratches of an object under a pixel are added up from.
struct Many<'a> {
    prepared: &'a Prepared<'a>,
    bundles: &'a Bundles,
    grids: &'a ObjectBundles,
    pixel: &'a Pixel<'a>,
    object: usize,
    list: Option<&'a [u32]>,
    views: &'a LightViews<'a>,
    may_tally: bool,
}

impl Many<'_> {
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

fn add_scaled(sums: &mut ScratchSums, more: &ScratchSums, weight: f64) {
    sums.share += weight * more.share;
    sums.share_by_line += weight * more.share_by_line;
    for c in 0..3 {
        sums.radiance[c] += weight * more.radiance[c];
        sums.energy[c] += weight * more.energy[c];
    }
}

/// The least standard deviation of footprint and window together in any direction.
fn least_std_um(pixel: &Pixel) -> f64 {
    let c = pixel.covariance_um2;
    let (mean, half) = (0.5 * (c.x + c.z), 0.5 * (c.x - c.z));
    ((mean - half.hypot(c.y)).max(0.0) + pixel.window_um2).sqrt()
}

#[cfg(test)]
mod tests;
