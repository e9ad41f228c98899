//! Comparisons of whole files: the figures of each layer, and reports about layers without any.

use hairline_image::metrics::{Problem, Side, Verdict, compare};
use hairline_image::{Display, Image, Layer, Layers, Noise, Picture, ToneMap};

const DISPLAY: Display = Display {
    exposure_ev: 0.0,
    tone_map: ToneMap::Neutral,
};

fn image() -> Image {
    let mut image = Image::new([32, 24]);
    for i in 0..image.pixel_count() {
        image.base[i] = [0.1, 0.2, 0.3];
        image.scratches[i] = [0.01 * (i % 50) as f32; 3];
        image.density[i] = [0.25; 3];
        image.depth_m[i] = 2.0;
        image.normal[i] = [0.0, 0.6, 0.8];
    }
    image
}

#[test]
fn equal_images() {
    let image = Layers::from(&image());
    let comparison = compare(&image, &image, &DISPLAY, None);
    assert_eq!(comparison.problems, []);
    let layers: Vec<Layer> = comparison.layers.iter().map(|l| l.layer).collect();
    // Neither picture has alpha.
    assert_eq!(layers, Layer::ALL[..6]);
    for layer in &comparison.layers {
        assert_eq!(layer.difference.rms, 0.0);
        assert_eq!(layer.relative_mse, 0.0);
        assert_eq!(layer.psnr.unwrap().db, f64::INFINITY);
        assert_eq!((layer.beyond_noise, layer.z_test), (None, None));
        let black = layer.error_map.picture.rgb[0];
        assert!(layer.error_map.picture.rgb.iter().all(|&c| c == black));
        if let Some(flip) = &layer.flip {
            assert_eq!((flip.mean, flip.percentile_95), (0.0, 0.0));
        }
    }
    assert!(comparison.layers[0].flip.is_some());
}

/// A picture without alpha is opaque: it differs from a transparent one, whatever their colours, and has the alpha of one that says 1.
#[test]
fn alpha_is_compared_and_an_opaque_picture_has_one() {
    let opaque = image();
    let with = |alpha: f32| {
        let alpha = Some(vec![alpha; opaque.pixel_count()]);
        Layers::from(&Image {
            alpha,
            ..opaque.clone()
        })
    };
    let opaque = Layers::from(&opaque);
    for (a, b, rms) in [
        (&opaque, &with(0.25), 0.75),
        (&with(0.25), &opaque, 0.75),
        (&with(1.0), &opaque, 0.0),
        (&with(0.75), &with(0.5), 0.25),
    ] {
        let comparison = compare(a, b, &DISPLAY, None);
        assert_eq!(comparison.problems, []);
        let alpha = comparison.layers.last().unwrap();
        assert_eq!((alpha.layer, alpha.difference.rms), (Layer::Alpha, rms));
    }
}

#[test]
fn a_difference_is_found_in_its_layer() {
    let reference = image();
    let mut other = reference.clone();
    for base in &mut other.base {
        *base = base.map(|c| 1.1 * c);
    }
    let mask: Vec<bool> = (0..other.pixel_count()).map(|i| i > 31).collect();
    let (a, b) = (Layers::from(&other), Layers::from(&reference));
    let comparison = compare(&a, &b, &DISPLAY, Some(&mask));
    for layer in &comparison.layers {
        assert_eq!(layer.difference.pixels, 31 * 24 - 8);
        let differs = matches!(layer.layer, Layer::Beauty | Layer::Base);
        assert_eq!(layer.difference.rms > 0.0, differs, "{:?}", layer.layer);
        if layer.layer == Layer::Base {
            assert!((layer.difference.relative_rms() - 0.1).abs() < 1e-6);
            // 0.01 b^2 over b^2 + (0.1 * 0.2)^2, for b = 0.1, 0.2, 0.3.
            let expected = [0.1, 0.2, 0.3].map(|b: f64| 0.01 * b * b / (b * b + 4e-4));
            let expected = expected.iter().sum::<f64>() / 3.0;
            assert!((layer.relative_mse / expected - 1.0).abs() < 1e-5);
            assert_eq!(layer.psnr.unwrap().peak, 1.0);
        }
        if layer.layer == Layer::Depth {
            assert_eq!(layer.psnr.unwrap().peak, 2.0);
        }
    }
}

#[test]
fn noise_of_either_is_used() {
    let exact = image();
    let mut estimate = exact.clone();
    let mut noise = Noise::new(exact.size_px, 4);
    for i in 0..exact.pixel_count() {
        // One standard deviation this way or that, in a pattern that no block sums up.
        let sign = if (i / 32 + i) % 2 == 0 { 0.01 } else { -0.01 };
        estimate.base[i] = estimate.base[i].map(|c| c + sign);
        noise.base[i] = [1e-4; 3];
        noise.beauty[i] = [1e-4; 3];
        noise.samples[i] = 64;
    }
    estimate.noise = Some(noise);
    let (a, b) = (Layers::from(&exact), Layers::from(&estimate));
    for (a, b) in [(&a, &b), (&b, &a)] {
        let comparison = compare(a, b, &DISPLAY, None);
        let [beauty, base] = [0, 1].map(|i| &comparison.layers[i]);
        for layer in [beauty, base] {
            assert_eq!(layer.z_test.unwrap().verdict, Verdict::ExplainedByNoise);
            assert!(layer.beyond_noise.unwrap().relative_rms() < 1e-3);
            assert!(layer.difference.relative_rms() > 0.02);
        }
        // Depth is no estimate.
        assert_eq!(comparison.layers[4].z_test, None);
    }
}

#[test]
fn sizes_that_differ_are_a_problem() {
    let small = Layers::from(&Image::new([3, 2]));
    let comparison = compare(&small, &Layers::from(&image()), &DISPLAY, None);
    assert!(comparison.layers.is_empty());
    assert_eq!(
        comparison.problems,
        [Problem::SizesDiffer {
            a: [3, 2],
            b: [32, 24]
        }]
    );
    let words = comparison.problems[0].to_string();
    assert!(
        words.contains("3 x 2") && words.contains("32 x 24"),
        "{words}"
    );
}

#[test]
fn missing_layers_and_values_are_problems() {
    let whole = Layers::from(&image());
    let mut part = whole.clone();
    part.held
        .retain(|h| !matches!(h.layer, Layer::Base | Layer::Normal));
    let beauty = &mut part.held[0].values;
    beauty[3] = [f32::NAN, f32::NEG_INFINITY, beauty[3][2]];
    let comparison = compare(&whole, &part, &DISPLAY, None);
    assert_eq!(
        comparison.problems,
        [
            Problem::MissingLayers {
                side: Side::B,
                layers: vec![Layer::Base, Layer::Normal]
            },
            Problem::NotFinite {
                side: Side::B,
                layer: Layer::Beauty,
                values: 2
            },
        ]
    );
    let words: Vec<String> = comparison
        .problems
        .iter()
        .map(ToString::to_string)
        .collect();
    assert!(
        words[0].contains("B lacks the layers base, normal"),
        "{words:?}"
    );
    assert!(
        words[1].contains("2 values in the layer beauty"),
        "{words:?}"
    );
    assert_eq!(comparison.layers.len(), 4);
    let beauty = &comparison.layers[0];
    assert_eq!(
        (beauty.difference.not_finite, beauty.difference.rms),
        (2, 0.0)
    );
    assert_eq!(beauty.relative_mse, 0.0);
    // Green: magma has no such colour.
    assert_eq!(beauty.error_map.picture.rgb[3], [0.0, 1.0, 0.0]);

    let mut other = whole.clone();
    other.held.retain(|h| h.layer == Layer::Depth);
    part.held.retain(|h| h.layer == Layer::Beauty);
    let comparison = compare(&part, &other, &DISPLAY, None);
    assert_eq!(comparison.problems.len(), 3);
    assert_eq!(comparison.problems[2], Problem::NothingInCommon);
}

#[test]
fn a_png_is_compared_with_what_the_display_shows() {
    let render = image();
    // Brighter than the curve leaves alone, so that it matters.
    let display = Display {
        exposure_ev: 1.5,
        tone_map: ToneMap::Agx,
    };
    let codes = hairline_image::png::quantize(&render.beauty(), &display);
    let shown = Layers::of_displayed(Picture {
        size_px: render.size_px,
        rgb: codes
            .chunks(3)
            .map(|c| {
                [0, 1, 2]
                    .map(|i| hairline_image::tone_map::linear_from_srgb(f32::from(c[i]) / 255.0))
            })
            .collect(),
    });
    let render = Layers::from(&render);
    for (a, b, side) in [(&shown, &render, Side::B), (&render, &shown, Side::A)] {
        let comparison = compare(a, b, &display, None);
        assert!(comparison.problems.contains(&Problem::ToneMapped { side }));
        assert_eq!(comparison.layers.len(), 1);
        // Rounding and dither: at most a code, a third of one on average, which is 56 dB.
        assert!(comparison.layers[0].psnr.unwrap().db > 54.0);
        // Another curve is another picture.
        let wrong = compare(a, b, &DISPLAY, None);
        assert!(wrong.layers[0].psnr.unwrap().db < 30.0);
    }
    // Two PNGs need no curve, and there is nothing to say about it.
    let comparison = compare(&shown, &shown, &DISPLAY, None);
    assert_eq!(comparison.problems, []);
}
