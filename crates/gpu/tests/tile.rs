//! Lines of scratches in a tile of pixels: what packing loses stays within the margin that the tiles' pass adds.

use hairline_gpu::call::Call;
use hairline_gpu::headless::test_gpu;
use hairline_gpu::shaders;

/// TILE_MARGIN_PX of tiles.wgsl.
const MARGIN_PX: f32 = 0.1;
/// Where a sample of the tile lies at most from its middle: the outermost pixel's centre and a jitter of half a pixel.
const REACH_PX: f32 = 4.0;

fn pseudo_random(i: u32) -> f32 {
    (f64::from(i) * 0.618_033_988_749_895).fract() as f32
}

/// The distances that a packed line has from some points, and whether it is the one that touches all.
fn packed(rows: &[[f32; 5]]) -> Option<Vec<[f32; 2]>> {
    let gpu = test_gpu()?;
    let call = Call {
        modules: &[&shaders::TILE],
        snippet: "let line = pack_tile_line(vec2f(x[0], x[1]), x[2]);
            let unpacked = unpack_tile_line(line);
            y[0] = abs(dot(unpacked.xy, vec2f(x[3], x[4])) - unpacked.z);
            y[1] = select(0.0, 1.0, line == 0u);",
        tables: &[],
    };
    Some(gpu.block_on(call.run(gpu, rows)).unwrap())
}

#[test]
fn a_packed_line_lies_where_it_did() {
    let rows: Vec<[f32; 5]> = (0..20_000)
        .map(|i| {
            let angle = match i % 10 {
                // Level, upright and diagonal ones.
                0 => (i / 10 % 8) as f32 * std::f32::consts::FRAC_PI_4,
                _ => pseudo_random(i) * std::f32::consts::TAU,
            };
            let offset = 15.999 * (2.0 * pseudo_random(7 * i + 3) - 1.0);
            let at = [11, 13].map(|k| REACH_PX * (2.0 * pseudo_random(k * i + 5) - 1.0));
            [angle.cos(), angle.sin(), offset, at[0], at[1]]
        })
        .collect();
    let Some(results) = packed(&rows) else { return };
    for (row, [distance, touches_all]) in rows.iter().zip(results) {
        let [nx, ny, offset, x, y] = *row;
        let expected = (nx * x + ny * y - offset).abs();
        // Half a step of the offset and of either component of the normal leave most of the margin to the surface's bend.
        assert!(
            (distance - expected).abs() < 0.2 * MARGIN_PX,
            "{row:?}: {distance}, not {expected}"
        );
        assert_eq!(touches_all, 0.0, "{row:?}");
    }
}

/// Lines that are too far off for the packing count as touching every pixel, as do lines of which nothing is known.
#[test]
fn a_line_out_of_range_touches_all() {
    let far = [16.0, -16.0, 17.0, 1e6, -1e30, f32::INFINITY, f32::NAN];
    let rows = far.map(|offset| [0.6, -0.8, offset, 3.5, -2.5]);
    let Some(results) = packed(&rows) else { return };
    for (row, result) in rows.iter().zip(results) {
        assert_eq!(result, [0.0, 1.0], "{row:?}");
    }
    // Within the range by a step of the offset.
    let near = packed(&[[0.6, -0.8, 15.99, 0.0, 0.0]]).unwrap();
    assert_eq!(near[0][1], 0.0);
}
