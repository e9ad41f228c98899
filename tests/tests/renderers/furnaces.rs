//! Light of radiance one from everywhere on surfaces whose normals differ under a pixel: no more comes back than the albedo that the surface has
//! under each of its normals.

use conformance::two_renderers::{on_the_cpu, on_the_gpu};
use conformance::{Sequence, furnace, square};
use glam::Vec3;
use hairline_cpu::closed_form::{RenderOptions, render};
use hairline_fixtures::SceneFile;
use hairline_optics::metal::Metal;
use hairline_reference::{Integrator, Settings};
use hairline_scene::{Anisotropy, Base, Coat, Sampling, Scene, Texture};
use std::ops::ControlFlow;
use std::sync::Arc;

const WHITE: [f64; 3] = [1.0; 3];

/// Materials, each with whether it reflects everything.
fn bases() -> [(Base, bool); 6] {
    let gltf = |metallic| Base::MetallicRoughness {
        base_color: WHITE,
        metallic,
    };
    [
        (Base::Mirror, true),
        (Base::ColoredMetal { base_color: WHITE }, true),
        (
            Base::Dielectric {
                ior: 1.5,
                base_color: WHITE,
            },
            true,
        ),
        (gltf(0.0), true),
        (gltf(0.5), true),
        (Base::Metal(Metal::Silver.into()), false),
    ]
}

/// The base layer, pixels of the background left out.
fn base(scene: &Scene) -> Vec<Option<[f32; 3]>> {
    let options = RenderOptions {
        samples: 1,
        ..RenderOptions::default()
    };
    let image = render(scene, &options, &|_| {});
    let seen = image.depth_m.iter().map(|depth| *depth > 0.0);
    seen.zip(image.base)
        .map(|(seen, radiance)| seen.then_some(radiance))
        .collect()
}

/// `scene` with each base and roughness in a furnace, against the same where a pixel sees one normal.
fn check(name: &str, mut scene: Scene) {
    scene.environment = furnace();
    scene.lights.clear();
    let mut worst = [0.0_f32; 2];
    for (kind, returns_all) in bases() {
        for roughness in [0.02, 0.1, 0.3, 0.6, 1.0] {
            let mut materials = scene.materials.clone();
            materials[0].base = kind.clone();
            materials[0].roughness = roughness;
            scene.materials = materials;
            scene.render.filter_std_px = 0.5;
            let wide = base(&scene);
            scene.render.filter_std_px = 1e-4;
            let narrow = base(&scene);
            assert!(wide.iter().flatten().count() > 500);
            for (wide, narrow) in wide.iter().zip(&narrow) {
                let (Some(wide), Some(narrow)) = (wide, narrow) else {
                    continue;
                };
                for c in 0..3 {
                    let albedo = if returns_all { 1.0 } else { narrow[c] };
                    let off = wide[c] / albedo - 1.0;
                    worst[usize::from(returns_all)] =
                        worst[usize::from(returns_all)].max(off.abs());
                    assert!(wide[c] < 1.01, "{name} {kind:?} {roughness}: {}", wide[c]);
                    // A smaller filter sees other normals of a map.
                    let has_albedo = returns_all || scene.textures.is_empty();
                    assert!(
                        !has_albedo || off.abs() < 0.01,
                        "{name} {kind:?} {roughness}: {off}"
                    );
                }
            }
        }
    }
    println!(
        "{name}: {:.4} off where all comes back, {:.4} elsewhere",
        worst[1], worst[0]
    );
}

/// A white surface that is a metal in part returns all, as both materials that it is a mix of do: by both renderers, and on average by Monte Carlo.
#[test]
fn white_metals_in_part_return_all_by_all_renderers() {
    let mut scene = square(
        Base::MetallicRoughness {
            base_color: WHITE,
            metallic: 0.4,
        },
        0.5,
        8,
    );
    scene.camera.fov_y_rad = 0.2;
    scene.environment = furnace();
    let sampled = |scene: &Scene| {
        let integrator = Integrator::new(scene, Settings::default());
        let mut image = integrator.start();
        let _ = integrator.run(&mut image, 256, &|_| ControlFlow::Continue(()));
        image
    };
    for roughness in [0.1, 0.5, 1.0] {
        scene.materials[0].roughness = roughness;
        for (by, image) in [
            ("CPU", Some(on_the_cpu(&scene, 1))),
            ("GPU", on_the_gpu(&scene, 1)),
            ("Monte Carlo", Some(sampled(&scene))),
        ] {
            let Some(image) = image else { continue };
            let sum: f32 = image.base.iter().map(|rgb| rgb[1]).sum();
            let mean = sum / image.base.len() as f32;
            assert!((mean - 1.0).abs() < 0.01, "{by}, {roughness}: {mean}");
        }
    }
}

/// Light that a coat does not send back goes through it, and comes back from a white base.
#[test]
fn a_coated_white_base_returns_all() {
    let mut scene = square(Base::ColoredMetal { base_color: WHITE }, 0.01, 8);
    scene.environment = furnace();
    scene.materials[0].roughness = 0.3;
    scene.textures = Arc::new(vec![Texture {
        size_px: [1; 2],
        levels: vec![vec![[150, 160, 240, 0]]],
        srgb: false,
        sampling: Sampling::default(),
    }]);
    // The last coat is smooth on what leans.
    for (weight, roughness, leans) in [
        (1.0, 0.02, false),
        (1.0, 0.4, false),
        (0.4, 0.1, false),
        (0.7, 0.2, true),
    ] {
        scene.materials[0].coat = Some(Coat { weight, roughness });
        scene.materials[0].normal_texture = leans.then_some((0, 1.0));
        for value in base(&scene).into_iter().flatten().flatten() {
            assert!((value - 1.0).abs() < 0.01, "{weight} {roughness}: {value}");
        }
    }
}

/// Facets that lean one way send all back as well, by all that they lean to.
#[test]
fn a_brushed_white_base_returns_all() {
    let mut scene = square(Base::ColoredMetal { base_color: WHITE }, 0.01, 8);
    scene.environment = furnace();
    scene.materials[0].roughness = 0.3;
    for (strength, direction_deg) in [(0.3, 0.0), (0.6, 90.0), (1.0, 30.0)] {
        scene.materials[0].anisotropy = Some(Anisotropy {
            strength,
            direction_deg,
        });
        for value in base(&scene).into_iter().flatten().flatten() {
            assert!(
                (value - 1.0).abs() < 0.01,
                "{strength} {direction_deg}: {value}"
            );
        }
    }
}

/// KHR_materials_ior with an index of 0: a dielectric that reflects as the metal of its specular colour does, and nothing gets to its body.
#[test]
fn a_dielectric_of_index_zero_reflects_as_a_metal() {
    let gltf = |base_color, metallic| Base::MetallicRoughness {
        base_color,
        metallic,
    };
    let color = [0.9, 0.6, 0.3];
    for roughness in [0.02, 0.3, 1.0] {
        let mut metal = square(gltf(color, 1.0), 0.01, 8);
        metal.environment = furnace();
        metal.materials[0].roughness = roughness;
        let mut dielectric = metal.clone();
        dielectric.materials[0].base = gltf([0.0; 3], 0.0);
        dielectric.materials[0].dielectric_f0 = 1.0;
        dielectric.materials[0].specular.color = color;
        let mut white = dielectric.clone();
        white.materials[0].base = gltf(WHITE, 0.0);
        white.materials[0].specular.color = WHITE;
        let [metal, dielectric, white] = [&metal, &dielectric, &white].map(base);
        assert!(metal.iter().flatten().count() > 20);
        for (metal, dielectric) in metal.iter().zip(&dielectric) {
            let pairs = metal.iter().flatten().zip(dielectric.iter().flatten());
            for (a, b) in pairs {
                assert!((a - b).abs() < 1e-6, "{roughness}: {a}, {b}");
            }
        }
        // All that comes to it comes back, once.
        for value in white.iter().flatten().flatten() {
            assert!((value - 1.0).abs() < 0.01, "{roughness}: {value}");
        }
    }
}

#[test]
fn balls_in_a_furnace() {
    let ball = SceneFile::seen_from([0.0, -0.5, 0.2])
        .mirror("m")
        .object("ball", "m", "sphere = { radius_m = 0.05 }")
        .fov_y_deg(14.0)
        .size_px([40, 40]);
    check("ball", ball.scene());
}

#[test]
fn sheets_that_bend_one_way_in_a_furnace() {
    let mut scene = square(Base::Mirror, 0.01, 32);
    let object = &mut scene.objects[0];
    let mesh = Arc::make_mut(&mut object.mesh);
    // Along a diagonal.
    for (normal, position) in mesh.normals.iter_mut().zip(&mesh.positions_m) {
        let tilt = 40.0 * (position.x + 0.5 * position.y);
        *normal = Vec3::new(tilt, 0.5 * tilt, 1.0).normalize();
    }
    check("bent sheet", scene);
}

#[test]
fn normal_maps_in_a_furnace() {
    let mut scene = square(Base::Mirror, 0.01, 32);
    let mesh = Arc::make_mut(&mut scene.objects[0].mesh);
    for (uv, position) in mesh.uvs.iter_mut().zip(&mesh.positions_m) {
        *uv = (position.truncate() / 0.02) + 0.5;
    }
    let mut random = Sequence(7);
    let mut texel = || {
        let xy = [0; 2].map(|_: u8| random.uniform(88.0, 168.0) as u8);
        // The last channel holds the spread of slopes.
        [xy[0], xy[1], 245, random.uniform(0.0, 120.0) as u8]
    };
    let levels =
        [64usize, 32, 16, 8, 4, 2, 1].map(|side| (0..side * side).map(|_| texel()).collect());
    scene.textures = Arc::new(vec![Texture {
        size_px: [64; 2],
        levels: levels.into(),
        srgb: false,
        sampling: Sampling::default(),
    }]);
    scene.materials[0].normal_texture = Some((0, 1.0));
    check("normal map", scene);
}
