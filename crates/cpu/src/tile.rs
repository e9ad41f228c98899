//! A tile of the picture: the stages from the surface to the film, for batches of its points.

mod layers;
mod shade;

use crate::bin::{TILE_PX, TileLists};
use crate::camera_beam::CameraBeam;
use crate::counts::Counts;
use crate::light_view::LightViews;
use crate::method::PointShader;
use crate::options::RenderOptions;
use crate::pixel_parts::{MOST_PARTS, pixel_parts};
use crate::prepared::Prepared;
use crate::resolve::{Pixel, Sample};
use crate::sample_point::{SamplePoint, SampleView, Shared};
use crate::shade_scratches::{BATCH, Picks, ScratchShader};
use crate::shadows::{HitBuffers, Rounds, Shadows};
use crate::share_scratches::share_scratches;
use crate::silhouettes::is_smooth;
use crate::surface::{SeenHit, surface_point};
use crate::visibility::{Visibility, center, coverage};
use glam::{DVec2, DVec3};
use hairline_image::{Image, Traced, TracedPixel};
use hairline_index::Hit;
use hairline_optics::mask::ScratchSums;
use hairline_scene::CameraFrame;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use layers::Layers;

/// Number of samples of a pixel that are shaded together and may share scratches.
const SAMPLES_AT_ONCE: usize = 16;
/// Pixels to a side.
pub(crate) const SIDE: usize = TILE_PX as usize;

/// A picture that is being rendered, shared by all of its tiles.
pub(crate) struct Picture<'a> {
    pub prepared: &'a Prepared<'a>,
    pub camera: CameraFrame,
    pub options: RenderOptions,
    pub rows: Range<usize>,
    /// Pixels that one sample is enough for are left as they are.
    pub only_edges: bool,
    pub visibility: Visibility,
    pub by: PictureMethod<'a>,
    /// Rays for shadows, if there are any.
    pub shadows: Option<Shadows<'a>>,
}

/// Method of the picture.
pub(crate) enum PictureMethod<'a> {
    /// Hairline's own.
    Tiles(TileLists),
    /// One of others, point by point.
    Other(Box<dyn PointShader + 'a>),
}

/// The buffers that a thread needs for a tile, filled anew for each.
pub(crate) struct Tile<'a> {
    picture: &'a Picture<'a>,
    /// Callback that tells whether to stop. It is called before each batch, and with shadows before each point, since its rays take
    /// long.
    cancelled: &'a (dyn Fn() -> bool + Sync),
    is_cancelled: bool,
    rays: CameraBeam,
    batch: Vec<SamplePoint<'a>>,
    /// The lights from each point of the batch.
    views: Vec<LightViews<'a>>,
    /// The lights from each part of the point in hand.
    part_views: Vec<LightViews<'a>>,
    sums: Vec<ScratchSums>,
    /// Picks of each point, if there are shadows.
    picks: Option<Vec<Picks>>,
    grating_picks: Picks,
    hit_buffers: Vec<HitBuffers<'a>>,
    shader: ScratchShader,
    pixels: Vec<Pixel>,
    pub counts: Counts,
}

impl<'a> Tile<'a> {
    pub fn new(picture: &'a Picture<'a>, cancelled: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self {
            picture,
            cancelled,
            is_cancelled: false,
            rays: CameraBeam::default(),
            batch: Vec::with_capacity(BATCH),
            views: (0..BATCH)
                .map(|_| LightViews::new(picture.prepared.scene))
                .collect(),
            part_views: (0..MOST_PARTS)
                .map(|_| LightViews::new(picture.prepared.scene))
                .collect(),
            sums: vec![ScratchSums::default(); BATCH],
            picks: picture
                .shadows
                .as_ref()
                .map(|_| (0..BATCH).map(|_| Picks::new()).collect()),
            grating_picks: Picks::new(),
            hit_buffers: picture
                .shadows
                .as_ref()
                .map_or(Vec::new(), |it| it.hit_buffers()),
            shader: ScratchShader::new(),
            pixels: vec![Pixel::default(); SIDE * SIDE],
            counts: Counts::default(),
        }
    }

    /// Renders the part of a tile that lies within the picture's rows; other pixels are `None`. Row by row. None if it was
    /// cancelled: then it renders nothing more.
    pub fn render(&mut self, column: usize, row: usize) -> Option<[Option<Sample>; SIDE * SIDE]> {
        let picture = self.picture;
        self.pixels.fill(Pixel::default());
        let (x0, y0) = (column * SIDE, row * SIDE);
        let width = picture.camera.size_px.x as usize;
        // Blocks of four by two pixels: a segment then misses more of the groups of points than it would of rows.
        for i in 0..SIDE * SIDE {
            let (block, within) = (i / 8, i % 8);
            let (x, y) = (block % 2 * 4 + within % 4, block / 2 * 2 + within / 4);
            let pixel = y * SIDE + x;
            let (x, y) = (x0 + x, y0 + y);
            if x >= width || !picture.rows.contains(&y) {
                continue;
            }
            self.add_pixel(column, row, pixel, [x, y]);
        }
        self.shade(column, row);
        let is_whole = !self.is_cancelled;
        is_whole.then(|| std::array::from_fn(|i| self.pixels[i].resolve()))
    }

    /// Renders one pixel of the picture's rows.
    pub fn render_pixel(&mut self, x: usize, y: usize) -> Sample {
        self.pixels.fill(Pixel::default());
        let pixel = y % SIDE * SIDE + x % SIDE;
        let (column, row) = (x / SIDE, y / SIDE);
        self.add_pixel(column, row, pixel, [x, y]);
        self.shade(column, row);
        self.pixels[pixel].resolve().unwrap_or_default()
    }

    /// Adds all samples of a pixel: one through its centre, or several where it has an edge.
    fn add_pixel(&mut self, column: usize, row: usize, pixel: usize, [x, y]: [usize; 2]) {
        let picture = self.picture;
        let samples = picture.options.samples.max(1);
        if samples == 1 || is_smooth(&picture.visibility, &picture.camera, x, y) {
            if picture.only_edges {
                return;
            }
            self.add(column, row, pixel, [x, y], None);
            return;
        }
        let range = picture.options.batch().range();
        for first in range.clone().step_by(SAMPLES_AT_ONCE) {
            let chunk = first..range.end.min(first + SAMPLES_AT_ONCE as u32);
            if self.batch.len() + chunk.len() > BATCH {
                self.shade(column, row);
            }
            let in_batch = self.batch.len();
            for sample in chunk {
                self.add(column, row, pixel, [x, y], Some(sample));
            }
            share_scratches(picture.prepared, &mut self.batch, in_batch, center(x, y));
        }
    }

    /// Adds a sample of a pixel: of one that has several its number.
    fn add(
        &mut self,
        column: usize,
        row: usize,
        pixel: usize,
        [x, y]: [usize; 2],
        sample: Option<u32>,
    ) {
        if self.batch.len() == BATCH {
            self.shade(column, row);
        }
        let picture = self.picture;
        let (options, render) = (&picture.options, &picture.prepared.scene.render);
        // A pixel without an edge has one sample, and the rays of all.
        let all_rounds = Rounds {
            now: options.batch(),
            all: options.samples.max(1),
        };
        let middle_px = center(x, y);
        let (at_px, samples, rounds, hit) = match sample {
            None => {
                let hit = picture.visibility.hit(x, y).copied();
                (middle_px, 1, all_rounds, hit)
            }
            Some(sample) => {
                let at_px = middle_px + render.jitter_px(sample, all_rounds.all);
                let direction = picture.camera.camera_ray(at_px).normalize();
                let triangles = &picture.prepared.triangles;
                let (camera, coverage) = (&picture.camera, coverage(x, y, sample));
                let rays = &mut self.rays;
                let hit = rays.intersect(triangles, camera, at_px, direction, coverage);
                let round = all_rounds.one(sample - all_rounds.now.first);
                (at_px, all_rounds.all, round, hit)
            }
        };
        let seen = picture.surface(at_px, samples, hit);
        let std_px = render.footprint_std_px(samples);
        self.batch.push(SamplePoint {
            pixel,
            middle_px,
            at_px,
            std_px,
            is_smooth: samples == 1 && options.samples > 1,
            rounds,
            seen,
            scratches: Shared::Among(1),
            wide: None,
        });
    }

    /// Shades the batch, unless it is cancelled, and empties it.
    fn shade(&mut self, column: usize, row: usize) {
        self.shade_unless_cancelled(column, row);
        self.batch.clear();
    }
}

impl<'a> Picture<'a> {
    /// Fills the layers of an image that is as high as there are rows. None if it was cancelled.
    pub fn render(
        &'a self,
        image: &mut Image,
        progress: &(dyn Fn(f64) + Sync),
        cancelled: &'a (dyn Fn() -> bool + Sync),
    ) -> Option<Counts> {
        let width = image.size_px[0] as usize;
        let parts = self.rows_of_tiles(image);
        let (done, all) = (AtomicUsize::new(0), parts.len());
        let is_cancelled = AtomicBool::new(false);
        // Tiles are reused: they take long to allocate, and a thread goes from one to the next.
        let unused: Mutex<Vec<Tile>> = Mutex::default();
        let render_tile = |column, row| {
            if is_cancelled.load(Ordering::Relaxed) {
                return [None; SIDE * SIDE];
            }
            let mut tile = take(&unused).unwrap_or_else(|| Tile::new(self, cancelled));
            let Some(samples) = tile.render(column, row) else {
                is_cancelled.store(true, Ordering::Relaxed);
                return [None; SIDE * SIDE];
            };
            put_back(&unused, tile);
            samples
        };
        parts.into_par_iter().for_each(|(row, mut layers)| {
            let first = self.rows.start.max(row * SIDE) - row * SIDE;
            let columns = (0..width.div_ceil(SIDE)).into_par_iter();
            let tiles: Vec<_> = columns.map(|column| render_tile(column, row)).collect();
            for i in 0..layers.len() {
                let (x, y) = (i % width, first + i / width);
                if let Some(sample) = &tiles[x / SIDE][y * SIDE + x % SIDE] {
                    layers.set(i, sample);
                }
            }
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress(done as f64 / all as f64);
        });
        if is_cancelled.into_inner() {
            return None;
        }
        let tiles = unused.into_inner().unwrap_or_default();
        let counts = tiles.iter().map(|tile| tile.counts);
        Some(counts.fold(Counts::default(), |a, b| a + b))
    }

    /// Rows of tiles, with the layers of an image that each fills.
    fn rows_of_tiles<'i>(&self, image: &'i mut Image) -> Vec<(usize, Layers<'i>)> {
        if self.shadows.is_some() && image.traced.is_none() {
            image.traced = Some(Traced {
                rounds: self.options.batch().count,
                pixels: vec![TracedPixel::default(); image.pixel_count()],
            });
        }
        let width = image.size_px[0] as usize;
        let mut layers = Layers::new(image);
        (self.rows.start / SIDE..self.rows.end.div_ceil(SIDE))
            .map(|row| {
                let height = self.rows.end.min((row + 1) * SIDE) - self.rows.start.max(row * SIDE);
                (row, layers.split_off_first(height * width))
            })
            .collect()
    }

    /// The surface under one of `samples` samples of a pixel.
    pub(crate) fn surface(&self, at_px: DVec2, samples: u32, hit: Option<Hit>) -> SampleView<'a> {
        let Prepared { scene, tables, .. } = self.prepared;
        let ray = self.camera.camera_ray(at_px);
        let direction = ray.normalize();
        let Some(hit) = hit else {
            return SampleView::Background(match &scene.environment {
                Some(environment) if environment.visible() => environment.radiance(direction),
                _ => DVec3::ZERO,
            });
        };
        let std_px = scene.render.footprint_std_px(samples);
        let depth_m = hit.distance_m / ray.length();
        let footprint = |normal| {
            let axes = self.camera.footprint_axes(ray, depth_m, normal);
            axes.map(|axis| axis * std_px)
        };
        let seen = SeenHit {
            hit: &hit,
            position_m: self.camera.position_m + ray * depth_m,
            to_viewer: -direction,
        };
        let point = surface_point(scene, tables, &seen, footprint);
        let parts = pixel_parts(self.prepared, &self.camera, &hit, &point, std_px);
        SampleView::Surface {
            hit,
            point,
            parts,
            depth_m,
        }
    }
}

fn take<T>(unused: &Mutex<Vec<T>>) -> Option<T> {
    unused.lock().ok()?.pop()
}

fn put_back<T>(unused: &Mutex<Vec<T>>, one: T) {
    if let Ok(mut unused) = unused.lock() {
        unused.push(one);
    }
}
