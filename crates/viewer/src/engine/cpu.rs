//! Painting by the CPU renderer, some rows at a time.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use egui::ColorImage;
use hairline_image::{Image, png};
use hairline_optics::method::Method;
use hairline_reference::closed_form::{Prepared, RenderOptions, TILE_PX};
use hairline_scene::Scene;
use web_time::Instant;

use super::frame::Picture;
use super::painter::{Easel, Shown, Step};
use super::pool;
use super::request::Order;
use super::{Built, DEFAULT_SAMPLES};

/// How much is painted between two looks at whether something newer is wanted.
#[derive(Clone, Copy)]
struct BandSize {
    /// The first, pixels.
    first_px: u32,
    /// Of which there are at least so many, rows.
    fewest_rows: u32,
    /// Bands that take less become larger, bands that take more become smaller.
    times: [Duration; 2],
}

/// Many rows, so that no thread waits long for another.
const OF_A_THREAD: BandSize = BandSize {
    first_px: 1 << 16,
    fewest_rows: TILE_PX,
    times: [Duration::from_millis(40), Duration::from_millis(120)],
};

/// The interface waits meanwhile.
const IN_TURN: BandSize = BandSize {
    first_px: 1 << 10,
    fewest_rows: TILE_PX,
    times: [Duration::from_millis(4), Duration::from_millis(12)],
};

/// Keeps the last picture, so that another exposure costs next to nothing, and one that was interrupted, to go on with it.
pub(super) struct CpuEasel {
    scene: Option<std::sync::Weak<super::Built>>,
    last: Option<(Image, Step)>,
    begun: Option<Begun>,
    band_size: BandSize,
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
            band_size,
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
        let mut bands = match begun {
            Some(begun) => begun.bands,
            None => Bands::new(step.size_px, self.band_size),
        };
        let scene = scene_seen(order, step);
        let samples = step.samples;
        let is_done = pool::Crew::Painter
            .install(|| bands.go_on(&order.built, &scene, samples, &|_| !interrupted()));
        if !is_done {
            self.begun = Some(Begun {
                order: order.clone(),
                step: *step,
                bands,
            });
            return Ok(false);
        }
        show(shown(order, &bands.image, step));
        self.last = Some((bands.image, *step));
        Ok(true)
    }

    fn show_again(&mut self, order: &Order) -> Result<Option<Shown>, hairline_gpu::Error> {
        let last = self.last.as_ref();
        Ok(last.map(|(image, step)| shown(order, image, step)))
    }

    fn best_samples(&self) -> u32 {
        DEFAULT_SAMPLES
    }
}

fn shown(order: &Order, image: &Image, step: &Step) -> Shown {
    let pixels = png::quantize(&image.beauty(), &order.view.display);
    let size = step.size_px.map(|side| side as usize);
    Shown {
        picture: Picture::Pixels(Arc::new(ColorImage::from_rgb(size, &pixels))),
        size_px: step.size_px,
        samples: step.samples,
        passes: Vec::new(),
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
    bands
        .go_on(built, scene, samples, go_on)
        .then_some(bands.image)
}

/// A picture from its first row to its last, with pauses.
struct Bands {
    image: Image,
    next_row: u32,
    rows: u32,
    size: BandSize,
}

impl Bands {
    fn new(size_px: [u32; 2], size: BandSize) -> Self {
        Self {
            image: Image::new(size_px),
            next_row: 0,
            rows: (size.first_px / size_px[0].max(1)).max(size.fewest_rows),
            size,
        }
    }

    /// Renders rows for as long as `go_on` says so; true if all are there. `built` and `scene` are as in [`render`], and each
    /// time the same.
    fn go_on(
        &mut self,
        built: &Built,
        scene: &Scene,
        samples: u32,
        go_on: &dyn Fn(f64) -> bool,
    ) -> bool {
        let prepared = Prepared::from_parts(
            scene,
            Arc::clone(&built.triangles),
            Arc::clone(&built.scratches),
            Arc::clone(&built.tables),
        );
        let options = RenderOptions {
            samples,
            method: Method::default(),
        };
        let [width, height] = scene.render.size_px;
        while self.next_row < height {
            if !go_on(f64::from(self.next_row) / f64::from(height)) {
                return false;
            }
            let start = Instant::now();
            let many = self.rows.next_multiple_of(TILE_PX);
            let rows = self.next_row..(self.next_row + many).min(height);
            let pixels = rows.start as usize * width as usize..rows.end as usize * width as usize;
            self.next_row = rows.end;
            let part = prepared.render_rows(&options, rows, &|_| {});
            put_rows(&mut self.image, pixels, &part);
            let time = start.elapsed();
            if time > self.size.times[1] {
                self.rows = (self.rows / 2).max(TILE_PX);
            } else if time < self.size.times[0] {
                self.rows *= 2;
            }
        }
        true
    }
}

/// Puts a part of the picture in its place.
pub(crate) fn put_rows(image: &mut Image, pixels: Range<usize>, part: &Image) {
    image.base[pixels.clone()].copy_from_slice(&part.base);
    image.scratches[pixels.clone()].copy_from_slice(&part.scratches);
    image.density[pixels.clone()].copy_from_slice(&part.density);
    image.depth_m[pixels.clone()].copy_from_slice(&part.depth_m);
    image.normal[pixels].copy_from_slice(&part.normal);
}
