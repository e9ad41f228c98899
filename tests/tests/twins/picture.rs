//! Pictures on lights.

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec2, DVec3};
use hairline_gpu::shaders;
use hairline_optics::picture::{PicturePlane, picture_lod, picture_part_spread, picture_place};

/// Planes all around, looked at from before and beside, also along them.
#[test]
fn look_ups() {
    let mut random = Sequence(12);
    let mut vector = |size: f32| random.direction(-1.0).map(|x| x * size);
    let mut rows = Vec::new();
    for i in 0..4000 {
        let [a, b, c] = [vector(1.0), vector(0.7), vector(0.5)];
        let toward = match i % 4 {
            // To a corner, along an edge, anywhere.
            0 => a,
            1 => b,
            _ => vector(2.0),
        };
        rows.push([
            a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], toward[0], toward[1], toward[2],
        ]);
    }
    let is_plain = |row: &[f32; 12]| {
        let v = |i: usize| DVec3::new(row[i].into(), row[i + 1].into(), row[i + 2].into());
        let normal = v(3).cross(v(6));
        // Single precision is imprecise for a plane without area, or seen edge-on.
        normal.length() > 0.02 && (v(9).dot(normal) / normal.length()).abs() > 0.02
    };
    rows.retain(is_plain);
    Twin {
        name: "picture_uv, picture_look, picture_on_chord, picture_part_spread, picture_lod",
        modules: &[&shaders::PICTURE],
        snippet: "let plane = PicturePlane(vec3f(x[0], x[1], x[2]), vec3f(x[3], x[4], x[5]), vec3f(x[6], x[7], x[8]));
            let toward = vec3f(x[9], x[10], x[11]);
            let uv = picture_uv(plane, toward);
            let look = picture_look(plane, toward);
            let chord = picture_on_chord(plane, plane.corner, toward, plane.corner + plane.right, 0.3);
            y[0] = uv.x; y[1] = uv.y; y[2] = look.spread; y[3] = chord.uv.x; y[4] = chord.spread;
            y[5] = picture_lod(picture_part_spread(look.spread), vec2f(512.0, 256.0));",
        tables: &[],
        expected: &|x: [f64; 12]| {
            let v = |i: usize| DVec3::new(x[i], x[i + 1], x[i + 2]);
            let plane = PicturePlane {
                corner: v(0),
                right: v(3),
                up: v(6),
            };
            let uv = plane.picture_uv(v(9));
            let look = plane.picture_look(v(9));
            let chord = plane.picture_on_chord([v(0), v(9), v(0) + v(3)], 0.3);
            let lod = picture_lod(picture_part_spread(look.spread), DVec2::new(512.0, 256.0));
            [uv.x, uv.y, look.spread, chord.uv.x, chord.spread, lod]
        },
        tolerance: Tolerance {
            absolute: 2e-3,
            relative: 1e-3,
        },
    }
    .check(&rows, 0);
}

#[test]
fn cells() {
    let mut random = Sequence(3);
    let mut rows = Vec::new();
    for i in 0..1000 {
        let (a, b) = (random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
        rows.push([
            (i % 13) as f32 / 12.0,
            a.min(b),
            a.max(b),
            random.uniform(0.0, 20.0),
        ]);
    }
    Twin {
        name: "picture_place",
        modules: &[&shaders::PICTURE],
        snippet: "y[0] = picture_place(x[0], x[1], x[2], x[3]);",
        tables: &[],
        expected: &|[share, low, high, width_um]: [f64; 4]| {
            [picture_place(share, low, high, width_um)]
        },
        tolerance: Tolerance {
            absolute: 1e-5,
            relative: 1e-4,
        },
    }
    .check(&rows, 0);
}
