//! Both renderers' pictures of a scene, and how much they differ.

use glam::DVec2;
use hairline_cpu::closed_form;
use hairline_gpu::{Method, Renderer, headless};
use hairline_image::metrics::{away_from_silhouettes, layer_difference};
use hairline_image::{Image, Layer};
use hairline_index::{ScratchIndex, TriangleIndex};
use hairline_scene::{Scene, ScratchTables};
use std::sync::Arc;

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

/// Renders on the GPU by a method, with shadows and `bounces`, or without shadows.
pub fn on_the_gpu_by(
    scene: &Scene,
    method: &Method,
    samples: u32,
    bounces: Option<u32>,
) -> Option<Image> {
    let gpu = headless::test_gpu()?;
    let options = hairline_gpu::RenderOptions {
        samples,
        ..Default::default()
    };
    let index = Arc::new(ScratchIndex::build(scene));
    let tables = ScratchTables::new(scene);
    let image = gpu.block_on(async {
        let mut renderer = Renderer::new(gpu).await?;
        let mut uploaded = renderer.upload(scene, &index, &tables, method).await?;
        if let Some(bounces) = bounces {
            renderer.add_shadows(&mut uploaded, scene, bounces).await?;
        }
        renderer.render(scene, &uploaded, &options, &|_| {}).await
    });
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

/// Mask of pixels whose centre lies clear of the edges of its triangle. Within rounding of an edge the rasteriser and the
/// ray may take one neighbour each, whose normals turn differently.
fn on_one_triangle(scene: &Scene) -> Vec<bool> {
    let triangles = TriangleIndex::build(scene);
    let [width, height] = scene.render.size_px;
    let camera = scene.camera.frame([width, height]);
    let pixels = (0..height)
        .flat_map(|y| (0..width).map(move |x| DVec2::new(x as f64 + 0.5, y as f64 + 0.5)));
    let seen = |pixel| triangles.intersect(camera.position_m, camera.camera_ray(pixel).normalize());
    let object = |pixel| seen(pixel).map(|hit| hit.object);
    let clear = |pixel| {
        let inside = seen(pixel).is_none_or(|hit| {
            let [u, v] = hit.barycentric;
            u.min(v).min(1.0 - u - v) > 2e-3
        });
        // One sample of a silhouette may meet another object, as far off as the filter reaches.
        let steps = [-1.0, 0.0, 1.0];
        let mut around = steps.iter().flat_map(|&x| steps.map(|y| DVec2::new(x, y)));
        inside && around.all(|step| object(pixel + step) == object(pixel))
    };
    pixels.map(clear).collect()
}

/// Compares two pictures of a scene away from silhouettes; says by how much they differ and fails beyond 0.5 % in any layer.
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
    compare_pixels(name, gpu, cpu, Some(&interior))
}

/// Compares the pixels of a mask, or all pixels.
pub fn compare_pixels(
    name: &str,
    gpu: &Image,
    cpu: &Image,
    mask: Option<&[bool]>,
) -> Result<(), String> {
    let mut failures = Vec::new();
    for layer in [
        Layer::Beauty,
        Layer::Base,
        Layer::Scratches,
        Layer::Density,
        Layer::Depth,
        Layer::Normal,
    ] {
        let difference = layer_difference(gpu, cpu, layer, mask);
        let percent = 100.0 * difference.relative_rms();
        println!("{name}, {}: relative rms {percent:.4} %", layer.name());
        if difference.not_finite > 0 {
            failures.push(format!("{name}, {}: NaN", layer.name()));
        }
        // Rounding may put a sample beyond a border of materials, where others share its scratches.
        let most = match layer {
            Layer::Density => 1.0,
            Layer::Scratches => 0.7,
            _ => 0.5,
        };
        if !(percent < most) {
            failures.push(format!(
                "{name}, {}: relative rms {percent:.3} %",
                layer.name()
            ));
        }
    }
    if failures.is_empty() {
        Ok(())
    } else {
        Err(failures.join("\n"))
    }
}
