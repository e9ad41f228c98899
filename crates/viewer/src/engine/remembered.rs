//! The last refined picture, reprojected to the current camera. A coarse picture takes its detail from it, and a picture without rays takes its
//! shadows and reflections, until it has its own (W. Mark, L. McMillan, G. Bishop, *Post-Rendering 3D Warping*, 1997).

use std::sync::{Arc, Weak};

use glam::{DVec2, Vec3};
use hairline_image::Image;
use hairline_index::{ScratchIndex, TriangleIndex};
use hairline_scene::camera::CameraFrame;
use rayon::prelude::*;

use super::Built;
use super::pace::scaled;
use super::request::Order;
use cells::Cells;
use warp::{SurfacePosition, Warp, is_same_depth};

mod cells;
mod warp;

/// Largest number of pixels of a picture in motion: two cores reproject so many in some 15 ms.
const MOST_PX: f64 = 200_000.0;
/// Side in pixels of the blocks over which light is averaged where single pixels are missing or too noisy.
const BLOCK_PX: u32 = 8;
/// Least cosine between the normals of neighbouring coarse pixels on one surface: below it the pixel sees the surface only by chance.
const EVEN_COS: f32 = 0.95;

/// A finished picture, of at least a quarter of the width of the view.
pub(super) struct Remembered {
    built: Weak<Built>,
    triangles: Weak<TriangleIndex>,
    scratches: Weak<ScratchIndex>,
    camera: CameraFrame,
    places: Vec<SurfacePosition>,
    pixels: Vec<Pixel>,
    /// Whether `shown` includes shadows and reflections.
    has_rays: bool,
}

#[derive(Clone, Copy)]
struct Pixel {
    base: Layer,
    scratches: Layer,
    /// Share of the pixel's light that a display shows.
    tone: f32,
}

/// Light of a layer, linear Rec.709 radiance.
#[derive(Clone, Copy, Default)]
struct Layer {
    /// Light by the closed form.
    open: Vec3,
    /// Light with shadows and reflections.
    shown: Vec3,
}

impl Layer {
    /// Applies the shadows and reflections of this picture to the closed form `open` of another.
    fn shade(&self, open: Vec3) -> Vec3 {
        changed(open, self.open, self.shown)
    }
}

impl Remembered {
    /// Stores a picture of an order: `open` has its closed forms, `shown` also its shadows and reflections, if it has any.
    pub fn new(order: &Order, open: &Image, shown: Option<&Image>) -> Self {
        let has_rays = shown.is_some();
        let shown = shown.unwrap_or(open);
        let camera = order.view.camera.frame(shown.size_px);
        let width = shown.size_px[0] as usize;
        let layer = |open: [f32; 3], shown: [f32; 3]| Layer {
            open: open.into(),
            shown: shown.into(),
        };
        let count = 0..shown.pixel_count();
        let places = count.clone().into_par_iter().map(|i| {
            let at_px = DVec2::new((i % width) as f64, (i / width) as f64) + 0.5;
            SurfacePosition::new(&camera, at_px, shown.depth_m[i])
        });
        let pixels = count.into_par_iter().map(|i| Pixel {
            base: layer(open.base[i], shown.base[i]),
            scratches: layer(open.scratches[i], shown.scratches[i]),
            tone: (shown.tones.as_ref()).map_or(1.0, |it| it.pixels[i].share(it.gain)),
        });
        Self {
            built: Arc::downgrade(&order.built),
            triangles: Arc::downgrade(&order.built.triangles),
            scratches: Arc::downgrade(&order.built.scratches),
            places: places.collect(),
            pixels: pixels.collect(),
            camera,
            has_rays,
        }
    }

    /// Whether the picture shows the same surfaces, from any camera, in any light and with any scratches.
    pub fn is_of(&self, order: &Order) -> bool {
        let triangles = Arc::downgrade(&order.built.triangles);
        self.triangles.ptr_eq(&triangles)
    }

    /// Whether the picture shows the same scratches, too.
    fn has_scratches_of(&self, order: &Order) -> bool {
        let scratches = Arc::downgrade(&order.built.scratches);
        self.scratches.ptr_eq(&scratches)
    }

    /// Whether the picture's shadows and reflections are right for an order, too.
    fn has_rays_of(&self, order: &Order) -> bool {
        let transport = order.view.transport;
        self.has_rays && transport.shadows && self.built.ptr_eq(&Arc::downgrade(&order.built))
    }

    /// Adds the detail, shadows and reflections of this picture to a coarse one; none if the coarse one has as many pixels as the result would have.
    pub fn sharpen(&self, coarse: &Image, order: &Order) -> Option<Image> {
        let full_px = order.view.size_px;
        let count = f64::from(full_px[0]) * f64::from(full_px[1]);
        let size_px = scaled(full_px, (MOST_PX / count).sqrt().min(1.0));
        if size_px[0] <= coarse.size_px[0] {
            return None;
        }
        let warp = Warp::new(
            &self.places,
            &self.camera,
            &order.view.camera.frame(size_px),
        );
        let means = self.means(coarse.size_px, &warp);
        let has_scratches = self.has_scratches_of(order);
        let changes = self.changes(coarse, &warp, &means, has_scratches);
        let has_rays = self.has_rays_of(order);
        let means = means.filled();
        let light = (0..warp.pixels.len()).into_par_iter().map(|i| {
            let at = warp.place(i);
            let [base_before, base, scratches_before, scratches] = changes.at(at);
            let (pixel, base, scratches) = match self.pixels.get(warp.pixels[i]) {
                Some(pixel) => (
                    *pixel,
                    changed(pixel.base.open, base_before, base),
                    match has_scratches {
                        true => changed(pixel.scratches.open, scratches_before, scratches),
                        false => scratches,
                    },
                ),
                None => (Pixel::mean(means.at(at)), base, scratches),
            };
            let light = match has_rays {
                true => [pixel.base.shade(base), pixel.scratches.shade(scratches)],
                false => [base, scratches],
            };
            let [base, scratches] = light.map(|light| (pixel.tone * light).to_array());
            (base, scratches)
        });
        let (base, scratches) = light.unzip();
        Some(Image {
            base,
            scratches,
            ..Image::new(size_px)
        })
    }

    /// Adds the shadows and reflections of this picture to one of closed forms at full resolution; none if this picture has none, or if they are of
    /// other light.
    pub fn shade(&self, open: &Image, order: &Order) -> Option<Image> {
        if !self.has_rays_of(order) {
            return None;
        }
        let camera = order.view.camera.frame(open.size_px);
        let mut warp = Warp::new(&self.places, &self.camera, &camera);
        warp.keep_those_at(&open.depth_m);
        let blocks = open.size_px.map(|side| side.div_ceil(BLOCK_PX));
        let means = self.means(blocks, &warp).filled();
        let mut image = open.clone();
        let layers = image.base.par_iter_mut().zip(&mut image.scratches);
        layers.enumerate().for_each(|(i, (base, scratches))| {
            let mean = Pixel::mean(means.at(warp.place(i)));
            let pixel = self.pixels.get(warp.pixels[i]).unwrap_or(&mean);
            *base = pixel.base.shade((*base).into()).into();
            // Scratches that glint now are not those that glinted before.
            *scratches = mean.scratches.shade((*scratches).into()).into();
        });
        Some(image)
    }

    /// Light of base and scratches, without rays, at each pixel of a coarse picture: before and now.
    fn changes(
        &self,
        coarse: &Image,
        warp: &Warp,
        means: &Cells<Option<[Vec3; 4]>>,
        has_scratches: bool,
    ) -> Cells<[Vec3; 4]> {
        let light =
            |layer: &[[f32; 3]]| -> Vec<Vec3> { layer.iter().map(|it| (*it).into()).collect() };
        let (base, scratches) = (light(&coarse.base), light(&coarse.scratches));
        let before =
            |i: usize| means.values[i].map_or(scratches[i], |it| Pixel::mean(it).scratches.open);
        // A coarse picture has few scratches, which stand for all.
        let scratches_before = Cells::new(coarse.size_px, before).smooth().smooth();
        let scratches_now = Cells::new(coarse.size_px, |i| scratches[i]);
        let scratches_now = match has_scratches {
            true => scratches_now.without_spikes().smooth().smooth(),
            false => scratches_now,
        };
        let middles = Cells::new(coarse.size_px, |_| ());
        let base_before = Cells::new(coarse.size_px, |i| {
            // Light of the same point, since a mean would include other surfaces. A rim in the coarse picture is seen only by chance.
            let at = warp.pixel_at(middles.middle(i));
            let is_same = is_same_depth(warp.depth_m[at], coarse.depth_m[i]) && is_even(coarse, i);
            let before = self.pixels.get(warp.pixels[at]).filter(|_| is_same);
            before.map_or(base[i], |it| it.base.open)
        });
        let gain = Cells::new(coarse.size_px, |i| base[i] - base_before.values[i]);
        let gain = gain.without_spikes();
        Cells::new(coarse.size_px, |i| {
            let before = base_before.values[i];
            [
                before,
                before + gain.values[i],
                scratches_before.values[i],
                scratches_now.values[i],
            ]
        })
    }

    /// Mean light in each of `parts` blocks of the picture, as [`Pixel::mean`] takes it; none where no pixel is known.
    fn means(&self, parts: [u32; 2], warp: &Warp) -> Cells<Option<[Vec3; 4]>> {
        let mut sums = Cells::new(parts, |_| ([Vec3::ZERO; 4], 0));
        for (i, pixel) in warp.pixels.iter().enumerate() {
            if let Some(Pixel {
                base, scratches, ..
            }) = self.pixels.get(*pixel)
            {
                let (sum, count) = sums.get_mut(warp.place(i));
                let added = [base.open, base.shown, scratches.open, scratches.shown];
                for (sum, added) in sum.iter_mut().zip(added) {
                    *sum += added;
                }
                *count += 1;
            }
        }
        Cells::new(parts, |i| {
            let (sum, count) = sums.values[i];
            (count > 0).then(|| sum.map(|it| it / count as f32))
        })
    }
}

impl Pixel {
    /// Makes a pixel from mean light: of the base and of the scratches, each by the closed form and as shown.
    fn mean([base, base_shown, scratches, scratches_shown]: [Vec3; 4]) -> Self {
        let layer = |open, shown| Layer { open, shown };
        Self {
            base: layer(base, base_shown),
            scratches: layer(scratches, scratches_shown),
            tone: 1.0,
        }
    }
}

/// Whether a pixel and its neighbours see one continuous surface.
fn is_even(coarse: &Image, i: usize) -> bool {
    let [width, height] = coarse.size_px.map(|side| side as usize);
    let (x, y) = (i % width, i / width);
    let beside = [
        (x > 0).then(|| i - 1),
        (x + 1 < width).then(|| i + 1),
        (y > 0).then(|| i - width),
        (y + 1 < height).then(|| i + width),
    ];
    beside.into_iter().flatten().all(|j| {
        let [own, other] = [i, j].map(|i| Vec3::from(coarse.normal[i]));
        own == other || own.dot(other) > EVEN_COS
    })
}

/// Changes a value as another one changes from `from` to `to`: by the same factor if that falls, by the same difference if that grows. A factor for
/// growth would make something bright of a nearly black value.
fn changed(value: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let factor = Vec3::select(from.cmpgt(Vec3::ZERO), to / from, Vec3::ONE);
    value * factor.clamp(Vec3::ZERO, Vec3::ONE) + (to - from).max(Vec3::ZERO)
}

#[cfg(test)]
mod tests;
