//! The frame uniform: camera, jitter and environment of one step of a strip.

use std::f64::consts::SQRT_2;
use std::ops::Range;

use glam::DVec3;
use hairline_image::Batch;
use hairline_scene::{Environment, RenderSettings, Scene};

use crate::bounces::Bounces;
use crate::layout::{ENVIRONMENT_PRESENT, ENVIRONMENT_VISIBLE, Frame};
use crate::passes::Shade;
use crate::shadows::Shadows;
use crate::upload::GpuScene;

/// Nearer surfaces are not drawn. With reversed floating-point depth a near plane this near costs no precision, and no
/// camera comes nearer to anything that it can show.
const NEAR_M: f32 = 1e-5;

/// Part of a picture that is shaded at a time.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub scene: &'a Scene,
    pub uploaded: &'a GpuScene,
    pub size_px: [u32; 2],
    /// 0: every pixel through its centre; later ones: samples of pixels on edges and creases.
    pub step: u32,
    /// Samples of pixels on edges.
    pub samples: u32,
    /// Batch of the samples that is taken.
    pub batch: Batch,
    pub without_shadows: bool,
}

/// Samples of a pixel that one step shades: more would take more memory than pixels through their centres.
pub(crate) const SAMPLES_AT_ONCE: u32 = 16;

impl View<'_> {
    /// Range of the samples of this step.
    pub(crate) fn step_samples(&self) -> Range<u32> {
        match self.step {
            0 => 0..1,
            _ => {
                let Range { start, end } = self.batch.range();
                let first = start + (self.step - 1) * SAMPLES_AT_ONCE;
                first..(first + SAMPLES_AT_ONCE).min(end)
            }
        }
    }
}

impl View<'_> {
    /// Shadows of the scene, if it has some and the view wants them.
    pub(crate) fn shadows(&self) -> Option<&Shadows> {
        let shadows = self.uploaded.shadows.as_ref();
        shadows.filter(|_| !self.without_shadows)
    }

    /// Light of other objects, as shadows.
    pub(crate) fn bounces(&self) -> Option<&Bounces> {
        let bounces = self.uploaded.bounces.as_ref();
        bounces.filter(|_| !self.without_shadows)
    }

    /// Rays that find something of each pixel; none without shadows.
    pub(crate) fn traced_rounds(&self) -> Option<u32> {
        let is_own = matches!(self.uploaded.passes.shade, Shade::Own { .. });
        (is_own && self.shadows().is_some()).then_some(self.batch.count)
    }

    /// Rays of each sample to each source, of all batches.
    pub(crate) fn all_rounds(&self) -> u32 {
        match self.step {
            0 => self.samples,
            _ => self.rounds().count,
        }
    }

    /// Rays of each sample to each source. A pixel without an edge has one sample, and the rays of all.
    pub(crate) fn rounds(&self) -> Batch {
        match self.step {
            0 => self.batch,
            _ => Batch::all(1),
        }
    }
}

/// Rays of each sample to each source.
#[derive(Clone, Copy)]
pub(crate) struct Rounds {
    pub now: Batch,
    /// Seed of the random numbers.
    pub seed: u32,
}

/// The uniform without what is counted on the device, for sample `sample` of a strip of `rows`, whose film begins with `film_row`.
pub(crate) fn frame(view: &View, rows: &Range<u32>, film_row: u32, sample: u32) -> Frame {
    let View {
        scene,
        uploaded,
        size_px,
        step,
        samples,
        ..
    } = *view;
    let camera = scene.camera.frame_of_batch(size_px, view.batch);
    let environment = scene.environment.as_ref();
    // Jittered samples share the pixel's filter; the one through the centre has all of it.
    let (jitter, of) = match step {
        0 => (glam::DVec2::ZERO, 1),
        _ => (scene.render.jitter_px(sample, samples), samples),
    };
    let data = &uploaded.data;
    Frame {
        camera_m: vec3(camera.position_m - data.origin_m()),
        forward: vec3(camera.forward),
        near_m: NEAR_M,
        per_px_x: vec3(camera.per_px_x),
        px_per_slope: (1.0 / camera.per_px_x.length()) as f32,
        per_px_y: vec3(camera.per_px_y),
        footprint_std_px: scene.render.footprint_std_px(of) as f32,
        size_px,
        rows: [rows.start, rows.end],
        jitter_px: jitter.as_vec2().to_array(),
        light_count: data.light_count,
        environment_flags: environment.map_or(0, environment_flags),
        environment_from_world: environment.map_or_else(Default::default, environment_from_world),
        environment_texel_radiance: environment.map_or(0.0, |e| e.texel_radiance() as f32),
        step,
        sample: sample - view.step_samples().start,
        samples: view.step_samples().len() as u32,
        film_row,
        segment_count: data.buffers.segment_count(),
        list_std_px: scene.render.footprint_std_px(1) as f32,
        list_jitter_px: match samples > 1 {
            // Along a diagonal.
            true => (SQRT_2 * scene.render.jitter_max_px()) as f32,
            false => 0.0,
        },
        halo_rows: halo_rows(scene),
        is_edge_everywhere: scene.render.outline_reach_px().is_none().into(),
        object_count: scene.objects.len() as u32,
        middle_px: camera.middle_px.as_vec2().to_array(),
        // A pixel of several samples counts as an edge where a surface covers only a part.
        coverage_round: match (step, samples) {
            (0, 2..) => u32::MAX,
            _ => sample,
        },
        sample_order: sample_order(&scene.render, view.step_samples(), samples),
        ..Frame::default()
    }
}

/// The samples of a step from the one nearest to the pixel's middle, 4 bits each.
fn sample_order(render: &RenderSettings, step: Range<u32>, samples: u32) -> [u32; 2] {
    let off = |i: &u32| render.jitter_px(step.start + i, samples).length_squared();
    let mut order: Vec<u32> = (0..step.len() as u32).collect();
    order.sort_by(|a, b| off(a).total_cmp(&off(b)));
    let mut packed = [0; 2];
    for (place, i) in order.into_iter().enumerate() {
        packed[place / 8] |= i << (4 * (place % 8));
    }
    packed
}

/// Rows above and below a strip in which outlines are looked for.
pub(crate) fn halo_rows(scene: &Scene) -> u32 {
    scene.render.outline_reach_px().unwrap_or(1)
}

fn vec3(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

fn environment_flags(environment: &Environment) -> u32 {
    ENVIRONMENT_PRESENT
        | if environment.visible() {
            ENVIRONMENT_VISIBLE
        } else {
            0
        }
}

/// Columns of the rotation, padded as WGSL pads a mat3x3f.
fn environment_from_world(environment: &Environment) -> [[f32; 4]; 3] {
    environment
        .map_from_world()
        .to_cols_array_2d()
        .map(|[x, y, z]| [x as f32, y as f32, z as f32, 0.0])
}
