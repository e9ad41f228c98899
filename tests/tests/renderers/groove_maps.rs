//! Gratings with pictures and along texture coordinates: the GPU against the CPU, and the meaning of
//! pictures.

use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use glam::{DMat4, DVec2, DVec3};
use hairline_cpu::closed_form::{RenderOptions, render};
use hairline_fixtures::SceneFile;
use hairline_image::Image;
use hairline_scene::{GrooveField, GroovePicture, PictureLie, Sampling, Scene, Texture, UvField};
use std::sync::Arc;

use super::gratings::grooves_one_by_one;

const SIDE_PX: u32 = 64;

/// A texture of numbers from 0 to 1, with its means.
fn texture(texel: impl Fn(DVec2) -> [f64; 3]) -> Texture {
    let mut size = SIDE_PX;
    let place = |i: u32| DVec2::new(f64::from(i % SIDE_PX), f64::from(i / SIDE_PX)) + 0.5;
    let mut level: Vec<[f64; 3]> = (0..SIDE_PX * SIDE_PX)
        .map(|i| texel(place(i) / f64::from(SIDE_PX)))
        .collect();
    let mut levels = Vec::new();
    loop {
        let codes = level.iter().map(|v| {
            let [r, g, b] = v.map(|v| (255.0 * v).round() as u8);
            [r, g, b, 255]
        });
        levels.push(codes.collect());
        if size == 1 {
            break;
        }
        let half = size / 2;
        let mean = |i: u32| -> [f64; 3] {
            let corner = 2 * (i / half) * size + 2 * (i % half);
            let four = [0, 1, size, size + 1].map(|by| level[(corner + by) as usize]);
            std::array::from_fn(|c| four.iter().map(|v| v[c]).sum::<f64>() / 4.0)
        };
        level = (0..half * half).map(mean).collect();
        size = half;
    }
    Texture {
        size_px: [SIDE_PX; 2],
        levels,
        srgb: false,
        sampling: Sampling::default(),
    }
}

/// Soft spots, and directions that turn by half a circle from one end to the other.
fn textures() -> Arc<Vec<Texture>> {
    let spots = texture(|uv| {
        let wave = (uv * 6.0 * std::f64::consts::TAU).map(f64::sin);
        [0.5 + 0.5 * wave.x * wave.y; 3]
    });
    let directions = texture(|uv| {
        let angle = std::f64::consts::PI * uv.x;
        [0.5 + 0.5 * angle.cos(), 0.5 + 0.5 * angle.sin(), 0.5]
    });
    Arc::new(vec![spots, directions])
}

fn one_sample(scene: &Scene) -> Image {
    let options = RenderOptions {
        samples: 1,
        ..RenderOptions::default()
    };
    render(scene, &options, &|_| {})
}

const LAMPS: &str = "[[light]]\nkind = \"tube\"\nends_m = [[0.2, -0.2, 0.3], [0.25, 0.3, 0.35]]\nradius_m = 0.01\nradiance = 40.0";

/// A plate, a ball and a cylinder with a grating each.
fn file(pitch_um: f64, more: &str) -> SceneFile {
    let grating = |object: &str| {
        format!(
            "[[grating]]\nobject = \"{object}\"\npattern = \"parallel\"\npitch_um = {pitch_um:?}\njitter_um = 0.02\n{more}"
        )
    };
    SceneFile::seen_from([0.0, -0.22, 0.16])
        .size_px([96, 72])
        .fov_y_deg(24.0)
        .metal("aluminium", "aluminium")
        .with_lines("roughness = 0.2")
        .object("plate", "aluminium", "plane = { size_m = [0.2, 0.2] }")
        .object("ball", "aluminium", "sphere = { radius_m = 0.02 }")
        .with_lines("translation_m = [0.03, 0.0, 0.02]")
        .object(
            "rod",
            "aluminium",
            "cylinder = { radius_m = 0.012, height_m = 0.05, rounding_m = 0.002 }",
        )
        .with_lines("translation_m = [-0.03, 0.0, 0.02]\nrotation_deg = [70.0, 20.0, 0.0]\nscale = [1.0, 1.3, 0.8]")
        .part(&grating("plate"))
        .part(&grating("ball"))
        .part(&grating("rod"))
        .sphere([0.05, 0.2, 0.3], 0.02, 60.0)
        .part(LAMPS)
        .part("[studio]\nhidden = true")
}

fn by_uv(along_v: bool, directions: Option<usize>) -> GrooveField {
    let uv = UvField {
        along_v,
        directions,
    };
    GrooveField::ByUv {
        uv,
        center_m: DVec3::ZERO,
    }
}

fn mask(lie: PictureLie) -> Option<GroovePicture> {
    Some(GroovePicture { texture: 0, lie })
}

/// Projection from the sides of an object that is turned, in tiles of 3 cm.
fn from_three_sides() -> PictureLie {
    let turn = DMat4::from_rotation_x(0.7) * DMat4::from_scale(DVec3::new(1.0, 1.3, 0.8));
    PictureLie::FromThreeSides {
        tiles_from_world: (turn * DMat4::from_scale(DVec3::splat(0.03))).inverse(),
    }
}

fn mapped(pitch_um: f64, more: &str) -> Scene {
    let mut scene = file(pitch_um, more).scene();
    scene.textures = textures();
    let [plate, ball, rod] = [0, 1, 2];
    scene.objects[plate].gratings[0].field = by_uv(true, Some(1));
    scene.objects[plate].gratings[0].mask = mask(PictureLie::ByUv);
    scene.objects[ball].gratings[0].field = by_uv(false, None);
    scene.objects[ball].gratings[0].mask = mask(from_three_sides());
    scene.objects[rod].gratings[0].field = by_uv(true, None);
    scene.objects[rod].gratings[0].mask = mask(from_three_sides());
    scene
}

#[test]
fn gpu_and_cpu_show_the_same_maps() {
    let scene = mapped(1.6, "theory = \"scalar\"\n");
    let Some(gpu) = on_the_gpu(&scene, 1) else {
        return;
    };
    let cpu = on_the_cpu(&scene, 1);
    compare("groove maps", &scene, &gpu, &cpu).unwrap_or_else(|error| panic!("{error}"));
    let wrong_ones: [fn(&mut Scene); 3] = [
        |scene| scene.objects[0].gratings[0].mask = mask(from_three_sides()),
        |scene| scene.objects[1].gratings[0].mask = None,
        |scene| scene.objects[0].gratings[0].field = by_uv(false, Some(1)),
    ];
    for wrong_one in wrong_ones {
        let mut wrong = scene.clone();
        wrong_one(&mut wrong);
        let seen = compare("wrong", &scene, &gpu, &on_the_cpu(&wrong, 1)).unwrap_err();
        assert!(seen.contains("scratches"), "{seen}");
    }
}

/// Grooves of 40 um that branch.
#[test]
fn gpu_and_cpu_show_the_same_grooves_one_by_one() {
    let grating = |object: &str, pattern: &str, coverage: f64, more: &str| {
        format!(
            "[[grating]]\nobject = \"{object}\"\npattern = \"{pattern}\"\npitch_um = 40.0\nwidth_um = 8.0\n\
             jitter_um = 3.0\ncoverage = {coverage:?}\ndepth_nm = {{ mean = 300.0, spread = 0.5 }}\n{more}"
        )
    };
    grooves_one_by_one(
        "branching grooves",
        &[
            grating("plate", "radial", 0.5, ""),
            grating("plate", "spun", 0.5, "curvature_per_m = 20.0\nseed = 5"),
            grating("ball", "uv", 1.0, "along = \"v\""),
        ],
    );
}

fn plate(change: impl Fn(&mut Scene)) -> Image {
    let mut scene = SceneFile::seen_from([0.0, -0.22, 0.16])
        .size_px([48, 36])
        .fov_y_deg(12.0)
        .metal("aluminium", "aluminium")
        .with_lines("roughness = 0.2")
        .object("plate", "aluminium", "plane = { size_m = [0.2, 0.2] }")
        .part("[[grating]]\nobject = \"plate\"\npattern = \"parallel\"\npitch_um = 1.6\njitter_um = 0.02\ntheory = \"scalar\"")
        .sphere([0.05, 0.2, 0.3], 0.05, 60.0)
        .part(LAMPS)
        .part("[studio]\nhidden = true")
        .scene();
    change(&mut scene);
    one_sample(&scene)
}

/// Relative to the second.
fn relative_error(a: &Image, b: &Image) -> f64 {
    let both = a
        .scratches
        .iter()
        .flatten()
        .zip(b.scratches.iter().flatten());
    let (mut error, mut all) = (0.0, 0.0);
    for (a, b) in both {
        let (a, b) = (f64::from(*a), f64::from(*b));
        error += (a - b) * (a - b);
        all += b * b;
    }
    (error / all).sqrt()
}

#[test]
fn texture_coordinates_of_a_plate_are_its_directions() {
    let along = |x: f64, y: f64| {
        plate(|scene| {
            scene.objects[0].gratings[0].field = GrooveField::Along {
                direction: DVec3::new(x, y, 0.0),
                center_m: DVec3::ZERO,
            };
        })
    };
    let uv = |along_v, [red, green]: [f64; 2]| {
        plate(|scene| {
            scene.textures = Arc::new(vec![texture(|_| [red, green, 0.0])]);
            scene.objects[0].gratings[0].field = by_uv(along_v, Some(0));
        })
    };
    let plain = |along_v| plate(|scene| scene.objects[0].gratings[0].field = by_uv(along_v, None));
    assert!(relative_error(&plain(false), &along(1.0, 0.0)) < 1e-6);
    assert!(relative_error(&plain(true), &along(0.0, 1.0)) < 1e-6);
    // Codes 255 and 0 are 1 and -1: to the right and down.
    assert!(relative_error(&uv(false, [1.0, 0.0]), &along(1.0, -1.0)) < 1e-6);
    assert!(relative_error(&uv(true, [1.0, 0.0]), &along(1.0, 1.0)) < 1e-6);
    assert!(relative_error(&uv(true, [1.0, 0.0]), &along(1.0, -1.0)) > 0.5);
}

/// Squares of a fiftieth of a pixel.
#[test]
fn a_mask_from_afar_is_its_mean() {
    let checkers = || {
        Arc::new(vec![texture(|uv| {
            let square = (uv * f64::from(SIDE_PX)).floor();
            [(square.x + square.y).rem_euclid(2.0); 3]
        })])
    };
    let lie = PictureLie::FromThreeSides {
        tiles_from_world: DMat4::from_scale(DVec3::splat(1.0 / 4e-4)),
    };
    let masked = plate(|scene| {
        scene.textures = checkers();
        scene.objects[0].gratings[0].mask = mask(lie);
    });
    let half = plate(|scene| scene.objects[0].gratings[0].coverage = 0.5);
    assert!(
        relative_error(&masked, &half) < 0.01,
        "{}",
        relative_error(&masked, &half)
    );
    assert!(relative_error(&plate(|_| {}), &half) > 0.5);
}
