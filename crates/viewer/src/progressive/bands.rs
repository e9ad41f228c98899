//! A picture by the CPU renderer, some rows at a time.

use std::time::Duration;

use hairline_cpu::closed_form::{Prepared, RenderOptions, TILE_PX};
use hairline_image::Image;
use web_time::Instant;

/// Amount of work between two checks for newer orders.
#[derive(Clone, Copy)]
pub(super) struct BandSize {
    /// The first, pixels.
    first_px: u32,
    /// Least number of rows.
    fewest_rows: u32,
    /// Bands that take less become larger, bands that take more become smaller.
    times: [Duration; 2],
    /// Whether a band ends at once, without a result, if there is a newer order; else it is finished.
    pub breaks_off: bool,
}

/// Many rows, so that no thread waits long for another. The progressive renderer of a page has no threads.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const OF_A_THREAD: BandSize = BandSize {
    first_px: 1 << 15,
    fewest_rows: TILE_PX,
    times: [Duration::from_millis(60), Duration::from_millis(200)],
    breaks_off: true,
};

/// The interface waits meanwhile.
pub(super) const IN_TURN: BandSize = BandSize {
    first_px: 1 << 10,
    fewest_rows: TILE_PX,
    times: [Duration::from_millis(4), Duration::from_millis(12)],
    breaks_off: false,
};

/// A picture from its first row to its last, with pauses.
pub(super) struct Bands {
    pub image: Image,
    pub next_row: u32,
    rows: u32,
    size: BandSize,
    /// The picture is there, but for further samples of pixels on edges.
    pub only_edges: bool,
}

impl Bands {
    pub fn new(size_px: [u32; 2], size: BandSize) -> Self {
        Self {
            image: Image::new(size_px),
            next_row: 0,
            rows: (size.first_px / size_px[0].max(1)).max(size.fewest_rows),
            size,
            only_edges: false,
        }
    }

    /// Bands that refine the edges of a picture of one sample a pixel.
    pub fn edges_of(image: Image, size: BandSize) -> Self {
        let bands = Self::new(image.size_px, size);
        Self {
            image,
            only_edges: true,
            ..bands
        }
    }

    /// The share that is there.
    pub fn done(&self) -> f64 {
        f64::from(self.next_row) / f64::from(self.image.size_px[1].max(1))
    }

    /// Renders some rows; true if all are there, none if it was broken off: then they are to be rendered again. `prepared` is each
    /// time the same.
    pub fn next(
        &mut self,
        prepared: &Prepared,
        options: &RenderOptions,
        interrupted: &(dyn Fn() -> bool + Sync),
    ) -> Option<bool> {
        let height = self.image.size_px[1];
        let start = Instant::now();
        let many = self.rows.next_multiple_of(TILE_PX);
        let rows = self.next_row..(self.next_row + many).min(height);
        let (first, end) = (rows.start, rows.end);
        let cancelled = || self.size.breaks_off && interrupted();
        let part = if self.only_edges {
            let before = self.image.rows(rows.clone());
            prepared.refine_edges_unless(&cancelled, options, rows, before)?
        } else {
            let (part, _) = prepared.render_unless(&cancelled, options, rows, &|_| {})?;
            part
        };
        self.image.put_rows(first, &part);
        self.next_row = end;
        let time = start.elapsed();
        if time > self.size.times[1] {
            self.rows = (self.rows / 2).max(TILE_PX);
        } else if time < self.size.times[0] {
            self.rows *= 2;
        }
        Some(end == height)
    }
}
