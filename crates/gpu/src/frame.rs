//! The frame uniform: camera, jitter and environment of one picture sample.

use glam::{DVec3, UVec2};
use hairline_scene::camera::pixel_jitter;
use hairline_scene::{Environment, Scene};

use crate::film::Band;
use crate::layout::{ENVIRONMENT_PRESENT, ENVIRONMENT_VISIBLE, Frame};
use crate::upload::GpuScene;

/// Nearer surfaces are not drawn. With reversed floating-point depth a near plane this near costs no precision, and no
/// camera comes nearer to anything that it can show.
const NEAR_M: f32 = 1e-5;

/// The uniform for sample `sample` of `samples` of a band of a picture of `size_px`.
pub(crate) fn frame(
    scene: &Scene,
    uploaded: &GpuScene,
    size_px: [u32; 2],
    sample: u32,
    samples: u32,
    band: &Band<'_>,
) -> Frame {
    let camera = scene.camera.frame(size_px);
    let environment = scene.environment.as_ref();
    Frame {
        camera_m: vec3(camera.position_m - uploaded.origin_m()),
        pad_0: 0.0,
        forward: vec3(camera.forward),
        near_m: NEAR_M,
        per_px_x: vec3(camera.per_px_x),
        px_per_slope: (1.0 / camera.per_px_x.length()) as f32,
        per_px_y: vec3(camera.per_px_y),
        footprint_std_px: scene.render.footprint_std_px(samples) as f32,
        size_px,
        rows: UVec2::new(band.rows.start, band.rows.end).to_array(),
        jitter_px: pixel_jitter(sample, samples).as_vec2().to_array(),
        light_count: uploaded.light_count,
        environment_flags: environment.map_or(0, environment_flags),
        environment_from_world: environment.map_or_else(Default::default, environment_from_world),
        environment_sh: environment.map_or_else(Default::default, environment_sh),
        environment_texel_radiance: environment.map_or(0.0, |e| e.texel_radiance() as f32),
        sample,
        tile_chunks: band.room.tiles.chunks(),
        record_segments: band.room.tiles.record_segments(),
    }
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

fn environment_sh(environment: &Environment) -> [[f32; 4]; 9] {
    environment.irradiance_sh().map(|[r, g, b]| [r, g, b, 0.0])
}
