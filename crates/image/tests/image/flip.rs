//! FLIP on pictures whose answer is known.

use hairline_image::metrics::{flip, magma};
use hairline_image::{Display, Picture, ToneMap};

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

#[test]
fn the_map_has_the_colours_of_its_authors() {
    let table = nv_flip::magma_lut().to_vec();
    for (n, code) in table.chunks(3).enumerate() {
        let color = DISPLAY.apply(magma(n as f64 / 255.0));
        for c in 0..3 {
            // Their table holds six digits of each colour, this one its 8-bit code.
            assert!((255.0 * color[c] - f32::from(code[c])).abs() < 1.01, "{n}");
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
