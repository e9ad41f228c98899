//! Outlines: the profile of the pixel's filter, and what a display shows of bright and of transparent ones.

use conformance::two_renderers::{on_the_cpu, on_the_gpu};
use conformance::unbiased::rendered;
use hairline_fixtures::SceneFile;
use hairline_image::png::quantize_image;
use hairline_image::tone_map::srgb_from_linear;
use hairline_image::{Display, Image, ToneMap};
use hairline_index::TriangleIndex;
use hairline_optics::gaussian::gaussian;
use hairline_scene::Transport;
use hairline_work::backend::Backend;

const DISPLAY: Display = Display {
    exposure_ev: 0.0,
    tone_map: ToneMap::None,
};

/// Matt paper of that grey that sends as much, seen straight on from 2 m.
fn paper(grey: f64, shape: &str, placed: &str) -> SceneFile {
    SceneFile::seen_from([0.0, 0.0, 2.0])
        .up([0.0, 1.0, 0.0])
        .fov_y_deg(20.0)
        .part(&format!(
            "[[material]]\nname = \"paper\"\nkind = \"metallic-roughness\"\nmetallic = 0\nspecular = 0\nroughness = 1\nbase_color = [{grey}, {grey}, {grey}]"
        ))
        .object("paper", "paper", shape)
        .with_lines(placed)
        .part("[[light]]\nkind = \"sun\"\ndirection = [0, 0, -1]\nirradiance = 3.14159265")
        .part("[studio]\nhidden = true")
}

/// A plane that ends in the middle of the picture. Any filter, whose width looks for edges near, farther, or in all pixels.
#[test]
fn an_outline_is_as_soft_as_the_filter() {
    for filter_std_px in [0.3, 0.5, 1.0, 2.0, 3.0] {
        let mut scene = paper(
            1.0,
            "plane = { size_m = [4.0, 8.0] }",
            "translation_m = [-2.0, 0.0, 0.0]",
        )
        .size_px([48, 8])
        .scene();
        scene.render.filter_std_px = filter_std_px;
        let images = [Some(on_the_cpu(&scene, 256)), on_the_gpu(&scene, 256)];
        for image in images.into_iter().flatten() {
            for x in 0..48 {
                let right_px = f64::from(x) + 0.5 - 24.0;
                // Samples end at two standard deviations.
                let expected = 1.0 - gaussian().between(-9.0, right_px / filter_std_px);
                let found = f64::from(image.base[image.index(x, 4)][1]);
                assert!(
                    (found - expected).abs() < 0.025,
                    "{filter_std_px}, {right_px}: {found}, not {expected}"
                );
            }
        }
    }
}

fn codes(image: &Image) -> Vec<u8> {
    quantize_image(image, &DISPLAY).unwrap()
}

/// Where a plane ends before nothing its colour stays, and its alpha falls.
#[test]
fn transparent_outlines_keep_their_colour() {
    let scene = paper(
        0.9,
        "plane = { size_m = [0.3, 0.3] }",
        "rotation_deg = [0, 0, 11]",
    )
    .size_px([64, 64])
    .scene();
    let alpha = hairline_cpu::alpha(&scene, &TriangleIndex::build(&scene), 16, 16);
    for image in [Some(on_the_cpu(&scene, 16)), on_the_gpu(&scene, 16)]
        .into_iter()
        .flatten()
    {
        let image = Image {
            alpha: Some(alpha.clone()),
            ..image
        };
        let mut partly = 0;
        for (code, alpha) in codes(&image).chunks_exact(4).zip(&alpha) {
            if *alpha > 0.0 {
                partly += usize::from(*alpha < 0.95);
                // 0.9 in sRGB.
                assert!(code[0].abs_diff(243) <= 2, "alpha {alpha}: {code:?}");
            }
        }
        assert!(partly > 50, "{partly}");
    }
}

/// A lamp as small as a pixel is as bright as its mean says, and so is one out of focus.
#[test]
fn small_bright_lamps_show_their_mean() {
    let plane = "plane = { size_m = [4.0, 4.0] }";
    let mut scene = paper(0.02, plane, "translation_m = [0, 0, -1]")
        .part("[[light]]\nkind = \"sphere\"\ncenter_m = [0, 0, 0]\nradius_m = 0.02\nradiance = 100\nvisible = true")
        .size_px([25, 25])
        .scene();
    for lens_radius_m in [0.0, 0.1] {
        scene.camera.lens.radius_m = lens_radius_m;
        scene.camera.lens.focus_m = 1.0;
        let image = rendered(&scene, Backend::Cpu, 256, Transport::DIRECT).unwrap();
        let shown = codes(&image);
        for (i, rgb) in image.beauty().rgb.iter().enumerate() {
            let expected = (255.0 * srgb_from_linear(rgb[1].min(1.0))).round();
            let found = f32::from(shown[3 * i + 1]);
            assert!(
                (found - expected).abs() <= 1.0,
                "{rgb:?}: {found}, not {expected}"
            );
        }
        assert_eq!(shown[3 * image.index(12, 12) + 1], 255);
    }
}
