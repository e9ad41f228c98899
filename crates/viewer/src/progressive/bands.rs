//! A picture by the CPU renderer, some rows at a time.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use hairline_cpu::closed_form::{Prepared, RenderOptions, TILE_PX};
use hairline_image::{Batch, Batches, Image, Traced, TracedPixel};
use hairline_scene::{Scene, Transport};
use web_time::Instant;

use super::Built;

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

/// A scene that is that of `built` from elsewhere, ready to be rendered.
pub(super) fn prepared<'s>(built: &Built, scene: &'s Scene) -> Prepared<'s> {
    Prepared::from_parts(
        scene,
        Arc::clone(&built.triangles),
        Arc::clone(&built.scratches),
        Arc::clone(&built.tables),
    )
}

/// Renders `scene`, which is that of `built` from elsewhere, in bands of `band_px` pixels or a little more. `go_on` is told before each which
/// share of the picture is done, which is the share of its time too; when it says no, there is no picture. `batches` add up; without them
/// all samples are taken at once.
pub(crate) fn render(
    built: &Built,
    scene: &Scene,
    samples: u32,
    transport: Transport,
    batches: Option<Batches>,
    band_px: u32,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Image> {
    let prepared = prepared(built, scene);
    let mut options = options(samples, transport, None);
    let render_once = |options: &RenderOptions, go_on: &dyn Fn(f64) -> bool| {
        let mut image = Image::new(scene.render.size_px);
        for (done, rows) in spread(scene.render.size_px, band_px) {
            if !go_on(done) {
                return None;
            }
            let (part, _) = prepared.render_unless(&|| false, options, rows.clone(), &|_| {})?;
            put_rows(&mut image, pixels(scene.render.size_px, rows), &part);
        }
        Some(image)
    };
    let Some(mut batches) = batches else {
        return render_once(&options, go_on);
    };
    options.samples = batches.samples();
    while let Some(batch) = batches.next() {
        options.batch = Some(batch);
        let share = 1.0 / f64::from(options.samples);
        let go_on =
            |done: f64| go_on((f64::from(batch.first) + f64::from(batch.count) * done) * share);
        batches.add(render_once(&options, &go_on)?);
    }
    batches.into_image()
}

/// The bands of a picture, whole rows of tiles of `band_px` pixels or a little more, each with the share of those before it. The first of them are
/// all over the picture: they take as long as others, so that the time of the rest is known.
pub(crate) fn spread(
    size_px: [u32; 2],
    band_px: u32,
) -> impl Iterator<Item = (f64, Range<u32>)> + use<> {
    let [width, height] = size_px;
    let rows = (band_px / width.max(1)).max(1).next_multiple_of(TILE_PX);
    let count = height.div_ceil(rows);
    // Near the golden ratio, which leaves no part out for long.
    let nearest = (0.618 * f64::from(count)).round() as u32;
    let stride = (nearest.max(1)..).find(|stride| gcd(*stride, count) == 1);
    let stride = u64::from(stride.unwrap_or(1));
    (0..count).map(move |i| {
        let band = (u64::from(i) * stride % u64::from(count)) as u32;
        let first = band * rows;
        let done = f64::from(i) / f64::from(count);
        (done, first..(first + rows).min(height))
    })
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Pixels of some rows of a picture.
pub(crate) fn pixels([width, _]: [u32; 2], rows: Range<u32>) -> Range<usize> {
    rows.start as usize * width as usize..rows.end as usize * width as usize
}

/// Options of Hairline's own method.
pub(crate) fn options(samples: u32, transport: Transport, batch: Option<Batch>) -> RenderOptions {
    RenderOptions {
        samples,
        batch,
        shadows: transport.shadows,
        bounces: transport.bounces,
        ..RenderOptions::default()
    }
}

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
        let pixels = pixels(self.image.size_px, rows.clone());
        let end = rows.end;
        let cancelled = || self.size.breaks_off && interrupted();
        let part = if self.only_edges {
            let before = rows_of(&self.image, pixels.clone());
            prepared.refine_edges_unless(&cancelled, options, rows, before)?
        } else {
            let (part, _) = prepared.render_unless(&cancelled, options, rows, &|_| {})?;
            part
        };
        put_rows(&mut self.image, pixels, &part);
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

/// Some rows of a picture, given by their pixels.
pub(crate) fn rows_of(image: &Image, pixels: Range<usize>) -> Image {
    let width = image.size_px[0];
    let mut part = Image::new([width, (pixels.len() / width as usize) as u32]);
    part.base.copy_from_slice(&image.base[pixels.clone()]);
    part.scratches
        .copy_from_slice(&image.scratches[pixels.clone()]);
    part.density.copy_from_slice(&image.density[pixels.clone()]);
    part.depth_m.copy_from_slice(&image.depth_m[pixels.clone()]);
    part.normal.copy_from_slice(&image.normal[pixels.clone()]);
    part
}

/// Puts a part of the picture in its place.
pub(crate) fn put_rows(image: &mut Image, pixels: Range<usize>, part: &Image) {
    image.base[pixels.clone()].copy_from_slice(&part.base);
    image.scratches[pixels.clone()].copy_from_slice(&part.scratches);
    image.density[pixels.clone()].copy_from_slice(&part.density);
    image.depth_m[pixels.clone()].copy_from_slice(&part.depth_m);
    image.normal[pixels.clone()].copy_from_slice(&part.normal);
    if let Some(of_part) = &part.traced {
        let count = image.pixel_count();
        let found = image.traced.get_or_insert_with(|| Traced {
            rounds: of_part.rounds,
            pixels: vec![TracedPixel::default(); count],
        });
        found.pixels[pixels].copy_from_slice(&of_part.pixels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_bands_of_a_picture_are_all_over_it() {
        for size_px in [[1920, 1080], [160, 100], [7, 8], [3000, 1], [640, 2160]] {
            let bands: Vec<_> = spread(size_px, 1 << 13).collect();
            let mut all: Vec<_> = bands.iter().map(|(_, rows)| rows.clone()).collect();
            all.sort_by_key(|rows| rows.start);
            assert!(all.windows(2).all(|two| two[0].end == two[1].start));
            assert_eq!((all[0].start, all[all.len() - 1].end), (0, size_px[1]));
            // Of a tenth of the bands each quarter of the picture has its share.
            let tenth = bands.len() / 10;
            for quarter in 0..4 {
                let of_quarter = |rows: &Range<u32>| rows.start * 4 / size_px[1] == quarter;
                let there = bands[..tenth].iter().filter(|(_, rows)| of_quarter(rows));
                let there = there.count();
                assert!(there >= tenth / 4, "{size_px:?}: {there} of {tenth}");
            }
        }
    }
}
