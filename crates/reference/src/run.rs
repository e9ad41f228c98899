//! Pixels, batch by batch.

use crate::integrator::Integrator;
use crate::path::Light;
use crate::random::{BATCH_SAMPLES, Purpose, Random};
use crate::wavelengths::Wavelengths;
use glam::{DVec2, DVec3};
use hairline_cpu::surface::{SeenHit, surface_point};
use hairline_image::{Image, Noise, add_batch};
use hairline_scene::camera::lens_point_at;
use rayon::prelude::*;
use spec_math::cephes64::ndtri;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Counts the changes that make samples worth something else: pictures of different revisions must not be added up. Raise it with
/// every change to the model, to what is drawn, or to the order of random numbers.
pub const REVISION: u32 = 4;

impl Integrator<'_> {
    /// An image without samples, to hand to [`Integrator::run`]: depth and normal alone, those of each pixel's middle.
    pub fn start(&self) -> Image {
        let mut image = Image::new(self.size_px());
        image.noise = Some(Noise::new(image.size_px, BATCH_SAMPLES));
        let (width, first) = (image.size_px[0] as usize, self.first_pixel());
        let layers = (&mut image.depth_m, &mut image.normal);
        layers
            .into_par_iter()
            .enumerate()
            .for_each(|(i, (depth_m, normal))| {
                let middle = middle(first + i, width);
                let ray = self.camera.camera_ray(middle);
                let direction = ray.normalize();
                if let Some(hit) = self.triangles.intersect(self.camera.position_m, direction) {
                    let seen = SeenHit {
                        hit: &hit,
                        position_m: self.camera.position_m + direction * hit.distance_m,
                        to_viewer: -direction,
                    };
                    let no_footprint = |_| [DVec3::ZERO; 2];
                    let point = surface_point(self.scene, &self.tables, &seen, no_footprint);
                    *depth_m = (hit.distance_m / ray.length()) as f32;
                    *normal = point.normal.as_vec3().to_array();
                }
            });
        image
    }

    /// Adds batches to the pixels of `image` until each has at least `samples`, all cores at work. `image` is from
    /// [`Integrator::start`] or an earlier run with the same scene and settings.
    ///
    /// `observe` is told the share that is done, from any thread, many times a second; when it answers
    /// [`ControlFlow::Break`], the batches in progress are finished and `run` returns Break. `image` is then a valid
    /// picture: some pixels may have more batches than others, and none at all where the first round was cut short, all over the picture.
    ///
    /// # Panics
    /// If `image` has another size than the scene, or the rows of [`Integrator::of_rows`], or no noise, or batches of another size.
    pub fn run(
        &self,
        image: &mut Image,
        samples: u32,
        observe: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
    ) -> ControlFlow<()> {
        assert_eq!(image.size_px, self.size_px(), "an image of another size");
        let noise = image.noise.as_ref().expect("an image with noise");
        assert_eq!(noise.batch, BATCH_SAMPLES, "batches of another size");
        let target = samples.div_ceil(BATCH_SAMPLES);
        let batches = |samples: u32| u64::from((samples / BATCH_SAMPLES).min(target));
        let total = u64::from(target) * image.pixel_count() as u64;
        let done = AtomicU64::new(noise.samples.iter().map(|n| batches(*n)).sum());
        let fewest = noise.samples.iter().map(|n| n / BATCH_SAMPLES).min();
        let stop = AtomicBool::new(false);
        let report = |more: u64| {
            let done = done.fetch_add(more, Ordering::Relaxed) + more;
            if observe(done as f64 / total.max(1) as f64).is_break() {
                stop.store(true, Ordering::Relaxed);
            }
        };
        // Rounds go over the whole picture, so that a stopped run is noisy everywhere rather than finished in a part. Each round
        // ends in idle cores: rounds grow until that is a small part of them.
        let mut round = Round {
            up_to: fewest.unwrap_or(target),
            batches: 1,
        };
        while round.up_to < target && !stop.load(Ordering::Relaxed) {
            round.up_to = (round.up_to + round.batches).min(target);
            let start = Instant::now();
            self.run_round(image, round.up_to, &report, &stop);
            if start.elapsed() < ROUND_LEAST {
                round.batches *= 2;
            }
        }
        if stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Brings every pixel to `up_to` batches.
    fn run_round(
        &self,
        image: &mut Image,
        up_to: u32,
        report: &(dyn Fn(u64) + Sync),
        stop: &AtomicBool,
    ) {
        let (width, first) = (image.size_px[0] as usize, self.first_pixel());
        let noise = image.noise.as_mut().expect("checked by the caller");
        let chunks = (
            image.base.par_chunks_mut(CHUNK_PX),
            image.scratches.par_chunks_mut(CHUNK_PX),
            image.density.par_chunks_mut(CHUNK_PX),
            noise.samples.par_chunks_mut(CHUNK_PX),
            noise.beauty.par_chunks_mut(CHUNK_PX),
            noise.base.par_chunks_mut(CHUNK_PX),
            noise.scratches.par_chunks_mut(CHUNK_PX),
            noise.density.par_chunks_mut(CHUNK_PX),
        );
        // All over the picture from the start: one that is stopped in its first round has no part without samples.
        let mut chunks: Vec<_> = chunks.into_par_iter().enumerate().map(Some).collect();
        let order: Vec<_> = scattered(chunks.len())
            .filter_map(|chunk| chunks[chunk].take())
            .collect();
        order.into_par_iter().for_each(|(chunk, pixels)| {
            let (base, scratches, density, samples, v_beauty, v_base, v_scratches, v_density) =
                pixels;
            for i in 0..base.len() {
                let pixel = first + chunk * CHUNK_PX + i;
                let place = middle(pixel, width);
                while samples[i] / BATCH_SAMPLES < up_to && !stop.load(Ordering::Relaxed) {
                    let batch = samples[i] / BATCH_SAMPLES;
                    let light = self.batch(pixel as u64, place, batch);
                    let mut beauty = sum(base[i], scratches[i]);
                    add_batch(&mut beauty, &mut v_beauty[i], light.total().into(), batch);
                    add_batch(&mut base[i], &mut v_base[i], light.base.into(), batch);
                    add_batch(
                        &mut scratches[i],
                        &mut v_scratches[i],
                        light.scratches.into(),
                        batch,
                    );
                    add_batch(
                        &mut density[i],
                        &mut v_density[i],
                        light.density.into(),
                        batch,
                    );
                    samples[i] = (batch + 1) * BATCH_SAMPLES;
                    report(1);
                }
            }
        });
    }

    /// Number of pixels of the picture before the image.
    fn first_pixel(&self) -> usize {
        self.rows.start as usize * self.scene.render.size_px[0] as usize
    }

    /// The mean of a batch of samples.
    fn batch(&self, pixel: u64, middle: DVec2, batch: u32) -> Light {
        let mut light = Light::default();
        for sample in 0..BATCH_SAMPLES {
            let random = Random::new(self.settings.seed, pixel, batch, sample);
            let [x, y, w, _] = random.four(Purpose::Camera);
            let std = self.scene.render.filter_std_px;
            let place = middle + std * DVec2::new(ndtri(x), ndtri(y));
            let lens = &self.scene.camera.lens;
            let camera = match lens.radius_m > 0.0 {
                true => {
                    let [u, v, ..] = random.four(Purpose::Lens);
                    let point = lens_point_at(DVec2::new(u, v));
                    self.camera.through_lens(lens, point)
                }
                false => self.camera,
            };
            let direction = camera.camera_ray(place).normalize();
            let wavelengths = Wavelengths::new(&self.scene.observer, w);
            let one = self.arrive(camera.position_m, direction, &wavelengths, random);
            light.base += one.base;
            light.scratches += one.scratches;
            light.density += one.density;
        }
        let share = 1.0 / f64::from(BATCH_SAMPLES);
        Light {
            base: share * light.base,
            scratches: share * light.scratches,
            density: share * light.density,
        }
    }
}

/// Numbers below `count`, each once: neighbours are far from one another.
fn scattered(count: usize) -> impl Iterator<Item = usize> {
    // Near the golden ratio, which leaves no part out for long.
    let nearest = (0.618 * count as f64).round() as usize;
    let stride = (nearest.max(1)..).find(|stride| gcd(*stride, count) == 1);
    let stride = stride.unwrap_or(1) as u64;
    (0..count as u64).map(move |i| (i * stride % count as u64) as usize)
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Progress of a run, and the number of batches in the next step.
struct Round {
    up_to: u32,
    batches: u32,
}

/// Number of pixels that a thread takes at a time.
const CHUNK_PX: usize = 16;

/// Rounds shorter than this are made longer.
const ROUND_LEAST: Duration = Duration::from_secs(1);

/// Middle of a pixel, given its index in a picture of this width.
fn middle(pixel: usize, width: usize) -> DVec2 {
    DVec2::new((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5)
}

fn sum(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|c| a[c] + b[c])
}
