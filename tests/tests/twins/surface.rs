//! A pixel's footprint, and the frame of the surface under it.

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec2, DVec3};
use hairline_gpu::shaders;
use hairline_optics::filtered_lobe::PixelSlopes;
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
        let ray = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
        let mut normal = random.direction(-1.0);
        if i % 8 == 0 {
            // Within the bound on the cosine, on either side of it: across the ray but for a little.
            let along = DVec3::new(ray[0].into(), ray[1].into(), -1.0).normalize();
            let across = along.any_orthonormal_vector();
            let cos = 1.5 * MIN_FOOTPRINT_COS * f64::from(random.uniform(-1.0, 1.0));
            normal = (across + cos * along).normalize().as_vec3().to_array();
        }
        let depth = 10f32.powf(random.uniform(-3.0, 3.0));
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
fn slopes_of_a_pixel() {
    let mut random = Sequence(3);
    let rows: Vec<[f32; 8]> = (0..4000)
        .map(|_| {
            let [a, b, c, d] = [0; 4].map(|_| random.uniform(-0.1, 0.1));
            let distance = 10f32.powf(random.uniform(-2.0, 1.0));
            [
                a,
                b,
                c,
                d,
                random.uniform(0.005, 1.0),
                distance,
                random.uniform(0.0, 5.0),
                random.uniform(0.0, 0.1),
            ]
        })
        .collect();
    Twin {
        name: "pixel_slopes_towards",
        modules: &[&shaders::PIXEL_SLOPES],
        snippet: "let slopes = PixelSlopes(vec2f(x[0], x[1]), vec2f(x[2], x[3]), 1e4 * vec2f(x[1], x[2]), 1e4 * vec2f(x[3], x[0]), x[4], x[5], x[7] * x[7]);
            let s = pixel_slopes_towards(slopes, x[6]); y[0] = s.x; y[1] = s.y; y[2] = s.z;",
        tables: &[],
        expected: &|[a, b, c, d, cos_o, viewer_m, per_m, map_std]: [f64; 8]| {
            let slopes = PixelSlopes {
                turns: [DVec2::new(a, b), DVec2::new(c, d)],
                steps_m: [DVec2::new(b, c), DVec2::new(d, a)].map(|step| 0.01 * step),
                cos_o,
                viewer_m,
                map_std,
            };
            let spread = slopes.towards(per_m);
            [spread.variance.x, spread.variance.y, spread.covariance]
        },
        tolerance: Tolerance {
            absolute: 1e-6,
            relative: 1e-5,
        },
    }
    .check(&rows, 0);
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
        // Least change of the normal: in the plane of both, to the least cosine or to its own.
        expected: &|[nx, ny, nz, wx, wy, wz]: [f64; 6]| {
            [v(nx, ny, nz).dot(v(wx, wy, wz)).max(0.01), 1.0, 0.0]
        },
        // Nearly opposite directions leave few digits of what is across.
        tolerance: Tolerance {
            absolute: 1e-5,
            ..SINGLE
        },
    }
    .check(&rows, 0);
}

#[test]
fn barycentric_coordinates() {
    let mut random = Sequence(4);
    let mut rows = Vec::new();
    for _ in 0..4000 {
        // A triangle by its point that the ray meets, a triangle of any size around it, and a ray from anywhere.
        let size = 10f32.powf(random.uniform(-3.0, 1.0));
        let (u, w) = (random.next(), random.next());
        let (u, w) = if u + w > 1.0 {
            (1.0 - u, 1.0 - w)
        } else {
            (u, w)
        };
        let e: [f32; 4] = std::array::from_fn(|_| size * random.uniform(-1.0, 1.0));
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
            random.uniform(0.5, 2.0),
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

/// Normals as they are packed come back as they were, within a step of their 16 bits, and none is the mark of a coat that is alike.
#[test]
fn packed_normals() {
    let mut random = Sequence(4);
    let mut rows: Vec<[f32; 3]> = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [-1.0, -0.0, -0.0]];
    rows.extend((0..4000).map(|_| random.direction(-1.0)));
    Twin {
        name: "under_coat_normal",
        modules: &[&shaders::COAT],
        snippet: "let packed = under_coat_pack(vec3f(x[0], x[1], x[2]));
            let n = under_coat_normal(packed);
            y[0] = n.x; y[1] = n.y; y[2] = n.z; y[3] = f32(packed == UNDER_COAT_ALIKE);",
        tables: &[],
        expected: &|[x, y, z]: [f64; 3]| {
            let unit = v(x, y, z).normalize();
            [unit.x, unit.y, unit.z, 0.0]
        },
        // Half a step, up to the square root of three times as long on the sphere, of x and y together in z.
        tolerance: Tolerance {
            absolute: 6e-5,
            relative: 0.0,
        },
    }
    .check(&rows, 0);
}

/// The point in the frame of the surface under its coat, from a viewer in the x-z plane of the coat's.
#[test]
fn frames_under_coats() {
    let mut random = Sequence(5);
    let rows: Vec<[f32; 6]> = (0..2000)
        .map(|_| {
            let n = random.direction(0.3);
            let turn = [0; 2].map(|_| random.uniform(-0.2, 0.2));
            // Beyond what a normal is bent back from.
            [
                n[0],
                n[1],
                n[2],
                random.uniform(-0.2, 0.2),
                turn[0],
                turn[1],
            ]
        })
        .collect();
    Twin {
        name: "surface_under_coat",
        modules: &[&shaders::COAT],
        snippet: "var point: SurfacePoint;
            point.axis_x = vec3f(1.0, 0.0, 0.0);
            point.axis_y = vec3f(0.0, 1.0, 0.0);
            point.normal = vec3f(0.0, 0.0, 1.0);
            point.wo = vec3f(x[3], 0.0, sqrt(1.0 - x[3] * x[3]));
            point.turn_x = vec2f(x[4], x[5]);
            point.under_coat = under_coat_pack(vec3f(x[0], x[1], x[2]));
            let under = surface_under_coat(point);
            let turn = world_from_surface(under, vec3f(under.turn_x, 0.0));
            let back = world_from_surface(under, under.wo);
            y[0] = under.wo.z; y[1] = dot(under.axis_x, under.normal); y[2] = length(cross(under.axis_x, under.axis_y));
            y[3] = turn.x; y[4] = turn.y; y[5] = turn.z; y[6] = back.x; y[7] = back.y; y[8] = back.z;",
        tables: &[],
        expected: &|[nx, ny, nz, w, tx, ty]: [f64; 6]| {
            let normal = v(nx, ny, nz).normalize();
            let to_viewer = v(w, 0.0, (1.0 - w * w).sqrt());
            let turn = v(tx, ty, 0.0);
            let flat = turn - normal * normal.dot(turn);
            let cos = normal.dot(to_viewer);
            let all = [cos, 0.0, 1.0, flat.x, flat.y, flat.z];
            let [a, b, c, d, e, f] = all;
            [a, b, c, d, e, f, to_viewer.x, to_viewer.y, to_viewer.z]
        },
        // Same as for the packed normal.
        tolerance: Tolerance {
            absolute: 2e-4,
            relative: 0.0,
        },
    }
    .check(&rows, 0);
}

/// The last words of a sample hold emission with 12 digits, and the coat's share, roughness and spread of slopes in steps of 1 / 4095.
#[test]
fn packed_coats_and_emission() {
    let mut random = Sequence(6);
    let mut rows: Vec<[f32; 6]> = vec![[0.0; 6], [-0.0; 6], [1e6, 1e-6, 1.0, 1.0, 1.0, 1.0]];
    for _ in 0..2000 {
        let emission = [0; 3].map(|_| 10f32.powf(random.uniform(-6.0, 4.0)));
        let coat = [0; 3].map(|_| random.next());
        rows.push([
            emission[0],
            emission[1],
            emission[2],
            coat[0],
            coat[1],
            coat[2],
        ]);
    }
    Twin {
        name: "pixel_paint_pack",
        modules: &[&shaders::PIXEL_POINT, &shaders::COAT],
        snippet: "var point: SurfacePoint;
            point.emission = vec3f(x[0], x[1], x[2]);
            point.coat = coat_pack(pack2x16unorm(vec2f(x[3], x[4])));
            point.coat_slope_std = x[5];
            point.under_coat = 0x12345678u;
            let paint = pixel_paint_pack(point, 0u);
            let back = surface_point_from(PixelPoint(), paint);
            let coat = surface_coat(back.coat);
            let off = abs(back.emission - point.emission) / max(point.emission, vec3f(1e-30));
            y[0] = f32(all(off < vec3f(1.3e-4))); y[1] = coat.x; y[2] = coat.y; y[3] = back.coat_slope_std;
            y[4] = f32(back.under_coat == point.under_coat);",
        tables: &[],
        expected: &|[.., share, roughness, slopes]: [f64; 6]| [1.0, share, roughness, slopes, 1.0],
        tolerance: Tolerance {
            absolute: 1.4e-4,
            relative: 0.0,
        },
    }
    .check(&rows, 0);
}
