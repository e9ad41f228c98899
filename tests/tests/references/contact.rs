//! Rays that begin on a surface: no light through thin objects, no shadow on surfaces that face the light, no gap at the foot of
//! standing ones.

use super::pictures::sampled;
use super::scenes::{off_the_mirror, plate, sphere};
use super::shadowed::{VIEW, WHITE, alone, closed};
use super::shadowed_on_gpu::on_gpu;
use conformance::furnace;
use glam::{DVec2, DVec3, Vec3};
use hairline_fixtures::SceneFile;
use hairline_fixtures::scenes::scratched_ball;
use hairline_image::Image;
use hairline_index::TriangleIndex;
use hairline_reference::Settings;
use hairline_scene::Scene;
use std::sync::Arc;

/// A panel that is flush with the ceiling, or a few micrometres below it: the floor has all of its light. Level, and turned so that
/// single precision takes the ceiling's corners off the plane.
#[test]
fn a_lamp_in_the_plane_of_a_ceiling_lights_the_floor() {
    check_ceiling(&[(0.0, 0.0), (0.0, 1e-6), (20.0, 0.0)]);
}

#[test]
#[ignore = "long: cargo long"]
fn a_lamp_a_little_below_a_ceiling_lights_the_floor() {
    check_ceiling(&[(0.0, 3e-6)]);
}

/// Checks lamps of each kind at places: the ceiling's turn in degrees, and the lamp's distance from it in metres.
fn check_ceiling(places: &[(f64, f64)]) {
    let lamps = [
        "kind = \"rectangle\"\nwidth_m = 0.5\nheight_m = 0.5",
        "kind = \"disk\"\nradius_m = 0.25",
        "kind = \"rectangle\"\nwidth_m = 0.5\nheight_m = 0.5\ntwo_sided = true",
    ];
    let each = |keys| places.iter().map(move |at| (keys, *at));
    for (keys, (turn_deg, below_m)) in lamps.into_iter().flat_map(each) {
        let (sin, cos) = f64::to_radians(turn_deg).sin_cos();
        let below = DVec3::new(0.0, sin, -cos);
        let ceiling_m = -0.8 * below;
        let lamp_m = ceiling_m + below_m * below;
        let scene = SceneFile::seen_from([0.0, -0.3, 0.5])
            .fov_y_deg(0.5)
            .size_px([8, 8])
            .part("[[material]]\nname = \"matt\"\nkind = \"dielectric\"\nior = 1.0")
            .object("floor", "matt", "plane = { size_m = [2.0, 2.0] }")
            .object("ceiling", "matt", "plane = { size_m = [2.0, 2.0] }")
            .with_lines(&format!(
                "rotation_deg = [{:?}, 0.0, 0.0]\ntranslation_m = {:?}",
                180.0 + turn_deg,
                ceiling_m.to_array()
            ))
            .part(&format!(
                "[[light]]\n{keys}\ncenter_m = {:?}\ntarget_m = {:?}\nradiance = 10.0",
                lamp_m.to_array(),
                (lamp_m + below).to_array()
            ))
            .scene();
        let name = format!("{keys}, {turn_deg} degrees, {below_m} m");
        for (by, open, image) in by_each(&scene, 8) {
            for (open, left) in open.base.iter().zip(&image.base) {
                assert!(open[1] > 0.1, "{by}: {name}: {open:?}");
                // All rays see the light: there is no noise but for rounding.
                let share = left[1] / open[1];
                assert!((share - 1.0).abs() < 1e-5, "{by}: {name}: {share}");
            }
        }
        let settings = Settings {
            shadows: true,
            ..Settings::default()
        };
        let image = sampled(&scene, settings, 4);
        let mean = |image: &Image| image.base.iter().map(|p| f64::from(p[1])).sum::<f64>() / 64.0;
        let (seen, open) = (mean(&image), mean(&closed(&scene, 8, false)));
        // 16,384 samples whose values spread by less than their mean: four standard errors.
        assert!(
            (seen / open - 1.0).abs() < 0.03,
            "reference: {name}: {seen} {open}"
        );
    }
}

/// Pictures without shadows and with them, by each renderer that there is.
fn by_each(scene: &Scene, samples: u32) -> Vec<(&'static str, Image, Image)> {
    let cpu = (closed(scene, samples, false), closed(scene, samples, true));
    let gpu = on_gpu(scene, samples, None).zip(on_gpu(scene, samples, Some(0)));
    let gpu = gpu.map(|(open, image)| ("GPU", alone(open), alone(image)));
    [("CPU", alone(cpu.0), alone(cpu.1))]
        .into_iter()
        .chain(gpu)
        .collect()
}

/// A camera and a scratched plate under a can of 3,584 triangles without thickness; lamps shine from outside.
fn under_a_can(target_m: [f64; 3], fov_y_deg: f64) -> Scene {
    SceneFile::seen_from([0.02, -0.03, 0.025])
        .looking_at(target_m)
        .fov_y_deg(fov_y_deg)
        .size_px([24, 16])
        .metal("steel", "steel")
        .with_lines("roughness = 0.4")
        .object("plate", "steel", "plane = { size_m = [0.2, 0.2] }")
        .random("plate", 2000)
        .object("can", "steel", "lathe = { profile_m = [[0, 0.03], [0.01, 0.03], [0.02, 0.03], [0.03, 0.03], [0.04, 0.03], [0.04, 0.02], [0.04, 0.01], [0.04, 0.0]], segments = 256 }")
        .sphere([0.02, -0.02, 0.1], 0.02, 100.0)
        .part("[[light]]\nkind = \"rectangle\"\ncenter_m = [0.0, 0.1, 0.1]\ntarget_m = [0.0, 0.0, 0.0]\nwidth_m = 0.1\nheight_m = 0.1\nradiance = 100.0")
        .part("[[light]]\nkind = \"disk\"\ncenter_m = [0.1, 0.0, 0.05]\ntarget_m = [0.0, 0.0, 0.0]\nradius_m = 0.04\nradiance = 100.0")
        .part("[[light]]\nkind = \"tube\"\nends_m = [[-0.1, -0.1, 0.02], [-0.1, 0.1, 0.02]]\nradius_m = 0.01\nradiance = 100.0")
        .scene()
}

/// No light comes on the plate, on the can, or where they meet; the sky is white.
#[test]
fn no_light_comes_through_a_sheet() {
    let mut scene = under_a_can([-0.004, 0.006, 0.004], 40.0);
    scene.environment = furnace();
    let open = closed(&scene, 16, false).beauty().rgb;
    let image = closed(&scene, 16, true).beauty().rgb;
    assert!(open.iter().all(|p| p[1] > 0.0));
    assert!(image.iter().all(|p| *p == [0.0; 3]));
}

/// No light comes on the plate, away from the foot of the can, except by rounding.
#[test]
fn no_light_comes_through_a_sheet_on_the_gpu() {
    check_sheet_on_the_gpu(2, [12, 8]);
}

#[test]
#[ignore = "long: cargo long"]
fn no_light_of_any_lamp_comes_through_a_sheet_on_the_gpu() {
    check_sheet_on_the_gpu(4, [24, 16]);
}

/// Checks the can under some of its lamps: each kind has shaders of its own, which take a second to compile.
fn check_sheet_on_the_gpu(lamps: usize, size_px: [u32; 2]) {
    let mut scene = under_a_can([0.0; 3], 15.0);
    scene.lights.truncate(lamps);
    scene.render.size_px = size_px;
    let open = on_gpu(&scene, 16, None);
    let image = on_gpu(&scene, 16, Some(0));
    let Some((open, image)) = open.zip(image) else {
        return;
    };
    let (open, image) = (open.beauty().rgb, image.beauty().rgb);
    assert!(open.iter().all(|p| p[1] > 0.0));
    let mut pixels = open.iter().zip(&image);
    assert!(pixels.all(|(open, left)| left[1].abs() < 1e-5 * open[1]));
}

/// The foot of a box, in pixels of 0.02 mm: dark behind it, and all the light before it.
#[test]
fn a_shadow_begins_at_the_foot() {
    let side = |name: &str, x_m: f64, turn_deg: f64| {
        format!(
            "[[object]]\nname = \"{name}\"\nmaterial = \"matt\"\nshape = {{ plane = {{ size_m = [0.01, 0.01] }} }}\n\
             rotation_deg = [0.0, {turn_deg:?}, 0.0]\ntranslation_m = [{x_m:?}, 0.0, 0.005]"
        )
    };
    for (foot_m, from_m, is_dark) in [(-0.005, -0.1, true), (0.005, 0.1, false)] {
        let scene = SceneFile::seen_from([from_m, -0.01, 0.1])
            .looking_at([foot_m, 0.0, 0.0])
            .fov_y_deg(0.13)
            .size_px([16, 16])
            .part("[[material]]\nname = \"matt\"\nkind = \"dielectric\"\nior = 1.0")
            .object("plate", "matt", "plane = { size_m = [1.0, 1.0] }")
            .part(&side("left", -0.005, -90.0))
            .part(&side("right", 0.005, 90.0))
            .object("top", "matt", "plane = { size_m = [0.01, 0.01] }")
            .with_lines("translation_m = [0.0, 0.0, 0.01]")
            .sphere([0.1, 0.0, 0.1], 0.01, 10.0)
            .scene();
        let camera = scene.camera.frame([16, 16]);
        let beside_m = |i: usize| {
            let pixel = DVec2::new((i % 16) as f64 + 0.5, (i / 16) as f64 + 0.5);
            let ray = camera.camera_ray(pixel);
            let at = camera.position_m - ray * (camera.position_m.z / ray.z);
            at.x.abs() - foot_m.abs()
        };
        for (by, open, image) in by_each(&scene, 16) {
            // The filter of the pixels at the foot reaches the box.
            let on_plate: Vec<usize> = (0..256)
                .filter(|i| (6e-5..1e-4).contains(&beside_m(*i)))
                .collect();
            assert!(on_plate.len() > 20, "{by}: {}", on_plate.len());
            for i in on_plate {
                let lit = if is_dark { [0.0; 3] } else { open.base[i] };
                assert!(open.base[i][1] > 0.0 && image.base[i] == lit, "{by}: {i}");
            }
        }
    }
}

/// A wall without thickness, the lamp behind it: all that the camera sees before it is dark, up to its foot. What pixels there average
/// reaches above the foot, where a ray of the camera ends at the wall and not on the plate behind it.
#[test]
fn no_light_comes_from_beyond_a_wall() {
    let scene = SceneFile::seen_from([-0.1, -0.01, 0.1])
        .looking_at([-0.00503, 0.0, 0.0])
        .fov_y_deg(0.13)
        .size_px([16, 16])
        .part("[[material]]\nname = \"matt\"\nkind = \"dielectric\"\nior = 1.0")
        .metal("steel", "steel")
        .with_lines("roughness = 0.4")
        .object("plate", "steel", "plane = { size_m = [0.1, 0.1] }")
        .random("plate", 20_000)
        .object("wall", "matt", "plane = { size_m = [0.01, 0.01] }")
        .with_lines("rotation_deg = [0.0, -90.0, 0.0]\ntranslation_m = [-0.005, 0.0, 0.005]")
        .sphere([0.1, 0.0, 0.1], 0.01, 10.0)
        .scene();
    for (by, open, image) in by_each(&scene, 16) {
        let [base, scratches] =
            [&open.base, &open.scratches].map(|l| l.iter().filter(|p| p[1] > 0.0).count());
        assert!(base > 100 && scratches > 100, "{by}: {base} {scratches}");
        let (open, left) = (open.beauty().rgb, image.beauty().rgb);
        let all: f32 = open.iter().map(|p| p[1]).sum();
        let leaks: f32 = left.iter().map(|p| p[1].abs()).sum();
        println!("{by}: {leaks} of {all}");
        // But for rounding: the start of a ray in some thousands lies within a step of the foot.
        assert!(leaks < 1e-3 * all, "{by}: {leaks} of {all}");
    }
}

/// Balls of 16 and of 4,096 triangles: a point that faces the lamp on a facet that faces it has all of its light, and of the light that
/// the shading normal shows beyond, most is left.
#[test]
fn balls_do_not_shade_themselves() {
    for (slices, stacks) in [(4, 3), (64, 33)] {
        let mut scene = plate(WHITE, VIEW);
        scene.render.size_px = [16; 2];
        scene.materials[0].roughness = 0.4;
        scene.lights = vec![sphere(VIEW, 0.3, -0.6, 0.05)];
        set_ball(&mut scene, slices, stacks, 2e-4);
        let towards = off_the_mirror(VIEW.angle_rad, 0.3, -0.6);
        let facing = facets_facing(&scene, towards);
        let side = scene.render.size_px[0] as usize;
        // The filter reaches this far.
        let around = |i: usize| {
            let (x, y) = (i % side, i / side);
            let reach = |at: usize| at.saturating_sub(2)..(at + 3).min(side);
            reach(y).flat_map(move |y| reach(x).map(move |x| y * side + x))
        };
        for (by, open, image) in by_each(&scene, 16) {
            let (mut before, mut all, mut left) = (0, 0.0, 0.0);
            for i in 0..open.base.len() {
                let normal = DVec3::from(open.normal[i].map(f64::from));
                // 0.05 is the lamp's radius.
                if open.depth_m[i] == 0.0 || normal.dot(towards) < 0.08 {
                    continue;
                }
                let (with, without) = (f64::from(image.base[i][1]), f64::from(open.base[i][1]));
                all += without;
                left += with;
                if around(i).all(|i| facing[i] > 0.08) {
                    before += 1;
                    // Of thin facets between the pixels' centres, which are turned away, samples see a little.
                    let rounding = 1e-4 * without;
                    assert!(
                        (with - without).abs() <= rounding,
                        "{by}, {slices}: {i} {with} {without}"
                    );
                }
            }
            println!(
                "{by}, {slices} slices: {before} pixels, {:.4} of the light",
                left / all
            );
            assert!(before > 20, "{by}, {slices}: {before}");
            assert!(left > 0.995 * all, "{by}, {slices}: {}", left / all);
        }
    }
}

/// Shadows change no bit of a scratched ball's scratches or base where it faces the lamp.
#[test]
fn a_scratched_ball_hides_nothing_from_itself() {
    let scene = scratched_ball(0.04)
        .looking_at([0.012, -0.034, 0.034])
        .fov_y_deg(0.15)
        .size_px([16, 16])
        .scene();
    for (by, open, image) in by_each(&scene, 8) {
        assert!(open.scratches.iter().any(|p| p[1] > 0.0), "{by}");
        assert!(image == open, "{by}");
    }
}

/// Cosine, for each pixel's middle, between the facet that is seen and a direction; 1 where nothing is seen.
fn facets_facing(scene: &Scene, towards: DVec3) -> Vec<f64> {
    let index = TriangleIndex::build(scene);
    let camera = scene.camera.frame(scene.render.size_px);
    let side = scene.render.size_px[0];
    let pixels = (0..side).flat_map(|y| (0..side).map(move |x| [x, y]));
    let facing = |pixel: [u32; 2]| {
        let ray = camera.camera_ray(DVec2::from(pixel.map(|p| f64::from(p) + 0.5)));
        index
            .intersect(camera.position_m, ray.normalize())
            .map_or(1.0, |hit| {
                let mesh = &scene.objects[0].mesh;
                let [a, b, c] = mesh.triangles[hit.triangle as usize]
                    .map(|v| mesh.positions_m[v as usize].as_dvec3());
                let normal = (b - a).cross(c - a).normalize();
                towards.dot(normal) * -normal.dot(ray).signum()
            })
    };
    pixels.map(facing).collect()
}

/// Puts a ball of `2 * slices * (stacks - 1)` triangles in place of the plate.
fn set_ball(scene: &mut Scene, slices: u32, stacks: u32, radius_m: f32) {
    let mesh = Arc::make_mut(&mut scene.objects[0].mesh);
    let angle = |i: u32, count: u32, whole: f32| whole * i as f32 / count as f32;
    mesh.normals = (0..=stacks)
        .flat_map(|i| (0..=slices).map(move |j| (i, j)))
        .map(|(i, j)| {
            let (sin, cos) = angle(i, stacks, std::f32::consts::PI).sin_cos();
            let (y, x) = angle(j, slices, std::f32::consts::TAU).sin_cos();
            Vec3::new(sin * x, sin * y, cos)
        })
        .collect();
    mesh.positions_m = mesh.normals.iter().map(|n| *n * radius_m).collect();
    mesh.uvs = vec![glam::Vec2::ZERO; mesh.normals.len()];
    mesh.tangents = vec![Vec3::X.extend(1.0); mesh.normals.len()];
    let row = slices + 1;
    let cells = (0..stacks).flat_map(|i| (0..slices).map(move |j| i * row + j));
    mesh.triangles = cells
        .flat_map(|a| [[a, a + row, a + row + 1], [a, a + row + 1, a + 1]])
        // Triangles at the poles have no area.
        .filter(|t| {
            let [a, b, c] = t.map(|i| mesh.positions_m[i as usize]);
            (b - a).cross(c - a).length() > 1e-6 * radius_m * radius_m
        })
        .collect();
    mesh.triangle_materials = vec![0; mesh.triangles.len()];
    assert_eq!(mesh.triangles.len() as u32, 2 * slices * (stacks - 1));
}
