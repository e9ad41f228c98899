//! The tone curves in WGSL against their twins in `hairline_image::tone_map`.

use hairline_gpu::call::Call;
use hairline_gpu::headless::test_gpu;
use hairline_gpu::shaders;
use hairline_image::ToneMap;
use hairline_image::tone_map::{
    display_code, dither_offset, linear_from_srgb, srgb_from_linear, tone_into_gamut, tone_map,
};

/// Colours from black to far beyond white, some outside of the gamut, some that are no colours.
fn colors() -> Vec<[f32; 3]> {
    let values = [
        -1e30, -2.0, -0.3, -1e-4, 0.0, 1e-30, 1e-6, 1e-3, 0.03, 0.079, 0.18, 0.5, 0.76, 0.8, 1.0,
        3.0, 17.0, 400.0, 1e6, 1e30,
    ];
    let mut colors = vec![
        [f32::NAN, 0.5, 0.5],
        [f32::INFINITY, 0.0, 1.0],
        [f32::NEG_INFINITY, 1.0, f32::NAN],
    ];
    for r in values {
        for g in values {
            for b in values {
                colors.push([r, g, b]);
            }
        }
    }
    colors
}

#[test]
fn curves() {
    let Some(gpu) = test_gpu() else { return };
    let rows: Vec<[f32; 4]> = ToneMap::ALL
        .into_iter()
        .flat_map(|curve| {
            let index = curve.shader_index() as f32;
            colors().into_iter().map(move |c| [index, c[0], c[1], c[2]])
        })
        .collect();
    let call = Call {
        modules: &[&shaders::TONE_MAP],
        snippet: "let c = tone_map(u32(x[0]), vec3f(x[1], x[2], x[3])); y[0] = c.x; y[1] = c.y; y[2] = c.z;",
        tables: &[],
    };
    let results: Vec<[f32; 3]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, got) in rows.iter().zip(results) {
        let curve = ToneMap::ALL[row[0] as usize];
        let want = tone_map(curve, [row[1], row[2], row[3]]);
        for c in 0..3 {
            // A tenth of an 8-bit step: log2 and pow in shaders have three units in the last place, AgX takes several in a row,
            // and out-of-gamut colours are differences of numbers up to 1e9.
            assert!(
                (got[c] - want[c]).abs() < 4e-4,
                "{curve:?} {:?}: {got:?}, not {want:?}",
                &row[1..]
            );
        }
    }
}

#[test]
fn gamut() {
    let Some(gpu) = test_gpu() else { return };
    let rows: Vec<[f32; 3]> = colors()
        .into_iter()
        .filter(|c| c.iter().all(|c| c.abs() <= 1e6))
        .collect();
    let call = Call {
        modules: &[&shaders::TONE_MAP],
        snippet: "let c = tone_into_gamut(vec3f(x[0], x[1], x[2])); y[0] = c.x; y[1] = c.y; y[2] = c.z;",
        tables: &[],
    };
    let results: Vec<[f32; 3]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (&row, got) in rows.iter().zip(results) {
        let want = tone_into_gamut(row);
        let largest = row.iter().fold(0.0_f32, |a, c| a.max(c.abs()));
        for c in 0..3 {
            // Differences of components: exact to a few units in the last place of the largest.
            assert!(
                (got[c] - want[c]).abs() <= 1e-6 * largest,
                "{row:?}: {got:?}, not {want:?}"
            );
        }
    }
}

#[test]
fn transfer_function_and_codes() {
    let Some(gpu) = test_gpu() else { return };
    let rows: Vec<[f32; 3]> = (0..=4096_u32)
        .map(|i| [i as f32 / 4096.0, (i % 61) as f32, (i / 61 * 977) as f32])
        .collect();
    let call = Call {
        modules: &[&shaders::TONE_MAP],
        snippet: "y[0] = srgb_from_linear(x[0]); y[1] = linear_from_srgb(x[0]);
            y[2] = dither_offset(u32(x[1]), u32(x[2])); y[3] = display_code(x[0], y[2]);",
        tables: &[],
    };
    let results: Vec<[f32; 4]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, got) in rows.iter().zip(results) {
        let offset = dither_offset(row[1] as u32, row[2] as u32);
        // pow() in shaders has three units in the last place, times its exponent.
        assert!(
            (got[0] - srgb_from_linear(row[0])).abs() < 5e-6,
            "{row:?} {got:?}"
        );
        assert!(
            (got[1] - linear_from_srgb(row[0])).abs() < 5e-6,
            "{row:?} {got:?}"
        );
        assert_eq!(got[2], offset, "integers and powers of two: exact");
        assert_eq!(got[3], f32::from(display_code(row[0], offset)), "{row:?}");
    }
}
