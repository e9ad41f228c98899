//! Share of each pixel that surfaces cover, for pictures before a transparent background.

use crate::camera_beam::CameraBeam;
use crate::silhouettes::is_smooth;
use crate::visibility::{Visibility, center, coverage};
use hairline_image::Batch;
use hairline_index::TriangleIndex;
use hairline_scene::{CameraFrame, Scene};
use rayon::prelude::*;

/// The share of each pixel that surfaces cover, from 0 to 1, row by row: of the first `done` samples of a picture that is to have
/// `samples`, by the same rays, through the lens if there is one. `triangles` are the scene's.
pub fn alpha(scene: &Scene, triangles: &TriangleIndex, done: u32, samples: u32) -> Vec<f32> {
    let size_px = scene.render.size_px;
    let (done, samples) = (done.max(1), samples.max(1));
    let all = Batch {
        first: 0,
        count: done,
    };
    if !scene.camera.has_lens() {
        return shares(scene, triangles, &scene.camera.frame(size_px), all, samples);
    }
    let batches: Vec<_> = Batch::split(samples)
        .filter(|batch| batch.first < done)
        .collect();
    let mut sums = vec![0.0; size_px[0] as usize * size_px[1] as usize];
    for batch in &batches {
        let camera = scene.camera.frame_of_batch(size_px, *batch);
        let shares = shares(scene, triangles, &camera, *batch, samples);
        let pixels = sums.iter_mut().zip(shares);
        pixels.for_each(|(sum, share)| *sum += share / batches.len() as f32);
    }
    sums
}

/// Shares of the samples of one batch, which all see the scene by one camera.
fn shares(
    scene: &Scene,
    triangles: &TriangleIndex,
    camera: &CameraFrame,
    batch: Batch,
    samples: u32,
) -> Vec<f32> {
    let [width, height] = [camera.size_px.x as usize, camera.size_px.y as usize];
    let rows = 0..height as u32;
    let seen = Visibility::new(triangles, camera, &scene.render, &rows, samples);
    let mut shares = vec![0.0; width * height];
    let pixels = shares.par_iter_mut().enumerate();
    pixels.for_each_init(CameraBeam::default, |rays, (i, share)| {
        let (x, y) = (i % width, i / width);
        if samples == 1 || is_smooth(&seen, camera, x, y) {
            *share = f32::from(u8::from(seen.hit(x, y).is_some()));
            return;
        }
        let covered = batch.range().filter(|&sample| {
            let at_px = center(x, y) + scene.render.jitter_px(sample, samples);
            let direction = camera.camera_ray(at_px).normalize();
            let coverage = coverage(x, y, sample);
            let hit = rays.intersect(triangles, camera, at_px, direction, coverage);
            hit.is_some()
        });
        *share = covered.count() as f32 / batch.count as f32;
    });
    shares
}
