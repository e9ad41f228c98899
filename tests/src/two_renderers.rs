//! Both renderers' pictures of a scene, and how much they differ.

use glam::DVec2;
use hairline_gpu::headless;
use hairline_image::metrics::{away_from_silhouettes, layer_difference};
use hairline_image::{Image, Layer};
use hairline_index::TriangleIndex;
use hairline_reference::closed_form;
use hairline_scene::Scene;

/// Width of the test pictures.
const WIDTH_PX: u32 = 256;

/// A scene at the tests' size, its proportions kept.
pub fn at_test_size(scene: Scene) -> Scene {
    at_width(scene, WIDTH_PX)
}

/// A scene so many pixels wide, its proportions kept.
pub fn at_width(mut scene: Scene, width_px: u32) -> Scene {
    let [width, height] = scene.render.size_px;
    scene.render.size_px = [width_px, (width_px * height).div_ceil(width)];
    scene
}

/// The GPU's picture; none, and a line on stderr, where there is no driver.
pub fn on_the_gpu(scene: &Scene, samples: u32) -> Option<Image> {
    let gpu = headless::test_gpu()?;
    let options = hairline_gpu::RenderOptions {
        samples,
        ..Default::default()
    };
    let image = headless::render(gpu, scene, &Default::default(), &options, &|_| {});
    Some(image.unwrap_or_else(|error| panic!("{error}")))
}

/// The picture by the closed form.
pub fn on_the_cpu(scene: &Scene, samples: u32) -> Image {
    let options = closed_form::RenderOptions {
        samples,
        ..Default::default()
    };
    closed_form::render(scene, &options, &|_| {})
}

/// Where a pixel's centre lies clear of the edges of its triangle. Within rounding of an edge the rasteriser and the ray may
/// take one neighbour each, whose normals turn differently.
fn on_one_triangle(scene: &Scene) -> Vec<bool> {
    let triangles = TriangleIndex::build(scene);
    let [width, height] = scene.render.size_px;
    let camera = scene.camera.frame([width, height]);
    let pixels = (0..height)
        .flat_map(|y| (0..width).map(move |x| DVec2::new(x as f64 + 0.5, y as f64 + 0.5)));
    let clear = |pixel| {
        let hit = triangles.intersect(camera.position_m, camera.camera_ray(pixel).normalize());
        hit.is_none_or(|hit| {
            let [u, v] = hit.barycentric;
            u.min(v).min(1.0 - u - v) > 2e-3
        })
    };
    pixels.map(clear).collect()
}

/// Compares two pictures of a scene; says by how much they differ and fails beyond 0.5 % in any layer.
pub fn compare(name: &str, scene: &Scene, gpu: &Image, cpu: &Image) -> Result<(), String> {
    let mut interior = away_from_silhouettes(gpu, cpu, 0.01);
    for (inside, on_one) in interior.iter_mut().zip(on_one_triangle(scene)) {
        *inside &= on_one;
    }
    let share = interior.iter().filter(|i| **i).count() as f64 / interior.len() as f64;
    assert!(
        share > 0.8,
        "{name}: only {share} of the pixels lie away from silhouettes"
    );
    for layer in [
        Layer::Beauty,
        Layer::Base,
        Layer::Scratches,
        Layer::Density,
        Layer::Depth,
        Layer::Normal,
    ] {
        let difference = layer_difference(gpu, cpu, layer, Some(&interior));
        println!(
            "{name}, {}: relative rms {:.4} %",
            layer.name(),
            100.0 * difference.relative_rms()
        );
        if difference.not_finite > 0 {
            return Err(format!("{name}, {}: NaN", layer.name()));
        }
        if !(difference.relative_rms() < 5e-3) {
            return Err(format!(
                "{name}, {}: relative rms {:.3} %",
                layer.name(),
                100.0 * difference.relative_rms()
            ));
        }
    }
    Ok(())
}
