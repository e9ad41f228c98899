//! The last refined picture, moved to where the camera is now. A coarse picture takes its detail from it, and one without rays its shadows and
//! reflections, until they have their own (W. Mark, L. McMillan, G. Bishop, *Post-Rendering 3D Warping*, 1997).

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
use warp::{Place, Warp, is_same_depth};

mod cells;
mod warp;

/// Pixels of a picture in motion at most: two cores move so many in some 15 ms.
const MOST_PX: f64 = 200_000.0;
/// Pixels to a side over which light is averaged where single pixels tell too little.
const BLOCK_PX: u32 = 8;
/// Surfaces whose normals differ by a smaller cosine from one coarse pixel to the next are seen there by chance.
const EVEN_COS: f32 = 0.95;

/// A picture with all pixels and all scratches.
pub(super) struct Remembered {
    built: Weak<Built>,
    triangles: Weak<TriangleIndex>,
    scratches: Weak<ScratchIndex>,
    camera: CameraFrame,
    places: Vec<Place>,
    pixels: Vec<Pixel>,
    /// Whether it has shadows and reflections.
    has_rays: bool,
}

#[derive(Clone, Copy)]
struct Pixel {
    base: Layer,
    scratches: Layer,
    /// The share of its light that a display shows.
    tone: f32,
}

/// The light of a layer. Linear Rec.709 radiance.
#[derive(Clone, Copy, Default)]
struct Layer {
    /// By the closed form.
    open: Vec3,
    /// With shadows and reflections.
    shown: Vec3,
}

impl Layer {
    /// The closed form of another picture with the shadows and reflections of this one.
    fn shade(&self, open: Vec3) -> Vec3 {
        changed(open, self.open, self.shown)
    }
}

impl Remembered {
    /// Keeps a picture of an order: `open` has its closed forms, `shown` its shadows and reflections too, if there are some.
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
            Place::new(&camera, at_px, shown.depth_m[i])
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

    /// Whether it shows the same surfaces with the same scratches, from wherever and in whatever light.
    pub fn is_of(&self, order: &Order) -> bool {
        let built = &order.built;
        self.triangles.ptr_eq(&Arc::downgrade(&built.triangles))
            && self.scratches.ptr_eq(&Arc::downgrade(&built.scratches))
    }

    /// Whether its shadows and reflections are those of an order, too.
    fn has_rays_of(&self, order: &Order) -> bool {
        let transport = order.view.transport;
        self.has_rays && transport.shadows && self.built.ptr_eq(&Arc::downgrade(&order.built))
    }

    /// A coarse picture with the detail, shadows and reflections of this one; none where the coarse one is as fine as what it would become.
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
        let changes = self.changes(coarse, &warp, &means);
        let has_rays = self.has_rays_of(order);
        let means = means.filled();
        let light = (0..warp.pixels.len()).into_par_iter().map(|i| {
            let at = warp.place(i);
            let [base_before, base, scratches_before, scratches] = changes.at(at);
            let (pixel, base, scratches) = match self.pixels.get(warp.pixels[i]) {
                Some(pixel) => (
                    *pixel,
                    changed(pixel.base.open, base_before, base),
                    changed(pixel.scratches.open, scratches_before, scratches),
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

    /// A picture of closed forms that has all pixels, with the shadows and reflections of this one; none where it has none, or those of other light.
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
            // Other scratches glint than did.
            *scratches = mean.scratches.shade((*scratches).into()).into();
        });
        Some(image)
    }

    /// The light of base and scratches that each pixel of a coarse picture had and has, without rays.
    fn changes(
        &self,
        coarse: &Image,
        warp: &Warp,
        means: &Cells<Option<[Vec3; 4]>>,
    ) -> Cells<[Vec3; 4]> {
        let light =
            |layer: &[[f32; 3]]| -> Vec<Vec3> { layer.iter().map(|it| (*it).into()).collect() };
        let (base, scratches) = (light(&coarse.base), light(&coarse.scratches));
        let before =
            |i: usize| means.values[i].map_or(scratches[i], |it| Pixel::mean(it).scratches.open);
        // Few scratches stand for all.
        let scratches_before = Cells::new(coarse.size_px, before).smooth().smooth();
        let scratches_now = Cells::new(coarse.size_px, |i| scratches[i]);
        let scratches_now = scratches_now.without_spikes().smooth().smooth();
        let middles = Cells::new(coarse.size_px, |_| ());
        let base_before = Cells::new(coarse.size_px, |i| {
            // Of the same point: a mean would have other surfaces in it. What is a rim in the coarse picture is seen by chance.
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

    /// The mean light in each of so many parts of the picture, as [`Pixel::mean`] takes it; none where nothing is known.
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
    /// Of mean light: of the base and the scratches, each by the closed form and as it was shown.
    fn mean([base, base_shown, scratches, scratches_shown]: [Vec3; 4]) -> Self {
        let layer = |open, shown| Layer { open, shown };
        Self {
            base: layer(base, base_shown),
            scratches: layer(scratches, scratches_shown),
            tone: 1.0,
        }
    }
}

/// Whether the pixels beside one see a surface that goes on.
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

/// A value that changes as another one does: it falls by the same factor and grows by the same difference. So nothing bright is made of what was
/// nearly black.
fn changed(value: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let factor = Vec3::select(from.cmpgt(Vec3::ZERO), to / from, Vec3::ONE);
    value * factor.clamp(Vec3::ZERO, Vec3::ONE) + (to - from).max(Vec3::ZERO)
}

#[cfg(test)]
mod tests;
