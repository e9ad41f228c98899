//! Tone mapping: published values, order, bounds, and colours that no display has.

use hairline_image::tone_map::{
    display_code, dither_offset, linear_from_srgb, srgb_from_linear, tone_agx_curve,
    tone_into_gamut, tone_luminance, tone_map, tone_neutral,
};
use hairline_image::{Display, Picture, ToneMap, png};

#[test]
fn names_and_shader_indices_are_in_order() {
    for (i, curve) in ToneMap::ALL.into_iter().enumerate() {
        assert_eq!(curve.shader_index(), i as u32);
    }
    let names: Vec<_> = ToneMap::ALL.iter().map(|t| t.name()).collect();
    assert_eq!(names, ["neutral", "agx", "aces", "none"]);
}

#[test]
fn every_curve_is_total_and_bounded() {
    let values = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        -1.0,
        -1e-30,
        -0.0,
        0.0,
        1e-45,
        1e-6,
        0.18,
        0.76,
        1.0,
        100.0,
        1e6,
    ];
    for curve in ToneMap::ALL {
        for r in values {
            for g in values {
                for b in values {
                    let shown = tone_map(curve, [r, g, b]);
                    assert!(
                        shown.iter().all(|c| (0.0..=1.0).contains(c)),
                        "{curve:?} {:?} -> {shown:?}",
                        [r, g, b]
                    );
                }
            }
        }
    }
}

#[test]
fn greys_stay_grey_and_in_order() {
    for curve in ToneMap::ALL {
        let mut last = -1.0;
        for i in 0..2000 {
            let x = 1e-5 * 1.01_f32.powi(i);
            let shown = tone_map(curve, [x; 3]);
            let (low, high) = shown
                .iter()
                .fold((1.0_f32, 0.0_f32), |(l, h), &c| (l.min(c), h.max(c)));
            // The rows of the published matrices sum to 1 within 1e-4.
            assert!(high - low < 1e-3, "{curve:?}: {x} -> {shown:?}");
            assert!(shown[1] >= last - 1e-6, "{curve:?} falls at {x}");
            last = shown[1];
        }
        assert!(last > 0.97, "{curve:?} ends at {last}");
    }
}

#[test]
fn black_is_black() {
    for curve in ToneMap::ALL {
        // AgX ends at its tenth stop below grey; ACES' fit has a small negative constant. Neither shows in 8 bits.
        let shown = Display {
            exposure_ev: 0.0,
            tone_map: curve,
        }
        .apply([0.0; 3]);
        assert!(
            shown.iter().all(|c| *c < 0.5 / 255.0),
            "{curve:?} {shown:?}"
        );
    }
}

#[test]
fn neutral_follows_its_specification() {
    // Below the compression: x - 0.04 for all components if the smallest is at least 0.08.
    let shown = tone_neutral([0.5, 0.3, 0.1]);
    for (got, want) in shown.iter().zip([0.46, 0.26, 0.06]) {
        assert!((got - want).abs() < 1e-6);
    }
    // The offset below 0.08 is x - 6.25 x^2: it takes a grey of 0.04 to 6.25 * 0.0016 = 0.01.
    assert!((tone_neutral([0.04; 3])[0] - 0.01).abs() < 1e-6);
    // A grey of 1.04 has a peak of 1 after the offset: 1 - 0.24^2 / (1 + 0.24 - 0.76) = 0.88.
    assert!((tone_neutral([1.04; 3])[0] - 0.88).abs() < 1e-6);
    // Saturated red at 10: the peak goes to n = 1 - 0.0576 / (10 - 0.52), the others to g n with
    // g = 1 - 1 / (0.15 (10 - n) + 1).
    let shown = tone_neutral([10.0, 0.0, 0.0]);
    let peak = 1.0 - 0.0576 / 9.48;
    let white = 1.0 - 1.0 / (0.15 * (10.0 - peak) + 1.0);
    assert!((shown[0] - peak).abs() < 1e-6);
    assert!((shown[1] - white * peak).abs() < 1e-6);
}

/// Benjamin Wrensch's polynomial in x for the same curve, published with a mean squared error of 3.7e-6.
fn agx_polynomial(x: f64) -> f64 {
    [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.002_32]
        .iter()
        .fold(0.0, |sum, c| sum * x + c)
}

#[test]
fn agx_curve_agrees_with_its_published_fit() {
    assert!(tone_agx_curve(0.0).abs() < 1e-6);
    assert!((tone_agx_curve(1.0) - 1.0).abs() < 1e-6);
    let mut squares = 0.0;
    for i in 0..=100 {
        let x = f64::from(i) / 100.0;
        let error = f64::from(tone_agx_curve(x as f32)) - agx_polynomial(x);
        squares += error * error;
    }
    assert!(
        squares / 101.0 < 1e-5,
        "mean squared error {}",
        squares / 101.0
    );
}

#[test]
fn matrices_undo_each_other() {
    // Through AgX' inset and outset with a curve that saturates nowhere: white at the top stays white, and a mid
    // grey lands where the curve puts it.
    let white = tone_map(ToneMap::Agx, [1e6; 3]);
    assert!(white.iter().all(|c| (c - 1.0).abs() < 1e-3), "{white:?}");
    let grey = tone_map(ToneMap::Agx, [0.18; 3]);
    let want = 0.5_f32.powf(2.2);
    assert!(
        grey.iter().all(|c| (c - want).abs() < 2e-3),
        "{grey:?} {want}"
    );
}

#[test]
fn aces_reaches_known_values() {
    // Hill's fit on grey is the rational function itself, since the rows of both matrices sum to 1.
    let fit = |v: f32| {
        (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081)
    };
    for v in [0.05, 0.18, 1.0, 4.0] {
        let shown = tone_map(ToneMap::Aces, [v; 3]);
        assert!(shown.iter().all(|c| (c - fit(v)).abs() < 1e-4), "{shown:?}");
    }
}

#[test]
fn out_of_gamut_colours_keep_luminance_and_hue() {
    for rgb in [[-0.3, 1.0, 0.1], [2.0, -0.1, -0.4], [0.0, -0.05, 3.0]] {
        let inside = tone_into_gamut(rgb);
        assert!(inside.iter().all(|c| *c >= 0.0));
        assert!((tone_luminance(inside) - tone_luminance(rgb)).abs() < 1e-5);
        // On the line from the colour to its grey: differences of components keep their ratio.
        let [a, b, c] = rgb;
        let [x, y, z] = inside;
        assert!(((x - y) * (b - c) - (y - z) * (a - b)).abs() < 1e-5);
        // No further than needed.
        assert!(inside.iter().any(|c| *c < 1e-6));
    }
    assert_eq!(tone_into_gamut([0.1, 0.2, 0.3]), [0.1, 0.2, 0.3]);
    assert_eq!(tone_into_gamut([-1.0, 0.1, 0.0]), [0.0; 3]);
}

#[test]
fn srgb_is_its_own_inverse_and_continuous() {
    for i in 0..=255 {
        let encoded = i as f32 / 255.0;
        let back = srgb_from_linear(linear_from_srgb(encoded));
        assert!((back - encoded).abs() < 1e-5);
        assert_eq!(display_code(back, 0.0), i as u8);
    }
    // The two branches meet at 0.0031308 within 1e-6 (IEC 61966-2-1 rounds its constants).
    assert!((srgb_from_linear(0.003_130_9) - srgb_from_linear(0.003_130_8)).abs() < 3e-6);
    assert!((srgb_from_linear(0.5) - 0.735_357).abs() < 1e-5);
}

#[test]
fn dither_keeps_exact_codes_and_the_mean() {
    for code in 0..=255_u32 {
        for i in 0..1000 {
            let offset = dither_offset(i % 37, i / 37);
            assert_eq!(u32::from(display_code(code as f32 / 255.0, offset)), code);
        }
    }
    // A quarter of the way between two codes, a quarter of the pixels take the upper one.
    let size = 64;
    let level = linear_from_srgb(10.25 / 255.0);
    let picture = Picture {
        size_px: [size; 2],
        rgb: vec![[level; 3]; (size * size) as usize],
    };
    let display = Display {
        exposure_ev: 0.0,
        tone_map: ToneMap::None,
    };
    let codes = png::quantize(&picture, &display);
    let mean = codes.iter().map(|c| f64::from(*c)).sum::<f64>() / codes.len() as f64;
    // The R2 sequence's discrepancy over 4096 points is far below 1 %.
    assert!((mean - 10.25).abs() < 0.01, "{mean}");
}
