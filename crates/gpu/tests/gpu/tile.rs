//! Lines of scratches in a tile of pixels: what is written of them is what their distances say.

use hairline_gpu::call::Call;
use hairline_gpu::headless::test_gpu;
use hairline_gpu::shaders;

const TILE_PX: usize = 8;
/// Roundings of single precision over distances of some ten pixels; nearly level lines take the place of level ones, which
/// moves them by a thousandth of a pixel.
const TOLERANCE_PX: f32 = 2e-3;

fn pseudo_random(i: u32) -> f32 {
    (f64::from(i) * 0.618_033_988_749_895).fract() as f32
}

/// Ends of a line from the tile's middle, how far pixels see it across and beyond its ends, and a jitter.
fn lines() -> Vec<[f32; 8]> {
    let line = |i: u32| {
        let angle = match i % 5 {
            // Level, upright and diagonal ones.
            0 => (i / 5 % 8) as f32 * std::f32::consts::FRAC_PI_4,
            _ => pseudo_random(i) * std::f32::consts::TAU,
        };
        let middle = [11, 13].map(|k| 8.0 * (2.0 * pseudo_random(k * i + 5) - 1.0));
        let half = [0.2, 2.0, 30.0][i as usize % 3] * (0.5 + pseudo_random(7 * i + 3));
        let [x, y] = [half * angle.cos(), half * angle.sin()];
        let reach = [17, 19].map(|k| 0.2 + 3.0 * pseudo_random(k * i + 1).powi(2));
        let jitter = [23, 29].map(|k| pseudo_random(k * i + 2) - 0.5);
        [
            middle[0] - x,
            middle[1] - y,
            middle[0] + x,
            middle[1] + y,
            reach[0],
            reach[1],
            jitter[0],
            jitter[1],
        ]
    };
    (0..6_000).map(line).collect()
}

/// By how much a pixel is within reach of a line, in pixels; negative beyond it.
fn within_px(line: &[f32; 8], column: usize, row: usize) -> f32 {
    let [ax, ay, bx, by, across, beyond, jx, jy] = *line;
    let [x, y] = [column as f32 + 0.5 + jx - 4.0, row as f32 + 0.5 + jy - 4.0];
    let [dx, dy] = [bx - ax, by - ay];
    let distance = ((x - ax) * dy - (y - ay) * dx).abs() / dx.hypot(dy);
    let outside = |v: f32, a: f32, b: f32| (a.min(b) - v).max(v - a.max(b));
    (across - distance)
        .min(beyond - outside(x, ax, bx))
        .min(beyond - outside(y, ay, by))
}

const NEAR: &str = "let along = vec2f(x[2], x[3]) - vec2f(x[0], x[1]);
    let normal = vec2f(-along.y, along.x) / length(along);
    let first = vec2f(0.5 - 4.0) + vec2f(x[6], x[7]);
    let near = tile_near(vec2f(x[0], x[1]), vec2f(x[2], x[3]), normal, vec2f(x[4], x[5]), first);";

#[test]
fn a_tile_knows_the_pixels_that_a_line_is_near_to() {
    let Some(gpu) = test_gpu() else { return };
    // Halves of words are whole numbers of single precision.
    let snippet = format!(
        "{NEAR}
        y[0] = f32(near.x & 0xffffu);
        y[1] = f32(near.x >> 16u);
        y[2] = f32(near.y & 0xffffu);
        y[3] = f32(near.y >> 16u);"
    );
    let call = Call {
        modules: &[&shaders::TILE_NEAR],
        snippet: &snippet,
        tables: &[],
    };
    let lines = lines();
    let results: Vec<[f32; 4]> = gpu.block_on(call.run(gpu, &lines)).unwrap();
    let (mut near, mut far) = (0, 0);
    for (line, halves) in lines.iter().zip(results) {
        for row in 0..TILE_PX {
            for column in 0..TILE_PX {
                let bit = halves[row / 2] as u32 >> (row % 2 * 8 + column) & 1;
                let within = within_px(line, column, row);
                match within {
                    _ if within > TOLERANCE_PX => assert_eq!(bit, 1, "{line:?} {column} {row}"),
                    _ if within < -TOLERANCE_PX => assert_eq!(bit, 0, "{line:?} {column} {row}"),
                    _ => {}
                }
                near += bit;
                far += 1 - bit;
            }
        }
    }
    assert!(near > 20_000 && far > 20_000, "{near} {far}");
}

/// What a pixel finds in the rows of eight lines is the bit that each line has for it.
#[test]
fn a_pixel_finds_its_bits_of_eight_lines() {
    let Some(gpu) = test_gpu() else { return };
    let call = Call {
        modules: &[&shaders::TILE_NEAR],
        snippet: "var near: array<vec2u, 8>;
            for (var i = 0u; i < 8u; i += 1u) {
                let seed = u32(x[0]) * 8u + i + 1u;
                near[i] = vec2u(seed * 2654435761u, seed * 2246822519u) ^ (vec2u(seed * 3266489917u) >> vec2u(9u));
            }
            let rows = tile_rows(near);
            var wrong = 0u;
            var ones = 0u;
            for (var row = 0u; row < 8u; row += 1u) {
                for (var column = 0u; column < 8u; column += 1u) {
                    let bits = tile_row_bits(rows[row], column);
                    for (var i = 0u; i < 8u; i += 1u) {
                        let bit = (near[i][row / 4u] >> (row % 4u * 8u + column)) & 1u;
                        wrong += u32(((bits >> i) & 1u) != bit);
                        ones += bit;
                    }
                }
            }
            y[0] = f32(wrong);
            y[1] = f32(ones);",
        tables: &[],
    };
    let rows: Vec<[f32; 1]> = (0..64).map(|i| [i as f32]).collect();
    let results: Vec<[f32; 2]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for [wrong, set] in results {
        assert_eq!(wrong, 0.0);
        assert!((128.0..384.0).contains(&set), "{set} of 512 bits are set");
    }
}
