//! Pictures by [`LightAt::Scratches`]: scratch by scratch instead of pixel by pixel (docs/model.md, section 6).
//!
//! What a scratch sends changes slowly along it, and dozens of pixels see each. So its light is worked out at a few places along it,
//! by the functions that do it for a pixel, and the pixels under it take their share, [`weigh`], of what lies between two of those.
//! The picture is done tile by tile: one walk finds a tile's scratches. What a pixel adds up is the same sum as ever, in another
//! order.

mod course;
mod dark;
mod line;
mod stations;
mod sums;
mod tile;
mod weigh;

use crate::closed_form::{Picture, Sample};
use hairline_image::Image;
use hairline_optics::method::{Gather, LightAt, Lookup, Method};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use tile::Tile;

/// Pixels to a side of a tile. Scratches are cut at its edges, and what is known of its pixels should stay in a core's cache.
pub(crate) const TILE_PX: usize = 32;

/// Whether pictures by a method are done this way.
pub(crate) fn is_for(method: Method) -> bool {
    method.light_at != LightAt::Pixels
        && method.lookup == Lookup::Tiles
        && method.gather != Gather::Tally
        && method.is_default_path()
}

/// Renders some rows of the picture; the image is as high as they are many. `progress` is told the share that is done, from any
/// thread.
pub(crate) fn render_rows(
    picture: &Picture,
    rows: Range<u32>,
    progress: &(dyn Fn(f64) + Sync),
) -> Image {
    let width = picture.way.prepared.scene.render.size_px[0] as usize;
    let (first, end) = (rows.start as usize, rows.end as usize);
    let mut image = Image::new([width as u32, rows.len() as u32]);
    let band = width * TILE_PX;
    let layers = (
        image.base.par_chunks_mut(band),
        image.scratches.par_chunks_mut(band),
        image.density.par_chunks_mut(band),
        image.depth_m.par_chunks_mut(band),
        image.normal.par_chunks_mut(band),
    );
    let (done, bands) = (AtomicUsize::new(0), (end - first).div_ceil(TILE_PX));
    // What a tile needs is dear to allocate, and threads take other tiles than they began with.
    let rooms: Mutex<Vec<Tile>> = Mutex::default();
    layers.into_par_iter().enumerate().for_each(
        |(i, (base, scratches, density, depth_m, normal))| {
            let y = first + i * TILE_PX;
            let height = TILE_PX.min(end - y);
            let corners: Vec<usize> = (0..width).step_by(TILE_PX).collect();
            let tiles: Vec<Vec<Sample>> = corners
                .par_iter()
                .map(|&x| {
                    let mut tile = take(&rooms).unwrap_or_else(|| Tile::new(picture));
                    let samples = tile.render([x, y], [TILE_PX.min(width - x), height]);
                    put_back(&rooms, tile);
                    samples
                })
                .collect();
            for (&x, samples) in corners.iter().zip(&tiles) {
                let across = TILE_PX.min(width - x);
                for (j, sample) in samples.iter().enumerate() {
                    let at = j / across * width + x + j % across;
                    base[at] = sample.base.as_vec3().to_array();
                    scratches[at] = sample.scratches.as_vec3().to_array();
                    density[at] = sample.density.as_vec3().to_array();
                    depth_m[at] = sample.depth_m as f32;
                    normal[at] = sample.normal.normalize_or_zero().as_vec3().to_array();
                }
            }
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress(done as f64 / bands as f64);
        },
    );
    image
}

fn take<T>(rooms: &Mutex<Vec<T>>) -> Option<T> {
    rooms.lock().ok()?.pop()
}

fn put_back<T>(rooms: &Mutex<Vec<T>>, room: T) {
    if let Ok(mut rooms) = rooms.lock() {
        rooms.push(room);
    }
}

#[cfg(test)]
mod tests;
