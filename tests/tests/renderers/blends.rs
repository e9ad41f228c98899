//! Surfaces that cover a part of what lies behind them (`alphaMode` `BLEND`): against the exact mean, by both renderers and by Monte Carlo.

use std::sync::Arc;

use conformance::square;
use conformance::two_renderers::{compare_pixels, on_the_cpu, on_the_gpu, on_the_gpu_by};
use glam::DVec3;
use hairline_cpu::closed_form;
use hairline_gpu::Method;
use hairline_image::{Image, Layer};
use hairline_index::TriangleIndex;
use hairline_reference::{Integrator, Model, Settings};
use hairline_scene::{
    AlphaRule, Base, Cutout, Light, LightShape, Material, Sampling, Scene, Texture,
};

const SIZE_PX: u32 = 64;
const SAMPLES: u32 = 16;

/// A picture without light: it sends its colour.
fn unlit(color: [f64; 3]) -> Base {
    Base::MetallicRoughness {
        base_color: color,
        metallic: 0.0,
    }
}

fn sheet(scene: &mut Scene, z_m: f32, material: Material) {
    let mut object = scene.objects[0].clone();
    let mesh = Arc::make_mut(&mut object.mesh);
    for position in &mut mesh.positions_m {
        position.z = z_m;
    }
    mesh.triangle_materials = vec![scene.materials.len() as u32; 2];
    scene.materials.push(material);
    scene.objects.push(object);
}

/// A floor that fills the picture, without light.
fn floor(color: [f64; 3]) -> Scene {
    let mut scene = square(unlit(color), 1.0, SIZE_PX);
    // The middle of the floor alone.
    scene.camera.fov_y_rad = 0.2;
    let material = &mut scene.materials[0];
    material.is_unlit = true;
    material.specular.weight = 0.0;
    scene
}

fn clear(scene: &Scene, color: [f64; 3], alpha: f64) -> Material {
    let rule = AlphaRule::Share;
    Material {
        base: unlit(color),
        cutout: Some(Cutout { alpha, rule }),
        ..scene.materials[0].clone()
    }
}

/// The mean of a layer over the picture.
fn mean(image: &Image, layer: Layer) -> [f64; 3] {
    let values = image.layer(layer);
    let sum = |c: usize| values.iter().map(|p| f64::from(p[c])).sum::<f64>();
    [0, 1, 2].map(|c| sum(c) / values.len() as f64)
}

fn assert_near(name: &str, found: [f64; 3], expected: [f64; 3], off: f64) {
    for c in 0..3 {
        assert!(
            (found[c] - expected[c]).abs() < off,
            "{name}: {found:?}, not {expected:?}"
        );
    }
}

fn reference(scene: &Scene, shadows: bool) -> Image {
    let settings = Settings {
        model: Model::Separable,
        mask: Default::default(),
        bounces: 0,
        shadows,
        seed: 1,
    };
    let integrator = Integrator::new(scene, settings);
    let mut image = integrator.start();
    let _ = integrator.run(&mut image, 64, &|_| std::ops::ControlFlow::Continue(()));
    image
}

/// One sheet and two: the mean is that of the layers composited, and with one sheet no pixel is off by more than a sample.
#[test]
fn sheets_cover_their_share_of_what_lies_behind() {
    let (below, red, blue) = ([0.2, 0.8, 0.4], [1.0, 0.1, 0.1], [0.1, 0.2, 0.9]);
    let mix = |a: [f64; 3], b: [f64; 3], alpha: f64| {
        [0, 1, 2].map(|c| alpha * a[c] + (1.0 - alpha) * b[c])
    };
    let mut scene = floor(below);
    let mut expected = below;
    for (layer, (color, alpha)) in [(red, 0.3), (blue, 0.6)].into_iter().enumerate() {
        let material = clear(&scene, color, alpha);
        sheet(&mut scene, 0.1 * (layer + 1) as f32, material);
        expected = mix(color, expected, alpha);
        let cpu = on_the_cpu(&scene, SAMPLES);
        // The counts of the samples of a pixel are off by less than one a layer; means over 4096 pixels by a hundredth of that.
        assert_near("CPU", mean(&cpu, Layer::Base), expected, 1.5e-3);
        if layer == 0 {
            // But for pixels on the sheet's diagonal: its triangles have numbers of their own.
            let off = 1.01 / f64::from(SAMPLES);
            let is_off =
                |pixel: &&[f32; 3]| (0..3).any(|c| (f64::from(pixel[c]) - expected[c]).abs() > off);
            let beyond = cpu.base.iter().filter(is_off).count();
            assert!(beyond < cpu.base.len() / 20, "{beyond} pixels");
        }
        // Monte Carlo draws each sample by itself: 64 of 4096 pixels.
        let image = reference(&scene, false);
        assert_near("reference", mean(&image, Layer::Base), expected, 4e-3);
        // The same samples see the same: but for a few whose number is their alpha, in single precision.
        let Some(gpu) = on_the_gpu(&scene, SAMPLES) else {
            continue;
        };
        assert_near("GPU", mean(&gpu, Layer::Base), expected, 1.5e-3);
        compare_pixels("sheets", &gpu, &cpu, None).unwrap();
        // A sample alone meets it as often.
        let one = [on_the_cpu(&scene, 1), on_the_gpu(&scene, 1).unwrap()];
        assert!(one[0].base == one[1].base);
        assert_near("one sample", mean(&one[0], Layer::Base), expected, 0.04);
    }
}

/// An image's alpha and that of vertices count; coverage is the picture's alpha; whole surfaces have none of it.
#[test]
fn coverage_is_that_of_images_and_vertices() {
    let mut scene = floor([1.0; 3]);
    scene.materials[0].base_color_texture = Some(0);
    scene.materials[0].cutout = Some(Cutout {
        alpha: 0.5,
        rule: AlphaRule::Share,
    });
    scene.textures = Arc::new(vec![Texture {
        size_px: [1, 1],
        levels: vec![vec![[255, 255, 255, 204]]],
        srgb: true,
        sampling: Sampling::default(),
    }]);
    let mesh = Arc::make_mut(&mut scene.objects[0].mesh);
    mesh.colors = vec![[1.0, 1.0, 1.0, 0.75].into(); 4];
    let expected = 0.5 * 0.8 * 0.75;
    let triangles = TriangleIndex::build(&scene);
    let coverage = hairline_cpu::alpha(&scene, &triangles, SAMPLES, SAMPLES);
    let sum: f64 = coverage.iter().map(|share| f64::from(*share)).sum();
    let share = sum / coverage.len() as f64;
    assert!((share - expected).abs() < 1.5e-3, "{share}");
    let cpu = on_the_cpu(&scene, SAMPLES);
    assert_near("CPU", mean(&cpu, Layer::Base), [expected; 3], 1.5e-3);
    if let Some(gpu) = on_the_gpu(&scene, SAMPLES) {
        compare_pixels("images", &gpu, &cpu, None).unwrap();
    }
}

/// A black sheet between lamp, floor and camera takes its share of the light on its way down, and again on its way up, in all renderers.
#[test]
fn sheets_take_their_share_of_the_light() {
    let mut open = floor([1.0; 3]);
    open.materials[0].is_unlit = false;
    open.materials[0].roughness = 1.0;
    open.lights.push(Light {
        radiance: [300.0; 3],
        shape: LightShape::Sphere {
            center_m: DVec3::new(0.1, 0.2, 1.5),
            radius_m: 0.02,
        },
        cone: None,
        picture: None,
        temperature_k: None,
    });
    let mut covered = open.clone();
    let mut black = clear(&covered, [0.0; 3], 0.4);
    black.is_unlit = true;
    sheet(&mut covered, 0.2, black);
    let check = |name: &str, open: &Image, covered: &Image, off: f64| {
        let (open, covered) = (mean(open, Layer::Base), mean(covered, Layer::Base));
        let share = [0, 1, 2].map(|c| covered[c] / open[c]);
        assert_near(name, share, [0.36; 3], off);
    };
    let by_cpu = |scene: &Scene| {
        let options = closed_form::RenderOptions {
            samples: SAMPLES,
            shadows: true,
            ..Default::default()
        };
        closed_form::render(scene, &options, &|_| {})
    };
    check("CPU", &by_cpu(&open), &by_cpu(&covered), 4e-3);
    check(
        "reference",
        &reference(&open, true),
        &reference(&covered, true),
        6e-3,
    );
    let by_gpu = |scene: &Scene| on_the_gpu_by(scene, &Method::default(), SAMPLES, Some(0));
    if let (Some(open), Some(covered)) = (by_gpu(&open), by_gpu(&covered)) {
        check("GPU", &open, &covered, 4e-3);
    }
}
