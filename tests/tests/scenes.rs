//! Every scene in `scenes/`: the GPU against the CPU's closed form, layer by layer.

use glam::DVec2;
use hairline_gpu::{Renderer, headless};
use hairline_image::Image;
use hairline_image::Layer;
use hairline_image::metrics::{away_from_silhouettes, layer_difference};
use hairline_index::{ScratchIndex, TriangleIndex};
use hairline_reference::closed_form;
use hairline_scene::{Scene, ScratchTables};
use std::path::{Path, PathBuf};

/// Width of the test pictures.
const SIZE_PX: u32 = 256;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

/// A scene at the tests' size, its proportions kept.
fn load(path: &Path) -> Scene {
    let mut scene = Scene::load(path).unwrap_or_else(|error| panic!("{error}"));
    let [width, height] = scene.render.size_px;
    scene.render.size_px = [SIZE_PX, (SIZE_PX * height).div_ceil(width)];
    scene
}

fn on_the_gpu(scene: &Scene, samples: u32) -> Option<Image> {
    let gpu = headless::test_gpu()?;
    let options = hairline_gpu::RenderOptions {
        samples,
        ..Default::default()
    };
    let image = gpu.block_on(async {
        let mut renderer = Renderer::new(gpu).await?;
        let uploaded = renderer
            .upload(
                scene,
                &ScratchIndex::build(scene),
                &ScratchTables::new(scene),
            )
            .await?;
        renderer.render(scene, &uploaded, &options, &|_| {}).await
    });
    Some(image.unwrap_or_else(|error| panic!("{error}")))
}

fn on_the_cpu(scene: &Scene, samples: u32) -> Image {
    closed_form::render(scene, &closed_form::RenderOptions { samples }, &|_| {})
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
fn compare(name: &str, scene: &Scene, gpu: &Image, cpu: &Image) -> Result<(), String> {
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

#[test]
fn gpu_and_cpu_show_the_same() {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(root().join("scenes"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .chain([root().join("apps/hairline/src/built_in_scene.toml")])
        .collect();
    paths.sort();
    let mut failures = Vec::new();
    for path in paths {
        let scene = load(&path);
        let Some(gpu) = on_the_gpu(&scene, 1) else {
            return;
        };
        let name = path.file_stem().unwrap().to_string_lossy();
        failures.extend(compare(&name, &scene, &gpu, &on_the_cpu(&scene, 1)).err());
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
