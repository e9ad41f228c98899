//! Shadow rays on the GPU against the CPU's.

use super::pictures::LINEAR;
use super::shadowed::{all_scenes, bounced, closed, luminance, scenes};
use conformance::middle_of;
use conformance::two_renderers::on_the_gpu_by;
use hairline_gpu::Method;
use hairline_image::{Image, Layer, Traced, TracedLight, TracedPixel};
use hairline_scene::Scene;
use std::path::Path;

/// Renders with shadows and `bounces`, or without shadows. None, and a line on stderr, where there is no driver.
pub(super) fn on_gpu(scene: &Scene, samples: u32, bounces: Option<u32>) -> Option<Image> {
    let method = Method {
        mask: LINEAR.mask,
        ..Method::default()
    };
    on_the_gpu_by(scene, &method, samples, bounces)
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// Rays are right in the mean, their error falls with their number, and it is about that of the CPU's.
#[test]
#[ignore = "long: cargo long"]
fn rays_come_to_the_cpus_shadows() {
    for (name, scene) in all_scenes() {
        let Some(open) = on_gpu(&scene, 1, None) else {
            return;
        };
        let truth = closed(&scene, 128, true);
        let cpu_open = closed(&scene, 1, false);
        let by_cpu = closed(&scene, 16, true);
        let images = [2, 16].map(|samples| (samples, on_gpu(&scene, samples, Some(0))));
        for layer in [Layer::Scratches, Layer::Base] {
            let of = |image: &Image| luminance(image, layer);
            let (open, cpu_open, truth) = (of(&open), of(&cpu_open), of(&truth));
            // Differences without shadows, by rounding, are removed.
            let there: Vec<f64> = (0..truth.len())
                .map(|i| truth[i] * (open[i] / cpu_open[i].max(1e-30)))
                .collect();
            let mean = there.iter().sum::<f64>() / there.len() as f64;
            let hidden = 1.0 - mean * open.len() as f64 / open.iter().sum::<f64>();
            assert!(hidden.abs() > 0.05, "{name}: {hidden}");
            let by_cpu: Vec<f64> = of(&by_cpu).iter().zip(&truth).map(|(a, b)| a - b).collect();
            let mut last = f64::INFINITY;
            for (samples, image) in &images {
                let image = of(image.as_ref().unwrap());
                let errors: Vec<f64> = image.iter().zip(&there).map(|(a, b)| a - b).collect();
                let bias = errors.iter().sum::<f64>() / errors.len() as f64;
                let error = rms(&errors);
                let z = bias / (error / (errors.len() as f64).sqrt());
                println!(
                    "{name}, {}, {samples} rays: rms {:.2} % of the mean, mean {:+.3} %, z {z:+.2}; the CPU's 16: {:.2} %",
                    layer.name(),
                    100.0 * error / mean,
                    100.0 * bias / mean,
                    100.0 * rms(&by_cpu) / mean
                );
                assert!(z.abs() < 4.0, "{name}");
                assert!(error < 0.65 * last, "{name}");
                assert!(*samples != 16 || error < 2.5 * rms(&by_cpu), "{name}");
                last = error;
            }
        }
    }
}

/// The scene of the short tests: they share its shaders, which take seconds to compile.
pub(super) fn a_wall() -> (&'static str, Scene) {
    scenes().swap_remove(6)
}

/// Rays change nothing where nothing is in the way. Without them the device adds up the layers, with them the host does: the last bits may differ.
#[test]
fn nothing_in_the_way_changes_nothing_on_the_gpu() {
    check_nothing_in_the_way([a_wall()]);
}

#[test]
#[ignore = "long: cargo long"]
fn nothing_in_the_way_changes_nothing_in_any_scene_on_the_gpu() {
    check_nothing_in_the_way(all_scenes());
}

fn check_nothing_in_the_way(scenes: impl IntoIterator<Item = (&'static str, Scene)>) {
    for (name, mut scene) in scenes {
        scene.objects.truncate(1);
        let Some(open) = on_gpu(&scene, 3, None) else {
            return;
        };
        let seen = on_gpu(&scene, 3, Some(0)).unwrap();
        for (seen, open) in [(seen.base, open.base), (seen.scratches, open.scratches)] {
            let both = seen.iter().flatten().zip(open.iter().flatten());
            let off = both.map(|(a, b)| (a - b).abs() / b.abs().max(1e-30));
            let most = off.fold(0.0, f32::max);
            assert!(most < 1e-6, "{name}: {most}");
        }
    }
}

/// Rays find the same light in each layer as the CPU's, in the mean over the picture.
#[test]
fn what_rays_find_is_what_the_cpus_find() {
    check_what_rays_find(scenes().swap_remove(8));
}

/// The same off gratings alone.
#[test]
fn what_rays_find_off_gratings_is_what_the_cpus_find() {
    let (name, mut scene) = scenes().swap_remove(7);
    let object = &mut scene.objects[0];
    (object.scratches, object.segments) = Default::default();
    for grating in &mut object.gratings {
        grating.is_rigorous = false;
    }
    check_what_rays_find((name, scene));
}

#[test]
#[ignore = "long: cargo long"]
fn what_rays_find_in_other_scenes_is_what_the_cpus_find() {
    all_scenes().skip(7).for_each(check_what_rays_find);
}

fn check_what_rays_find((name, scene): (&str, Scene)) {
    if let Some(on_gpu) = on_gpu(&scene, 32, Some(1)) {
        let on_cpu = bounced(&scene, 32, true, 1);
        compare_found(name, &on_gpu, &on_cpu, &|_| true);
    }
}

/// Rays give equal light on edges, whose samples share scratches and the rays off them.
#[test]
fn on_edges_rays_find_what_the_cpus_find() {
    // In more pixels of the same size the foot of the wall is seen.
    let (_, mut scene) = a_wall();
    scene.render.size_px = [24, 16];
    scene.camera.fov_y_rad *= 2.0;
    check_edges(&scene, 4, 10);
}

#[test]
#[ignore = "long: cargo long"]
fn on_the_edges_of_a_lid_rays_find_what_the_cpus_find() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/lid.toml");
    let scene = middle_of(hairline_document::load(&path).unwrap(), 1280, [72, 56]);
    check_edges(&scene, 8, 60);
}

/// Compares pixels on edges, of which there must be more than some.
fn check_edges(scene: &Scene, samples: u32, least: usize) {
    let Some(on_gpu) = on_gpu(scene, samples, Some(1)) else {
        return;
    };
    let on_cpu = bounced(scene, samples, true, 1);
    let one = closed(scene, 1, false);
    let is_edge = |i: usize| one.density[i] != on_cpu.density[i];
    let edges = (0..one.density.len()).filter(|i| is_edge(*i)).count();
    assert!(edges > least, "{edges}");
    compare_found("edges", &on_gpu, &on_cpu, &is_edge);
}

/// Bound: four standard deviations of the mean, which the differences of the pixels tell, and half a percent for single precision and for what the
/// GPU keeps in fewer bits.
fn compare_found(name: &str, on_gpu: &Image, on_cpu: &Image, counts: &dyn Fn(usize) -> bool) {
    let [on_gpu, on_cpu] = [on_gpu, on_cpu].map(|image| image.traced.as_ref().unwrap());
    assert_eq!(on_gpu.rounds, on_cpu.rounds);
    let compare = |what: &str, of: &dyn Fn(&TracedPixel) -> [f32; 3]| {
        let sums = |found: &Traced| -> Vec<f64> {
            let sum = |i: usize| of(&found.pixels[i]).map(f64::from).iter().sum();
            (0..found.pixels.len())
                .filter(|i| counts(*i))
                .map(sum)
                .collect()
        };
        let (found, truth) = (sums(on_gpu), sums(on_cpu));
        let count = truth.len() as f64;
        let errors: Vec<f64> = found.iter().zip(&truth).map(|(a, b)| a - b).collect();
        let mean = truth.iter().sum::<f64>() / count;
        let off = errors.iter().sum::<f64>() / count;
        let std = rms(&errors) / count.sqrt();
        println!("{name}, {what}: mean {mean:.4e}, off {off:+.2e}, std {std:.1e}");
        assert!(off.abs() <= 5e-3 * mean + 4.0 * std, "{name}, {what}");
    };
    type Layer = fn(&TracedPixel) -> &TracedLight;
    let layers: [(&str, Layer); 3] = [
        ("diffuse", |pixel| &pixel.diffuse),
        ("specular", |pixel| &pixel.specular),
        ("scratches", |pixel| &pixel.scratches),
    ];
    for (layer, light) in layers {
        compare(&format!("{layer} open"), &|pixel| light(pixel).open);
        compare(&format!("{layer} weight"), &|pixel| light(pixel).weight);
        compare(&format!("{layer} seen"), &|pixel| light(pixel).seen);
        compare(&format!("{layer} around"), &|pixel| light(pixel).around);
        compare(&format!("{layer} bounced"), &|pixel| light(pixel).bounced);
    }
}

/// However few rays there are, no light is below zero.
#[test]
fn no_layer_is_negative() {
    let (name, scene) = a_wall();
    for samples in [1, 2, 4] {
        let Some(image) = on_gpu(&scene, samples, Some(1)) else {
            return;
        };
        let layers = [&image.base, &image.scratches].into_iter().flatten();
        let least = layers.flatten().copied().fold(f32::INFINITY, f32::min);
        assert!(least >= 0.0, "{name}, {samples}: {least}");
    }
}
