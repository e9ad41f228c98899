//! The surface that a camera sees, at a few thousand points: a depth buffer of a small picture.

use glam::{DVec2, DVec3};
use hairline_scene::{CameraFrame, Mesh};

use crate::description::Camera;

/// The picture's width; its height is that of the picture's shape.
const WIDTH_PX: u32 = 120;

/// A point of a surface that a camera sees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenPoint {
    pub position_m: DVec3,
    /// Unit normal of the shading, towards the camera.
    pub normal: DVec3,
    /// Index of the mesh.
    pub mesh: usize,
    /// Material of the triangle.
    pub material: u32,
}

/// Finds the points of some meshes in world space that a camera sees, one for each pixel that has one.
pub(crate) fn seen_points(
    camera: &Camera,
    [width, height]: [u32; 2],
    meshes: &[&Mesh],
) -> Vec<SeenPoint> {
    let height_px = (WIDTH_PX * height).div_ceil(width.max(1)).max(1);
    let frame = camera.in_scene().frame([WIDTH_PX, height_px]);
    let mut nearest: Vec<Option<(f64, SeenPoint)>> =
        vec![None; WIDTH_PX as usize * height_px as usize];
    for (i, mesh) in meshes.iter().enumerate() {
        for (corners, material) in mesh.triangles.iter().zip(&mesh.triangle_materials) {
            let corners = corners.map(|corner| corner as usize);
            let positions_m = corners.map(|corner| mesh.positions_m[corner].as_dvec3());
            let Some(on_picture) = Projected::new(&frame, positions_m) else {
                continue;
            };
            let normals = corners.map(|corner| mesh.normals[corner].as_dvec3());
            on_picture.each_pixel(&frame, |pixel, depth_m, shares| {
                let slot = &mut nearest[pixel];
                if slot.is_some_and(|(there_m, _)| there_m <= depth_m) {
                    return;
                }
                let mean = |of: [DVec3; 3]| -> DVec3 { (0..3).map(|k| shares[k] * of[k]).sum() };
                let position_m = mean(positions_m);
                let normal = mean(normals).normalize_or(DVec3::Z);
                let towards = frame.position_m - position_m;
                *slot = Some((
                    depth_m,
                    SeenPoint {
                        position_m,
                        normal: normal * normal.dot(towards).signum(),
                        mesh: i,
                        material: *material,
                    },
                ));
            });
        }
    }
    nearest
        .into_iter()
        .flatten()
        .map(|(_, point)| point)
        .collect()
}

/// A triangle on the picture.
struct Projected {
    corners_px: [DVec2; 3],
    depths_m: [f64; 3],
}

impl Projected {
    /// Projects a triangle; none where a corner is not before the camera.
    fn new(frame: &CameraFrame, corners_m: [DVec3; 3]) -> Option<Self> {
        let depths_m = corners_m.map(|corner| (corner - frame.position_m).dot(frame.forward));
        let [Some(a), Some(b), Some(c)] = corners_m.map(|corner| frame.pixel_of(corner)) else {
            return None;
        };
        Some(Self {
            corners_px: [a, b, c],
            depths_m,
        })
    }

    /// Calls `each` for every pixel whose middle the triangle covers, with the depth there and the shares
    /// of its corners.
    fn each_pixel(&self, frame: &CameraFrame, mut each: impl FnMut(usize, f64, [f64; 3])) {
        let [a, b, c] = self.corners_px;
        let area = (b - a).perp_dot(c - a);
        let low = a.min(b).min(c).max(DVec2::ZERO);
        let high = a.max(b).max(c).min(frame.size_px);
        if area == 0.0 || !(low.cmplt(high).all()) {
            return;
        }
        let first = (low - 0.5).ceil().max(DVec2::ZERO).as_uvec2();
        let end = (high + 0.5).floor().min(frame.size_px).as_uvec2();
        for y in first.y..end.y {
            for x in first.x..end.x {
                let p = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
                let (v, w) = (
                    (p - a).perp_dot(c - a) / area,
                    (b - a).perp_dot(p - a) / area,
                );
                let shares = [1.0 - v - w, v, w];
                if shares.iter().any(|share| *share < 0.0) {
                    continue;
                }
                // Over depth they are linear on the picture.
                let [d, e, f] = std::array::from_fn(|k| shares[k] / self.depths_m[k]);
                let depth_m = 1.0 / (d + e + f);
                let pixel = y as usize * frame.size_px.x as usize + x as usize;
                each(pixel, depth_m, [d, e, f].map(|share| share * depth_m));
            }
        }
    }
}
