//! Rays among triangles: the tree in its texture against the CPU's.

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec3, Vec3};
use hairline_fixtures::{DISK, SceneFile};
use hairline_gpu::call::{Table, Texels};
use hairline_gpu::{shaders, triangle_tree};
use hairline_index::TriangleIndex;
use hairline_scene::Scene;
use std::sync::Arc;

/// Texels to a row. Twin: texels.wgsl.
const ROW_TEXELS: usize = 1 << 12;

/// A ball over a plate beside a bowl; among the triangles of the plate many without area, and some that lie on one another.
fn scene() -> Scene {
    let mut scene = SceneFile::seen_from([0.0, -0.3, 0.3])
        .metal("steel", "steel")
        .object("plate", "steel", DISK)
        .object("ball", "steel", "sphere = { radius_m = 0.02 }")
        .with_lines("translation_m = [0.01, 0.0, 0.03]")
        .object(
            "bowl",
            "steel",
            "lathe = { profile_m = [[0.0, 0.0], [0.05, 0.0], [0.066, 0.02]] }",
        )
        .with_lines("translation_m = [-0.05, 0.0, 0.005]")
        .scene();
    let mesh = Arc::make_mut(&mut scene.objects[0].mesh);
    let count = mesh.triangles.len();
    for i in 0..count {
        let [a, b, c] = mesh.triangles[i];
        mesh.triangles.extend([[a, a, a], [a, b, b], [a, b, c]]);
    }
    mesh.triangle_materials.resize(mesh.triangles.len(), 0);
    scene
}

/// Rays meet the same on the GPU as on the CPU: the nearest triangle, and whether any lies before a limit.
#[test]
fn rays_meet_the_same_triangles() {
    let scene = scene();
    let index = TriangleIndex::build(&scene);
    let origin_m = DVec3::new(0.01, 0.0, 0.02);
    let mut texels = triangle_tree::packed(&scene, &index, origin_m);
    texels.resize(texels.len().next_multiple_of(ROW_TEXELS), [0; 4]);
    let mut random = Sequence(5);
    let mut rows = Vec::new();
    for i in 0..8000 {
        let at = [-0.09, -0.09, 0.001].map(|low| random.uniform(low, 0.09));
        let mut towards = random.direction(-1.0);
        if i % 2 == 0 {
            // Rays to the ball's middle, and past its edge.
            let to = [0.01, 0.0, 0.03].map(|c: f32| c + random.uniform(-0.02, 0.02));
            let v = Vec3::from(to) - Vec3::from(at);
            towards = v.normalize_or(Vec3::X).to_array();
        }
        let limit_m = random.uniform(0.0, 0.2);
        rows.push([
            at[0], at[1], at[2], towards[0], towards[1], towards[2], limit_m,
        ]);
    }
    let hits = rows
        .iter()
        .filter(|row| expected(&index, row.map(f64::from))[1] > 0.0);
    let hits = hits.count();
    assert!(hits > 2000 && hits < 6000, "{hits}");
    Twin {
        name: "tree_hit",
        modules: &[&shaders::TRIANGLE_TREE],
        snippet: "let at = vec3f(x[0] - 0.01, x[1], x[2] - 0.02);
            let ray = tree_ray(at, vec3f(x[3], x[4], x[5]));
            let hit = tree_hit(table_0, ray, 1e30, 0u, false);
            y[0] = select(-1.0, hit.distance_m, hit.triangle != 0u);
            y[1] = f32(tree_hit(table_0, ray, x[6], 0u, true).triangle != 0u);
            y[2] = select(-1.0, f32(hit.object), hit.triangle != 0u);
            // The ray skips the triangle that was met and finds the surface behind it.
            let next = tree_hit(table_0, ray, 1e30, hit.triangle, false);
            y[3] = f32(next.distance_m >= hit.distance_m && (hit.triangle == 0u || next.triangle != hit.triangle));",
        tables: &[Table {
            size: [ROW_TEXELS as u32, (texels.len() / ROW_TEXELS) as u32],
            layers: None,
            texels: Texels::Integers(&texels),
        }],
        expected: &|row| expected(&index, row),
        tolerance: Tolerance {
            absolute: 1e-7,
            relative: 1e-4,
        },
    }
    // Within rounding of an outline or of the limit.
    .check(&rows, rows.len() / 1000);
}

fn expected(index: &TriangleIndex, row: [f64; 7]) -> [f64; 4] {
    let [x, y, z, dx, dy, dz, limit_m] = row;
    let (from, along) = (DVec3::new(x, y, z), DVec3::new(dx, dy, dz));
    let hit = index.intersect(from, along);
    [
        hit.map_or(-1.0, |hit| hit.distance_m),
        f64::from(index.is_hidden(from, along, limit_m)),
        hit.map_or(-1.0, |hit| f64::from(hit.object)),
        1.0,
    ]
}

/// A scene without triangles hides nothing, and its walk ends.
#[test]
fn nothing_is_met_in_an_empty_scene() {
    let mut scene = scene();
    scene.objects.clear();
    let index = TriangleIndex::build(&scene);
    assert!(triangle_tree::packed(&scene, &index, DVec3::ZERO).is_empty());
    Twin {
        name: "tree_hit",
        modules: &[&shaders::TRIANGLE_TREE],
        snippet: "let ray = tree_ray(vec3f(0.0), vec3f(0.0, 0.0, x[0]));
            y[0] = f32(tree_hit(table_0, ray, 1e30, 0u, true).triangle);",
        tables: &[Table {
            size: [1, 1],
            layers: None,
            texels: Texels::Integers(&[[0; 4]]),
        }],
        expected: &|_| [0.0],
        tolerance: Tolerance {
            absolute: 0.0,
            relative: 0.0,
        },
    }
    .check(&[[1.0], [-1.0]], 0);
}
