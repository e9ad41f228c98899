//! Error of each cell's picture, so that nobody buys speed with error.
//!
//! The truth is the separable Monte Carlo with the energy mask, for every method: what scratches do to light does not depend on how
//! it is computed. It is sampled on a crop of the picture with pixels of the same size; without anti-aliasing it is that of points,
//! with it that of the Gaussian whose variance the square pixel has.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use glam::DVec2;
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_gpu::Error;
use hairline_image::metrics::{BeyondNoise, Estimate, away_from_silhouettes};
use hairline_image::{Image, Layer, Layers};
use hairline_reference::{Integrator, Settings};
use hairline_scene::{LightShape, Scene};

use super::figures::CellError;
use super::worker::{Ready, Worker};

/// Cost of a reference.
#[derive(Clone, Copy, Debug)]
pub struct Accuracy {
    pub crop_px: [u32; 2],
    /// Time for sampling one reference.
    pub time: Duration,
}

impl Accuracy {
    /// Size of the measured part of the picture.
    pub fn crop_of(&self, scene: &Scene) -> [u32; 2] {
        [0, 1].map(|i| self.crop_px[i].min(scene.render.size_px[i].div_ceil(2)))
    }
}

/// Pixels as small as points, in pixels.
const POINT_STD_PX: f64 = 1e-3;
/// Neighbouring depths that differ by more than this part of themselves are a silhouette.
const SILHOUETTE_DEPTH: f32 = 0.2;
/// Samples between two looks at the clock.
const SAMPLES_LEAST: u32 = 128;
const SAMPLES_MOST: u32 = 1 << 16;
/// Known well enough, relative to the reference.
const GOAL: f64 = 0.002;

/// The part of the picture about `middle`, in pixels as large as the picture's own.
pub fn crop(scene: &Scene, middle: DVec2, crop_px: [u32; 2], antialiasing: bool) -> Scene {
    let mut crop = scene.clone();
    crop.camera = scene.camera.crop(scene.render.size_px, middle, crop_px);
    crop.render.size_px = crop_px;
    if !antialiasing {
        crop.render.filter_std_px = POINT_STD_PX;
    }
    crop
}

/// The errors of some methods on a crop, each as `hairline_scene` makes it; None for a method that cannot be had, or where no scratch is lit.
pub fn errors(
    worker: &mut Worker,
    crop: &Scene,
    ready: &[&Result<Ready, Error>],
    accuracy: &Accuracy,
) -> Vec<Option<CellError>> {
    // A device has its own.
    let prepared = worker.adapter().is_none().then(|| Prepared::new(crop));
    let images: Vec<Option<Image>> = ready
        .iter()
        .map(|ready| {
            worker
                .image(crop, prepared.as_ref(), ready.as_ref().ok()?)
                .ok()
        })
        .collect();
    let Some(first) = images.iter().flatten().next() else {
        return images.iter().map(|_| None).collect();
    };
    let reference = reference(crop, first, accuracy.time);
    images
        .iter()
        .map(|image| compared(image.as_ref()?, &reference))
        .collect()
}

/// Sampled for some time, or until the error of `image` is known well enough.
fn reference(scene: &Scene, image: &Image, time: Duration) -> Image {
    let integrator = Integrator::new(scene, Settings::default());
    let mut reference = integrator.start();
    let start = Instant::now();
    let mut samples = SAMPLES_LEAST;
    while samples <= SAMPLES_MOST {
        let end = integrator.run(&mut reference, samples, &|_| {
            // Every pixel needs a variance, whatever it takes.
            if samples > SAMPLES_LEAST && start.elapsed() > time {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        let known = compared(image, &reference).is_none_or(|e| e.standard_error < GOAL);
        if known || end.is_break() || start.elapsed() > time {
            break;
        }
        samples *= 2;
    }
    reference
}

/// Compares the scratches; none if the reference's are black.
fn compared(image: &Image, reference: &Image) -> Option<CellError> {
    let mask = away_from_silhouettes(image, reference, SILHOUETTE_DEPTH);
    let (a, b) = (Layers::from(image), Layers::from(reference));
    let (a, b) = (a.estimate(Layer::Scratches)?, b.estimate(Layer::Scratches)?);
    let beyond = BeyondNoise::compare(&a, &b, Some(&mask))?;
    if !(beyond.reference_rms > 0.0) {
        return None;
    }
    let [low, high] = beyond.relative_rms_within(1.0);
    let relative_rms = beyond.relative_rms();
    let standard_error = if beyond.mean_square > 0.0 {
        (high - relative_rms).max(relative_rms - low)
    } else {
        // Error that could be there without being found.
        beyond.mean_square_error.sqrt() / beyond.reference_rms
    };
    let noise = reference.noise.as_ref();
    Some(CellError {
        relative_rms,
        standard_error,
        mean_ratio: sum(&a, &mask) / sum(&b, &mask),
        crop_px: reference.size_px,
        samples: noise.map_or(0, |n| n.samples.iter().copied().min().unwrap_or(0)),
    })
}

fn sum(estimate: &Estimate, mask: &[bool]) -> f64 {
    let counted = estimate.values.iter().zip(mask).filter(|(_, m)| **m);
    counted
        .flat_map(|(value, _)| value.iter())
        .filter(|v| v.is_finite())
        .map(|v| f64::from(*v))
        .sum()
}

/// Finds the place where the rim of the first lamp is mirrored on the right of the picture's middle, in parts of its width and height: light
/// and dark, strong scratches and weak ones side by side. For surfaces in the plane z = 0.
pub fn rim_of_reflection(scene: &Scene) -> DVec2 {
    const MIDDLE: DVec2 = DVec2::splat(0.5);
    let Some(lamp) = scene.lights.first() else {
        return MIDDLE;
    };
    let (center_m, bound_m) = lamp.bounding_sphere();
    let radius_m = match lamp.shape {
        LightShape::Sphere { radius_m, .. } => radius_m,
        // The circle within it, about.
        _ => 0.5 * bound_m,
    };
    let frame = scene.camera.frame(scene.render.size_px);
    let inside = |x: f64| {
        let ray = frame.camera_ray(DVec2::new(x, 0.5) * frame.size_px);
        let point_m = frame.position_m - ray * (frame.position_m.z / ray.z);
        let mirrored = ray.with_z(-ray.z).normalize();
        let to_lamp = center_m - point_m;
        mirrored.angle_between(to_lamp) < (radius_m / to_lamp.length()).min(1.0).asin()
    };
    let (mut low, mut high) = (0.5, 1.0);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if inside(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    MIDDLE.with_x(low.min(0.9))
}

/// Finds the place where scratches shine most, in parts of the picture's width and height.
pub fn brightest(scene: &Scene, crop_px: [u32; 2]) -> DVec2 {
    // A look at a small picture is enough: pixels four times as large.
    const COARSE: u32 = 4;
    let mut small = scene.clone();
    small.render.size_px = scene.render.size_px.map(|px| px.div_ceil(COARSE));
    let image = Prepared::new(&small).render(&RenderOptions::default(), &|_| {});
    let [width, height] = small.render.size_px;
    let block = [0, 1].map(|i| crop_px[i].div_ceil(COARSE).min(small.render.size_px[i]));
    let mut best = (f64::NEG_INFINITY, DVec2::splat(0.5));
    let steps = |size: u32, block: u32| (0..=size - block).step_by((block as usize / 2).max(1));
    for y in steps(height, block[1]) {
        for x in steps(width, block[0]) {
            let rows = (y..y + block[1]).map(|row| image.index(x, row));
            let sum: f64 = rows
                .flat_map(|first| &image.scratches[first..first + block[0] as usize])
                .map(|rgb| f64::from(rgb[1]))
                .sum();
            if sum > best.0 {
                let middle = DVec2::new(f64::from(x), f64::from(y))
                    + 0.5 * DVec2::new(f64::from(block[0]), f64::from(block[1]));
                let size = DVec2::new(f64::from(width), f64::from(height));
                best = (sum, middle / size);
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::super::stage::{Lamps, Stage};
    use super::*;
    use hairline_image::Noise;

    #[test]
    fn the_rim_is_beside_the_middle_and_in_the_picture() {
        for lamps in [Lamps::Sphere, Lamps::Triangle] {
            for zoom in [0.5, 1.0, 2.0] {
                let stage = Stage {
                    lamps,
                    zoom,
                    scratches: 1,
                    ..Stage::default()
                };
                let scene = stage.build().unwrap_or_else(|error| panic!("{error}"));
                let at = rim_of_reflection(&scene);
                assert!((0.53..0.8).contains(&at.x), "{lamps:?} {zoom}: {at}");
            }
        }
    }

    #[test]
    fn an_error_is_seen_and_noise_is_none() {
        let picture = |value: f32| {
            let mut image = Image::new([32, 32]);
            image.depth_m.fill(1.0);
            image.scratches.fill([value; 3]);
            image
        };
        let mut reference = picture(1.0);
        let mut noise = Noise::new([32, 32], 64);
        noise.samples.fill(64 * 64);
        noise.scratches.fill([0.01; 3]);
        reference.noise = Some(noise);
        for (i, pixel) in reference.scratches.iter_mut().enumerate() {
            *pixel = [if i % 2 == 0 { 1.1 } else { 0.9 }; 3];
        }
        let right = compared(&picture(1.0), &reference).unwrap();
        assert!(right.relative_rms <= right.standard_error, "{right:?}");
        let wrong = compared(&picture(1.2), &reference).unwrap();
        assert!((wrong.relative_rms - 0.2).abs() < 3.0 * wrong.standard_error);
        assert!((wrong.mean_ratio - 1.2).abs() < 1e-6);
        assert!(compared(&picture(1.0), &picture(0.0)).is_none());
    }
}
