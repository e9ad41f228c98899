//! Lights that the camera sees.

use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu, on_the_gpu_by};
use hairline_cpu::closed_form::{RenderOptions, render};
use hairline_fixtures::SceneFile;
use hairline_gpu::Method;
use hairline_image::Image;
use hairline_reference::{BATCH_SAMPLES, Integrator, Model, Settings};
use hairline_scene::Scene;
use std::ops::ControlFlow;

/// A lamp of each shape over a table, `visible` or not; the last two shine away from the camera, the spot partly.
fn lamps(visible: bool) -> Scene {
    let light = |keys: &str| format!("[[light]]\nvisible = {visible}\n{keys}");
    SceneFile::seen_from([0.0, -0.6, 0.12])
        .looking_at([0.0, 0.0, 0.06])
        .fov_y_deg(30.0)
        .size_px([192, 108])
        .metal("steel", "steel")
        .object("table", "steel", "plane = { size_m = [0.4, 0.4] }")
        .random("table", 300)
        .part(&light("kind = \"sphere\"\ncenter_m = [-0.17, 0.0, 0.11]\nradius_m = 0.02\nradiance = 3.0"))
        .part(&light("kind = \"disk\"\ncenter_m = [-0.1, 0.0, 0.11]\ntarget_m = [-0.1, -1.0, 0.0]\nradius_m = 0.025\nradiance = 2.0\ncolor = [1.0, 0.5, 0.25]"))
        .part(&light("kind = \"tube\"\nends_m = [[-0.04, 0.0, 0.09], [-0.02, 0.03, 0.14]]\nradius_m = 0.008\nradiance = 4.0"))
        .part(&light("kind = \"polygon\"\nvertices_m = [[0.02, 0, 0.08], [0.08, 0, 0.08], [0.08, 0, 0.1], [0.04, 0, 0.1], [0.04, 0, 0.14], [0.02, 0, 0.14]]\nradiance = 1.5"))
        .part(&light("kind = \"sphere\"\ncenter_m = [0.12, 0.0, 0.12]\nradius_m = 0.015\nradiance = 8.0\ncone_deg = 140.0\ncone_softness = 0.5\ntarget_m = [0.6, -0.6, 0.12]"))
        .part(&light("kind = \"rectangle\"\ncenter_m = [0.17, 0.0, 0.11]\ntarget_m = [0.17, 1.0, 0.11]\nwidth_m = 0.03\nheight_m = 0.04\nradiance = 9.0"))
        .part(&light("kind = \"disk\"\ncenter_m = [0.0, -0.05, 0.15]\ntarget_m = [0.0, 1.0, 0.15]\nradius_m = 0.02\ntwo_sided = true\nradiance = 0.7"))
        .scene()
}

fn pixel_at(image: &Image, scene: &Scene, point_m: [f64; 3]) -> [f32; 3] {
    let frame = scene.camera.frame(scene.render.size_px);
    let ray = glam::DVec3::from(point_m) - frame.position_m;
    let ray = ray / ray.dot(frame.forward);
    let across = |step: glam::DVec3| ray.dot(step) / step.length_squared();
    let x = across(frame.per_px_x) + 0.5 * frame.size_px.x;
    let y = across(frame.per_px_y) + 0.5 * frame.size_px.y;
    image.beauty().rgb[y as usize * image.size_px[0] as usize + x as usize]
}

#[test]
fn the_camera_sees_their_radiance() {
    let scene = lamps(true);
    let image = on_the_cpu(&scene, 4);
    let spot = scene.lights[4].cone.expect("a cone");
    let towards = (scene.camera.position_m - glam::DVec3::new(0.12, 0.0, 0.12)).normalize();
    let spot = 8.0 * spot.share(towards);
    assert!((0.1..7.9).contains(&spot), "{spot}");
    for (point_m, expected) in [
        ([-0.17, 0.0, 0.11], [3.0; 3]),
        ([-0.1, 0.0, 0.11], [2.0, 1.0, 0.5]),
        ([-0.03, 0.015, 0.115], [4.0; 3]),
        ([0.03, 0.0, 0.12], [1.5; 3]),
        // Beyond the corner of the L.
        ([0.07, 0.0, 0.13], [0.0; 3]),
        ([0.12, 0.0, 0.12], [spot; 3]),
        // The light shines away from this point.
        ([0.17, 0.0, 0.115], [0.0; 3]),
        ([0.0, -0.05, 0.15], [0.7; 3]),
    ] {
        let found = pixel_at(&image, &scene, point_m);
        for (found, expected) in found.iter().zip(expected) {
            let found = f64::from(*found);
            assert!(
                (found - expected).abs() < 1e-5,
                "{point_m:?}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn both_renderers_see_the_same_shapes() -> Result<(), String> {
    let mut scene = lamps(true);
    scene.render.size_px = [384, 216];
    let Some(gpu) = on_the_gpu(&scene, 4) else {
        return Ok(());
    };
    let cpu = on_the_cpu(&scene, 4);
    compare("lamps", &scene, &gpu, &cpu)?;
    // Silhouettes too: the samples of an edge are the same.
    let [a, b] = [&gpu, &cpu].map(|image| image.beauty().rgb);
    let differ = a
        .iter()
        .zip(&b)
        .filter(|(a, b)| (a[1] - b[1]).abs() > 0.02 * b[1].max(0.05));
    let share = differ.count() as f64 / b.len() as f64;
    assert!(share < 0.002, "{share} of all pixels differ");
    Ok(())
}

/// Shapes of lamps hide no light of other lamps, and lit objects show each lamp once.
#[test]
fn what_they_light_stays_as_it_is() {
    let [seen, unseen] = [lamps(true), lamps(false)];
    for (shadows, bounces) in [(false, 0), (true, 1)] {
        let options = RenderOptions {
            samples: 4,
            shadows,
            bounces,
            ..Default::default()
        };
        let [a, b] = [&seen, &unseen].map(|scene| render(scene, &options, &|_| {}));
        // Pixels that show the table in both pictures.
        let mut table = 0;
        let (mut error, mut sum) = (0.0, 0.0);
        for i in 0..a.depth_m.len() {
            let [x, y] = [&a, &b].map(|image| image.depth_m[i]);
            if y > 0.0 && (x - y).abs() < 1e-6 {
                table += 1;
                error += f64::from((a.beauty().rgb[i][1] - b.beauty().rgb[i][1]).abs());
                sum += f64::from(b.beauty().rgb[i][1]);
            }
        }
        assert!(table > 4000, "{table} pixels");
        assert!(error < 1e-3 * sum, "shadows {shadows}: {error} of {sum}");
    }
}

/// Monte Carlo shows a lamp as bright, and lit objects show it once, also with bounces.
#[test]
fn both_references_see_them() {
    for model in [Model::Separable, Model::Full] {
        let settings = Settings {
            model,
            shadows: true,
            bounces: 1,
            ..Settings::default()
        };
        let [seen, unseen] = [true, false].map(|visible| {
            let mut scene = lamps(visible);
            scene.render.size_px = [96, 54];
            let integrator = Integrator::new(&scene, settings);
            let mut image = integrator.start();
            let _ = integrator.run(&mut image, BATCH_SAMPLES, &|_| ControlFlow::Continue(()));
            (scene, image)
        });
        let (scene, image) = &seen;
        let found = pixel_at(image, scene, [-0.1, 0.0, 0.11]);
        for (found, expected) in found.iter().zip([2.0, 1.0, 0.5]) {
            assert!((found - expected).abs() < 1e-4, "{model:?}: {found}");
        }
        // The same rays are drawn for what lies in front of all lamps.
        let row = 50 * 96..54 * 96;
        let [a, b] = [&seen.1, &unseen.1].map(|image| image.beauty().rgb[row.clone()].to_vec());
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!(
                (a - b).abs() < 1e-3 * b.abs().max(0.1),
                "{model:?}: {a} {b}"
            );
        }
    }
}

/// A small lamp 0.2 m above a rough table with one door at 30 degrees and another at 45: the light ends where they stand, and is that without
/// doors where they are open. Both renderers and Monte Carlo agree.
#[test]
fn barn_doors_end_the_light() -> Result<(), String> {
    let scene = |doors: &str| {
        SceneFile::seen_from([0.0, -1.0e-3, 1.0])
            .fov_y_deg(40.0)
            .size_px([160, 160])
            .part("[[material]]\nname = \"paper\"\nkind = \"dielectric\"\nbase_color = [0.8, 0.8, 0.8]\nroughness = 1.0")
            .object("table", "paper", "plane = { size_m = [1.0, 1.0] }")
            .part(&format!(
                "[[light]]\nkind = \"rectangle\"\ncenter_m = [0.0, 0.0, 0.2]\ntarget_m = [0.0, 0.0, 0.0]\nwidth_m = 0.002\nheight_m = 0.002\nradiance = 900.0\n{doors}"
            ))
            .scene()
    };
    let [open, shaded] = ["", "barn_doors_deg = [30.0, 90.0, 90.0, 45.0]"].map(scene);
    let [of_open, of_shaded] = [&open, &shaded].map(|scene| on_the_cpu(scene, 1));
    // Right is at -x, as seen from the target with y up.
    let share = |x: f64, y: f64| {
        let point_m = [x, y, 0.0];
        f64::from(pixel_at(&of_shaded, &shaded, point_m)[1] / pixel_at(&of_open, &open, point_m)[1])
    };
    for (x, y, expected) in [
        (0.0, 0.0, 1.0),
        (-0.25, 0.0, 1.0),
        (0.0, 0.25, 1.0),
        // Falling off begins at 27 degrees.
        (0.2 * 26.0_f64.to_radians().tan(), 0.0, 1.0),
        (0.2 * 31.5_f64.to_radians().tan(), 0.0, 0.0),
        (0.0, -0.2 * 46.5_f64.to_radians().tan(), 0.0),
        (0.0, -0.2 * 39.5_f64.to_radians().tan(), 1.0),
    ] {
        let found = share(x, y);
        assert!(
            (found - expected).abs() < 0.01,
            "{x} {y}: {found}, not {expected}"
        );
    }
    let integrator = Integrator::new(&shaded, Settings::default());
    let mut image = integrator.start();
    let _ = integrator.run(&mut image, BATCH_SAMPLES, &|_| ControlFlow::Continue(()));
    let [sum, reference] = [&of_shaded, &image].map(|image| {
        let base = image.base.iter().map(|rgb| f64::from(rgb[1]));
        base.sum::<f64>()
    });
    assert!((sum / reference - 1.0).abs() < 0.01, "{sum} {reference}");
    match on_the_gpu(&shaded, 1) {
        Some(gpu) => compare("barn doors", &shaded, &gpu, &of_shaded),
        None => Ok(()),
    }
}

/// Matt paper under a sun: albedo / pi of the irradiance, by either renderer.
#[test]
fn a_sun_on_matt_paper() -> Result<(), String> {
    const ALBEDO: f64 = 0.8;
    let scene = |keys: &str| {
        SceneFile::seen_from([0.0, -1.0, 1.0])
            .fov_y_deg(20.0)
            .size_px([24, 24])
            .part(&format!(
                "[[material]]\nname = \"paper\"\nkind = \"dielectric\"\nior = 1.0\nbase_color = [{ALBEDO}, {ALBEDO}, {ALBEDO}]\nroughness = 1.0"
            ))
            .object("table", "paper", "plane = { size_m = [2.0, 2.0] }")
            .part(&format!("[[light]]\nkind = \"sun\"\n{keys}"))
            .scene()
    };
    // The cosine to the plate's normal is 0.8 for a direction of (0, 0.6, -0.8).
    for (keys, expected) in [
        ("direction = [0.0, 0.0, -2.0]", 1.0),
        ("direction = [0.0, 3.0, -4.0]\nirradiance = 2.0", 1.6),
        (
            "direction = [0.0, 0.6, -0.8]\nangle_deg = 40.0\nexposure_ev = 1.0",
            1.6,
        ),
        ("direction = [0.0, 0.0, -1.0]\nangle_deg = 0.01", 1.0),
        ("direction = [0.0, 0.0, 1.0]", 0.0),
    ] {
        let scene = scene(keys);
        let expected = expected * ALBEDO / std::f64::consts::PI;
        let pictures = [Some(on_the_cpu(&scene, 1)), on_the_gpu(&scene, 1)];
        for (image, renderer) in pictures.iter().zip(["CPU", "GPU"]) {
            for rgb in image.iter().flat_map(|image| &image.base) {
                let found = f64::from(rgb[1]);
                assert!(
                    (found - expected).abs() <= 5e-3 * expected,
                    "{renderer}, {keys}: {found}, not {expected}"
                );
            }
        }
    }
    Ok(())
}

/// A sun low over a scratched table, with the shadow of a ball: no other picture on the GPU, with rays for the shadow and without.
#[test]
fn both_renderers_see_the_same_sun() -> Result<(), String> {
    let scene = SceneFile::seen_from([0.0, -0.5, 0.4])
        .fov_y_deg(22.0)
        .size_px([128, 96])
        .metal("steel", "steel")
        .with_lines("roughness = 0.15")
        .object("table", "steel", "plane = { size_m = [0.4, 0.4] }")
        .random("table", 400)
        .object("ball", "steel", "sphere = { radius_m = 0.03 }")
        .with_lines("translation_m = [0.04, 0.03, 0.04]")
        .part("[[light]]\nkind = \"sun\"\ndirection = [-0.1, -0.75, -0.65]\nirradiance = 2.0\ntemperature_k = 5000")
        .scene();
    if let Some(gpu) = on_the_gpu(&scene, 4) {
        compare("a sun", &scene, &gpu, &on_the_cpu(&scene, 4))?;
    }
    let Some(gpu) = on_the_gpu_by(&scene, &Method::default(), 16, Some(0)) else {
        return Ok(());
    };
    let options = RenderOptions {
        samples: 16,
        shadows: true,
        bounces: 0,
        ..RenderOptions::default()
    };
    let cpu = render(&scene, &options, &|_| {});
    let open = on_the_cpu(&scene, 16);
    let sum = |image: &Image, of: fn(&Image) -> &[[f32; 3]]| -> f64 {
        of(image).iter().map(|rgb| f64::from(rgb[1])).sum()
    };
    for of in [
        (|image| &image.base[..]) as fn(&Image) -> &[[f32; 3]],
        |image| &image.scratches[..],
    ] {
        let [open, cpu, gpu] = [&open, &cpu, &gpu].map(|image| sum(image, of));
        println!("sun: {open} open, {cpu} shadowed on the CPU, {gpu} on the GPU");
        // Rays of the two are not the same.
        assert!((gpu / cpu - 1.0).abs() < 0.01, "{gpu} {cpu}");
        assert!(cpu < 0.97 * open, "{cpu} of {open}");
    }
    Ok(())
}
