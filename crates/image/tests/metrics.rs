//! Metrics on images whose differences are known.

use hairline_image::metrics::{Difference, away_from_silhouettes, layer_difference};
use hairline_image::{Image, Layer};

#[test]
fn known_differences() {
    let reference = [[3.0], [4.0], [0.0], [f32::NAN]];
    let image = [[3.3], [3.6], [0.0], [1.0]];
    let d = Difference::between(&image, &reference, None);
    assert_eq!((d.pixels, d.not_finite), (4, 1));
    assert!((d.rms - (0.25_f64 / 3.0).sqrt()).abs() < 1e-6);
    assert!((d.relative_rms() - 0.1).abs() < 1e-6);
    assert!((d.max_abs - 0.4).abs() < 1e-6);
    assert!((d.mean - 2.3).abs() < 1e-6 && (d.reference_mean - 7.0 / 3.0).abs() < 1e-6);
    let masked = Difference::between(&image, &reference, Some(&[false, false, true, false]));
    assert_eq!(
        (masked.pixels, masked.not_finite, masked.relative_rms()),
        (1, 0, 0.0)
    );
    let nothing = Difference::between(&image, &reference, Some(&[false; 4]));
    assert_eq!(nothing, Difference::default());
}

#[test]
fn black_references() {
    let black = [[0.0; 3]; 2];
    assert_eq!(
        Difference::between(&black, &black, None).relative_rms(),
        0.0
    );
    let light = [[1.0; 3]; 2];
    assert_eq!(
        Difference::between(&light, &black, None).relative_rms(),
        f64::INFINITY
    );
}

#[test]
fn beauty_is_base_plus_scratches() {
    let mut a = Image::new([2, 1]);
    a.base[0] = [1.0, 2.0, 3.0];
    a.scratches[0] = [0.5; 3];
    let mut b = a.clone();
    std::mem::swap(&mut b.base, &mut b.scratches);
    assert_eq!(a.beauty().pixel(0, 0), [1.5, 2.5, 3.5]);
    assert_eq!(layer_difference(&a, &b, Layer::Beauty, None).rms, 0.0);
    assert!(layer_difference(&a, &b, Layer::Base, None).rms > 0.0);
    assert_eq!(Layer::ALL.map(Layer::name)[4], "depth");
}

#[test]
fn silhouettes_are_left_out() {
    // A hit in the left three columns of five: columns 2 and 3 touch the edge.
    let mut image = Image::new([5, 3]);
    for y in 0..3 {
        for x in 0..3 {
            let i = image.index(x, y);
            image.depth_m[i] = 2.0;
        }
    }
    let mask = away_from_silhouettes(&image, &image, 0.1);
    for y in 0..3 {
        let row: Vec<bool> = (0..5).map(|x| mask[image.index(x, y)]).collect();
        assert_eq!(row, [true, true, false, false, true]);
    }
    // A pixel that only the other image hits is an edge too.
    let mut other = image.clone();
    let corner = other.index(4, 0);
    other.depth_m[corner] = 2.0;
    assert!(!away_from_silhouettes(&image, &other, 0.1)[corner]);
}
