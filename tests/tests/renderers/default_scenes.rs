//! The default path in all its ways to find scratches and to mask the base: the GPU against the CPU, and tiles of pixels, which
//! share one walk, against pixels that walk for themselves.

use std::ops::Range;
use std::sync::Arc;

use conformance::two_renderers::compare;
use conformance::{Sequence, lay, middle, sphere_light, square};
use glam::{DVec3, Vec3};
use hairline_gpu::{Gpu, GpuScene, RenderOptions, Renderer, headless};
use hairline_image::metrics::layer_difference;
use hairline_image::{Image, Layer};
use hairline_optics::mask::Mask;
use hairline_optics::method::{Lookup, Method, PixelFilter};
use hairline_reference::closed_form::{self, Prepared};
use hairline_scene::{Base, Light, Scene};

/// Largest relative rms difference between two ways to the same scratches: sums in another order, and those that a tile leaves
/// out because their lines are further from a pixel than its footprint reaches.
const SAME: f64 = 1e-4;

/// Tiles see scratches enough there and not too many. No tile divides its sides.
fn odd_middle(name: &str, of_px: u32, side_px: u32) -> Scene {
    middle(name, of_px, [side_px, side_px + 6])
}

/// Both renderers with a scene at hand.
struct Both<'a> {
    name: &'a str,
    scene: &'a Scene,
    prepared: Prepared<'a>,
    renderer: Renderer,
    gpu: Gpu,
}

impl<'a> Both<'a> {
    /// None where there is no driver.
    fn new(name: &'a str, scene: &'a Scene) -> Option<Self> {
        let gpu = headless::test_gpu()?.clone();
        Some(Self {
            name,
            scene,
            prepared: Prepared::new(scene),
            renderer: gpu.block_on(Renderer::new(&gpu)).unwrap(),
            gpu,
        })
    }

    fn upload(&mut self, method: &Method) -> GpuScene {
        let (index, tables) = (self.prepared.scratches(), self.prepared.tables());
        let uploaded = self.renderer.upload(self.scene, index, tables, method);
        let uploaded = self.gpu.block_on(uploaded);
        uploaded.unwrap_or_else(|error| panic!("{method:?}: {error}"))
    }

    fn gpu(&mut self, method: &Method, samples: u32) -> Image {
        self.gpu_rows(method, samples, 0..self.scene.render.size_px[1])
    }

    fn gpu_rows(&mut self, method: &Method, samples: u32, rows: Range<u32>) -> Image {
        let uploaded = self.upload(method);
        let options = RenderOptions {
            samples,
            ..Default::default()
        };
        let image = self
            .renderer
            .render_rows(self.scene, &uploaded, &options, rows, &|_| {});
        let image = self.gpu.block_on(image);
        image.unwrap_or_else(|error| panic!("{}, {method:?}: {error}", self.name))
    }

    /// Fails where the two renderers differ by more than 0.5 % in any layer.
    fn check(&mut self, method: &Method) -> Image {
        let options = closed_form::RenderOptions {
            samples: 1,
            method: *method,
        };
        let (gpu, cpu) = (self.gpu(method, 1), self.prepared.render(&options, &|_| {}));
        let Method {
            lookup,
            footprint,
            mask,
            ..
        } = method;
        let name = format!("{}, {lookup:?}, {footprint:?}, {mask:?}", self.name);
        compare(&name, self.scene, &gpu, &cpu).unwrap_or_else(|error| panic!("{error}"));
        gpu
    }
}

/// Some rows of a picture, in the layers that are compared.
fn rows_of(image: &Image, rows: Range<u32>) -> Image {
    let mut part = Image::new([image.size_px[0], rows.len() as u32]);
    let pixels = image.index(0, rows.start)..image.index(0, rows.end);
    part.base.copy_from_slice(&image.base[pixels.clone()]);
    part.scratches
        .copy_from_slice(&image.scratches[pixels.clone()]);
    part.density.copy_from_slice(&image.density[pixels]);
    part
}

/// The largest relative rms difference of a layer.
fn difference(what: &str, a: &Image, b: &Image) -> f64 {
    let largest = [Layer::Base, Layer::Scratches, Layer::Density]
        .map(|layer| {
            let difference = layer_difference(a, b, layer, None);
            assert_eq!(difference.not_finite, 0, "{what}");
            difference.relative_rms()
        })
        .into_iter()
        .fold(0.0, f64::max);
    println!("{what}: {largest:.2e}");
    largest
}

/// Fails unless tiles and walks show the same, and not by walks alone: sums in another order differ in their last digits.
fn same(what: &str, tiles: &Image, walked: &Image) {
    let largest = difference(what, tiles, walked);
    assert!(largest < SAME, "{what}: {largest}");
    assert!(largest > 0.0, "{what}: no tile had a list");
}

fn method(lookup: Lookup, footprint: PixelFilter, mask: Mask) -> Method {
    Method {
        lookup,
        footprint,
        mask,
        ..Method::default()
    }
}

/// A mask, each way to find scratches with it, and the same picture by all that look at the same pixel.
fn every_way(name: &str, scene: &Scene, mask: Mask) -> Option<Image> {
    let mut both = Both::new(name, scene)?;
    let tiles = both.check(&method(Lookup::Tiles, PixelFilter::Gaussian, mask));
    let walked = both.gpu(&method(Lookup::Bvh, PixelFilter::Gaussian, mask), 1);
    same(&format!("{name}, tiles and walks"), &tiles, &walked);
    // A point in the middle instead of a pixel.
    let off = both.check(&method(Lookup::Tiles, PixelFilter::Off, mask));
    assert!(difference(&format!("{name}, no footprint"), &off, &tiles) > 7e-3);
    let walked = both.gpu(&method(Lookup::Bvh, PixelFilter::Off, mask), 1);
    same(&format!("{name}, tiles and walks of points"), &off, &walked);
    // All scratches of a large triangle are looked at for each pixel: some rows tell.
    let row = walked.size_px[1] / 2;
    let rows = row - 4..row + 4;
    let listed = both.gpu_rows(
        &method(Lookup::Triangles, PixelFilter::Off, mask),
        1,
        rows.clone(),
    );
    let what = format!("{name}, lists and walks of points");
    assert!(difference(&what, &listed, &rows_of(&walked, rows)) < SAME);
    Some(tiles)
}

/// Pixels far wider than the coherence window.
#[test]
fn a_plate() {
    let scene = odd_middle("plate.toml", 1024, 93);
    let Some(energy) = every_way("plate", &scene, Mask::Energy) else {
        return;
    };
    // The other masks are others.
    let mut both = Both::new("plate", &scene).unwrap();
    for mask in [Mask::Linear, Mask::Density] {
        let masked = both.check(&method(Lookup::Tiles, PixelFilter::Gaussian, mask));
        assert!(difference("masks", &masked, &energy) > 7e-3, "{mask:?}");
    }
}

/// Pixels finer than the coherence window.
#[test]
fn a_closeup() {
    every_way(
        "closeup",
        &odd_middle("closeup.toml", 256, 93),
        Mask::Linear,
    );
}

/// Ten lights, among them a star with ten corners.
#[test]
fn ten_lights() {
    every_way("lights", &odd_middle("lights.toml", 768, 77), Mask::Density);
}

/// Half the side of the square below, metres.
const HALF_M: f32 = 0.01;

/// A square whose pixels are about 0.2 mm wide, and one light on the band of all scratches along x.
fn scratched(size_px: [u32; 2], count: u32, across: impl Fn(f32) -> f32) -> Scene {
    let mut scene = square(Base::Mirror, HALF_M, 1);
    scene.render.size_px = size_px;
    let mut random = Sequence(3);
    for _ in 0..count {
        let y = HALF_M * across(random.between(-1.0, 1.0));
        let reach = HALF_M * random.between(0.5, 0.99);
        let (width, depth) = (random.between(0.5, 1.0), random.between(40.0, 400.0));
        let [start, end] = [-reach, reach].map(|x| Vec3::new(x, y, 0.0));
        lay(&mut scene, start, end, width, depth, 1);
    }
    let light = Light::Sphere {
        center_m: DVec3::new(0.0, 0.4, 1.0) * 2.0 * f64::from(HALF_M),
        radius_m: 0.004,
        radiance: [10.0; 3],
    };
    scene.lights.push(light);
    scene
}

fn ways() -> [Method; 2] {
    [Lookup::Tiles, Lookup::Bvh].map(|lookup| Method {
        lookup,
        ..Method::default()
    })
}

/// A pixel sees 15 scratches at the lower edge and 450 at the upper one, a tile three times as many: in the middle and above pixels see
/// more than a batch holds (64), which walk on a software driver.
#[test]
fn more_scratches_than_a_tile_holds() {
    let scene = scratched([61, 53], 5000, |u| 2.0 * (0.5 + 0.5 * u).cbrt() - 1.0);
    let Some(mut both) = Both::new("dense", &scene) else {
        return;
    };
    let [tiles, walked] = ways().map(|way| both.gpu(&way, 1));
    same("dense, one sample", &tiles, &walked);
    let density = |y: u32| tiles.density[tiles.index(30, y)][1];
    assert!(
        density(0) > 5.0 * density(52),
        "{} {}",
        density(0),
        density(52)
    );
    // Jitter moves pixels within their tiles.
    let [tiles, walked] = ways().map(|way| both.gpu(&way, 3));
    same("dense, three samples", &tiles, &walked);

    // Rows that begin within what is a tile of the whole.
    let rows = 13..38;
    let uploaded = both.upload(&ways()[0]);
    let options = RenderOptions {
        samples: 3,
        submission_px: 10 * 61,
    };
    let part = both
        .renderer
        .render_rows(&scene, &uploaded, &options, rows.clone(), &|_| {});
    let part = both.gpu.block_on(part).unwrap();
    let mut expected = rows_of(&tiles, rows);
    assert!(difference("rows", &part, &expected) < SAME);
    // A row off is seen.
    expected.scratches.rotate_left(61);
    assert!(difference("a row off", &part, &expected) > 0.01);
}

/// Scratches under many lights are more work than a software driver does in one go. From far away every pixel sees every light,
/// small and on five lines of the band; but for the lowest they see more scratches than a tile has room for under so many.
#[test]
fn many_lights_on_many_scratches() {
    let mut scene = scratched([21, 19], 420, |u| 2.0 * (0.5 + 0.5 * u).cbrt() - 1.0);
    scene.camera.position_m *= 500.0;
    scene.camera.fov_y_rad = 2.0 * ((0.5 * scene.camera.fov_y_rad).tan() / 500.0).atan();
    scene.lights.clear();
    let mut random = Sequence(5);
    for i in 0..90 {
        let angle: f64 = random.between(-1.2, 1.2).into();
        let corner = |x: f64, angle: f64| DVec3::new(x, 10.0 * angle.sin(), 10.0 * angle.cos());
        let radiance = [random.between(1.0, 100.0).into(); 3];
        scene.lights.push(match i % 2 {
            0 => Light::Sphere {
                center_m: corner(0.0, angle),
                radius_m: 0.05,
                radiance,
            },
            _ => Light::Polygon {
                vertices_m: vec![
                    corner(-0.05, angle),
                    corner(0.05, angle),
                    corner(0.05, angle + 0.01),
                    corner(-0.05, angle + 0.01),
                ],
                radiance,
                two_sided: true,
            },
        });
    }
    let Some(mut both) = Both::new("many lights", &scene) else {
        return;
    };
    let [tiles, walked] = ways().map(|way| both.gpu(&way, 1));
    same("many lights", &tiles, &walked);
    let cpu = both.prepared.render(&Default::default(), &|_| {});
    assert!(difference("many lights, CPU", &tiles, &cpu) < 5e-3);
    let lit = tiles.scratches.iter().filter(|c| c[1] > 0.0).count();
    assert!(lit > 21 * 19 / 2, "{lit} pixels see light from scratches");
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

/// Tiles that see several triangles ask few pixels where these lie in one plane, and each pixel else.
#[test]
fn triangles_smaller_than_a_tile() {
    let flat = |_: f32| 0.0;
    let fold = |x: f32| 0.003 * x.abs();
    let coarser = |scene: &mut Scene| {
        let mut material = scene.materials[0].clone();
        material.coherence_um *= 4.0;
        scene.materials.push(material);
    };
    for side in [3, 8, 24] {
        let mut scene = scratched([61, 53], 300, |u| u);
        cut(&mut scene, side, |_| 0, flat);
        let Some(mut both) = Both::new("small triangles", &scene) else {
            return;
        };
        let [tiles, walked] = ways().map(|way| both.gpu(&way, 1));
        same(&format!("{side} to a side"), &tiles, &walked);

        // Wider footprints beside narrow ones.
        coarser(&mut scene);
        cut(&mut scene, side, |i| i % 2, flat);
        let mut both = Both::new("two materials", &scene).unwrap();
        let [tiles, walked] = ways().map(|way| both.gpu(&way, 1));
        same(&format!("{side} to a side, two materials"), &tiles, &walked);

        // Both slopes are within the reach of footprints.
        cut(&mut scene, side, |_| 0, fold);
        let mut both = Both::new("a fold", &scene).unwrap();
        let [tiles, walked] = ways().map(|way| both.gpu(&way, 1));
        same(&format!("{side} to a side, a fold"), &tiles, &walked);
    }
}

/// Two plates side by side, an edge of which runs through tiles; the other plate's scratches must not show on either.
#[test]
fn two_objects_in_a_tile() {
    let mut scene = scratched([77, 59], 300, |u| u);
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
    let Some(mut both) = Both::new("two plates", &scene) else {
        return;
    };
    let [tiles, walked] = ways().map(|way| both.gpu(&way, 1));
    same("two plates", &tiles, &walked);
    both.check(&ways()[0]);
}

/// Curved meshes seen at a grazing angle, whose normals lean away from their facets: a scratch's line in the picture is not
/// quite what shading sees.
#[test]
fn normals_that_lean() {
    for name in ["spoon.toml", "pan.toml"] {
        let scene = odd_middle(name, 1024, 133);
        let Some(mut both) = Both::new(name, &scene) else {
            return;
        };
        let [tiles, walked] = ways().map(|way| both.gpu(&way, 1));
        same(name, &tiles, &walked);
    }
}
