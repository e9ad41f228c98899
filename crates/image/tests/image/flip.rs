//! FLIP on pictures whose answer is known.

use hairline_image::metrics::{flip, magma};
use hairline_image::tone_map::linear_from_srgb;
use hairline_image::{Display, Picture, ToneMap};
use std::f32::consts::PI;

const DISPLAY: Display = Display {
    exposure_ev: 0.0,
    tone_map: ToneMap::None,
};

fn flat(value: [f32; 3]) -> Picture {
    Picture {
        size_px: [64, 48],
        rgb: vec![value; 64 * 48],
    }
}

/// Stripes of several widths with a step of brightness.
fn stripes() -> Picture {
    let mut picture = flat([0.2, 0.3, 0.1]);
    for (i, rgb) in picture.rgb.iter_mut().enumerate() {
        if (i % 64) * (i % 64) / 64 % 2 == 0 {
            *rgb = [0.6, 0.2, 0.5];
        }
    }
    picture
}

#[test]
fn from_nothing_to_everything() {
    let picture = stripes();
    let same = flip(&picture, &picture, &DISPLAY, None).unwrap();
    assert_eq!((same.mean, same.percentile_95), (0.0, 0.0));
    assert_eq!(same.map.rgb[0], magma(0.0));
    let opposite = flip(&flat([0.0; 3]), &flat([1.0; 3]), &DISPLAY, None).unwrap();
    // The scale ends at the largest distance of colours, which is green to blue; black and white are at 0.967 of it.
    assert!((opposite.mean - 0.967).abs() < 1e-3, "{}", opposite.mean);
    let farthest = flip(
        &flat([0.0, 1.0, 0.0]),
        &flat([0.0, 0.0, 1.0]),
        &DISPLAY,
        None,
    )
    .unwrap();
    assert!((farthest.mean - 1.0).abs() < 1e-3 && (farthest.percentile_95 - 1.0).abs() < 1e-3);
    assert_eq!(opposite.map.rgb.len(), 64 * 48);
}

#[test]
fn more_difference_is_more_flip() {
    let reference = stripes();
    let mut last = 0.0;
    for gain in [1.02_f32, 1.1, 1.3, 2.0] {
        let mut brighter = reference.clone();
        for rgb in &mut brighter.rgb {
            *rgb = rgb.map(|c| gain * c);
        }
        let there = flip(&brighter, &reference, &DISPLAY, None).unwrap();
        let back = flip(&reference, &brighter, &DISPLAY, None).unwrap();
        assert!(there.mean > last, "{gain}: {} {last}", there.mean);
        assert!(there.percentile_95 >= there.mean);
        // The difference is the same either way, but for the rounding of single precision.
        assert!((there.mean - back.mean).abs() < 1e-4);
        last = there.mean;
    }
}

#[test]
fn a_mask_limits_the_figures() {
    let reference = stripes();
    let mut spoiled = reference.clone();
    for rgb in &mut spoiled.rgb[..64 * 4] {
        *rgb = [1.0; 3];
    }
    let all = flip(&spoiled, &reference, &DISPLAY, None).unwrap();
    let far_below: Vec<bool> = (0..64 * 48).map(|i| i >= 64 * 40).collect();
    let part = flip(&spoiled, &reference, &DISPLAY, Some(&far_below)).unwrap();
    assert!(
        all.mean > 0.01 && part.mean < 1e-3,
        "{} {}",
        all.mean,
        part.mean
    );
    assert_eq!(all.map, part.map);
    assert_eq!(
        flip(&spoiled, &reference, &DISPLAY, Some(&[false; 64 * 48])),
        None
    );
}

#[test]
fn what_the_display_does_not_show_is_no_difference() {
    let (a, b) = (flat([2.0; 3]), flat([5.0; 3]));
    assert_eq!(flip(&a, &b, &DISPLAY, None).unwrap().mean, 0.0);
    let darker = Display {
        exposure_ev: -3.0,
        ..DISPLAY
    };
    assert!(flip(&a, &b, &darker, None).unwrap().mean > 0.1);
    // Values that are not finite have a place on the display, and do no harm.
    let spoiled = flip(&flat([f32::NAN, f32::INFINITY, -1.0]), &b, &DISPLAY, None).unwrap();
    assert!(spoiled.mean.is_finite());
}

/// A picture of waves, number `n`, and the same with one of five faults. Its values are those of codes of 8 bits.
fn waves(n: u32, [width, height]: [u32; 2]) -> [Picture; 2] {
    let mut state = u64::from(n) + 1;
    let mut random = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut pictures = [(); 2].map(|()| Picture::new([width, height]));
    for y in 0..height {
        for x in 0..width {
            let [u, v] = [x as f32 / width as f32, y as f32 / height as f32];
            let wave = |count: f32, phase: f32| {
                0.5 + 0.5 * (2.0 * PI * count * (u + 0.3 * v) + phase).sin()
            };
            let rgb = [wave(2.0 + n as f32, 0.0), wave(5.0, 1.0 + n as f32), u * v];
            let [r, g, b] = rgb;
            let spoiled = match n % 5 {
                0 => rgb.map(|c| 0.9 * c),
                1 => [r, g, 1.0 - b],
                2 => rgb.map(|c| (c + 0.3 * (random() - 0.5)).clamp(0.0, 1.0)),
                3 if (x / 7 + y / 5) % 4 == 0 => [1.0, 0.9, 0.2],
                3 => rgb,
                _ => [g, r, b].map(|c| (1.3 * c).min(1.0)),
            };
            for (picture, rgb) in pictures.iter_mut().zip([rgb, spoiled]) {
                picture.rgb[(y * width + x) as usize] =
                    rgb.map(|c| linear_from_srgb((c * 255.0).round() / 255.0));
            }
        }
    }
    pictures
}

/// Mean and 95th percentile by the evaluator of FLIP's authors (nv-flip 0.1.2). Seen: pixels differ by 7e-6 at most. A feature 5 % wider changes
/// the means by 3e-4 to 1e-3, another shape of the yellow filter by 2e-4 to 7e-4, an exponent of 0.71 by 6e-3.
#[test]
fn errors_are_those_of_the_authors_evaluator() {
    const SIZES_PX: [[u32; 2]; 5] = [[64, 48], [97, 31], [40, 80], [128, 96], [33, 33]];
    let expected = [
        [0.420807, 0.531777],
        [0.800036, 0.961719],
        [0.168567, 0.287339],
        [0.538112, 0.975298],
        [0.749898, 0.974244],
        [0.421377, 0.530766],
        [0.796514, 0.961805],
        [0.168179, 0.294129],
        [0.540289, 0.978595],
        [0.749244, 0.967184],
    ];
    for (n, [mean, percentile_95]) in (0..).zip(expected) {
        let [reference, image] = waves(n, SIZES_PX[n as usize % 5]);
        let found = flip(&image, &reference, &DISPLAY, None).unwrap();
        assert!((found.mean - mean).abs() < 1e-5, "{n}: {}", found.mean);
        assert!(
            (found.percentile_95 - percentile_95).abs() < 1e-4,
            "{n}: {}",
            found.percentile_95
        );
    }
}

#[test]
fn the_map_has_the_colours_of_its_authors() {
    for (n, code) in [
        (0, [0, 0, 4]),
        (32, [29, 17, 71]),
        (64, [81, 18, 124]),
        (100, [137, 40, 129]),
        (128, [183, 55, 121]),
        (160, [231, 82, 99]),
        (200, [253, 152, 105]),
        (255, [252, 253, 191]),
    ] {
        let color = DISPLAY.apply(magma(f64::from(n) / 255.0));
        for c in 0..3 {
            // Their table holds six digits of each colour, this one its 8-bit code.
            assert!(
                (255.0 * color[c] - f32::from(code[c] as u8)).abs() < 1.01,
                "{n}"
            );
        }
    }
}

#[test]
fn tiny_pictures() {
    for size_px in [[1, 1], [3, 1], [1, 7]] {
        let mut a = Picture::new(size_px);
        let b = Picture::new(size_px);
        assert_eq!(flip(&a, &b, &DISPLAY, None).unwrap().mean, 0.0);
        a.rgb[0] = [1.0; 3];
        assert!(flip(&a, &b, &DISPLAY, None).unwrap().mean > 0.0);
    }
    assert_eq!(
        flip(&Picture::new([0, 0]), &Picture::new([0, 0]), &DISPLAY, None),
        None
    );
}
