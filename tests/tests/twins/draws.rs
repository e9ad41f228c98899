//! Random numbers for directions.

use super::twin::{Sequence, Tolerance, Twin};
use glam::{DVec2, DVec3};
use hairline_gpu::call::Call;
use hairline_gpu::{headless, shaders};
use hairline_optics::ggx::{ggx_pdf, ggx_sample};

#[test]
fn visible_normals() {
    let mut random = Sequence(7);
    let rows: Vec<[f32; 6]> = (0..4000)
        .map(|_| {
            let [x, y, z] = random.direction(0.05);
            let alpha = random.uniform(0.002, 1.0);
            [x, y, z, alpha, random.next(), random.next()]
        })
        // A viewer on the horizon sees no normals.
        .filter(|row| row[2] > 0.0)
        .collect();
    Twin {
        name: "ggx_sample, ggx_pdf",
        modules: &[&shaders::GGX],
        snippet: "let wo = vec3f(x[0], x[1], x[2]);
            let wi = ggx_sample(wo, x[3], vec2f(x[4], x[5]));
            y[0] = wi.x; y[1] = wi.y; y[2] = wi.z;
            // Off the peak, where the lobe is not too steep for single precision.
            let beside = normalize(vec3f(x[4], x[5], 0.5));
            y[3] = ggx_pdf(beside, wo, max(x[3], 0.1));",
        tables: &[],
        expected: &|[x, y, z, alpha, u, v]: [f64; 6]| {
            let wo = DVec3::new(x, y, z);
            let wi = ggx_sample(wo, alpha, DVec2::new(u, v));
            let beside = DVec3::new(u, v, 0.5).normalize();
            [wi.x, wi.y, wi.z, ggx_pdf(beside, wo, alpha.max(0.1))]
        },
        // The built-in sine may be off by 5e-4.
        tolerance: Tolerance {
            absolute: 1e-3,
            relative: 1e-3,
        },
    }
    .check(&rows, 0);
}

/// Each of 16 rounds falls into another cell, however the square is cut into 16; and pairs know nothing of one another.
#[test]
fn pairs_are_even() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let rows: Vec<[f32; 2]> = (0..200 * 16)
        .map(|i| [(i % 16) as f32, (i / 16) as f32])
        .collect();
    let call = Call {
        modules: &[&shaders::SOBOL],
        snippet: "let pair = sobol_pair(u32(x[0]), u32(x[1])); y[0] = pair.x; y[1] = pair.y;",
        tables: &[],
    };
    let pairs: Vec<[f32; 2]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (seed, pairs) in pairs.chunks(16).enumerate() {
        for columns in [1, 2, 4, 8, 16] {
            let mut cells: Vec<[u32; 2]> = pairs
                .iter()
                .map(|[x, y]| [x * columns as f32, y * (16 / columns) as f32].map(|c| c as u32))
                .collect();
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), 16, "{seed}: {pairs:?}");
        }
    }
    let sum: f32 = (pairs.iter().zip(&pairs[16..]))
        .map(|(a, b)| (a[0] - 0.5) * (b[0] - 0.5))
        .sum();
    // The products have a variance of 1/144.
    let std = (pairs.len() as f32).sqrt() / 12.0;
    assert!(sum.abs() < 5.0 * std, "{sum} {std}");
}
