//! Small scenes: a scratched plate of which the picture shows a millimetre or less.

use conformance::{lay_random, square};
use glam::{DVec3, Vec3};
use hairline_scene::{Base, Light, Sampling, Scene, Texture};
use std::sync::Arc;

/// Half the plate's side.
pub const HALF_SIDE_M: f32 = 5e-3;
const CAMERA_M: f64 = 0.4;
const LIGHT_M: f64 = 1.0;

/// View of a plate.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Angle from the normal, towards -y.
    pub angle_rad: f64,
    /// Size of a pixel on the plate, across the view.
    pub pixel_um: f64,
    pub size_px: u32,
}

/// A plate without scratches and light.
pub fn plate(base: Base, view: View) -> Scene {
    let mut scene = square(base, HALF_SIDE_M, view.size_px);
    let (sin, cos) = view.angle_rad.sin_cos();
    scene.camera.position_m = CAMERA_M * DVec3::new(0.0, -sin, cos);
    scene.camera.fov_y_rad =
        2.0 * (0.5 * f64::from(view.size_px) * view.pixel_um * 1e-6 / CAMERA_M).atan();
    scene
}

/// A normal map that leans all normals by the same slopes.
pub fn leaning(slopes: [f64; 2]) -> Texture {
    let normal = DVec3::new(slopes[0], slopes[1], 1.0).normalize();
    let [x, y, z] = normal.to_array().map(|c| (127.5 * (c + 1.0)).round() as u8);
    Texture {
        size_px: [1; 2],
        levels: vec![vec![[x, y, z, 0]]],
        srgb: false,
        sampling: Sampling::default(),
    }
}

/// Scratches all over the view, some to a pixel of 20 um: 1 to 4 um wide, 40 to 400 nm deep.
pub fn scratch(scene: &mut Scene, view: View, count: u32) {
    let shown_m = f64::from(view.size_px) * view.pixel_um * 1e-6 / view.angle_rad.cos();
    // Half of it, and beyond the corners.
    lay_random(scene, 0.7 * shown_m as f32, count, shown_m as f32, 5);
}

/// The unit direction whose components on the plate differ by (x, y) from those of the mirrored view.
pub fn off_the_mirror(angle_rad: f64, x: f64, y: f64) -> DVec3 {
    let y = angle_rad.sin() + y;
    DVec3::new(x, y, (1.0 - x * x - y * y).sqrt())
}

/// A sphere of a given angular radius about a direction (x, y) in cosines from the mirror's.
pub fn sphere(view: View, x: f64, y: f64, radius_rad: f64) -> Light {
    Light::sphere(
        LIGHT_M * off_the_mirror(view.angle_rad, x, y),
        LIGHT_M * radius_rad.sin(),
        [1.0, 0.8, 0.6],
    )
}

/// A rectangle that faces the plate, of two given half widths.
pub fn panel(view: View, x: f64, y: f64, half_rad: [f64; 2]) -> Light {
    let towards = off_the_mirror(view.angle_rad, x, y);
    let right = LIGHT_M * half_rad[0].tan() * towards.cross(DVec3::Y).normalize();
    let up = LIGHT_M * half_rad[1].tan() * right.cross(towards).normalize();
    let middle = LIGHT_M * towards;
    Light::polygon(
        vec![
            middle - right - up,
            middle + right - up,
            middle + right + up,
            middle - right + up,
        ],
        [0.6, 0.8, 1.0],
        true,
    )
}

/// A flat light that faces the plate; its corners by their angles from its middle, all around.
pub fn outline(view: View, x: f64, y: f64, corners_rad: impl IntoIterator<Item = f64>) -> Light {
    let towards = off_the_mirror(view.angle_rad, x, y);
    let (right, up) = towards.any_orthonormal_pair();
    let corners: Vec<f64> = corners_rad.into_iter().collect();
    let turn = std::f64::consts::TAU / corners.len() as f64;
    let corner = |(i, radius): (usize, &f64)| {
        let (sin, cos) = (turn * i as f64).sin_cos();
        LIGHT_M * (towards + radius.tan() * (cos * right + sin * up))
    };
    let vertices_m = corners.iter().enumerate().map(corner).collect();
    Light::polygon(vertices_m, [0.9, 0.7, 0.8], true)
}

/// A tube across the way to the plate; half its length and its radius as angles.
pub fn tube(view: View, x: f64, y: f64, half_rad: f64, radius_rad: f64) -> Light {
    let middle = LIGHT_M * off_the_mirror(view.angle_rad, x, y);
    // Neither end is as far as the other.
    let along = (middle.cross(DVec3::new(0.3, 1.0, 0.2)).normalize() + 0.3 * middle).normalize();
    let half = LIGHT_M * half_rad.tan() * along;
    Light::tube(
        [middle - half, middle + half],
        LIGHT_M * radius_rad.sin(),
        [0.7, 0.8, 0.5],
    )
}

/// Adds scratches with one width and one depth for all.
pub fn scratch_alike(scene: &mut Scene, view: View, count: u32, width_um: f32, depth_nm: f32) {
    scratch(scene, view, count);
    for scratch in Arc::make_mut(&mut scene.objects[0].scratches).iter_mut() {
        scratch.profile.width_um = width_um;
        scratch.profile.depth_nm = depth_nm;
    }
}

/// A quadrilateral with a material of its own; its corners counter-clockwise from the side that it faces.
pub fn add_quad(scene: &mut Scene, base: Base, roughness: f64, corners_m: [Vec3; 4]) {
    let mut quad = scene.objects[0].clone();
    let [a, b, _, d] = corners_m;
    quad.name = "quad".into();
    quad.scratches = Arc::default();
    quad.gratings.clear();
    quad.segments = Arc::default();
    let mesh = Arc::make_mut(&mut quad.mesh);
    mesh.positions_m = corners_m.to_vec();
    mesh.normals = vec![(b - a).cross(d - a).normalize(); 4];
    mesh.tangents = vec![(b - a).normalize().extend(1.0); 4];
    mesh.triangle_materials = vec![scene.materials.len() as u32; 2];
    scene.objects.push(quad);
    let mut material = scene.materials[0].clone();
    material.name = "quad".into();
    material.base = base;
    material.roughness = roughness;
    scene.materials.push(material);
}
