//! A pixel's footprint, and the frame of the surface under it.

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec2, DVec3};
use hairline_gpu::shaders;
use hairline_scene::camera::{CameraFrame, MIN_FOOTPRINT_COS};

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Single precision, a few operations deep.
const SINGLE: Tolerance = Tolerance {
    absolute: 2e-6,
    relative: 2e-6,
};

#[test]
fn footprints() {
    let mut random = Sequence(1);
    let mut rows = Vec::new();
    for i in 0..4000 {
        // Rays as the camera's: 1 along the view axis, here -z. Normals from facing to beyond edge-on.
        let ray = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
        let mut normal = random.direction(-1.0);
        if i % 8 == 0 {
            // Within the bound on the cosine, on either side of it: across the ray but for a little.
            let along = DVec3::new(ray[0].into(), ray[1].into(), -1.0).normalize();
            let across = along.any_orthonormal_vector();
            let cos = 1.5 * MIN_FOOTPRINT_COS * f64::from(random.between(-1.0, 1.0));
            normal = (across + cos * along).normalize().as_vec3().to_array();
        }
        let depth = 10f32.powf(random.between(-3.0, 3.0));
        // Results are compared in units of depth times a pixel's angle.
        rows.push([
            ray[0], ray[1], normal[0], normal[1], normal[2], depth, 0.001, 0.0005,
        ]);
    }
    Twin {
        name: "footprint_axis",
        modules: &[&shaders::CAMERA],
        snippet: "let ray = vec3f(x[0], x[1], -1.0);
            let normal = vec3f(x[2], x[3], x[4]);
            let a = footprint_axis(ray, x[5], normal, vec3f(x[6], 0.0, 0.0)) / (x[5] * x[6]);
            let b = footprint_axis(ray, x[5], normal, vec3f(0.0, -x[7], 0.0)) / (x[5] * x[7]);
            y[0] = a.x; y[1] = a.y; y[2] = a.z; y[3] = b.x; y[4] = b.y; y[5] = b.z;",
        tables: &[],
        expected: &|[rx, ry, nx, ny, nz, depth, px, py]: [f64; 8]| {
            let frame = CameraFrame {
                position_m: DVec3::ZERO,
                forward: DVec3::NEG_Z,
                per_px_x: DVec3::X * px,
                per_px_y: DVec3::NEG_Y * py,
                size_px: DVec2::ONE,
                middle_px: DVec2::splat(0.5),
            };
            let [a, b] = frame.footprint_axes(v(rx, ry, -1.0), depth, v(nx, ny, nz));
            let (a, b) = (a / (depth * px), b / (depth * py));
            [a.x, a.y, a.z, b.x, b.y, b.z]
        },
        // The cosine, at least 0.035 of the ray's length, is a sum rounded at 6e-8 of it; results reach 40 and their
        // components are differences of such.
        tolerance: Tolerance {
            absolute: 2e-4,
            relative: 1e-5,
        },
    }
    // Edge-on, rounding may decide from which side the surface is seen.
    .check(&rows, rows.len() / 2000);
}

#[test]
fn vectors_across() {
    let mut random = Sequence(2);
    let mut rows: Vec<[f32; 3]> = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [-0.0, 0.0, -1.0]];
    rows.extend((0..4000).map(|_| random.direction(-1.0)));
    Twin {
        name: "surface_any_across",
        modules: &[&shaders::SURFACE],
        snippet: "let n = vec3f(x[0], x[1], x[2]);
            let a = surface_any_across(n);
            y[0] = dot(a, n); y[1] = length(a);",
        tables: &[],
        // Any vector will do that is across and of unit length.
        expected: &|_: [f64; 3]| [0.0, 1.0],
        tolerance: SINGLE,
    }
    .check(&rows, 0);
}

#[test]
fn normals_that_face_the_viewer() {
    let mut random = Sequence(3);
    let mut rows: Vec<[f32; 6]> = vec![
        [0.0, 0.0, 1.0, 0.0, 0.0, 1.0],
        // Straight away from the viewer: no side to bend to is better than another.
        [0.0, 0.0, -1.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, -1.0, 0.0, 0.0],
    ];
    for _ in 0..4000 {
        let (n, w) = (random.direction(-1.0), random.direction(-1.0));
        rows.push([n[0], n[1], n[2], w[0], w[1], w[2]]);
    }
    Twin {
        name: "surface_face_viewer",
        modules: &[&shaders::SURFACE],
        snippet: "let normal = vec3f(x[0], x[1], x[2]);
            let viewer = vec3f(x[3], x[4], x[5]);
            let bent = surface_face_viewer(normal, viewer);
            y[0] = dot(bent, viewer); y[1] = length(bent); y[2] = dot(bent, cross(normal, viewer));",
        tables: &[],
        // As little as it takes: in the plane of both, with the least cosine or with its own.
        expected: &|[nx, ny, nz, wx, wy, wz]: [f64; 6]| {
            [v(nx, ny, nz).dot(v(wx, wy, wz)).max(0.01), 1.0, 0.0]
        },
        tolerance: SINGLE,
    }
    .check(&rows, 0);
}

#[test]
fn barycentric_coordinates() {
    let mut random = Sequence(4);
    let mut rows = Vec::new();
    for _ in 0..4000 {
        // A triangle by its point that the ray meets, a triangle of any size around it, and a ray from anywhere.
        let size = 10f32.powf(random.between(-3.0, 1.0));
        let (u, w) = (random.next(), random.next());
        let (u, w) = if u + w > 1.0 {
            (1.0 - u, 1.0 - w)
        } else {
            (u, w)
        };
        let e: [f32; 4] = std::array::from_fn(|_| size * random.between(-1.0, 1.0));
        let ray = random.direction(-1.0);
        rows.push([
            u,
            w,
            e[0],
            e[1],
            e[2],
            e[3],
            ray[0],
            ray[1],
            ray[2],
            random.between(0.5, 2.0),
        ]);
    }
    // Slivers and triangles seen edge-on have no answer to compare.
    rows.retain(|r| {
        let e1 = glam::Vec3::new(r[2], r[3], r[4]);
        let e2 = glam::Vec3::new(r[5], r[4], -r[2]);
        let determinant = e1.dot(glam::Vec3::new(r[6], r[7], r[8]).cross(e2));
        determinant.abs() > 0.05 * e1.length() * e2.length()
    });
    Twin {
        name: "surface_barycentric",
        modules: &[&shaders::SURFACE],
        snippet: "let e1 = vec3f(x[2], x[3], x[4]);
            let e2 = vec3f(x[5], x[4], -x[2]);
            let a = vec3f(0.1, -0.2, 0.3);
            let ray = vec3f(x[6], x[7], x[8]);
            let size = length(e1);
            let origin = a + x[0] * e1 + x[1] * e2 - ray * (x[9] * size);
            let bary = surface_barycentric(origin, ray, a, a + e1, a + e2);
            y[0] = bary.x; y[1] = bary.y;",
        tables: &[],
        // The point that the ray was aimed at.
        expected: &|x: [f64; 10]| [x[0], x[1]],
        // Positions of 0.3 m are rounded at 3e-8 m: 3e-5 of a triangle of a millimetre, over the bound of 0.05 above.
        tolerance: Tolerance {
            absolute: 2e-3,
            relative: 0.0,
        },
    }
    .check(&rows, 0);
}
