//! Look-ups in environment maps in WGSL against their twins in `hairline_scene::environment::lookup`.

use glam::{DVec2, DVec3};
use hairline_gpu::call::{Call, Table, Texels};
use hairline_gpu::headless::test_gpu;
use hairline_gpu::shaders;
use hairline_image::Picture;
use hairline_scene::environment::lookup::{
    environment_bilinear, environment_irradiance, environment_lod, environment_prefiltered,
    environment_radiance, environment_uv,
};
use hairline_scene::environment::{LEVEL_HALVINGS, LEVEL_ROUGHNESS};

/// Unit directions all over the sphere, the poles, the seam and the axes among them.
fn directions() -> Vec<[f32; 3]> {
    let mut directions = vec![
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [-0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [1e-6, 1.0, -1e-6],
        [1e-20, -1.0, 0.0],
        [1e-7, 0.0, 1.0],
        [-1e-7, 0.0, 1.0],
    ];
    directions.extend((0..2000).map(|i| {
        let y = 1.0 - (2.0 * f64::from(i) + 1.0) / 2000.0;
        let phi = f64::from(i) * 2.399_963_229_728_653;
        let r = (1.0 - y * y).sqrt();
        DVec3::new(r * phi.cos(), y, r * phi.sin())
            .as_vec3()
            .to_array()
    }));
    directions
}

fn double(v: &[f32]) -> DVec3 {
    DVec3::new(v[0].into(), v[1].into(), v[2].into())
}

/// A map with a step in every channel; halves hold its values.
fn map() -> Picture {
    let size_px = [64, 32];
    let rgb = (0..64 * 32_u32)
        .map(|i| [(i % 64) as f32, (i / 64) as f32, f32::from(i % 7 == 0)])
        .collect();
    Picture { size_px, rgb }
}

fn padded(picture: &Picture) -> Vec<[f32; 4]> {
    picture
        .rgb
        .iter()
        .map(|c| [c[0], c[1], c[2], 1.0])
        .collect()
}

#[test]
fn map_positions() {
    let Some(gpu) = test_gpu() else { return };
    let rows = directions();
    let call = Call {
        modules: &[&shaders::ENVIRONMENT],
        snippet: "let uv = environment_uv(vec3f(x[0], x[1], x[2])); y[0] = uv.x; y[1] = uv.y;",
        tables: &[],
    };
    let results: Vec<[f32; 2]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, got) in rows.iter().zip(results) {
        let want = environment_uv(double(row));
        let uv = DVec2::new(got[0].into(), got[1].into());
        // 4096 units in the last place for atan2, as WGSL allows, would be 5e-4; drivers keep it below this, which is a
        // hundredth of a texel of the finest level.
        let turn = (uv.x - want.x).abs();
        let from_axis = row[0].hypot(row[2]);
        assert!(
            turn.min(1.0 - turn) < 5e-6 || from_axis < 1e-5,
            "{row:?}: {uv}, not {want}"
        );
        assert!((uv.y - want.y).abs() < 5e-6, "{row:?}: {uv}, not {want}");
    }
}

#[test]
fn radiance_and_interpolation() {
    let Some(gpu) = test_gpu() else { return };
    let map = map();
    let tables = [Table {
        size: map.size_px,
        layers: None,
        texels: Texels::Floats(&padded(&map)),
    }];
    let rows = directions();
    let call = Call {
        modules: &[&shaders::ENVIRONMENT],
        snippet: "let d = vec3f(x[0], x[1], x[2]); let c = environment_radiance(table_0, d);
            y[0] = c.x; y[1] = c.y; y[2] = c.z;",
        tables: &tables,
    };
    let results: Vec<[f32; 3]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, got) in rows.iter().zip(results) {
        let want = environment_radiance(&map, double(row));
        // The step at the seam is 63 over one texel of 1/64: an error of 5e-6 in u is 0.02 there.
        assert!(
            (double(&got) - want).abs().max_element() < 0.03,
            "{row:?}: {got:?}, not {want}"
        );
    }

    // Positions in all corners, at the edges and in between.
    let rows: Vec<[f32; 2]> = (0..=40)
        .flat_map(|i| (0..=40).map(move |j| [i as f32 / 40.0, j as f32 / 40.0]))
        .collect();
    let call = Call {
        snippet: "let c = environment_bilinear(table_0, environment_whole(table_0), vec2f(x[0], x[1])); y[0] = c.x; y[1] = c.y; y[2] = c.z;",
        ..call
    };
    let results: Vec<[f32; 3]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, got) in rows.iter().zip(results) {
        let want = environment_bilinear(&map, DVec2::new(row[0].into(), row[1].into()));
        assert!(
            (double(&got) - want).abs().max_element() < 1e-3,
            "{row:?}: {got:?}, not {want}"
        );
    }
}

#[test]
fn levels() {
    let Some(gpu) = test_gpu() else { return };
    let map = map();
    // Nothing below the first level.
    let [width, height] = map.size_px;
    let texels = [padded(&map), vec![[0.0; 4]; (width * height) as usize]].concat();
    let tables = [Table {
        size: [width, 2 * height],
        layers: None,
        texels: Texels::Floats(&texels),
    }];
    let mut roughness: Vec<f32> = (-10..=110).map(|i| i as f32 / 100.0).collect();
    roughness.extend(LEVEL_ROUGHNESS.map(|r| r as f32));
    let rows: Vec<[f32; 4]> = roughness
        .iter()
        .zip(directions())
        .map(|(&r, d)| [r, d[0], d[1], d[2]])
        .collect();
    let call = Call {
        modules: &[&shaders::ENVIRONMENT],
        snippet: "y[0] = environment_lod(x[0]);
            let c = environment_prefiltered(table_0, vec3f(x[1], x[2], x[3]), x[0]);
            y[1] = c.x; y[2] = c.y; y[3] = c.z;",
        tables: &tables,
    };
    let results: Vec<[f32; 4]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, got) in rows.iter().zip(results) {
        let want = environment_lod(row[0].into());
        // Differences of squares near 0: a few units in the last place of 1/0.0036.
        assert!(
            (f64::from(got[0]) - want).abs() < 1e-4,
            "{row:?}: {got:?}, not {want}"
        );
        // One level alone: the last one is the first.
        let want = environment_prefiltered(std::slice::from_ref(&map), double(&row[1..]), 0.0);
        assert!(
            (double(&got[1..]) - want).abs().max_element() < 0.03,
            "{row:?}: {got:?}, not {want}"
        );
    }
}

#[test]
fn irradiance() {
    let Some(gpu) = test_gpu() else { return };
    let environment = hairline_sky::from_map(map(), 0.0, 1.0, true);
    let blurred = environment.irradiance_map();
    // Layout of the host: below a first level, which is empty here and of that size.
    let [width, height] = blurred.size_px;
    let mut texels = vec![[0.0; 4]; (width * height) as usize];
    texels.extend(blurred.rgb.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]));
    let tables = [Table {
        size: [width, 2 * height],
        layers: None,
        texels: Texels::Floats(&texels),
    }];
    let rows = directions();
    let call = Call {
        modules: &[&shaders::ENVIRONMENT],
        snippet:
            "let c = 3.14159265 * environment_mean_by_cosine(table_0, vec3f(x[0], x[1], x[2]));
            y[0] = c.x; y[1] = c.y; y[2] = c.z;",
        tables: &tables,
    };
    let results: Vec<[f32; 3]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    let brightest = blurred.rgb.iter().flatten().fold(0.0_f32, |a, b| a.max(*b));
    for (row, got) in rows.iter().zip(results) {
        let want = environment_irradiance(blurred, double(row));
        // A place on the map is rounded to a hundred thousandth of a texel.
        assert!(
            (double(&got) - want).abs().max_element() < 1e-4 * f64::from(brightest),
            "{row:?}: {got:?}, not {want}"
        );
    }
}

/// The places of levels are those where the host puts them.
#[test]
fn places_of_levels() {
    let Some(gpu) = test_gpu() else { return };
    let tables = [Table {
        size: [256, 256],
        layers: None,
        texels: Texels::Floats(&vec![[0.0; 4]; 256 * 256]),
    }];
    let call = Call {
        modules: &[&shaders::ENVIRONMENT],
        snippet: "let place = environment_level_place(table_0, i32(x[0]));
            y[0] = f32(place.mip); y[1] = f32(place.row); y[2] = f32(place.size.x); y[3] = f32(place.size.y);",
        tables: &tables,
    };
    let rows: Vec<[f32; 1]> = (0..LEVEL_HALVINGS.len()).map(|i| [i as f32]).collect();
    let results: Vec<[f32; 4]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (i, place) in results.into_iter().enumerate() {
        let halvings = LEVEL_HALVINGS[i];
        let height = 128 >> halvings;
        let is_second = i > 0 && LEVEL_HALVINGS[i - 1] == halvings;
        let row = if is_second { height } else { 0 };
        let want = [halvings, row, 256 >> halvings, height].map(|n| n as f32);
        assert_eq!(place, want, "{i}");
    }
}
