//! Painting by the CPU renderer, some rows at a time.

use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::ColorImage;
use hairline_image::{Image, png};
use hairline_reference::closed_form::{Prepared, RenderOptions};
use hairline_scene::Scene;

use super::Built;
use super::frame::Picture;
use super::painter::{Easel, Shown, Step};
use super::pool;
use super::request::Order;

/// Pixels to the first look at whether something newer is wanted.
const BAND_PX: u32 = 1 << 16;
/// Bands that take less become larger, bands that take more become smaller.
const BAND_TIMES: [Duration; 2] = [Duration::from_millis(40), Duration::from_millis(120)];

/// Keeps the last picture, so that another exposure costs next to nothing.
#[derive(Default)]
pub(super) struct CpuEasel {
    scene: Option<std::sync::Weak<super::Built>>,
    last: Option<(Image, Step)>,
}

impl Easel for CpuEasel {
    fn take(&mut self, order: &Order) -> Result<bool, hairline_gpu::Error> {
        let built = Arc::downgrade(&order.built);
        let is_new = !self.scene.as_ref().is_some_and(|last| last.ptr_eq(&built));
        self.scene = Some(built);
        Ok(is_new)
    }

    fn paint(
        &mut self,
        order: &Order,
        step: &Step,
        interrupted: &(dyn Fn() -> bool + Sync),
        show: &mut dyn FnMut(Shown),
    ) -> Result<bool, hairline_gpu::Error> {
        let Some(image) = pool::Crew::Painter.install(|| paint(order, step, interrupted)) else {
            return Ok(false);
        };
        show(shown(order, &image, step));
        self.last = Some((image, *step));
        Ok(true)
    }

    fn show_again(&mut self, order: &Order) -> Result<Option<Shown>, hairline_gpu::Error> {
        let last = self.last.as_ref();
        Ok(last.map(|(image, step)| shown(order, image, step)))
    }

    fn best_samples(&self) -> u32 {
        // Of pixels on edges only.
        16
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

fn paint(order: &Order, step: &Step, interrupted: &(dyn Fn() -> bool + Sync)) -> Option<Image> {
    let mut scene = order.built.scene.clone();
    scene.camera = order.view.camera;
    scene.render.size_px = step.size_px;
    scene.render.filter_std_px = step.filter_std_px(&order.view);
    render(&order.built, &scene, step.samples, BAND_PX, &|_| {
        !interrupted()
    })
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
    let prepared = Prepared::from_parts(
        scene,
        Arc::clone(&built.triangles),
        Arc::clone(&built.scratches),
        Arc::clone(&built.tables),
    );
    let options = RenderOptions {
        samples,
        ..Default::default()
    };
    let [width, height] = scene.render.size_px;
    // A row is the least that a thread takes.
    let fewest = pool::threads() as u32;
    let mut band = (band_px / width).max(8);
    let mut image = Image::new(scene.render.size_px);
    let mut first = 0;
    while first < height {
        if !go_on(f64::from(first) / f64::from(height)) {
            return None;
        }
        let start = Instant::now();
        let rows = first..(first + band).min(height);
        let pixels = first as usize * width as usize..rows.end as usize * width as usize;
        first = rows.end;
        let part = prepared.render_rows(&options, rows, &|_| {});
        put_rows(&mut image, pixels, &part);
        let time = start.elapsed();
        if time > BAND_TIMES[1] {
            band = (band / 2).max(fewest);
        } else if time < BAND_TIMES[0] {
            band *= 2;
        }
    }
    Some(image)
}

/// Puts a part of the picture in its place.
pub(crate) fn put_rows(image: &mut Image, pixels: Range<usize>, part: &Image) {
    image.base[pixels.clone()].copy_from_slice(&part.base);
    image.scratches[pixels.clone()].copy_from_slice(&part.scratches);
    image.density[pixels.clone()].copy_from_slice(&part.density);
    image.depth_m[pixels.clone()].copy_from_slice(&part.depth_m);
    image.normal[pixels].copy_from_slice(&part.normal);
}
