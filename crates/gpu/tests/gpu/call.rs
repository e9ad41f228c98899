//! The harness that calls WGSL functions: it must return the function's results, and must be able to fail.

use crate::common::default_limits;
use hairline_gpu::call::{Call, Table, Texels};
use hairline_gpu::headless::test_gpu;
use hairline_gpu::shaders::Module;
use hairline_gpu::{AdapterRequest, Error, headless};

static CUBE: Module = Module {
    name: "cube",
    source: "fn cube(a: f32) -> f32 { return a * a * a; }",
    needs: &[],
    bindings: &[],
    entry_points: &[],
    overrides: &[],
};
static FETCH: Module = Module {
    name: "fetch",
    source: "fn fetch(t: texture_2d_array<f32>, at: vec2i, layer: i32) -> vec4f { return textureLoad(t, at, layer, 0); }",
    needs: &[],
    bindings: &[],
    entry_points: &[],
    overrides: &[],
};

#[test]
fn a_function_is_called_for_each_row() {
    let Some(gpu) = test_gpu() else { return };
    let rows: Vec<[f32; 2]> = (0..1000).map(|i| [i as f32 * 0.01, 1.0]).collect();
    let call = Call {
        modules: &[&CUBE],
        snippet: "y[0] = cube(x[0]); y[1] = y[0] + x[1];",
        tables: &[],
    };
    let results: Vec<[f32; 2]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for ([a, b], [cube, sum]) in rows.iter().zip(results) {
        let expected = a * a * a;
        // Two roundings of one half unit in the last place each; drivers may contract or not.
        assert!(
            (cube - expected).abs() <= 2.0 * f32::EPSILON * expected,
            "{a}: {cube}, not {expected}"
        );
        assert!((sum - (cube + b)).abs() <= 2.0 * f32::EPSILON * (cube + b));
    }
}

/// The harness itself can fail: it finds a row that is off by one part in a thousand.
#[test]
fn a_wrong_row_is_seen() {
    let Some(gpu) = test_gpu() else { return };
    let rows = [[1.0], [2.0], [3.0]];
    let wrong = [[1.0], [8.0], [27.0 * 1.001]];
    let call = Call {
        modules: &[&CUBE],
        snippet: "y[0] = cube(x[0]);",
        tables: &[],
    };
    let results: Vec<[f32; 1]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    let off = |expected: &[[f32; 1]]| {
        results
            .iter()
            .zip(expected)
            .filter(|(a, b)| (a[0] - b[0]).abs() > 1e-5 * b[0])
            .count()
    };
    assert_eq!(off(&[[1.0], [8.0], [27.0]]), 0);
    assert_eq!(off(&wrong), 1);
}

#[test]
fn tables_arrive_texel_by_texel() {
    let Some(gpu) = test_gpu() else { return };
    let texels: Vec<[f32; 4]> = (0..3 * 2 * 2).map(|i| [i as f32, 0.5, -1.0, 2.0]).collect();
    let tables = [
        Table {
            size: [3, 2],
            layers: Some(2),
            texels: Texels::Floats(&texels),
        },
        Table {
            size: [3, 4],
            layers: None,
            texels: Texels::Floats(&texels),
        },
    ];
    let snippet = "y[0] = fetch(table_0, vec2i(i32(x[0]), i32(x[1])), i32(x[2])).x;";
    let call = Call {
        modules: &[&FETCH],
        snippet,
        tables: &tables,
    };
    let rows = [[2.0, 1.0, 0.0], [1.0, 0.0, 1.0]];
    let results: Vec<[f32; 1]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    assert_eq!(results, [[5.0], [7.0]]);
}

#[test]
fn a_snippet_that_does_not_compile_says_why() {
    let Some(gpu) = test_gpu() else { return };
    let call = Call {
        modules: &[&CUBE],
        snippet: "y[0] = kube(x[0]);",
        tables: &[],
    };
    let error = gpu.block_on(call.run::<1, 1>(gpu, &[[1.0]])).unwrap_err();
    assert!(
        matches!(&error, Error::Validation { description } if description.contains("kube")),
        "{error}"
    );
}

#[test]
fn a_destroyed_device_is_an_error() {
    let Some(gpu) = default_limits() else { return };
    gpu.device.destroy();
    let call = Call {
        modules: &[&CUBE],
        snippet: "y[0] = cube(x[0]);",
        tables: &[],
    };
    let error = gpu.block_on(call.run::<1, 1>(&gpu, &[[1.0]])).unwrap_err();
    assert!(matches!(error, Error::Lost { .. }), "{error}");
}

#[test]
fn an_adapter_that_does_not_exist_is_named() {
    let error = headless::open(&AdapterRequest {
        name: Some("no such card".into()),
        ..Default::default()
    });
    assert!(matches!(error, Err(Error::NoAdapter { .. })));
}
