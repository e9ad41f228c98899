//! Distinctions that tiles of pixels must make: objects, materials, planes, and rows that begin within a tile.

use std::ops::Range;
use std::sync::Arc;

use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use conformance::{Sequence, lay, middle, sphere_light, square};
use glam::{DVec3, Vec3};
use hairline_cpu::closed_form;
use hairline_gpu::{Method, RenderOptions, Renderer, headless};
use hairline_image::metrics::layer_difference;
use hairline_image::{Image, Layer};
use hairline_index::ScratchIndex;
use hairline_optics::mask::Mask;
use hairline_scene::{Base, Light, Scene, ScratchTables};

/// Number of samples on edges.
const SAMPLES: u32 = 4;
/// Half the side of the square below, metres.
const HALF_M: f32 = 0.01;

/// A square whose pixels are about 0.2 mm wide, and one light on the band of all scratches along x.
fn scratched(size_px: [u32; 2], count: u32) -> Scene {
    let mut scene = square(Base::Mirror, HALF_M, 1);
    scene.render.size_px = size_px;
    let mut random = Sequence(3);
    for _ in 0..count {
        let y = HALF_M * random.uniform(-1.0, 1.0);
        let reach = HALF_M * random.uniform(0.5, 0.99);
        let (width, depth) = (random.uniform(0.5, 1.0), random.uniform(40.0, 400.0));
        let [start, end] = [-reach, reach].map(|x| Vec3::new(x, y, 0.0));
        lay(&mut scene, start, end, width, depth, 1);
    }
    let light = Light::sphere(
        DVec3::new(0.0, 0.4, 1.0) * 2.0 * f64::from(HALF_M),
        0.004,
        [10.0; 3],
    );
    scene.lights.push(light);
    scene
}

/// Fails where the two renderers differ by more than 0.5 % in any layer; nothing where there is no driver.
fn check(name: &str, scene: &Scene) {
    if let Some(gpu) = on_the_gpu(scene, SAMPLES) {
        let cpu = on_the_cpu(scene, SAMPLES);
        compare(name, scene, &gpu, &cpu).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// Cuts the square of a scene into `side` times `side` smaller ones, of two triangles each.
fn cut(
    scene: &mut Scene,
    side: u32,
    material_of: impl Fn(u32) -> u32,
    height_m: impl Fn(f32) -> f32,
) {
    let mesh = Arc::make_mut(&mut scene.objects[0].mesh);
    let (normal, tangent, uv) = (mesh.normals[0], mesh.tangents[0], mesh.uvs[0]);
    let corners = side + 1;
    let at = |i: u32| HALF_M * (2.0 * i as f32 / side as f32 - 1.0);
    mesh.positions_m = (0..corners * corners)
        .map(|i| Vec3::new(at(i % corners), at(i / corners), height_m(at(i % corners))))
        .collect();
    mesh.normals = vec![normal; mesh.positions_m.len()];
    mesh.tangents = vec![tangent; mesh.positions_m.len()];
    mesh.uvs = vec![uv; mesh.positions_m.len()];
    let lowest = (0..side * side).map(|i| i % side + corners * (i / side));
    mesh.triangles = lowest
        .flat_map(|i| {
            [
                [i, i + 1, i + 1 + corners],
                [i, i + 1 + corners, i + corners],
            ]
        })
        .collect();
    mesh.triangle_materials = (0..2 * side * side).map(|i| material_of(i / 2)).collect();
}

/// Wider footprints beside narrow ones, and slopes that are both within the reach of footprints.
#[test]
fn triangles_smaller_than_a_tile() {
    let mut scene = scratched([61, 53], 300);
    let mut coarser = scene.materials[0].clone();
    coarser.coherence_um *= 4.0;
    scene.materials.push(coarser);
    cut(&mut scene, 8, |i| i % 2, |_| 0.0);
    check("two materials", &scene);
    cut(&mut scene, 8, |_| 0, |x| 0.003 * x.abs());
    check("a fold", &scene);
}

/// Lists so long that one line stands for the band of each scratch.
#[test]
fn thousands_of_scratches_in_each_pixel() {
    const SIDE: u32 = 12;
    const FINER: u32 = 4;
    let scene = scratched([SIDE; 2], 40_000);
    let cpu = on_the_cpu(&scene, 1);
    if let Some(gpu) = on_the_gpu(&scene, 1) {
        let difference = of_scratches(&gpu, &cpu);
        assert!(difference < 1e-3, "{difference}");
    }
    // The same scratches by lists that are short enough for all lines, filtered as far as a pixel of the first picture is.
    let mut finer = scene.clone();
    finer.render.size_px = [SIDE * FINER; 2];
    let std_px = scene.render.filter_std_px;
    let left_px = std_px * f64::from(FINER * FINER - 1).sqrt();
    let finer = Image {
        scratches: blurred(&on_the_cpu(&finer, 1), FINER, left_px),
        ..cpu.clone()
    };
    let difference = of_scratches(&cpu, &finer);
    println!("scratches: {difference:.4} off finer pixels");
    // The footprints of wide pixels are off by 0.016 with all lines, too.
    assert!(difference < 0.025, "{difference}");
}

fn of_scratches(found: &Image, expected: &Image) -> f64 {
    layer_difference(found, expected, Layer::Scratches, None).relative_rms()
}

/// The scratches of a square picture under Gaussian filters, in the middles of squares of `step` pixels.
fn blurred(image: &Image, step: u32, std_px: f64) -> Vec<[f32; 3]> {
    let side = image.size_px[0];
    let weight = |middle: u32, at: u32| {
        let off_px = f64::from(at) + 0.5 - f64::from(step) * (f64::from(middle) + 0.5);
        (-0.5 * (off_px / std_px).powi(2)).exp()
    };
    let pixel = |x: u32, y: u32| {
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for (i, value) in (0..).zip(&image.scratches) {
            let weight = weight(x, i % side) * weight(y, i / side);
            sum += weight * Vec3::from(*value).as_dvec3();
            weights += weight;
        }
        (sum / weights).as_vec3().to_array()
    };
    let squares = side / step;
    (0..squares * squares)
        .map(|i| pixel(i % squares, i / squares))
        .collect()
}

/// Two plates side by side, an edge of which runs through tiles; the other plate's scratches must not show on either.
#[test]
fn two_objects_in_a_tile() {
    let mut scene = scratched([77, 59], 300);
    let mut upper = scene.objects[0].clone();
    for position in &mut Arc::make_mut(&mut upper.mesh).positions_m {
        *position = Vec3::new(0.4 * position.x + 0.3e-3, 0.3 * position.y, 1e-3);
    }
    // Upright ones on the upper plate.
    for segment in Arc::make_mut(&mut upper.segments).iter_mut() {
        for end in [&mut segment.start_m, &mut segment.end_m] {
            *end = Vec3::new(0.4 * end.y + 0.3e-3, 0.3 * end.x, 1e-3);
        }
    }
    scene.objects.push(upper);
    scene.lights.push(sphere_light(HALF_M, 0.4));
    check("two plates", &scene);
}

#[test]
fn masks_for_comparison() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let scene = middle("plate.toml", 256, [24; 2]);
    let mut densities = Vec::new();
    for mask in [Mask::Energy, Mask::Linear, Mask::Density] {
        let method = Method {
            mask,
            ..Method::default()
        };
        let options = closed_form::RenderOptions {
            samples: 1,
            mask,
            ..Default::default()
        };
        let cpu = closed_form::render(&scene, &options, &|_| {});
        let image = headless::render(gpu, &scene, &method, &RenderOptions::default(), &|_| {});
        let image = image.unwrap_or_else(|error| panic!("{error}"));
        compare(&format!("{mask:?}"), &scene, &image, &cpu).unwrap();
        densities.push(image.density);
    }
    assert_ne!(densities[0], densities[1]);
    assert_ne!(densities[1], densities[2]);
}

/// Some rows of a picture.
fn rows_of(image: &Image, rows: Range<u32>) -> Image {
    let mut part = Image::new([image.size_px[0], rows.len() as u32]);
    let pixels = image.index(0, rows.start)..image.index(0, rows.end);
    part.base.copy_from_slice(&image.base[pixels.clone()]);
    part.scratches
        .copy_from_slice(&image.scratches[pixels.clone()]);
    part.density.copy_from_slice(&image.density[pixels.clone()]);
    part.depth_m.copy_from_slice(&image.depth_m[pixels.clone()]);
    part.normal.copy_from_slice(&image.normal[pixels]);
    part
}

/// Rows that begin within a tile of the whole, and bands of ten rows.
#[test]
fn a_part_is_the_same_as_in_the_whole() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let scene = scratched([61, 53], 300);
    let rows = 13..38;
    let options = RenderOptions {
        samples: SAMPLES,
        submission_px: 10 * 61,
        ..Default::default()
    };
    let part = gpu.block_on(async {
        let mut renderer = Renderer::new(gpu).await?;
        let (index, tables) = (ScratchIndex::build(&scene), ScratchTables::new(&scene));
        let method = Method::default();
        let uploaded = renderer
            .upload(&scene, &Arc::new(index), &tables, &method)
            .await?;
        renderer
            .render_rows(&scene, &uploaded, &options, rows.clone(), &|_| {})
            .await
    });
    let part = part.unwrap_or_else(|error: hairline_gpu::Error| panic!("{error}"));
    let whole = rows_of(&on_the_cpu(&scene, SAMPLES), rows);
    let off = |a: &Image, b: &Image| {
        let layers = [Layer::Base, Layer::Scratches, Layer::Density];
        let off = layers.map(|layer| layer_difference(a, b, layer, None).relative_rms());
        off.into_iter().fold(0.0, f64::max)
    };
    assert!(off(&part, &whole) < 5e-3, "{}", off(&part, &whole));
    // A row off is seen.
    let mut shifted = whole;
    shifted.scratches.rotate_left(61);
    assert!(off(&part, &shifted) > 0.01);
}
