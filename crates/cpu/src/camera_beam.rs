//! Hits of the camera's rays through neighbouring pixels.

use glam::{DVec2, DVec3};
use hairline_index::{Coverage, Hit, TriangleBeam, TriangleIndex};
use hairline_scene::CameraFrame;

/// The triangles under a few pixels of a row. One for each thread and picture, aimed anew where a ray leaves it: pixels come row by
/// row.
#[derive(Default)]
pub(crate) struct CameraBeam {
    beam: TriangleBeam,
    /// Block of pixels at which it is aimed.
    block: Option<[i64; 2]>,
}

/// Pixels of a row to a beam.
const BLOCK_PX: f64 = 16.0;

impl CameraBeam {
    /// Returns the nearest hit of the ray through a point of the picture; `direction` is its unit direction, and `coverage` the rule
    /// for surfaces that cover a part of what lies behind them. Scene and camera are the same for all calls.
    pub fn intersect(
        &mut self,
        triangles: &TriangleIndex,
        camera: &CameraFrame,
        pixel: DVec2,
        direction: DVec3,
        coverage: Coverage,
    ) -> Option<Hit> {
        let size = DVec2::new(BLOCK_PX, 1.0);
        let block = (pixel / size).floor();
        let index = [block.x as i64, block.y as i64];
        if self.block != Some(index) {
            let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
                .map(|(x, y)| camera.camera_ray((block + DVec2::new(x, y)) * size));
            self.beam.aim(triangles, camera.position_m, corners);
            self.block = Some(index);
        }
        self.beam
            .intersect(triangles, camera.position_m, direction, coverage)
    }
}
