//! Painting by the CPU renderer, some rows at a time.

use std::sync::Arc;

use egui::ColorImage;
use hairline_image::{Image, png};
use hairline_reference::closed_form::{Prepared, RenderOptions};

use super::frame::Picture;
use super::painter::{Easel, Shown, Step};
use super::pool;
use super::request::Order;

/// Pixels between two looks at whether something newer is wanted.
const BAND_PX: u32 = 1 << 16;

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
        let Some(image) = pool::install(|| paint(order, step, interrupted)) else {
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
    let built = &order.built;
    let mut scene = built.scene.clone();
    scene.camera = order.view.camera;
    scene.render.size_px = step.size_px;
    scene.render.filter_std_px = order.view.filter_std_px;
    let prepared = Prepared::from_parts(
        &scene,
        Arc::clone(&built.triangles),
        Arc::clone(&built.scratches),
        Arc::clone(&built.tables),
    );
    let options = RenderOptions {
        samples: step.samples,
        ..Default::default()
    };
    let [width, height] = step.size_px;
    let band = (BAND_PX / width).clamp(8, height.max(8));
    let mut image = Image::new(step.size_px);
    for first in (0..height).step_by(band as usize) {
        if interrupted() {
            return None;
        }
        let rows = first..(first + band).min(height);
        let pixels = (first * width) as usize..(rows.end * width) as usize;
        let part = prepared.render_rows(&options, rows, &|_| {});
        image.base[pixels.clone()].copy_from_slice(&part.base);
        image.scratches[pixels.clone()].copy_from_slice(&part.scratches);
        image.density[pixels.clone()].copy_from_slice(&part.density);
        image.depth_m[pixels.clone()].copy_from_slice(&part.depth_m);
        image.normal[pixels].copy_from_slice(&part.normal);
    }
    Some(image)
}
