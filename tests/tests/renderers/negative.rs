//! No light of any scene is negative, however few rays there are: of both renderers, before the filter and after it.

use super::scenes::{ALL, scene};
use conformance::middle_of;
use conformance::two_renderers::on_the_gpu_by;
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_document::DEFAULT_TRANSPORT;
use hairline_gpu::Method;
use hairline_image::tone_map::tone_luminance;
use hairline_image::{Image, filter_traced};
use hairline_scene::Scene;

/// Finds the first pixel, before the filter or after it, whose luminance is negative, or a channel of which is below both zero and the closed
/// form. It tells the layer and the colours.
///
/// Colours of scratches may lie outside of the gamut of Rec.709: the closed form itself has a channel below zero then.
fn no_light(image: &Image) -> Option<String> {
    let mut filtered = image.clone();
    filter_traced(&mut filtered);
    for (stage, image) in [("found", image), ("filtered", &filtered)] {
        for (i, pixel) in image
            .traced
            .iter()
            .flat_map(|found| &found.pixels)
            .enumerate()
        {
            let layers = [
                ("base", image.base[i], [0.0; 3]),
                ("scratches", image.scratches[i], pixel.scratches.open),
                ("diffuse bounced", pixel.diffuse.bounced, [0.0; 3]),
                ("specular bounced", pixel.specular.bounced, [0.0; 3]),
                ("scratches bounced", pixel.scratches.bounced, [0.0; 3]),
            ];
            for (layer, color, open) in layers {
                let rounding = 1e-5 * color.into_iter().fold(0.0, f32::max);
                let is_light =
                    |(value, open): (f32, f32)| value >= 1.0001 * open.min(0.0) - rounding;
                let is_bright = tone_luminance(color) >= 0.0;
                if !is_bright || !color.into_iter().zip(open).all(is_light) {
                    return Some(format!(
                        "{layer} {stage}, pixel {i}: {color:?}, open {open:?}"
                    ));
                }
            }
        }
    }
    None
}

fn check(name: &str, samples: u32, image: &Image) {
    assert!(image.traced.is_some(), "{name} has no rays");
    assert_eq!(no_light(image), None, "{name}, {samples} samples");
}

/// Numbers of samples: one has the fewest rays; with four, their means count, which a few scenes show.
fn numbers_of_samples(name: &str) -> &'static [u32] {
    match name {
        "built_in_scene" | "lights" | "mirror" => &[1, 4],
        _ => &[1],
    }
}

fn small(name: &str) -> Scene {
    middle_of(scene(name), 320, [40, 30])
}

#[test]
#[ignore = "long: cargo long"]
fn no_light_is_negative_on_the_cpu() {
    for &name in ALL {
        let scene = small(name);
        let prepared = Prepared::new(&scene);
        for &samples in numbers_of_samples(name) {
            let options = RenderOptions {
                samples,
                shadows: DEFAULT_TRANSPORT.shadows,
                bounces: DEFAULT_TRANSPORT.bounces,
                ..RenderOptions::default()
            };
            check(name, samples, &prepared.render(&options, &|_| {}));
        }
    }
}

#[test]
#[ignore = "long: cargo long"]
fn no_light_is_negative_on_the_gpu() {
    for &name in ALL {
        let scene = small(name);
        for &samples in numbers_of_samples(name) {
            let bounces = Some(DEFAULT_TRANSPORT.bounces);
            let Some(image) = on_the_gpu_by(&scene, &Method::default(), samples, bounces) else {
                return;
            };
            check(name, samples, &image);
        }
    }
}

/// The search finds one negative channel, and one that is no number.
#[test]
fn one_value_is_told() {
    let options = RenderOptions {
        shadows: true,
        ..RenderOptions::default()
    };
    let image = Prepared::new(&small("plate")).render(&options, &|_| {});
    assert_eq!(no_light(&image), None);
    let mut negative = image.clone();
    negative.base[7][2] = -1e-6;
    assert!(no_light(&negative).is_some());
    let mut nan = image;
    nan.scratches[3][1] = f32::NAN;
    assert!(no_light(&nan).is_some());
}
