//! Painting by the CPU renderer, some rows at a time.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use hairline_image::Image;
use hairline_optics::method::Method;
use hairline_reference::closed_form::{Prepared, RenderOptions, TILE_PX};
use hairline_scene::{DEFAULT_SAMPLES, Scene};
use web_time::Instant;

use super::Built;
use super::drafts::Drafts;
use super::frame::Picture;
use super::pace::{self, Kind};
use super::painter::{Easel, Shown, Step};
use super::partial::Backdrop;
use super::pool::Crew;
use super::request::Order;
use crate::reading::{Findings, Shows};

/// How much is painted between two looks at whether something newer is wanted.
#[derive(Clone, Copy)]
struct BandSize {
    /// The first, pixels.
    first_px: u32,
    /// Of which there are at least so many, rows.
    fewest_rows: u32,
    /// Bands that take less become larger, bands that take more become smaller.
    times: [Duration; 2],
    /// Whether a band ends at once, without a result, where something newer is wanted; else it is worked to its end.
    breaks_off: bool,
}

/// Many rows, so that no thread waits long for another.
const OF_A_THREAD: BandSize = BandSize {
    first_px: 1 << 15,
    fewest_rows: TILE_PX,
    times: [Duration::from_millis(60), Duration::from_millis(200)],
    breaks_off: true,
};

/// The interface waits meanwhile.
const IN_TURN: BandSize = BandSize {
    first_px: 1 << 10,
    fewest_rows: TILE_PX,
    times: [Duration::from_millis(4), Duration::from_millis(12)],
    breaks_off: false,
};

/// A picture that is finished in part is shown as often.
const REFRESH: Duration = Duration::from_millis(600);

/// Keeps the last picture, so that another exposure costs next to nothing, and one that was interrupted, to go on with it.
pub(super) struct CpuEasel {
    scene: Option<std::sync::Weak<super::Built>>,
    last: Option<Last>,
    begun: Option<Begun>,
    drafts: Drafts,
    band_size: BandSize,
    /// Whether a picture is shown before it is finished, which takes time of its own.
    shows_parts: bool,
}

/// The last picture that was done.
struct Last {
    image: Image,
    step: Step,
    order: Order,
}

/// A picture that is not done yet.
struct Begun {
    order: Order,
    step: Step,
    bands: Bands,
}

impl CpuEasel {
    /// For a thread that paints.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn of_a_thread() -> Self {
        Self::new(OF_A_THREAD)
    }

    /// For an interface that waits meanwhile.
    pub fn in_turn() -> Self {
        Self::new(IN_TURN)
    }

    fn new(band_size: BandSize) -> Self {
        Self {
            scene: None,
            last: None,
            begun: None,
            drafts: Drafts::default(),
            band_size,
            shows_parts: band_size.breaks_off,
        }
    }
}

impl Easel for CpuEasel {
    fn take(&mut self, order: &Order) -> Result<bool, hairline_gpu::Error> {
        let built = Arc::downgrade(&order.built);
        let is_new = !self.scene.as_ref().is_some_and(|last| last.ptr_eq(&built));
        self.scene = Some(built);
        if is_new {
            self.begun = None;
        }
        Ok(is_new)
    }

    fn paint(
        &mut self,
        order: &Order,
        step: &Step,
        interrupted: &(dyn Fn() -> bool + Sync),
        show: &mut dyn FnMut(Shown),
    ) -> Result<bool, hairline_gpu::Error> {
        let begun = self
            .begun
            .take()
            .filter(|begun| begun.step == *step && begun.order.has_same_pixels(order));
        let is_coarse = step.samples == 1 && !step.is_whole(&order.view);
        let is_of_order = |last: &&Last| last.order.has_same_pixels(order);
        let before = self.last.as_ref().filter(is_of_order);
        let mut bands = match (begun, before) {
            (Some(begun), _) => begun.bands,
            (None, Some(last)) if !is_coarse && last.step.is_whole(&order.view) => {
                Bands::edges_of(last.image.clone(), self.band_size)
            }
            (None, _) => Bands::new(step.size_px, self.band_size),
        };
        let crew = if is_coarse {
            Crew::Sketcher
        } else {
            Crew::Painter
        };
        let scene = scene_seen(order, step);
        let mut prepared = prepared(&order.built, &scene);
        if step.thin > 1 || order.built.sketch.is_some() {
            let draft = crew.install(|| self.drafts.of(&order.built, step.thin));
            prepared = prepared.with_draft(draft);
        }
        // What the rows that are left look like meanwhile.
        let before = before
            .filter(|_| !is_coarse && self.shows_parts && !bands.only_edges)
            .filter(|_| order.view.reading.shows == Shows::Beauty);
        let mut backdrop = None;
        let mut shown_last = Instant::now();
        let is_done = loop {
            if interrupted() {
                break false;
            }
            let go_on = crew.install(|| bands.next(&prepared, step.samples, interrupted));
            match go_on {
                Some(true) => break true,
                Some(false) => {}
                None => break false,
            }
            if let Some(last) = before
                && shown_last.elapsed() > REFRESH
            {
                let backdrop = backdrop.get_or_insert_with(|| {
                    Backdrop::new(&last.image, step.size_px, &order.view.display)
                });
                let picture = backdrop.under(&bands.image, bands.next_row);
                show(Shown {
                    picture,
                    size_px: step.size_px,
                    samples: step.samples,
                    thin: step.thin,
                    done: bands.done(),
                    passes: Vec::new(),
                    findings: Findings::default(),
                });
                shown_last = Instant::now();
            }
        };
        if !is_done {
            self.begun = Some(Begun {
                order: order.clone(),
                step: *step,
                bands,
            });
            return Ok(false);
        }
        show(shown(order, &bands.image, step));
        self.last = Some(Last {
            image: bands.image,
            step: *step,
            order: order.clone(),
        });
        Ok(true)
    }

    fn show_again(&mut self, order: &Order) -> Result<Option<Shown>, hairline_gpu::Error> {
        let last = self.last.as_ref();
        Ok(last.map(|last| shown(order, &last.image, &last.step)))
    }

    fn best_samples(&self) -> u32 {
        DEFAULT_SAMPLES
    }

    fn kind(&self) -> &'static Kind {
        &pace::THINNED
    }
}

fn shown(order: &Order, image: &Image, step: &Step) -> Shown {
    let (pixels, findings) = crate::reading::develop(image, &order.view);
    Shown {
        picture: Picture::Pixels(Arc::new(pixels)),
        size_px: step.size_px,
        samples: step.samples,
        thin: step.thin,
        done: 1.0,
        passes: Vec::new(),
        findings,
    }
}

/// The scene from where it is seen.
fn scene_seen(order: &Order, step: &Step) -> Scene {
    let mut scene = order.built.scene.clone();
    scene.camera = order.view.camera;
    scene.render.size_px = step.size_px;
    scene.render.filter_std_px = step.filter_std_px(&order.view);
    scene
}

/// A scene that is that of `built` from elsewhere, ready to be rendered.
fn prepared<'s>(built: &Built, scene: &'s Scene) -> Prepared<'s> {
    Prepared::from_parts(
        scene,
        Arc::clone(&built.triangles),
        Arc::clone(&built.scratches),
        Arc::clone(&built.tables),
    )
}

/// Renders `scene`, which is that of `built` from elsewhere, in bands of `band_px` pixels at first, then of as many as are
/// soon done. `go_on` is told before each which share of the picture is done; when it says no, there is no picture.
pub(crate) fn render(
    built: &Built,
    scene: &Scene,
    samples: u32,
    band_px: u32,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Image> {
    let band_size = BandSize {
        first_px: band_px,
        ..OF_A_THREAD
    };
    let mut bands = Bands::new(scene.render.size_px, band_size);
    let prepared = prepared(built, scene);
    loop {
        if !go_on(bands.done()) {
            return None;
        }
        if bands.next(&prepared, samples, &|| false)? {
            return Some(bands.image);
        }
    }
}

/// A picture from its first row to its last, with pauses.
struct Bands {
    image: Image,
    next_row: u32,
    rows: u32,
    size: BandSize,
    /// The picture is there, but for further samples of pixels on edges.
    only_edges: bool,
}

impl Bands {
    fn new(size_px: [u32; 2], size: BandSize) -> Self {
        Self {
            image: Image::new(size_px),
            next_row: 0,
            rows: (size.first_px / size_px[0].max(1)).max(size.fewest_rows),
            size,
            only_edges: false,
        }
    }

    /// Of a picture of one sample a pixel.
    fn edges_of(image: Image, size: BandSize) -> Self {
        let bands = Self::new(image.size_px, size);
        Self {
            image,
            only_edges: true,
            ..bands
        }
    }

    /// The share that is there.
    fn done(&self) -> f64 {
        f64::from(self.next_row) / f64::from(self.image.size_px[1].max(1))
    }

    /// Renders some rows; true if all are there, none if it was broken off: then they are to be rendered again. `prepared` is each
    /// time the same.
    fn next(
        &mut self,
        prepared: &Prepared,
        samples: u32,
        interrupted: &(dyn Fn() -> bool + Sync),
    ) -> Option<bool> {
        let options = RenderOptions {
            samples,
            method: Method::default(),
        };
        let [width, height] = self.image.size_px;
        let start = Instant::now();
        let many = self.rows.next_multiple_of(TILE_PX);
        let rows = self.next_row..(self.next_row + many).min(height);
        let pixels = rows.start as usize * width as usize..rows.end as usize * width as usize;
        let end = rows.end;
        let cancelled = || self.size.breaks_off && interrupted();
        let part = if self.only_edges {
            let before = rows_of(&self.image, pixels.clone());
            prepared.refine_edges_unless(&cancelled, &options, rows, before)?
        } else {
            let (part, _) = prepared.render_unless(&cancelled, &options, rows, &|_| {})?;
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
fn rows_of(image: &Image, pixels: Range<usize>) -> Image {
    let width = image.size_px[0];
    let mut part = Image::new([width, (pixels.len() / width as usize) as u32]);
    part.base.copy_from_slice(&image.base[pixels.clone()]);
    part.scratches
        .copy_from_slice(&image.scratches[pixels.clone()]);
    part.density.copy_from_slice(&image.density[pixels.clone()]);
    part.depth_m.copy_from_slice(&image.depth_m[pixels.clone()]);
    part.normal.copy_from_slice(&image.normal[pixels]);
    part
}

/// Puts a part of the picture in its place.
pub(crate) fn put_rows(image: &mut Image, pixels: Range<usize>, part: &Image) {
    image.base[pixels.clone()].copy_from_slice(&part.base);
    image.scratches[pixels.clone()].copy_from_slice(&part.scratches);
    image.density[pixels.clone()].copy_from_slice(&part.density);
    image.depth_m[pixels.clone()].copy_from_slice(&part.depth_m);
    image.normal[pixels].copy_from_slice(&part.normal);
}
