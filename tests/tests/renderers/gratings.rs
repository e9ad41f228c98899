//! Gratings in pictures: the GPU against the CPU, their energy, and the angles of their orders.

use conformance::furnace;
use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use glam::DVec3;
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_fixtures::{BALL, SceneFile};
use hairline_image::Image;
use hairline_optics::scratch::phase_step_energy;
use hairline_optics::spectrum;
use hairline_scene::Scene;
use std::ops::Range;

fn one_sample(scene: &Prepared<'_>) -> Image {
    let options = RenderOptions {
        samples: 1,
        ..RenderOptions::default()
    };
    scene.render(&options, &|_| {})
}

/// Gratings send the light that the base loses: whatever the pitch, the view and the scratches on top.
#[test]
fn a_white_furnace_stays_white() {
    let file = |gratings: &str| {
        SceneFile::seen_from([0.0, -0.2, 0.1])
            .size_px([40, 30])
            .mirror("m")
            .object("ball", "m", BALL)
            .part(gratings)
    };
    let circular = "[[grating]]\nobject = \"ball\"\npattern = \"circular\"\n";
    let fine = format!("{circular}pitch_um = 0.6\nwidth_um = 0.3\ndepth_nm = 150.0\n");
    let coarse = format!(
        "{circular}pitch_um = 20.0\njitter_um = 2.0\njitter_deg = 3.0\ncoverage = 0.6\n\
         depth_nm = {{ mean = 300.0, spread = 0.2 }}\n"
    );
    let spots = |spacing_m: f64| {
        file("[[grating]]\nobject = \"ball\"\npattern = \"swirl\"\npitch_um = 3.0\n")
            .with_lines(&format!("spacing_m = {spacing_m:?}"))
    };
    for file in [
        file(&fine),
        file(&coarse),
        spots(0.02),
        spots(0.001),
        file(&fine).part(&coarse),
        file(&coarse).random("ball", 400),
    ] {
        let has_scratches = file.to_string().contains("[[scratches]]");
        let mut scene = file.part("[studio]\nhidden = true").scene();
        scene.environment = furnace();
        let image = one_sample(&Prepared::new(&scene));
        let mut covered = 0;
        for i in 0..image.depth_m.len() {
            let all: [f32; 3] = std::array::from_fn(|c| image.base[i][c] + image.scratches[i][c]);
            if image.depth_m[i] > 0.0 && image.scratches[i][1] > 0.01 {
                covered += 1;
                // Scratches lose what goes beyond the horizon.
                let least = if has_scratches { 0.9 } else { 0.999 };
                assert!(all.iter().all(|v| (least..1.001).contains(v)), "{all:?}");
            }
        }
        assert!(covered > 100, "{covered}");
    }
}

/// A fine grating in a metal absorbs what its efficiencies say, and no light is made: a ball under even light is no brighter than without grooves.
#[test]
fn a_fine_grating_in_a_furnace_absorbs_more_than_its_metal() {
    let ball = |grating: &str| {
        let file = SceneFile::seen_from([0.0, -0.2, 0.1])
            .size_px([40, 30])
            .metal("m", "silver")
            .object("ball", "m", BALL)
            .part(grating);
        let mut scene = file.part("[studio]\nhidden = true").scene();
        scene.environment = furnace();
        one_sample(&Prepared::new(&scene))
    };
    let bare = ball("");
    let fine = ball(
        "[[grating]]\nobject = \"ball\"\npattern = \"circular\"\npitch_um = 0.74\nwidth_um = 0.32\ndepth_nm = 105.0",
    );
    let (mut least, mut most, mut sum, mut covered) = (f32::MAX, 0.0_f32, 0.0, 0);
    for i in 0..fine.depth_m.len() {
        if fine.depth_m[i] > 0.0 && fine.scratches[i][1] > 0.01 {
            let kept = (fine.base[i][1] + fine.scratches[i][1]) / bare.base[i][1];
            (least, most) = (least.min(kept), most.max(kept));
            (sum, covered) = (sum + kept, covered + 1);
        }
    }
    let mean = sum / covered as f32;
    println!("silver of 0.74 um keeps {least} to {most} of green, in the mean {mean}");
    assert!(covered > 100 && least > 0.5 && most < 1.02 && (0.8..0.99).contains(&mean));
}

/// The mean wavelength of a first order, computed from its angles in the picture, is the one that the eye's response gives.
#[test]
fn orders_lie_where_the_grating_equation_says() {
    // Orders 1 and 2 of a compact disc overlap beyond 0.47, and the visible part of the second begins at 0.5; those of a DVD have all wavelengths within.
    for (pitch_um, within) in [(1.6, 0.23..0.485), (0.74, 0.49..1.0)] {
        let plate = Grooved {
            size_m: 1.0,
            object: "plane = { size_m = [0.1, 1.2] }",
            center_y_m: 0.0,
            grating: "pattern = \"parallel\"",
        };
        let found_nm = first_order_nm(&plate, pitch_um, within.clone());
        let expected_nm = seen_nm();
        println!(
            "gratings, {pitch_um} um: the first order's mean wavelength is {found_nm:.2} nm in the picture, {expected_nm:.2} by the spectrum"
        );
        assert!((found_nm / expected_nm - 1.0).abs() < 1e-3, "{pitch_um}");
        // A disc as it is sold, from 27 to 55 mm off its axis.
        let disc = Grooved {
            size_m: 0.15,
            object: "disk = { radius_m = 0.06 }",
            center_y_m: -0.027,
            grating: "pattern = \"circular\"\nradius_m = [0.0228, 0.058]",
        };
        if pitch_um == 1.6 {
            let found_nm = first_order_nm(&disc, pitch_um, within.clone());
            println!("gratings, on a disc: {found_nm:.2} nm");
            assert!((found_nm / expected_nm - 1.0).abs() < 1e-3, "{found_nm}");
            // Grooves of another pitch are seen.
            let wrong_nm = first_order_nm(&disc, 1.61, within) * 1.6 / 1.61;
            assert!((wrong_nm / expected_nm - 1.0).abs() > 3e-3, "{wrong_nm}");
        }
    }
}

/// An object under a strip lamp, and the width of the scene.
struct Grooved {
    size_m: f64,
    object: &'static str,
    center_y_m: f64,
    grating: &'static str,
}

/// Grooves so shallow that their colours follow the inverse square of the wavelength, and the square of the depth along the path.
const SHALLOW_NM: f64 = 4.0;

/// The mean wavelength of a first order by the angles in a picture; `within` are the directions across the grooves that are asked for.
fn first_order_nm(grooved: &Grooved, pitch_um: f64, within: Range<f64>) -> f64 {
    let camera_m = 2.0 * grooved.size_m;
    // A strip across the order's way, wider than the band.
    let [lamp_y_m, lamp_z_m, half_m, reach_m] = [0.5, 0.9, 0.0005, 0.1].map(|v| v * grooved.size_m);
    let corner_m = |x: f64, y: f64| [x * reach_m, lamp_y_m + y * half_m, lamp_z_m];
    let width_px = 400;
    let scene = SceneFile::seen_from([0.0, 0.0, camera_m])
        .size_px([3, width_px])
        .fov_y_deg(30.0)
        .mirror("m")
        .object("it", "m", grooved.object)
        .with_lines(&format!(
            "translation_m = [0.0, {:?}, 0.0]",
            grooved.center_y_m
        ))
        .part(&format!(
            "[[grating]]\nobject = \"it\"\n{}\npitch_um = {pitch_um}\n\
             width_um = {:?}\ndepth_nm = {SHALLOW_NM:?}",
            grooved.grating,
            0.3 * pitch_um
        ))
        .polygon(
            &[
                corner_m(-1.0, -1.0),
                corner_m(-1.0, 1.0),
                corner_m(1.0, 1.0),
                corner_m(1.0, -1.0),
            ],
            1e6,
        )
        .with_lines("two_sided = true")
        .scene();
    let image = one_sample(&Prepared::new(&scene));
    let half = f64::from(width_px) / 2.0;
    let slope = (15.0f64).to_radians().tan() / half;
    let q = |row: f64| {
        // Up in the picture is +y.
        let y = -(row - half) * slope * camera_m;
        let to_lamp = (lamp_y_m - y) / (lamp_y_m - y).hypot(lamp_z_m);
        to_lamp - y / y.hypot(camera_m)
    };
    // The lamp's chord in q, up to a factor, times what the path takes of the depth.
    let chord = |row: f64| {
        let y = -(row - half) * slope * camera_m;
        let lamp_m = (lamp_y_m - y).hypot(lamp_z_m);
        let share = 0.5 * (lamp_z_m / lamp_m + camera_m / y.hypot(camera_m));
        share * share / lamp_m.powi(3)
    };
    let (mut sum, mut moment) = (0.0, 0.0);
    for row in 0..width_px as usize {
        let middle = row as f64 + 0.5;
        let at = q(middle);
        if !within.contains(&at) {
            continue;
        }
        let rgb = image.scratches[3 * row + 1];
        let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        let step = (q(row as f64 + 1.0) - q(row as f64)).abs();
        let density = f64::from(luminance) / chord(middle) * step;
        sum += density;
        moment += density * at;
    }
    1e3 * pitch_um * moment / sum
}

/// The mean wavelength that the eye sees of white light from shallow grooves.
fn seen_nm() -> f64 {
    let (mut sum, mut moment) = (0.0, 0.0);
    for sample in spectrum::samples() {
        let [r, g, b] = sample.weight;
        let seen = (0.2126 * r + 0.7152 * g + 0.0722 * b)
            * phase_step_energy(SHALLOW_NM, sample.wavelength_nm);
        sum += seen;
        moment += seen * sample.wavelength_nm;
    }
    moment / sum
}

/// A plate and a ball with gratings of all patterns side by side, scratches on top of some, under lights of all kinds and a studio.
fn all_patterns() -> SceneFile {
    let fine = "pitch_um = 1.6\njitter_um = 0.05\ndepth_nm = { mean = 120.0, spread = 0.1 }\n";
    // One table of the whole field is enough, which takes a second to make.
    let scalar = "theory = \"scalar\"\n";
    let rough = "pitch_um = 8.0\njitter_um = 1.0\njitter_deg = 2.0\ncoverage = 0.7\n";
    let grating = |object: &str, pattern: &str, more: &str| {
        format!("[[grating]]\nobject = \"{object}\"\npattern = \"{pattern}\"\n{more}")
    };
    SceneFile::seen_from([0.0, -0.22, 0.16])
        .size_px([96, 72])
        .fov_y_deg(24.0)
        .metal("aluminium", "aluminium")
        .with_lines("roughness = 0.2")
        .metal("gold", "gold")
        .with_lines("roughness = 0.3")
        .object("plate", "aluminium", "plane = { size_m = [0.2, 0.2] }")
        .object("ball", "gold", "sphere = { radius_m = 0.02 }")
        .with_lines("translation_m = [0.02, 0.0, 0.02]")
        .part(&grating("plate", "parallel", &format!("direction = [1.0, 0.3, 0.0]\n{rough}")))
        .part(&grating("plate", "circular", &format!("radius_m = [0.01, 0.05]\n{fine}")))
        .part(&grating("plate", "swirl", &format!("spacing_m = 0.02\nradius_m = [0.05, 0.09]\n{rough}")))
        .part(&grating("plate", "swirl", &format!("spacing_m = 0.001\nradius_m = [0.09, 0.15]\n{fine}{scalar}")))
        .part(&grating("ball", "radial", &format!("center_m = [0.02, 0.0, 0.02]\n{fine}{scalar}")))
        .part(&grating("ball", "spun", &format!("center_m = [0.02, 0.0, 0.02]\ncurvature_per_m = 30.0\n{rough}")))
        .random("ball", 60)
        .sphere([0.05, 0.2, 0.3], 0.01, 60.0)
        .polygon(&[[-0.3, 0.1, 0.3], [-0.2, 0.1, 0.3], [-0.2, 0.2, 0.3], [-0.3, 0.2, 0.3]], 20.0)
        .with_lines("two_sided = true")
        .part("[[light]]\nkind = \"tube\"\nends_m = [[0.2, -0.2, 0.3], [0.25, 0.3, 0.35]]\nradius_m = 0.004\nradiance = 40.0")
        .part("[[light]]\nkind = \"disk\"\ncenter_m = [0.0, 0.4, 0.4]\ntarget_m = [0.0, 0.0, 0.0]\nradius_m = 0.03\nradiance = 10.0")
        .part("[studio]\nhidden = true")
}

#[test]
fn gpu_and_cpu_show_the_same_gratings() {
    let scene = all_patterns().scene();
    let Some(gpu) = on_the_gpu(&scene, 1) else {
        return;
    };
    let cpu = on_the_cpu(&scene, 1);
    compare("gratings", &scene, &gpu, &cpu).unwrap_or_else(|error| panic!("{error}"));
    // A groove a hundredth further from the next is seen.
    let mut wrong = scene.clone();
    wrong.objects[0].gratings[1].row.pitch_um *= 1.01;
    let seen = compare("wrong", &scene, &gpu, &on_the_cpu(&wrong, 1)).unwrap_err();
    assert!(seen.contains("scratches"), "{seen}");
    // So are orders of the other theory.
    let mut scalar = scene.clone();
    scalar.objects[0].gratings[1].is_rigorous = false;
    let seen = compare("scalar", &scene, &gpu, &on_the_cpu(&scalar, 1)).unwrap_err();
    assert!(seen.contains("scratches"), "{seen}");
}

/// Gratings on the objects `plate` and `ball`, in pixels of 6 um seven centimetres from the middle of the scene, on both renderers; and with another seed of the
/// second one.
pub(super) fn grooves_one_by_one(name: &str, gratings: &[String]) {
    let mut file = SceneFile::seen_from([0.06, 0.01, 0.02])
        .looking_at([0.06, 0.03, 0.0])
        .size_px([96, 72])
        .fov_y_deg(1.0)
        .metal("aluminium", "aluminium")
        .with_lines("roughness = 0.2\ncoherence_um = 8.0")
        .object("plate", "aluminium", "plane = { size_m = [0.2, 0.2] }")
        .object("ball", "aluminium", "sphere = { radius_m = 0.0003 }")
        .with_lines("translation_m = [0.0601, 0.03, 0.0]");
    for grating in gratings {
        file = file.part(grating);
    }
    let scene = file
        .polygon(
            &[
                [-1.0, -1.0, 0.7],
                [-1.0, 1.0, 0.7],
                [1.0, 1.0, 0.7],
                [1.0, -1.0, 0.7],
            ],
            1.0,
        )
        .with_lines("two_sided = true")
        .part("[studio]\nhidden = true")
        .scene();
    let Some(gpu) = on_the_gpu(&scene, 1) else {
        return;
    };
    let cpu = on_the_cpu(&scene, 1);
    compare(name, &scene, &gpu, &cpu).unwrap_or_else(|error| panic!("{error}"));
    let mut wrong = scene.clone();
    wrong.objects[0].gratings[1].seed = 6;
    let seen = compare("wrong", &scene, &gpu, &on_the_cpu(&wrong, 1)).unwrap_err();
    assert!(seen.contains("scratches"), "{seen}");
}

/// Grooves of 30 and 40 um.
#[test]
fn gpu_and_cpu_show_the_same_single_grooves() {
    let grating = |object: &str, pattern: &str, pitch_um: f64, more: &str| {
        format!(
            "[[grating]]\nobject = \"{object}\"\npattern = \"{pattern}\"\npitch_um = {pitch_um:?}\nwidth_um = 8.0\n\
             jitter_um = 3.0\ndepth_nm = {{ mean = 300.0, spread = 0.5 }}\n{more}"
        )
    };
    grooves_one_by_one(
        "single grooves",
        &[
            grating(
                "plate",
                "parallel",
                40.0,
                "direction = [1.0, 0.3, 0.0]\ncoverage = 0.5",
            ),
            grating("plate", "circular", 30.0, "coverage = 0.5\nseed = 5"),
            grating("ball", "circular", 30.0, ""),
        ],
    );
}

/// A disc of circular grooves under a lamp, a tube and a studio, seen from 0.3 m.
fn disc(pitch_um: f64, side_px: u32) -> Scene {
    SceneFile::seen_from([0.03, -0.16, 0.24])
        .looking_at([0.03, 0.02, 0.0])
        .size_px([side_px, side_px])
        .metal("m", "aluminium")
        .object("disc", "m", "disk = { radius_m = 0.06 }")
        .part(&format!(
            "[[grating]]\nobject = \"disc\"\npattern = \"circular\"\npitch_um = {pitch_um:?}\njitter_um = {:?}",
            0.02 * pitch_um
        ))
        .sphere([0.1, 0.25, 0.4], 0.02, 50.0)
        .part("[[light]]\nkind = \"tube\"\nends_m = [[-0.4, -0.1, 0.3], [-0.4, 0.35, 0.3]]\nradius_m = 0.006\nradiance = 60.0")
        .part("[environment]\nbuiltin = \"studio\"")
        .scene()
}

/// A [`disc`] at `pixel_um` per pixel, with the camera moved by `aside_px` pixels along x.
fn zoom(disc: &Scene, pixel_um: f64, aside_px: f64) -> Scene {
    let mut scene = disc.clone();
    let half = 0.5 * f64::from(scene.render.size_px[0]) * pixel_um * 1e-6 / 0.3;
    scene.camera.fov_y_rad = 2.0 * half.atan();
    let aside_m = DVec3::X * (aside_px * pixel_um * 1e-6);
    scene.camera.position_m += aside_m;
    scene.camera.target_m += aside_m;
    scene
}

/// The mean of the picture changes steadily from the whole disc to 10 um a pixel, in steps of a half, and it hardly changes where the camera moves by a third
/// of a pixel.
#[test]
fn a_zoom_neither_steps_nor_flickers() {
    let seen = |disc: &Prepared<'_>, pixel_um: f64, aside_px: f64| {
        let scene = zoom(disc.scene(), pixel_um, aside_px);
        let image = one_sample(&disc.with_scene(&scene));
        let count = image.scratches.len() as f64;
        let sum = image.scratches.iter().flatten().map(|v| f64::from(*v));
        sum.sum::<f64>() / count
    };
    for pitch_um in [1.6, 30.0] {
        let disc = disc(pitch_um, 12);
        let disc = Prepared::new(&disc);
        let (mut pixel_um, mut last) = (300.0, Vec::new());
        let mut most: [f64; 2] = [0.0; 2];
        while pixel_um > 10.0 {
            let here = seen(&disc, pixel_um, 0.0);
            let beside = seen(&disc, pixel_um, 0.33);
            most[1] = most[1].max((beside / here - 1.0).abs());
            last.push(here.ln());
            if let [.., a, b, c] = last[..] {
                most[0] = most[0].max(f64::abs(a - 2.0 * b + c));
            }
            pixel_um /= 1.5;
        }
        println!(
            "gratings, zoom, {pitch_um} um: a step differs by {:.2} % from the one before, a third of a pixel {:.2} %",
            100.0 * most[0],
            100.0 * most[1]
        );
        assert!(most[0] < 0.03 && most[1] < 0.03, "{pitch_um}: {most:?}");
    }
}

/// Frames of a zoom into a disc of this pitch, from `first_um` to 10 um a pixel, each a tenth nearer; by what the middle one of three differs from the mean of the
/// two about it, both warped to it: the greatest of all frames, relative.
fn flicker(pitch_um: f64, first_um: f64, filter_std_px: f64) -> f64 {
    let side_px = 32;
    let mut disc = disc(pitch_um, side_px);
    disc.materials[0].coherence_um = 8.0;
    disc.render.filter_std_px = filter_std_px;
    let prepared = Prepared::new(&disc);
    let frame = |pixel_um: f64| {
        one_sample(&prepared.with_scene(&zoom(&disc, pixel_um, 0.0)))
            .scratches
            .iter()
            .map(|rgb| f64::from(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]))
            .collect::<Vec<f64>>()
    };
    let ratio = 1.1;
    let count = ((first_um / 10.0).ln() / f64::ln(ratio)).ceil() as i32;
    let frames: Vec<_> = (0..=count)
        .map(|i| frame(first_um / f64::powi(ratio, i)))
        .collect();
    let side = side_px as usize;
    let half = 0.5 * f64::from(side_px);
    // Between four pixels each way, by cubics through them.
    let weights = |t: f64| {
        let (t2, t3) = (t * t, t * t * t);
        [
            0.5 * (2.0 * t2 - t - t3),
            0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
            0.5 * (4.0 * t2 - 3.0 * t3 + t),
            0.5 * (t3 - t2),
        ]
    };
    let warped = |frame: &[f64], x: usize, y: usize, scale: f64| {
        let [at_x, at_y] = [x, y].map(|v| (v as f64 + 0.5 - half) * scale + half - 0.5);
        let (first_x, first_y) = (at_x.floor(), at_y.floor());
        let (across, down) = (weights(at_x - first_x), weights(at_y - first_y));
        let mut sum = 0.0;
        for (j, down) in down.iter().enumerate() {
            for (i, across) in across.iter().enumerate() {
                let place = (first_y as usize + j - 1) * side + first_x as usize + i - 1;
                sum += across * down * frame[place];
            }
        }
        sum
    };
    let mut most: f64 = 0.0;
    for three in frames.windows(3) {
        let (mut error, mut all) = (0.0, 0.0);
        for y in 5..side - 5 {
            for x in 5..side - 5 {
                let before = warped(&three[0], x, y, 1.0 / ratio);
                let after = warped(&three[2], x, y, ratio);
                let here = three[1][y * side + x];
                error += (here - 0.5 * (before + after)).powi(2);
                all += here * here;
            }
        }
        most = most.max((error / all).sqrt());
    }
    most
}

/// Frames do not flicker either where single grooves, a few pixels apart, become visible. Pixels that look at points see other grooves in each frame there.
#[test]
#[ignore = "long: cargo long"]
fn frames_of_a_zoom_do_not_flicker() {
    for (pitch_um, limit) in [(1.6, 0.02), (30.0, 0.05)] {
        let found = flicker(pitch_um, 1000.0, 0.5);
        println!(
            "gratings, frames of a zoom, {pitch_um} um: a frame differs from those about it by {:.2} % at most",
            100.0 * found
        );
        assert!(found < limit, "{pitch_um}: {found}");
    }
    let by_points = flicker(30.0, 60.0, 0.02);
    println!(
        "by {:.2} % with pixels that look at points",
        100.0 * by_points
    );
    assert!(by_points > 3.0 * 0.05, "{by_points}");
}
