//! Light from other objects on the GPU against the CPU's, which is tested against the path tracer (`bounced.rs`).

use super::bounced::{a_wall_in_a_mirror, along_an_axis_in_a_mirror, scenes};
use super::shadowed::bounced;
use super::shadowed_on_gpu::{a_wall, on_gpu};
use hairline_image::{Image, Layer};
use hairline_scene::Scene;

const LAYERS: [Layer; 2] = [Layer::Base, Layer::Scratches];

fn sum(values: &[f64]) -> f64 {
    values.iter().sum()
}

/// Luminance that bounces add to a layer of each pixel. Where light goes by several objects, the CPU takes the colour of all gratings for that of one
/// ray.
fn added(with: &Image, without: &Image, layer: Layer) -> Vec<f64> {
    let luminance = |image: &Image| -> Vec<f64> {
        let pixels = match layer {
            Layer::Base => &image.base,
            _ => &image.scratches,
        };
        let of = |rgb: &[f32; 3]| {
            let [r, g, b] = rgb.map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        pixels.iter().map(of).collect()
    };
    let (with, without) = (luminance(with), luminance(without));
    with.iter().zip(without).map(|(a, b)| a - b).collect()
}

/// A picture with and without bounces, with the same rays for its shadows.
fn pair(picture: impl Fn(u32) -> Option<Image>, bounces: u32) -> Option<[Image; 2]> {
    Some([picture(bounces)?, picture(0)?])
}

/// Other objects add the same light as on the CPU, in the mean over the picture. Bound: four standard deviations of the mean, which the differences
/// of the pixels tell and which are one to two percent, and 0.2 % for single precision and for what the GPU keeps in fewer bits.
#[test]
#[ignore = "long: cargo long"]
fn the_gpus_bounces_are_the_cpus_in_the_mean() {
    let more = [
        ("along an axis", along_an_axis_in_a_mirror()),
        ("a wall in a mirror", a_wall_in_a_mirror()),
    ];
    let scenes = scenes().into_iter().chain(more);
    let few = [1, 1, 3, 1, 1].map(|bounces| (bounces, 64));
    let settings = few.into_iter().chain([(1, 96), (2, 384)]);
    for ((bounces, samples), (name, scene)) in settings.zip(scenes) {
        let on_gpu = |bounces| on_gpu(&scene, samples, Some(bounces));
        let Some([with, without]) = pair(on_gpu, bounces) else {
            return;
        };
        let on_cpu = |bounces| Some(bounced(&scene, 2 * samples, true, bounces));
        let by_cpu = pair(on_cpu, bounces).unwrap();
        for layer in LAYERS {
            let found = added(&with, &without, layer);
            assert!(found.iter().all(|v| v.is_finite()), "{name}");
            let truth = added(&by_cpu[0], &by_cpu[1], layer);
            let errors: Vec<f64> = found.iter().zip(&truth).map(|(a, b)| a - b).collect();
            let count = errors.len() as f64;
            let variance = sum(&errors.iter().map(|e| e * e).collect::<Vec<_>>()) / count;
            let mean = sum(&truth) / count;
            let off = sum(&errors) / count / mean.max(1e-30);
            let std = (variance / count).sqrt() / mean.max(1e-30);
            println!(
                "{name}, {}, {bounces}: {:+.3} % of what is added, std {:.3} %; a pixel {:.2} %",
                layer.name(),
                100.0 * off,
                100.0 * std,
                100.0 * variance.sqrt() / mean.max(1e-30)
            );
            if mean == 0.0 {
                assert!(found.iter().all(|v| *v == 0.0), "{name}");
                continue;
            }
            assert!(std < 0.018, "{name}: {std}");
            assert!(off.abs() < 2e-3 + 4.0 * std, "{name}: {off} {std}");
        }
    }
}

/// A bounce changes no bit where light has no object to go by.
#[test]
fn without_objects_the_gpus_bounces_change_nothing() {
    check_without_objects(a_wall());
}

#[test]
#[ignore = "long: cargo long"]
fn without_objects_the_gpus_bounces_change_nothing_in_any_scene() {
    scenes().into_iter().for_each(check_without_objects);
}

fn check_without_objects((name, mut scene): (&str, Scene)) {
    scene.objects.truncate(1);
    let Some(direct) = on_gpu(&scene, 3, Some(0)) else {
        return;
    };
    let bounced = on_gpu(&scene, 3, Some(2)).unwrap();
    let layers = |image: Image| (image.base, image.scratches);
    assert!(layers(bounced) == layers(direct), "{name}");
}
