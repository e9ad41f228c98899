//! Metrics on images whose differences are known.

use hairline_image::metrics::{
    Difference, away_from_silhouettes, error_map, layer_difference, magma, psnr_displayed,
    psnr_of_values, relative_mse,
};
use hairline_image::{Display, Image, Layer, ToneMap};

#[test]
fn known_differences() {
    let reference = [[3.0], [4.0], [0.0], [f32::NAN]];
    let image = [[3.3], [3.6], [0.0], [1.0]];
    let d = Difference::compare(&image, &reference, None);
    assert_eq!((d.pixels, d.not_finite), (4, 1));
    assert!((d.rms - (0.25_f64 / 3.0).sqrt()).abs() < 1e-6);
    assert!((d.relative_rms() - 0.1).abs() < 1e-6);
    assert!((d.max_abs - 0.4).abs() < 1e-6);
    assert!((d.mean - 2.3).abs() < 1e-6 && (d.reference_mean - 7.0 / 3.0).abs() < 1e-6);
    let masked = Difference::compare(&image, &reference, Some(&[false, false, true, false]));
    assert_eq!(
        (masked.pixels, masked.not_finite, masked.relative_rms()),
        (1, 0, 0.0)
    );
    let nothing = Difference::compare(&image, &reference, Some(&[false; 4]));
    assert_eq!(nothing, Difference::default());
}

#[test]
fn black_references() {
    let black = [[0.0; 3]; 2];
    assert_eq!(
        Difference::compare(&black, &black, None).relative_rms(),
        0.0
    );
    let light = [[1.0; 3]; 2];
    assert_eq!(
        Difference::compare(&light, &black, None).relative_rms(),
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

#[test]
fn relative_mse_follows_the_exposure() {
    let reference: Vec<[f32; 3]> = (0..100).map(|i| [i as f32, 1.0, 0.1]).collect();
    let image: Vec<[f32; 3]> = reference.iter().map(|b| b.map(|c| 1.2 * c + 0.1)).collect();
    let error = relative_mse(&image, &reference, None);
    // Powers of two, exact.
    for exposure in [0.25_f32, 1024.0] {
        let scaled = |values: &[[f32; 3]]| -> Vec<[f32; 3]> {
            values.iter().map(|v| v.map(|c| c * exposure)).collect()
        };
        let again = relative_mse(&scaled(&image), &scaled(&reference), None);
        assert!((again / error - 1.0).abs() < 1e-12);
    }
    // A tenth off where the reference is far above a tenth of its mean.
    let flat = vec![[5.0_f32; 3]; 10];
    let off = vec![[5.5_f32; 3]; 10];
    assert!((relative_mse(&off, &flat, None) - 0.01 / 1.01).abs() < 1e-9);
}

#[test]
fn relative_mse_of_odd_values() {
    let black = [[0.0; 3]; 2];
    let light = [[1.0; 3]; 2];
    assert_eq!(relative_mse(&black, &black, None), 0.0);
    assert_eq!(relative_mse(&light, &black, None), f64::INFINITY);
    assert_eq!(relative_mse(&light, &light, Some(&[false; 2])), 0.0);
    let spoiled = [[f32::NAN, 1.0, f32::INFINITY], [1.0; 3]];
    assert_eq!(relative_mse(&spoiled, &light, None), 0.0);
    assert_eq!(relative_mse(&light, &spoiled, None), 0.0);
}

#[test]
fn known_psnr() {
    // A tenth off everywhere, by a peak of 2: 20 lg 20 = 26.02 dB.
    let reference = [[2.0, 1.0, 0.5], [0.0; 3]];
    let image = reference.map(|b| b.map(|c| c + 0.1));
    let psnr = psnr_of_values(&image, &reference, None).unwrap();
    assert!(
        (psnr.db - 26.0206).abs() < 1e-4 && psnr.peak == 2.0,
        "{psnr:?}"
    );
    assert_eq!(psnr_of_values(&image, &[[0.0; 3]; 2], None), None);
    // Black against white: the whole range.
    let display = Display {
        exposure_ev: 0.0,
        tone_map: ToneMap::None,
    };
    let psnr = psnr_displayed(&[[0.0; 3]], &[[7.0; 3]], &display, None).unwrap();
    assert!(psnr.db.abs() < 1e-5, "{psnr:?}");
    // Beyond the display's range there is no difference to see.
    let psnr = psnr_displayed(&[[3.0; 3]], &[[7.0; 3]], &display, None).unwrap();
    assert_eq!(psnr.db, f64::INFINITY);
    assert_eq!(
        psnr_displayed(&[[f32::NAN; 3]], &[[7.0; 3]], &display, None),
        None
    );
}

#[test]
fn error_maps_brighten_with_the_error() {
    let reference = vec![[1.0_f32; 3]; 6];
    let mut image = reference.clone();
    for (pixel, error) in image.iter_mut().zip([0.0, 1e-4, 1e-2, 0.1, 1.0, 50.0]) {
        *pixel = pixel.map(|c| c + error);
    }
    let map = error_map([6, 1], &image, &reference);
    let brightness: Vec<f32> = map.picture.rgb.iter().map(|c| c.iter().sum()).collect();
    assert_eq!(brightness[0], brightness[1], "below the lowest error");
    assert!(brightness.windows(2).skip(1).all(|pair| pair[0] <= pair[1]));
    assert!(brightness[1] < brightness[2] && brightness[2] < brightness[3]);
    assert_eq!(map.picture.rgb[5], magma(1.0));
    assert_eq!((magma(-1.0), magma(f64::NAN)), (magma(0.0), magma(0.0)));
    // The first and the last colour of the published table, as codes: 0, 0, 4 and 252, 253, 191.
    let display = Display {
        exposure_ev: 0.0,
        tone_map: ToneMap::None,
    };
    let codes = |color| display.apply(color).map(|c| (255.0 * c).round());
    assert_eq!(codes(magma(0.0)), [0.0, 0.0, 4.0]);
    assert_eq!(codes(magma(1.0)), [252.0, 253.0, 191.0]);
}
