//! Pictures of the device: visibility, sample after sample, band after band, and errors.

use crate::common::{default_limits, options};
use glam::{DVec2, DVec3, Vec2, Vec3, Vec4};
use hairline_fixtures::{DISK, SceneFile};
use hairline_gpu::headless::{self, test_gpu};
use hairline_gpu::{AdapterRequest, Error, Gpu, GpuScene, RenderOptions, Renderer};
use hairline_image::tone_map::{display_code, dither_offset, linear_from_srgb};
use hairline_image::{Display, Image, Picture, ToneMap};
use hairline_index::ScratchIndex;
use hairline_scene::{Mesh, Sampling, Scene, ScratchTables, Texture};
use std::sync::Arc;

/// A tilted mirror.
fn plate() -> SceneFile {
    SceneFile::seen_from([0.05, -0.22, 0.30])
        .looking_at([0.01, 0.0, 0.0])
        .fov_y_deg(28.0)
        .size_px([97, 64])
        .mirror("steel")
        .with_lines("roughness = 0.1")
        .object("plate", "steel", DISK)
        .with_lines("rotation_deg = [10.0, 20.0, 0.0]")
}

fn upload(renderer: &mut Renderer, scene: &Scene) -> Result<GpuScene, Error> {
    let (index, tables) = (
        Arc::new(ScratchIndex::build(scene)),
        ScratchTables::new(scene),
    );
    let gpu = renderer.gpu().clone();
    gpu.block_on(renderer.upload(scene, &index, &tables, &Default::default()))
}

fn render(gpu: &Gpu, scene: &Scene, options: &RenderOptions) -> Result<Image, Error> {
    headless::render(gpu, scene, &Default::default(), options, &|_| {})
}

/// The depth at which a pixel's ray meets the plate's plane, where it meets the plate; relative to the rim, how far out.
fn plate_hit(scene: &Scene, pixel: DVec2) -> (f64, f64) {
    let mesh = &scene.objects[0].mesh;
    let [a, b, c] = mesh.triangles[0].map(|v| mesh.positions_m[v as usize].as_dvec3());
    let normal = (b - a).cross(c - a).normalize();
    let camera = scene.camera.frame(scene.render.size_px);
    let ray = camera.camera_ray(pixel);
    let depth = (a - camera.position_m).dot(normal) / ray.dot(normal);
    (depth, (camera.position_m + ray * depth).length() / 0.08)
}

#[test]
fn a_disk_is_seen_where_it_is() {
    let Some(gpu) = test_gpu() else { return };
    let scene = plate().scene();
    let image = render(gpu, &scene, &RenderOptions::default()).unwrap();
    let mesh = &scene.objects[0].mesh;
    let normal = mesh.normals[0];
    let mut seen = 0;
    for y in 0..image.size_px[1] {
        for x in 0..image.size_px[0] {
            let i = image.index(x, y);
            let (depth, out) = plate_hit(&scene, DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
            // The rim is a polygon of many corners: within a few tenths of a percent of the circle.
            if out < 0.99 {
                seen += 1;
                assert!(
                    (image.depth_m[i] as f64 / depth - 1.0).abs() < 1e-5,
                    "{x} {y}: {} {depth}",
                    image.depth_m[i]
                );
                assert!(Vec3::from(image.normal[i]).dot(normal) > 1.0 - 1e-6);
            } else if out > 1.001 {
                assert_eq!(
                    (image.depth_m[i], image.normal[i]),
                    (0.0, [0.0; 3]),
                    "{x} {y}"
                );
                assert_eq!((image.base[i], image.scratches[i]), ([0.0; 3], [0.0; 3]));
            }
        }
    }
    assert!(seen > 1000, "the test looks past the plate: {seen}");
}

#[test]
fn bands_join_to_the_same_picture() {
    let Some(gpu) = test_gpu() else { return };
    let scene = plate().scene();
    for samples in [1, 3] {
        let whole = render(
            gpu,
            &scene,
            &RenderOptions {
                samples,
                ..Default::default()
            },
        )
        .unwrap();
        // 64 rows in bands of 5 and of a single one, the last of which is cut.
        for submission_px in [5 * 97 + 20, 1] {
            let banded = render(
                gpu,
                &scene,
                &RenderOptions {
                    submission_px,
                    ..options(samples)
                },
            )
            .unwrap();
            let rim = |i: usize| {
                let pixel = DVec2::new((i % 97) as f64 + 0.5, (i / 97) as f64 + 0.5);
                (plate_hit(&scene, pixel).1 - 1.0).abs() < 0.05
            };
            for i in (0..whole.pixel_count()).filter(|i| !rim(*i)) {
                assert!((whole.depth_m[i] - banded.depth_m[i]).abs() < 1e-6);
                let normals = [whole.normal[i], banded.normal[i]].map(Vec3::from);
                assert!(normals[0].distance(normals[1]) < 1e-6);
            }
        }
    }
}

#[test]
fn some_rows_are_the_pictures() {
    let Some(gpu) = test_gpu() else { return };
    let scene = plate().scene();
    let (index, tables) = (
        Arc::new(ScratchIndex::build(&scene)),
        ScratchTables::new(&scene),
    );
    let options = RenderOptions {
        submission_px: 3 * 97,
        ..Default::default()
    };
    let rows = 20..28;
    let (whole, some) = gpu
        .block_on(async {
            let mut renderer = Renderer::new(gpu).await?;
            let uploaded = renderer
                .upload(&scene, &index, &tables, &Default::default())
                .await?;
            let some = renderer
                .render_rows(&scene, &uploaded, &options, rows, &|_| {})
                .await?;
            let whole = renderer
                .render(&scene, &uploaded, &options, &|_| {})
                .await?;
            Ok::<_, Error>((whole, some))
        })
        .unwrap();
    assert_eq!(some.size_px, [97, 8]);
    assert!(some.depth_m.iter().any(|depth| *depth > 0.0));
    let depths = || some.depth_m.iter().zip(&whole.depth_m[20 * 97..]);
    // A rasteriser may round an edge of the plate differently where bands begin elsewhere.
    let at_the_edge = |(a, b): &(&f32, &f32)| (**a == 0.0) != (**b == 0.0);
    assert!(depths().filter(at_the_edge).count() <= 4);
    assert!(
        depths()
            .filter(|pair| !at_the_edge(pair))
            .all(|(a, b)| (a - b).abs() < 1e-6)
    );
}

#[test]
fn samples_smooth_the_rim() {
    let Some(gpu) = test_gpu() else { return };
    let mut scene = plate().scene();
    scene.materials[0].emission = [1.0; 3];
    let levels = |samples| {
        let image = render(
            gpu,
            &scene,
            &RenderOptions {
                samples,
                ..Default::default()
            },
        )
        .unwrap();
        let brightest = image.base.iter().map(|c| c[1]).fold(0.0, f32::max);
        image
            .base
            .iter()
            .filter(|c| c[1] > 0.1 * brightest && c[1] < 0.9 * brightest)
            .count()
    };
    let rim = levels(16);
    assert!(rim > 60, "{rim} pixels between inside and outside");
}

/// The nearest of several objects is seen, however near it is.
#[test]
fn near_objects_hide_far_ones_down_to_a_tenth_of_a_millimetre() {
    let Some(gpu) = test_gpu() else { return };
    for gap_m in [0.02, 1e-4] {
        let near = format!("disk = {{ radius_m = {} }}", 0.1 * gap_m);
        let scene = SceneFile::seen_from([0.0, 0.0, 0.1])
            .up([0.0, 1.0, 0.0])
            .fov_y_deg(40.0)
            .size_px([32, 32])
            .mirror("m")
            .object("near", "m", &near)
            .with_lines(&format!("translation_m = [0.0, 0.0, {}]", 0.1 - gap_m))
            .object("far", "m", "disk = { radius_m = 0.2 }")
            .scene();
        let image = render(gpu, &scene, &RenderOptions::default()).unwrap();
        let center = image.depth_m[image.index(16, 16)] as f64;
        let corner = image.depth_m[image.index(0, 0)] as f64;
        assert!((center / gap_m - 1.0).abs() < 1e-3, "{center}, not {gap_m}");
        assert!((corner - 0.1).abs() < 1e-6, "{corner}");
    }
}

/// Triangles that reach behind the camera are clipped, not dropped.
#[test]
fn a_plane_under_the_camera_reaches_the_horizon() {
    let Some(gpu) = test_gpu() else { return };
    let mut scene = plate().scene();
    for position in &mut Arc::make_mut(&mut scene.objects[0].mesh).positions_m {
        // The plate, flat and a kilometre wide.
        *position = Vec3::new(position.x, position.y, 0.0) * 1e4;
    }
    scene.camera.position_m = DVec3::new(0.3, 0.2, 0.001);
    scene.camera.target_m = DVec3::new(0.3, 1.2, 0.001);
    let image = render(gpu, &scene, &RenderOptions::default()).unwrap();
    let [width, height] = image.size_px;
    for x in 0..width {
        for y in 0..height {
            // The horizon passes through the middle, between two rows.
            let hit = image.depth_m[image.index(x, y)] > 0.0;
            assert_eq!(hit, y >= height / 2, "{x} {y}");
        }
    }
}

#[test]
fn the_display_shows_what_a_png_would() {
    let Some(gpu) = test_gpu() else { return };
    let scene = plate().scene();
    let size = scene.render.size_px;
    let mut renderer = gpu.block_on(Renderer::new(gpu)).unwrap();
    let uploaded = upload(&mut renderer, &scene).unwrap();
    let image = gpu
        .block_on(renderer.render(&scene, &uploaded, &RenderOptions::default(), &|_| {}))
        .unwrap();
    // Bands of 10 rows, the last of 4.
    let mut canvas = gpu.block_on(renderer.canvas(size, 10 * size[0])).unwrap();
    for band in 0..canvas.bands() {
        gpu.block_on(renderer.accumulate(&scene, &uploaded, &mut canvas, band, 0, &options(1)))
            .unwrap();
    }
    for tone_map in ToneMap::ALL {
        let display = Display {
            exposure_ev: 0.5,
            tone_map,
        };
        let shown = gpu
            .block_on(renderer.read_shown(&canvas, &display))
            .unwrap();
        assert_eq!(shown.len(), 4 * image.pixel_count());
        let beauty = image.beauty();
        for y in 0..size[1] {
            for x in 0..size[0] {
                let expected = display.apply(beauty.pixel(x, y));
                for (c, encoded) in expected.into_iter().enumerate() {
                    let code = display_code(encoded, dither_offset(x, y));
                    let found = shown[4 * image.index(x, y) + c];
                    // The curve's last digit may tip the rounding.
                    assert!(
                        code.abs_diff(found) <= 1,
                        "{tone_map:?} {x} {y}: {found}, not {code}"
                    );
                }
            }
        }
    }
}

/// Texels arrive unfiltered and undistorted, whatever the sizes of the other textures, each decoded as its kind says.
#[test]
fn textures_keep_their_texels() {
    let Some(gpu) = test_gpu() else { return };
    let mut scene = plate().scene();
    scene.camera.position_m = DVec3::new(0.0, 0.0, 1.0);
    scene.camera.target_m = DVec3::ZERO;
    scene.camera.up = DVec3::Y;
    // 1 m high at 1 m: a pixel is a texel.
    scene.camera.fov_y_rad = 2.0 * 0.5f64.atan();
    scene.render.size_px = [12, 6];
    let texels = |count: u8| {
        (0..count)
            .map(|i| [3 * i, 255 - 2 * i, 7 * i % 250, 255])
            .collect::<Vec<_>>()
    };
    let srgb = Texture {
        size_px: [12, 6],
        levels: vec![texels(72), texels(18)],
        srgb: true,
        sampling: Sampling::default(),
    };
    let linear = Texture {
        size_px: [3, 17],
        levels: vec![texels(51)],
        srgb: false,
        sampling: Sampling::default(),
    };
    // Twice as wide as high, like the picture; u, v over it.
    let corner = |x: f32, y: f32| (Vec3::new(x, y, 0.0), Vec2::new(0.5 + 0.5 * x, 0.5 - y));
    let corners = [
        corner(-1.0, -0.5),
        corner(1.0, -0.5),
        corner(1.0, 0.5),
        corner(-1.0, 0.5),
    ];
    scene.objects[0].mesh = Arc::new(Mesh {
        positions_m: corners.map(|c| c.0).to_vec(),
        normals: vec![Vec3::Z; 4],
        tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4],
        uvs: corners.map(|c| c.1).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        triangle_materials: vec![0, 0],
        ..Mesh::default()
    });
    scene.materials[0].emission = [2.0, 1.0, 0.5];
    for (textures, used) in [
        (vec![linear.clone(), srgb.clone()], 1),
        (vec![srgb, linear], 0),
    ] {
        scene.textures = Arc::new(textures);
        scene.materials[0].emission_texture = Some(used);
        // Level 0: the footprint of half a pixel is half a texel.
        let image = render(gpu, &scene, &RenderOptions::default()).unwrap();
        for (i, texel) in scene.textures[used].levels[0].iter().enumerate() {
            for (c, emission) in [2.0, 1.0, 0.5].into_iter().enumerate() {
                let expected = emission * linear_from_srgb(texel[c] as f32 / 255.0);
                let found = image.base[i][c];
                assert!(
                    (found - expected).abs() < 2e-4,
                    "pixel {i}, channel {c}: {found}, not {expected}"
                );
            }
        }
    }
    // The smooth one: the middle of the picture lies on the middle texel of 3 x 17.
    Arc::make_mut(&mut scene.textures).swap(0, 1);
    scene.materials[0].emission_texture = Some(0);
    scene.render.size_px = [13, 7];
    let image = render(gpu, &scene, &RenderOptions::default()).unwrap();
    let texel = scene.textures[0].levels[0][8 * 3 + 1];
    let found = image.base[image.index(6, 3)];
    assert!(
        (found[1] - texel[1] as f32 / 255.0).abs() < 1e-4,
        "{found:?} {texel:?}"
    );
}

/// The background is the map, turned as the scene says and as bright.
#[test]
fn the_environment_is_seen_where_it_is() {
    let Some(gpu) = test_gpu() else { return };
    let mut scene = plate().scene();
    scene.objects.clear();
    let map = Picture {
        size_px: [32, 16],
        rgb: (0..32 * 16)
            .map(|i| [(i % 32) as f32, (i / 32) as f32 * 3.0, 1.0])
            .collect(),
    };
    let visible = hairline_sky::from_map(map, 0.0, 1.5, true).with_up(DVec3::Z, 0.7);
    scene.environment = Some(visible.clone());
    let camera = scene.camera.frame(scene.render.size_px);
    let image = render(gpu, &scene, &RenderOptions::default()).unwrap();
    for y in 0..image.size_px[1] {
        for x in 0..image.size_px[0] {
            let ray = camera
                .camera_ray(DVec2::new(x as f64 + 0.5, y as f64 + 0.5))
                .normalize();
            let expected = visible.radiance(ray).as_vec3();
            let found = Vec3::from(image.base[image.index(x, y)]);
            assert!(
                found.distance(expected) < 1e-3 * expected.length(),
                "{x} {y}: {found}, not {expected}"
            );
        }
    }
    // A map of one colour takes no time to prefilter.
    let white = Picture {
        size_px: [2, 1],
        rgb: vec![[1.0; 3]; 2],
    };
    scene.environment = Some(hairline_sky::from_map(white, 0.0, 1.0, false));
    let image = render(gpu, &scene, &RenderOptions::default()).unwrap();
    assert!(image.base.iter().all(|c| *c == [0.0; 3]));
}

/// The limits of a browser must do.
#[test]
fn default_limits_are_enough() {
    let Some(gpu) = default_limits() else { return };
    assert_eq!(gpu.limits().max_storage_buffers_per_shader_stage, 8);
    assert_eq!(gpu.limits().max_storage_buffer_binding_size, 128 << 20);
    let image = render(&gpu, &plate().scene(), &RenderOptions::default()).unwrap();
    assert!(image.depth_m[image.index(48, 32)] > 0.0);
}

/// A million triangles of 192 bytes do not fit into 128 MiB; that is known before any memory is spent on them.
#[test]
fn a_scene_beyond_one_binding_is_refused_with_figures() {
    let Some(gpu) = default_limits() else { return };
    let mut scene = plate().scene();
    let (index, tables) = (
        Arc::new(ScratchIndex::build(&scene)),
        ScratchTables::new(&scene),
    );
    let mesh = Arc::make_mut(&mut scene.objects[0].mesh);
    mesh.triangles = vec![[0, 1, 2]; 1_000_000];
    mesh.triangle_materials = vec![0; 1_000_000];
    let mut renderer = gpu.block_on(Renderer::new(&gpu)).unwrap();
    let Err(error) = gpu.block_on(renderer.upload(&scene, &index, &tables, &Default::default()))
    else {
        panic!("a million triangles of 192 bytes went into 128 MiB");
    };
    let message = error.to_string();
    assert!(matches!(error, Error::TooLarge { .. }), "{message}");
    assert!(
        ["triangles", "1000000", "192000000 bytes", "134217728"]
            .iter()
            .all(|s| message.contains(s)),
        "{message}"
    );
}

#[test]
fn a_picture_that_is_too_wide_is_refused() {
    let Some(gpu) = test_gpu() else { return };
    let mut scene = plate().scene();
    scene.render.size_px = [gpu.limits().max_texture_dimension_2d + 1, 2];
    let error = render(gpu, &scene, &RenderOptions::default()).unwrap_err();
    assert!(matches!(error, Error::TooLarge { .. }), "{error}");
}

#[test]
fn a_device_lost_between_two_pictures_is_an_error() {
    if test_gpu().is_none() {
        return;
    }
    let gpu = headless::open(&AdapterRequest::default()).unwrap();
    let scene = plate().scene();
    let mut renderer = gpu.block_on(Renderer::new(&gpu)).unwrap();
    let uploaded = upload(&mut renderer, &scene).unwrap();
    let options = RenderOptions::default();
    gpu.block_on(renderer.render(&scene, &uploaded, &options, &|_| {}))
        .unwrap();
    gpu.device.destroy();
    let error = gpu
        .block_on(renderer.render(&scene, &uploaded, &options, &|_| {}))
        .unwrap_err();
    assert!(matches!(error, Error::Lost { .. }), "{error}");
    assert!(matches!(
        gpu.block_on(Renderer::new(&gpu)).err(),
        Some(Error::Lost { .. })
    ));
}

#[test]
fn a_device_lost_in_the_middle_is_an_error() {
    if test_gpu().is_none() {
        return;
    }
    let gpu = headless::open(&AdapterRequest::default()).unwrap();
    let options = RenderOptions {
        submission_px: 10 * 97,
        ..options(2)
    };
    let error = headless::render(
        &gpu,
        &plate().scene(),
        &Default::default(),
        &options,
        &|share| {
            if share > 0.5 {
                gpu.device.destroy();
            }
        },
    )
    .unwrap_err();
    assert!(matches!(error, Error::Lost { .. }), "{error}");
}
