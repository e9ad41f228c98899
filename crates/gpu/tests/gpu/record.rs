//! Records of parts of scratches: what texels hold of them is what was put there.

use hairline_gpu::call::Call;
use hairline_gpu::headless::test_gpu;
use hairline_gpu::shaders;

fn pseudo_random(i: u32) -> f32 {
    (f64::from(i) * 0.618_033_988_749_895).fract() as f32
}

/// Six numbers of either sign, from nothing to `most`.
fn rows(most: f32) -> Vec<[f32; 6]> {
    let number = |i: u32| {
        let size = most * 10f32.powf(-6.0 * pseudo_random(i));
        [0.0, size, -size, most][(7.0 * pseudo_random(31 * i + 5)) as usize % 4]
    };
    (0..2_000)
        .map(|row| std::array::from_fn(|i| number(6 * row + i as u32)))
        .collect()
}

/// What a snippet makes of each row; nothing where there is no GPU.
fn results<const N: usize>(snippet: &str, rows: &[[f32; 6]]) -> Vec<[f32; N]> {
    let Some(gpu) = test_gpu() else {
        return Vec::new();
    };
    let call = Call {
        modules: &[&shaders::SCRATCH_RECORD],
        snippet,
        tables: &[],
    };
    gpu.block_on(call.run(gpu, rows)).unwrap()
}

fn largest(row: &[f32]) -> f32 {
    row.iter().fold(1e-30, |most, x| most.max(x.abs()))
}

/// The largest has 127 steps at least, and is off by half of one.
#[test]
fn what_the_base_pays_is_kept_to_four_thousandths() {
    let snippet = "let kept = record_energy(record_energy_word(vec3f(x[0], x[1], x[2])));
        y[0] = kept.x; y[1] = kept.y; y[2] = kept.z;";
    for most in [4.0, 1e-3, 59.0] {
        let rows = rows(most);
        for (row, kept) in rows.iter().zip(results::<3>(snippet, &rows)) {
            let most = 0.0041 * largest(&row[..3]) + 1e-9;
            let is_kept = (0..3).all(|i| (kept[i] - row[i]).abs() <= most);
            assert!(is_kept, "{row:?}: {kept:?}");
        }
    }
}

/// 16 bits of a scale that is up to four times too large.
#[test]
fn what_is_sent_is_kept_and_mixed() {
    let snippet = "let texel = record_station_texel(vec3f(x[0], x[1], x[2]), vec3f(x[3], x[4], x[5]), 0xabcdefu);
        let quarter = record_between(texel, 0.25);
        y[0] = quarter.x; y[1] = quarter.y; y[2] = quarter.z;
        y[3] = f32(record_key(texel) == 0xabcdefu);";
    for most in [1.0, 1e-12, 1e12] {
        let rows = rows(most);
        for (row, y) in rows.iter().zip(results::<4>(snippet, &rows)) {
            let most = 7e-5 * largest(row);
            let is_mixed = (0..3).all(|i| {
                let mixed = row[i] + 0.25 * (row[i + 3] - row[i]);
                (y[i] - mixed).abs() <= most
            });
            assert!(is_mixed && y[3] == 1.0, "{row:?}: {y:?}");
        }
    }
}

/// Places to a thousandth of a pixel, numbers in half floats; the last station to the last.
#[test]
fn shares_are_kept() {
    let snippet = "var record: Record;
        record.middle_px = vec2f(x[0], x[1]) * 4000.0;
        record.last = round(7.0 * abs(x[2]));
        record.half_line = 0.02 * abs(x[3]);
        record.across = vec2f(x[4], x[5]);
        record.along = vec2f(x[5], x[4]);
        record.ends = vec2f(-30.0, 40.0) * x[3];
        record.per_blur = abs(x[4]);
        let kept = record_from_texels(record_texel(record, 0u), record_texel(record, 1u));
        y[0] = abs(kept.last - record.last);
        y[0] += f32(any(abs(kept.middle_px - record.middle_px) > vec2f(2.5e-3)));
        y[0] += f32(any(kept.across != record.across));
        y[0] += f32(any(abs(kept.along - record.along) > 5e-4 * abs(record.along) + 1e-7));
        y[0] += f32(any(abs(kept.ends - record.ends) > 5e-4 * abs(record.ends) + 1e-7));
        y[0] += f32(abs(kept.per_blur - record.per_blur) > 5e-4 * record.per_blur + 1e-7);
        y[0] += f32(abs(kept.half_line - record.half_line) > 5e-4 * record.half_line + 1e-9);";
    let rows = rows(1.0);
    for (row, [wrong]) in rows.iter().zip(results(snippet, &rows)) {
        assert_eq!(wrong, 0.0, "{row:?}");
    }
}
