//! Contents of models: images beyond their borders and by other coordinates, colours of vertices, surfaces without light, and cutouts.

use std::path::Path;
use std::sync::Arc;

use conformance::two_renderers::{compare, compare_pixels, on_the_cpu, on_the_gpu, on_the_gpu_by};
use conformance::{Sequence, middle_of, square};
use glam::{DVec3, Vec2, Vec3, Vec4, vec2};
use hairline_cpu::closed_form;
use hairline_fixtures::SceneFile;
use hairline_gpu::Method;
use hairline_image::Image;
use hairline_image::tone_map::linear_from_srgb;
use hairline_index::TriangleIndex;
use hairline_scene::{
    AlphaRule, Anisotropy, Base, Coat, Cutout, Light, LightShape, Mesh, Sampling, Scene, Specular,
    Texture, Wrap,
};

const HALF_M: f32 = 0.1;

/// A white square under a lamp.
fn white() -> Scene {
    let base = Base::MetallicRoughness {
        base_color: [1.0; 3],
        metallic: 0.0,
    };
    let mut scene = square(base, HALF_M, 96);
    scene.materials[0].roughness = 0.4;
    scene.lights.push(Light {
        radiance: [200.0; 3],
        shape: LightShape::Sphere {
            center_m: DVec3::new(0.0, 0.0, 0.4),
            radius_m: 0.004,
        },
        cone: None,
        picture: None,
        temperature_k: None,
    });
    scene
}

fn mesh_of(scene: &mut Scene) -> &mut Mesh {
    Arc::make_mut(&mut scene.objects[0].mesh)
}

/// Eight texels by four of many colours.
fn motley(sampling: Sampling) -> Texture {
    let texel = |i: u32, step: u32| [i * step % 251, i * 2 * step % 253, i * 5 * step % 256, 255];
    let level = |count: u32, step| {
        (0..count)
            .map(|i| texel(i + 1, step).map(|c| c as u8))
            .collect()
    };
    Texture {
        size_px: [8, 4],
        levels: vec![level(32, 37), level(8, 41), level(2, 43), level(1, 91)],
        srgb: true,
        sampling,
    }
}

#[test]
fn images_beyond_their_borders_and_colours_of_vertices() {
    for (i, wrap) in [
        [Wrap::Mirror, Wrap::Clamp],
        [Wrap::Clamp, Wrap::Repeat],
        [Wrap::Repeat, Wrap::Mirror],
    ]
    .into_iter()
    .enumerate()
    {
        let mut scene = white();
        let corners = [[-1.2, 2.3], [1.9, 2.1], [2.6, -1.4], [-1.6, -1.1]];
        let mesh = mesh_of(&mut scene);
        mesh.uvs = vec![Vec2::ZERO, vec2(9.0, 0.0), vec2(9.0, 9.0), vec2(0.0, 9.0)];
        mesh.other_uvs = corners.map(Vec2::from).to_vec();
        let colors = [[1.0, 0.2, 0.5], [0.1, 1.0, 0.9], [0.4, 0.5, 1.0], [1.0; 3]];
        mesh.colors = colors.map(|c| Vec3::from(c).extend(1.0)).to_vec();
        let sampling = Sampling {
            wrap,
            is_sharp: i % 2 == 0,
            by_other_uvs: true,
        };
        let plain = Sampling::default();
        scene.textures = Arc::new(vec![motley(plain), motley(sampling)]);
        scene.materials[0].base_color_texture = Some(1);
        scene.materials[0].metallic_roughness_texture = Some(0);
        let cpu = on_the_cpu(&scene, 1);
        let Some(gpu) = on_the_gpu(&scene, 1) else {
            return;
        };
        let name = format!("{wrap:?}");
        compare_pixels(&name, &gpu, &cpu, None).unwrap();
        // The colours are seen.
        let means = [0, 1, 2].map(|c| cpu.base.iter().map(|p| p[c]).sum::<f32>());
        assert!(
            means[0] > 1.02 * means[1] || means[1] > 1.02 * means[0],
            "{means:?}"
        );
    }
}

#[test]
fn a_surface_without_light_sends_its_colour() {
    let mut scene = white();
    let mesh = mesh_of(&mut scene);
    mesh.colors = vec![Vec4::new(0.5, 0.25, 1.0, 1.0); 4];
    scene.textures = Arc::new(vec![Texture {
        size_px: [1, 1],
        levels: vec![vec![[200, 100, 50, 255]]],
        srgb: true,
        sampling: Sampling::default(),
    }]);
    let material = &mut scene.materials[0];
    material.base_color_texture = Some(0);
    material.is_unlit = true;
    material.specular.weight = 0.0;
    let expected = [(200, 0.5), (100, 0.25), (50, 1.0)]
        .map(|(code, color)| color * linear_from_srgb(code as f32 / 255.0));
    let check = |image: &Image| {
        let seen = image.base[image.index(48, 48)];
        for c in 0..3 {
            assert!(
                (seen[c] - expected[c]).abs() < 1e-4,
                "{seen:?}, not {expected:?}"
            );
        }
    };
    check(&on_the_cpu(&scene, 1));
    let Some(gpu) = on_the_gpu(&scene, 1) else {
        return;
    };
    check(&gpu);
}

/// The square, and 3 cm over it a lid that is there in its left half alone.
fn half_a_lid() -> Scene {
    let mut scene = white();
    let mut lid = scene.objects[0].clone();
    let mesh = Arc::make_mut(&mut lid.mesh);
    for position in &mut mesh.positions_m {
        position.z = 0.03;
    }
    mesh.uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]
        .map(Vec2::from)
        .to_vec();
    mesh.triangle_materials = vec![1; 2];
    lid.name = "lid".into();
    scene.objects.push(lid);
    scene.textures = Arc::new(vec![Texture {
        size_px: [2, 1],
        levels: vec![vec![[255, 0, 0, 255], [255, 0, 0, 0]]],
        srgb: true,
        sampling: Sampling {
            wrap: [Wrap::Clamp; 2],
            is_sharp: true,
            by_other_uvs: false,
        },
    }]);
    let mut material = scene.materials[0].clone();
    material.base_color_texture = Some(0);
    material.cutout = Some(Cutout {
        alpha: 0.8,
        rule: AlphaRule::AtLeast(0.5),
    });
    scene.materials.push(material);
    scene
}

#[test]
fn rays_go_through_what_is_cut_out() {
    let scene = half_a_lid();
    let triangles = TriangleIndex::build(&scene);
    for (x, is_there) in [(-0.05, true), (-0.001, true), (0.001, false), (0.05, false)] {
        let (above, below) = (DVec3::new(x, 0.01, 0.2), DVec3::new(x, 0.01, 0.01));
        let hit = triangles.intersect(above, DVec3::NEG_Z).unwrap();
        assert_eq!(hit.object == 1, is_there, "{x}");
        assert_eq!(triangles.is_hidden(below, DVec3::Z, 1.0), is_there, "{x}");
        assert_eq!(
            triangles.intersect_solid(below, DVec3::Z).is_some(),
            is_there,
            "{x}"
        );
    }
}

/// Pictures with shadows.
fn shadowed(scene: &Scene, samples: u32) -> Option<[Image; 2]> {
    let options = closed_form::RenderOptions {
        samples,
        shadows: true,
        ..Default::default()
    };
    let cpu = closed_form::render(scene, &options, &|_| {});
    Some([
        cpu,
        on_the_gpu_by(scene, &Method::default(), samples, Some(0))?,
    ])
}

#[test]
fn what_is_cut_out_is_seen_through_and_lets_light_by() {
    let scene = half_a_lid();
    let Some([cpu, gpu]) = shadowed(&scene, 16) else {
        return;
    };
    // Away from the edge of the lid and of its shadow both see the same, and as much light.
    let mut seen = [0, 0];
    for y in 4..92 {
        for x in 4..92 {
            let i = cpu.index(x, y);
            if cpu.depth_m[i] == 0.0 || (44..52).contains(&x) {
                continue;
            }
            let is_red = cpu.base[i][1] < 0.5 * cpu.base[i][0];
            seen[usize::from(is_red)] += 1;
            let (a, b) = (cpu.base[i], gpu.base[i]);
            assert!((cpu.depth_m[i] - gpu.depth_m[i]).abs() < 1e-4, "{x}, {y}");
            assert!(
                (a[0] - b[0]).abs() < 0.1 * a[0] + 2e-3,
                "{x}, {y}: {a:?}, {b:?}"
            );
        }
    }
    assert!(seen.iter().all(|count| *count > 400), "{seen:?}");
}

/// A map of occlusion passes exactly its share of the light of an environment that is the same all around.
#[test]
fn occlusion_takes_its_share_of_the_environment() {
    let mut open = white();
    open.lights.clear();
    let map = hairline_image::Picture {
        size_px: [4, 2],
        rgb: vec![[0.7, 0.5, 0.3]; 8],
    };
    open.environment = Some(hairline_sky::from_map(map, 0.0, 1.0, false));
    let mut closed = open.clone();
    closed.textures = Arc::new(vec![Texture {
        size_px: [1, 1],
        levels: vec![vec![[51, 255, 255, 255]]],
        srgb: false,
        sampling: Sampling::default(),
    }]);
    // 1 + 0.5 (0.2 - 1).
    closed.materials[0].occlusion_texture = Some((0, 0.5));
    let check = |open: &Image, closed: &Image| {
        for (x, y) in [(48, 48), (30, 60), (70, 40)] {
            let i = open.index(x, y);
            for c in 0..3 {
                let share = closed.base[i][c] / open.base[i][c];
                assert!((share - 0.6).abs() < 1e-4, "{share}");
            }
        }
    };
    let by_cpu = |scene| on_the_cpu(scene, 1);
    check(&by_cpu(&open), &by_cpu(&closed));
    let (Some(a), Some(b)) = (on_the_gpu(&open, 1), on_the_gpu(&closed, 1)) else {
        return;
    };
    check(&a, &b);
}

/// Maps of a clear layer are factors: a layer with maps of one value is that of the products.
#[test]
fn maps_of_a_clear_layer_are_factors_on_it() {
    let mut mapped = white();
    let map = |texel: [u8; 4]| Texture {
        size_px: [1, 1],
        levels: vec![vec![texel]],
        srgb: false,
        sampling: Sampling::default(),
    };
    mapped.textures = Arc::new(vec![map([51, 255, 255, 255]), map([255, 102, 255, 255])]);
    let coat = |weight, roughness| Some(Coat { weight, roughness });
    mapped.materials[0].coat = coat(1.0, 0.5);
    let mut product = mapped.clone();
    product.materials[0].coat = coat(0.2, 0.2);
    mapped.materials[0].coat_textures = [Some(0), Some(1)];
    let plain = white();
    let [a, b, bare] = [&mapped, &product, &plain].map(|scene| on_the_cpu(scene, 1));
    compare_pixels("by factors, CPU", &a, &b, None).unwrap();
    assert!(compare_pixels("without a layer", &a, &bare, None).is_err());
    if let Some(gpu) = on_the_gpu(&mapped, 1) {
        compare_pixels("by factors, GPU", &gpu, &b, None).unwrap();
    }
}

/// Eight by eight normals about the surface's, with a spread of slopes.
fn bumps(seed: u64) -> Texture {
    let mut random = Sequence(seed);
    let mut texel = || {
        let xy = [0; 2].map(|_: u8| random.uniform(90.0, 165.0) as u8);
        [xy[0], xy[1], 245, random.uniform(0.0, 60.0) as u8]
    };
    Texture {
        size_px: [8; 2],
        levels: [64, 16, 4, 1]
            .map(|count| (0..count).map(|_| texel()).collect())
            .into(),
        srgb: false,
        sampling: Sampling::default(),
    }
}

/// Clear layers with other normals than the surface under them, scratched, one of them with holes. The surface under them glows and is
/// brushed or not.
#[test]
fn balls_under_layers_of_other_normals() {
    let [coarse, fine] = [(0, 0.7), (1, 1.0)].map(Some);
    for (maps, weight, strength, emission) in [
        ([coarse, None], None, 0.0, [0.0; 3]),
        ([coarse, fine], Some(2), 0.6, [2e-3, 0.5, 0.01]),
        ([None, fine], None, 0.0, [0.01; 3]),
    ] {
        let mut scene = SceneFile::seen_from([0.0, -0.5, 0.2])
            .mirror("m")
            .object("ball", "m", "sphere = { radius_m = 0.05 }")
            .laid("ball", "random", 300)
            .with_lines("length_m = 0.03\nwidth_um = 3.0\ndepth_nm = 200.0")
            .fov_y_deg(14.0)
            .size_px([56, 56])
            .scene();
        let holes = Texture {
            size_px: [2; 2],
            levels: vec![vec![[0; 4], [255; 4], [120; 4], [0; 4]], vec![[94; 4]]],
            srgb: false,
            sampling: Sampling {
                is_sharp: true,
                ..Sampling::default()
            },
        };
        scene.textures = Arc::new(vec![bumps(1), bumps(2), holes]);
        let material = &mut scene.materials[0];
        material.base = Base::MetallicRoughness {
            base_color: [0.6, 0.2, 0.1],
            metallic: 0.3,
        };
        material.roughness = 0.35;
        material.emission = emission;
        material.coat = Some(Coat {
            weight: 0.9,
            roughness: 0.12,
        });
        material.coat_textures[0] = weight;
        [material.normal_texture, material.coat_normal_texture] = maps;
        material.anisotropy = (strength > 0.0).then_some(Anisotropy {
            strength,
            direction_deg: 40.0,
        });
        scene.environment = Some(hairline_sky::uniform([0.1, 0.2, 0.3]));
        let lamp = DVec3::new(-0.4, -0.5, 0.6);
        scene.lights = vec![Light::sphere(lamp, 0.05, [30.0, 20.0, 10.0])];
        let cpu = on_the_cpu(&scene, 1);
        let mut shared = scene.clone();
        shared.materials[0].coat_normal_texture = maps[0];
        let shared = on_the_cpu(&shared, 1);
        if let Some(gpu) = on_the_gpu(&scene, 1) {
            let name = format!("{maps:?}");
            compare(&name, &scene, &gpu, &cpu).unwrap();
            assert!(compare("shared", &scene, &gpu, &shared).is_err(), "{name}");
        }
    }
}

/// Maps of reflections are factors on the reflection: alpha is the weight and the colours are the colour.
#[test]
fn maps_of_reflections_are_factors_on_them() {
    let mut mapped = white();
    let map = |srgb| Texture {
        size_px: [1, 1],
        levels: vec![vec![[255, 128, 51, 102]]],
        srgb,
        sampling: Sampling::default(),
    };
    mapped.textures = Arc::new(vec![map(false), map(true)]);
    mapped.materials[0].base = Base::MetallicRoughness {
        base_color: [0.2, 0.1, 0.1],
        metallic: 0.25,
    };
    let mut product = mapped.clone();
    mapped.materials[0].specular = Specular {
        weight: 0.5,
        color: [8.0, 2.0, 40.0],
    };
    mapped.materials[0].specular_textures = [Some(0), Some(1)];
    let color = [255u8, 128, 51].map(|byte| f64::from(linear_from_srgb(f32::from(byte) / 255.0)));
    product.materials[0].specular = Specular {
        weight: 0.2,
        color: [8.0, 2.0 * color[1], 40.0 * color[2]],
    };
    let mut plain = product.clone();
    plain.materials[0].specular = Specular::default();
    let [a, b, other] = [&mapped, &product, &plain].map(|scene| on_the_cpu(scene, 1));
    compare_pixels("by factors, CPU", &a, &b, None).unwrap();
    assert!(compare_pixels("of plastic", &a, &other, None).is_err());
    if let Some(gpu) = on_the_gpu(&mapped, 1) {
        compare_pixels("by factors, GPU", &gpu, &b, None).unwrap();
    }
}

/// A map of anisotropy turns it and is a factor on it: one of one value is that of the sum and the product.
#[test]
fn a_map_of_anisotropy_turns_it_and_is_a_factor_on_it() {
    let mut mapped = white();
    mapped.textures = Arc::new(vec![Texture {
        size_px: [1, 1],
        // Along v, and 0.4.
        levels: vec![vec![[128, 255, 102, 255]]],
        srgb: false,
        sampling: Sampling::default(),
    }]);
    let brushed = |strength, direction_deg| {
        Some(Anisotropy {
            strength,
            direction_deg,
        })
    };
    let mut product = mapped.clone();
    mapped.materials[0].anisotropy = brushed(1.0, 30.0);
    mapped.materials[0].anisotropy_texture = Some(0);
    // 128 is a little more than a half.
    let off_deg = (1.0_f64 / 255.0).atan().to_degrees();
    product.materials[0].anisotropy = brushed(0.4, 120.0 - off_deg);
    let plain = white();
    let [a, b, round] = [&mapped, &product, &plain].map(|scene| on_the_cpu(scene, 1));
    compare_pixels("by factors, CPU", &a, &b, None).unwrap();
    assert!(compare_pixels("round", &a, &round, None).is_err());
    if let Some(gpu) = on_the_gpu(&mapped, 1) {
        compare_pixels("by factors, GPU", &gpu, &b, None).unwrap();
    }
}

/// Balls, whose normals turn under a pixel, under lamps of all kinds and a sky: brushed one way and another, with and without a body.
#[test]
fn brushed_balls() {
    for (metallic, roughness, strength, direction_deg) in [
        (1.0, 0.25, 0.6, 0.0),
        (1.0, 0.15, 0.9, 60.0),
        (0.0, 0.4, 0.5, 90.0),
    ] {
        let mut scene = SceneFile::seen_from([0.0, -0.5, 0.2])
            .mirror("m")
            .object("ball", "m", "sphere = { radius_m = 0.05 }")
            .fov_y_deg(14.0)
            .size_px([56, 56])
            .scene();
        scene.materials[0].base = Base::MetallicRoughness {
            base_color: [0.9, 0.6, 0.4],
            metallic,
        };
        scene.materials[0].roughness = roughness;
        scene.materials[0].anisotropy = Some(Anisotropy {
            strength,
            direction_deg,
        });
        let map = hairline_image::Picture {
            size_px: [8, 4],
            rgb: (0..32)
                .map(|i| [0.1 * (i % 5) as f32, 0.3, 0.05 * (i % 7) as f32])
                .collect(),
        };
        scene.environment = Some(hairline_sky::from_map(map, 0.3, 1.0, false));
        let lamp = DVec3::new(-0.4, -0.5, 0.6);
        scene.lights = vec![
            Light::sphere(lamp, 0.05, [30.0, 20.0, 10.0]),
            Light::polygon(
                vec![
                    DVec3::new(0.4, -0.6, -0.1),
                    DVec3::new(0.8, -0.2, -0.1),
                    DVec3::new(0.8, -0.2, 0.5),
                    DVec3::new(0.4, -0.6, 0.5),
                ],
                [2.0, 3.0, 4.0],
                true,
            ),
        ];
        let cpu = on_the_cpu(&scene, 1);
        if let Some(gpu) = on_the_gpu(&scene, 1) {
            let name = format!("{metallic} {roughness} {strength} {direction_deg}");
            compare(&name, &scene, &gpu, &cpu).unwrap();
        }
    }
}

/// Under bumps that are about as wide as a pixel its base is a mean over parts, under a coat as well.
#[test]
fn bumps_as_wide_as_a_pixel() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers/scenes/bumpy-ball-lamps.toml");
    let bare = middle_of(hairline_document::load(path).unwrap(), 96, [40, 40]);
    let mut coated = bare.clone();
    let material = &mut coated.materials[0];
    material.coat = Some(Coat {
        weight: 0.7,
        roughness: 0.1,
    });
    // As it is without a map of its own.
    material.coat_normal_texture = material.normal_texture;
    let mut own = coated.clone();
    own.materials[0].coat_normal_texture = None;
    for (name, scene, samples) in [
        ("bare", bare, 1),
        ("coated", coated, 4),
        ("own normals", own, 1),
    ] {
        let cpu = on_the_cpu(&scene, samples);
        if let Some(gpu) = on_the_gpu(&scene, samples) {
            compare(&format!("bumps, {name}, {samples}"), &scene, &gpu, &cpu).unwrap();
        }
    }
}
