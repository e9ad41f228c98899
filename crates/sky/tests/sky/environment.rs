//! Environment maps: conventions, energy, prefiltering against quadrature, and files that are no maps.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use crate::asset::asset;
use glam::{DVec2, DVec3};
use hairline_image::{Display, Output, Picture};
use hairline_optics::ggx::{ggx_alpha, ggx_eval};
use hairline_scene::environment::lookup::{environment_dir, environment_lod, environment_uv};
use hairline_scene::environment::{LEVEL_HALVINGS, LEVEL_ROUGHNESS};
use hairline_scene::{Environment, LightShape};
use hairline_sky::Error;
use rayon::prelude::*;

/// A map whose texels hold a function of their direction.
fn map_of(size_px: [u32; 2], radiance: impl Fn(DVec3) -> [f64; 3]) -> Picture {
    let mut map = Picture::new(size_px);
    for y in 0..size_px[1] {
        for x in 0..size_px[0] {
            let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let size = DVec2::new(f64::from(size_px[0]), f64::from(size_px[1]));
            let i = (y * size_px[0] + x) as usize;
            map.rgb[i] = radiance(environment_dir(at / size)).map(|c| c as f32);
        }
    }
    map
}

fn sphere_mean(map: &Picture) -> DVec3 {
    let [width, height] = map.size_px;
    let mut sum = DVec3::ZERO;
    for y in 0..height {
        let edge = |y: u32| (PI * f64::from(y) / f64::from(height)).cos();
        let weight = (edge(y) - edge(y + 1)) / 2.0 / f64::from(width);
        for x in 0..width {
            sum += DVec3::from(map.pixel(x, y).map(f64::from)) * weight;
        }
    }
    sum
}

/// Directions all over the sphere (Fibonacci's spiral).
fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |i| {
        let y = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let phi = i as f64 * 2.399_963_229_728_653;
        let r = (1.0 - y * y).sqrt();
        DVec3::new(r * phi.cos(), y, r * phi.sin())
    })
}

fn relative(a: DVec3, b: DVec3) -> f64 {
    (a - b).length() / b.length()
}

#[test]
fn directions_and_map_positions_agree() {
    let at = |x, y, z| environment_uv(DVec3::new(x, y, z));
    assert!(
        (at(0.0, 0.0, -1.0) - DVec2::new(0.5, 0.5)).length() < 1e-15,
        "the centre is at -Z"
    );
    assert!(
        (at(1.0, 0.0, 0.0) - DVec2::new(0.75, 0.5)).length() < 1e-15,
        "+X is to the right"
    );
    assert_eq!(at(0.0, 1.0, 0.0), DVec2::new(0.5, 0.0), "the top is at +Y");
    assert_eq!(at(0.0, -1.0, 0.0), DVec2::new(0.5, 1.0));
    for dir in directions(1000) {
        let uv = environment_uv(dir);
        assert!((0.0..=1.0).contains(&uv.x) && (0.0..=1.0).contains(&uv.y));
        assert!((environment_dir(uv) - dir).length() < 1e-12);
    }
}

#[test]
fn rotation_and_up_turn_the_map() {
    // Red at the map's centre (-Z), green to the right of it (+X), blue at the top.
    let map = map_of([64, 32], |d| [(-d.z).max(0.0), d.x.max(0.0), d.y.max(0.0)]);
    let plain = hairline_sky::from_map(map, 0.0, 1.0, true);
    let close = |a: DVec3, b: [f64; 3]| assert!((a - DVec3::from(b)).length() < 0.07, "{a} {b:?}");
    close(plain.radiance(DVec3::NEG_Z), [1.0, 0.0, 0.0]);
    close(plain.radiance(DVec3::X), [0.0, 1.0, 0.0]);
    close(plain.radiance(DVec3::Y), [0.0, 0.0, 1.0]);
    // A quarter turn, counter-clockwise seen from above, takes what was at -Z to -X.
    let turned = plain.clone().with_up(DVec3::Y, FRAC_PI_2);
    close(turned.radiance(DVec3::NEG_X), [1.0, 0.0, 0.0]);
    close(turned.radiance(DVec3::NEG_Z), [0.0, 1.0, 0.0]);
    close(turned.radiance(DVec3::Y), [0.0, 0.0, 1.0]);
    // Z up: the top goes to +Z, the centre to +Y, the right stays.
    let z_up = plain.with_up(DVec3::new(0.0, 0.0, 2.0), 0.0);
    close(z_up.radiance(DVec3::Z), [0.0, 0.0, 1.0]);
    close(z_up.radiance(DVec3::Y), [1.0, 0.0, 0.0]);
    close(z_up.radiance(DVec3::X), [0.0, 1.0, 0.0]);
}

#[test]
fn a_uniform_map_is_uniform_everywhere() {
    // Half floats hold these.
    let radiance = DVec3::new(0.5, 1.0, 3.25);
    let environment = hairline_sky::uniform(radiance.to_array().map(|c| c as f32));
    assert!(environment.visible());
    for dir in directions(500) {
        assert_eq!(environment.radiance(dir), radiance);
        for i in 0..=20 {
            assert_eq!(environment.prefiltered(dir, f64::from(i) / 20.0), radiance);
            assert_eq!(
                environment.prefiltered_lod(dir, f64::from(i) / 2.0 - 1.0),
                radiance
            );
        }
        // Coefficients are single precision.
        let error = relative(environment.irradiance(dir), PI * radiance);
        assert!(error < 1e-6, "{error}");
    }
    // A size that is no power of two, and a map that is smaller and one that is larger than the levels.
    for size in [[6, 3], [1000, 500], [2100, 1050]] {
        let map = Picture {
            size_px: size,
            rgb: vec![[0.5, 1.0, 3.25]; (size[0] * size[1]) as usize],
        };
        let environment = hairline_sky::from_map(map, 1.0, 1.0, false);
        for level in environment.prefiltered_levels() {
            assert!(level.rgb.iter().all(|t| *t == [0.5, 1.0, 3.25]));
        }
    }
}

#[test]
fn levels_have_their_sizes_and_lods_hit_their_roughness() {
    let environment = hairline_sky::uniform([1.0; 3]);
    let levels = environment.prefiltered_levels();
    assert_eq!(levels.len(), LEVEL_ROUGHNESS.len());
    for (i, level) in levels.iter().enumerate() {
        assert_eq!(level.size_px, [2048, 1024].map(|n| n >> LEVEL_HALVINGS[i]));
        assert!((environment_lod(LEVEL_ROUGHNESS[i]) - i as f64).abs() < 1e-12);
    }
    let mut last = -1.0;
    for i in 0..=100 {
        let lod = environment_lod(f64::from(i) / 100.0);
        assert!(lod > last, "the level rises with roughness");
        last = lod;
    }
    assert_eq!(environment_lod(-1.0), 0.0);
    assert_eq!(environment_lod(7.0), 11.0);
}

/// A sky with a gradient, a bright window and a small hot lamp, for maps.
fn room(d: DVec3) -> [f64; 3] {
    let lamp = DVec3::new(0.5, 0.7, 0.2).normalize();
    let hot = if d.dot(lamp) > 0.999 { 300.0 } else { 0.0 };
    let window = if d.z < -0.7 && d.x.abs() < 0.4 && d.y.abs() < 0.5 {
        8.0
    } else {
        0.0
    };
    let sky = 0.3 + 0.2 * d.y;
    [
        sky + hot + 0.5 * window,
        sky + hot + 0.8 * window,
        1.5 * sky + hot + window,
    ]
}

#[test]
fn blurring_keeps_the_light() {
    let map = map_of([1024, 512], room);
    let mean = sphere_mean(&map);
    let environment = hairline_sky::from_map(map, 0.0, 1.0, true);
    for (level, roughness) in environment.prefiltered_levels().iter().zip(LEVEL_ROUGHNESS) {
        let error = relative(sphere_mean(level), mean);
        println!(
            "roughness {roughness}: mean radiance off by {:.3} %",
            100.0 * error
        );
        // The level's texels sample the blurred map at their centres, and there are few near the poles.
        assert!(error < 0.01, "roughness {roughness}: {error}");
    }
}

/// A map for quadrature: the direction of each texel, its solid angle up to a factor, and its radiance.
struct Texels(Vec<(DVec3, f64, DVec3)>);

impl Texels {
    fn new(map: &Picture) -> Self {
        let [width, height] = map.size_px.map(f64::from);
        let texel = |(i, rgb): (usize, &[f32; 3])| {
            let (x, y) = (i as u32 % map.size_px[0], i as u32 / map.size_px[0]);
            let (u, v) = ((f64::from(x) + 0.5) / width, (f64::from(y) + 0.5) / height);
            let dir = environment_dir(DVec2::new(u, v));
            (dir, (PI * v).sin(), DVec3::from(rgb.map(f64::from)))
        };
        Self(map.rgb.iter().enumerate().map(texel).collect())
    }

    /// Light that a surface whose normal is `mirror` reflects to a viewer along it, over its albedo: by quadrature over all texels.
    fn blurred(&self, mirror: DVec3, roughness: f64) -> DVec3 {
        let alpha = ggx_alpha(roughness);
        let rows = self.0.par_chunks(8192).map(|texels| {
            let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
            for (dir, solid_angle, radiance) in texels {
                let cos = dir.dot(mirror);
                // The lobe is 0 below the horizon.
                if cos > 0.0 {
                    let wi = DVec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
                    let weight = ggx_eval(wi, DVec3::Z, alpha) * solid_angle;
                    sum += radiance * weight;
                    weights += weight;
                }
            }
            (sum, weights)
        });
        let add = |a: (DVec3, f64), b: (DVec3, f64)| (a.0 + b.0, a.1 + b.1);
        let (sum, weights) = rows.reduce(Default::default, add);
        sum / weights
    }
}

/// Root mean square of the error over directions, relative to that of the blurred map.
fn blur_error(environment: &Environment, map: &Texels, roughness: f64, count: usize) -> f64 {
    let (mut squares, mut reference) = (0.0, 0.0);
    for dir in directions(count) {
        let want = map.blurred(dir, roughness);
        squares += (environment.prefiltered(dir, roughness) - want).length_squared();
        reference += want.length_squared();
    }
    (squares / reference).sqrt()
}

#[test]
fn blur_matches_quadrature() {
    let map = map_of([1024, 512], room);
    let texels = Texels::new(&map);
    let environment = hairline_sky::from_map(map, 0.0, 1.0, true);
    for roughness in &LEVEL_ROUGHNESS[1..] {
        let error = blur_error(&environment, &texels, *roughness, 60);
        println!("roughness {roughness}: {:.2} % rms", 100.0 * error);
        // A lamp of 2.6 degrees at 1000 times the sky's radiance is the hard case: at the smooth levels it is as narrow as their texels.
        assert!(error < 0.015, "roughness {roughness}: {error}");
    }
}

/// A lamp's light is a thousandth of its peak here and all there is: relative errors of single directions, poles among them. At a right angle
/// to the lamp the lobe ends, in less than a coarse texel; no surface's lobe ends there, as viewers do not look along its normal.
#[test]
fn far_tails_match_quadrature() {
    let lamp = DVec3::new(-0.74, 0.66, 0.11).normalize();
    let map = map_of([1024, 512], |d| {
        let sky = 0.01 + 0.005 * d.y;
        [if d.dot(lamp) > 0.999 { 3000.0 } else { sky }; 3]
    });
    let texels = Texels::new(&map);
    let environment = hairline_sky::from_map(map, 0.0, 1.0, true);
    let poles = [
        DVec3::Y,
        DVec3::new(0.01, 1.0, 0.02),
        DVec3::new(-0.02, -1.0, 0.01),
    ];
    let directions: Vec<DVec3> = directions(80)
        .chain(poles.map(DVec3::normalize))
        .filter(|d| (d.angle_between(lamp) - FRAC_PI_2).abs() > 0.2)
        .collect();
    for roughness in &LEVEL_ROUGHNESS[3..] {
        let errors: Vec<f64> = directions
            .iter()
            .map(|d| {
                let want = texels.blurred(*d, *roughness).x;
                (environment.prefiltered(*d, *roughness).x / want - 1.0).abs()
            })
            .collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let most = errors.iter().fold(0.0_f64, |most, error| most.max(*error));
        println!(
            "roughness {roughness}: {:.2} % in the mean, {:.1} % at most",
            100.0 * mean,
            100.0 * most
        );
        // A coarse texel spans a fifth of its angle from the lobe's middle, and tails fall with the fourth power.
        assert!(mean < 0.02 && most < 0.1, "{roughness}: {mean} {most}");
    }
}

#[test]
fn irradiance_matches_quadrature() {
    let axis = DVec3::new(0.3, 0.8, -0.5).normalize();
    let map = map_of([256, 128], |d| {
        [d.dot(axis).max(0.0), 1.0 + d.x, 1.0 + d.y * d.z]
    });
    let environment = hairline_sky::from_map(map.clone(), 0.0, 2.0, true);
    for normal in directions(60) {
        let mut want = DVec3::ZERO;
        let [width, height] = map.size_px;
        for y in 0..height {
            let v = (f64::from(y) + 0.5) / f64::from(height);
            let solid_angle = (PI * v).sin() * (PI / f64::from(height)) * (TAU / f64::from(width));
            for x in 0..width {
                let u = (f64::from(x) + 0.5) / f64::from(width);
                let cos = environment_dir(DVec2::new(u, v)).dot(normal).max(0.0);
                want += DVec3::from(map.pixel(x, y).map(f64::from)) * (cos * solid_angle);
            }
        }
        let got = environment.irradiance(normal) / 2.0;
        // Linear between texels of 5.6 degrees.
        assert!((got.x - want.x).abs() < 0.003 * TAU / 3.0, "{got} {want}");
        assert!((got.y - want.y).abs() < 2e-3 * PI, "{got} {want}");
        assert!((got.z - want.z).abs() < 2e-3 * PI, "{got} {want}");
    }
}

/// A window a few degrees wide in a black room, high and low, against the integral over it: for a level floor, a ceiling, a slightly leaning
/// surface, and all others.
#[test]
fn a_small_window_lights_every_normal_as_its_integral_says() {
    const WIDTH_DEG: f64 = 11.25;
    const HEIGHT_DEG: f64 = 5.625;
    for low_deg in [2.8125, 22.5, 45.0, 78.75, -22.5] {
        // The window covers 8 by 4 texels, of 256 a turn.
        let map = map_of([256, 128], |d| {
            let [azimuth, elevation] = [d.x.atan2(-d.z), d.y.asin()].map(f64::to_degrees);
            let inside = azimuth.abs() < 0.5 * WIDTH_DEG
                && (low_deg..low_deg + HEIGHT_DEG).contains(&elevation);
            [f64::from(u8::from(inside)); 3]
        });
        let environment = hairline_sky::from_map(map, 0.0, 1.0, true);
        const STEPS: u32 = 100;
        let irradiance = |normal: DVec3| -> f64 {
            let place = |i: u32, whole: f64| whole * (f64::from(i) + 0.5) / f64::from(STEPS);
            let at = |i: u32| {
                let elevation = (low_deg + place(i / STEPS, HEIGHT_DEG)).to_radians();
                let azimuth = (place(i % STEPS, WIDTH_DEG) - 0.5 * WIDTH_DEG).to_radians();
                let (sin, cos) = elevation.sin_cos();
                let d = DVec3::new(cos * azimuth.sin(), sin, -cos * azimuth.cos());
                d.dot(normal).max(0.0) * cos
            };
            let texel_sr = (WIDTH_DEG * HEIGHT_DEG).to_radians().to_radians();
            (0..STEPS * STEPS).map(at).sum::<f64>() * texel_sr / f64::from(STEPS * STEPS)
        };
        let most = irradiance({
            let (sin, cos) = (low_deg + 0.5 * HEIGHT_DEG).to_radians().sin_cos();
            DVec3::new(0.0, sin, -cos)
        });
        let leaning = |deg: f64, turn: f64| {
            let (sin, cos) = deg.to_radians().sin_cos();
            DVec3::new(sin * turn.cos(), cos, sin * turn.sin())
        };
        let mut normals = vec![DVec3::Y, DVec3::NEG_Y];
        for (deg, turn) in [(0.01, 0.0), (0.3, 2.0), (0.7, 4.0), (1.5, 1.0), (2.8, 5.0)] {
            normals.extend([leaning(deg, turn), -leaning(deg, turn)]);
        }
        normals.extend(directions(100));
        let mut worst = 0.0_f64;
        for normal in normals {
            let (got, want) = (environment.irradiance(normal).x, irradiance(normal));
            worst = worst.max((got - want).abs() / most);
            if normal.y.abs() > 0.99 && want > 0.05 * most {
                // All of the window is above the floor.
                assert!(
                    (got / want - 1.0).abs() < 2e-3,
                    "{low_deg}: {normal} {got} {want}"
                );
            }
        }
        println!("{low_deg} degrees: {:.3} % of the most", 100.0 * worst);
        assert!(worst < 2e-3, "{low_deg}: {worst}");
    }
}

#[test]
fn awkward_texels_are_repaired() {
    let mut map = Picture::new([8, 4]);
    map.rgb[0] = [f32::NAN, 1.0, 1.0];
    map.rgb[1] = [-1.0, 1.0, 1.0];
    map.rgb[2] = [f32::INFINITY, 0.0, 0.0];
    map.rgb[3] = [1e6, 2.0, 1e-3];
    let environment = hairline_sky::from_map(map, 0.0, 3.0, true);
    assert_eq!(environment.repaired_texels(), 3);
    let all = environment
        .prefiltered_levels()
        .iter()
        .chain([environment.background()]);
    for c in all.flat_map(|level| level.rgb.iter().flatten()) {
        assert!((0.0..=65504.0).contains(c), "{c}");
    }
    for dir in directions(200) {
        assert!(environment.radiance(dir).is_finite() && environment.irradiance(dir).is_finite());
        assert!(environment.prefiltered(dir, 0.3).min_element() >= 0.0);
    }
    // Infinity is 65,504; the brightest number, 1e6, fits half floats as radiance over 16.
    assert_eq!(environment.texel_radiance(), 3.0 * 16.0);
}

#[test]
fn bright_maps_keep_their_radiance() {
    let environment = hairline_sky::uniform([4.0e6, 1.0, 0.25]);
    let radiance = environment.radiance(DVec3::X);
    for (got, want) in radiance.to_array().into_iter().zip([4.0e6, 1.0, 0.25]) {
        // Eleven bits, or less where dividing by 64 made half floats subnormal.
        assert!((got / want - 1.0).abs() < 5e-4, "{radiance}");
    }
}

/// The disc of a sun is a light, which turns and shines with its map; the camera sees the map whole, surfaces the rest of it.
#[test]
fn a_sun_is_a_light() {
    let evening = |d: DVec3| [0.3 + 0.2 * d.y, 0.3, 0.5 + 0.1 * d.x];
    let toward = DVec3::new(0.3, 0.5, -0.8).normalize();
    let sunny = map_of([512, 256], |d| {
        let is_sun = d.angle_between(toward) < 0.03;
        evening(d).map(|c| if is_sun { c + 4000.0 } else { c })
    });
    let sky = hairline_sky::from_map(map_of([512, 256], evening), 0.4, 1.5, true);
    let whole = hairline_sky::from_map(sunny.clone(), 0.4, 1.5, true);
    let parted = hairline_sky::with_suns_parted(sunny, 0.4, 1.5, true);
    assert!(sky.suns().is_empty() && whole.suns().is_empty());
    for d in directions(500) {
        assert_eq!(parted.radiance(d), whole.radiance(d));
        for roughness in [0.0, 0.2, 0.6] {
            let [left, sky] = [&parted, &sky].map(|map| map.prefiltered(d, roughness));
            assert!(relative(left, sky) < 0.02, "{left} {sky}");
        }
        assert!(relative(parted.irradiance(d), sky.irradiance(d)) < 1e-3);
    }
    let turned = parted.clone().with_up(DVec3::Z, 1.0).with_intensity(3.0);
    for (environment, intensity) in [(&parted, 1.5), (&turned, 3.0)] {
        let [sun] = environment.suns() else {
            panic!("{:?}", environment.suns())
        };
        let expected = environment.map_from_world().transpose() * toward;
        let (center_m, radius_m) = sun.bounding_sphere();
        // Half a texel.
        assert!(center_m.angle_between(expected) < 6e-3);
        assert!((radius_m / center_m.length() / 0.03 - 1.0).abs() < 0.1);
        let expected = DVec3::splat(4000.0 * intensity);
        assert!(relative(DVec3::from(sun.radiance), expected) < 1e-3);
    }
}

#[test]
#[ignore = "long: cargo long"]
fn real_maps_load() {
    for name in ["studio.hdr", "workshop.hdr"] {
        let Some(path) = asset(name) else { continue };
        let start = Instant::now();
        let environment = hairline_sky::load(&path, 0.0, 1.0, true).unwrap();
        println!(
            "{name}: {:.2} s to load and prefilter",
            start.elapsed().as_secs_f64()
        );
        let map = environment.background();
        assert_eq!(map.size_px, [1024, 512]);
        let mean = sphere_mean(map);
        assert!(
            mean.min_element() > 0.01 && mean.max_element() < 100.0,
            "{mean}"
        );
        let mut suns = DVec3::ZERO;
        for sun in environment.suns() {
            let LightShape::Sphere { center_m, radius_m } = &sun.shape else {
                panic!("{sun:?}")
            };
            let (radius_rad, radiance) = (
                (radius_m / center_m.length()).asin(),
                DVec3::from(sun.radiance),
            );
            println!("  a sun of {radius_rad:.4} rad, {radiance:.0}");
            suns += radiance * (0.5 * (1.0 - radius_rad.cos()));
        }
        for (level, roughness) in environment.prefiltered_levels().iter().zip(LEVEL_ROUGHNESS) {
            let error = relative(sphere_mean(level) + suns, mean);
            println!(
                "  roughness {roughness}: mean off by {:.3} %",
                100.0 * error
            );
            assert!(error < 0.01);
        }
        // Below, the lobe is hardly wider than the file's texels: quadrature over them does not resolve it.
        let texels = Texels::new(map);
        let environment = hairline_sky::from_map(map.clone(), 0.0, 1.0, true);
        for roughness in &LEVEL_ROUGHNESS[2..] {
            let error = blur_error(&environment, &texels, *roughness, 40);
            println!(
                "  roughness {roughness}: {:.2} % rms of the blur",
                100.0 * error
            );
            // Hard-edged lamps at hundreds of times the room's radiance.
            assert!(error < 0.08);
        }
        let up = environment.irradiance(DVec3::Y) + environment.irradiance(DVec3::NEG_Y);
        assert!(up.min_element() > 0.0);
    }
}

/// A Radiance picture without run lengths.
fn radiance_file(width: usize, height: usize, header: &str, texel: [u8; 4]) -> Vec<u8> {
    let mut bytes =
        format!("#?RADIANCE\n{header}FORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n")
            .into_bytes();
    for _ in 0..width * height {
        bytes.extend(texel);
    }
    bytes
}

/// Maps in cd/m2 have suns of 1.6e9, and files of half floats have infinite ones.
#[test]
fn radiances_of_any_unit_are_kept() {
    let mut map = Picture::new([64, 32]);
    map.rgb.fill([5000.0; 3]);
    map.rgb[300] = [1.6e9, 1.5e9, 1.4e9];
    let environment = hairline_sky::from_map(map.clone(), 0.0, 1.0, true);
    let scale = environment.texel_radiance();
    let radiance = |i: usize| environment.background().rgb[i].map(|c| f64::from(c) * scale);
    for (got, want) in radiance(300).into_iter().zip([1.6e9, 1.5e9, 1.4e9]) {
        assert!((got / want - 1.0).abs() < 5e-4, "{got} {want}");
    }
    assert!((radiance(0)[0] / 5000.0 - 1.0).abs() < 5e-4);
    assert_eq!(environment.repaired_texels(), 0);
    map.rgb[300] = [f32::INFINITY, 1.0, 1.0];
    map.rgb[301] = [1e38, 1.0, 1.0];
    let environment = hairline_sky::from_map(map, 0.0, 1.0, true);
    let scale = environment.texel_radiance();
    let radiance = |i: usize| f64::from(environment.background().rgb[i][0]) * scale;
    assert!(
        (radiance(300) / 65504.0 - 1.0).abs() < 1e-3,
        "{}",
        radiance(300)
    );
    // Values that no light can have are cut, and counted.
    assert!((6e10..7e10).contains(&radiance(301)), "{}", radiance(301));
    assert_eq!(environment.repaired_texels(), 2);
}

/// The primaries are those of ITU-R BT.2020, converted by the matrix of BT.2087; the last such line counts.
#[test]
fn radiance_files_in_their_colours() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.hdr");
    let write = |head: &str, texel| fs::write(&path, radiance_file(4, 2, head, texel)).unwrap();
    let rec_2020 = "PRIMARIES=0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290\n";
    write(rec_2020, [200, 160, 120, 128]);
    let environment = hairline_sky::load(&path, 0.0, 1.0, false).unwrap();
    let [r, g, b] = [200.0, 160.0, 120.0].map(|c| c / 256.0);
    let want = DVec3::new(
        1.6605 * r - 0.5876 * g - 0.0728 * b,
        -0.1246 * r + 1.1329 * g - 0.0083 * b,
        -0.0182 * r - 0.1006 * g + 1.1187 * b,
    );
    let got = environment.radiance(DVec3::X);
    assert!((got - want).abs().max_element() < 1e-3, "{got} {want}");
    write("PRIMARIES=0.64 0.33 0.30\n", [128, 128, 128, 129]);
    let error = hairline_sky::load(&path, 0.0, 1.0, false)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("PRIMARIES=0.64 0.33 0.30 in the header: eight numbers"),
        "{error}"
    );
}

#[test]
fn radiance_files_in_their_units() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.HDR");
    // Mantissa 128 of 256, exponent 129: 1.
    fs::write(&path, radiance_file(4, 2, "", [128, 128, 128, 129])).unwrap();
    let environment = hairline_sky::load(&path, 0.0, 1.0, false).unwrap();
    assert_eq!(environment.radiance(DVec3::X), DVec3::ONE);
    assert!(!environment.visible());
    fs::write(
        &path,
        radiance_file(4, 2, "EXPOSURE=4\n", [128, 128, 128, 129]),
    )
    .unwrap();
    let exposed = hairline_sky::load(&path, 0.0, 2.0, false).unwrap();
    assert_eq!(exposed.radiance(DVec3::X), DVec3::splat(0.5));
}

/// Other programs begin the same file with another word.
#[test]
fn rgbe_is_radiance_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.hdr");
    let bytes = radiance_file(4, 2, "", [128, 128, 128, 129]);
    let begin = b"#?RADIANCE".len();
    fs::write(&path, [b"#?RGBE", &bytes[begin..]].concat()).unwrap();
    let environment = hairline_sky::load(&path, 0.0, 1.0, false).unwrap();
    assert_eq!(environment.radiance(DVec3::X), DVec3::ONE);
    // Nothing else is.
    fs::write(&path, [b"#?RGB", &bytes[begin..]].concat()).unwrap();
    assert!(hairline_sky::load(&path, 0.0, 1.0, false).is_err());
}

#[test]
fn exr_files_in_their_units() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let map = map_of([32, 16], |d| [1.0, 1.0 + d.x, 2.0]);
    Output::check(&path)
        .unwrap()
        .write_picture(&map, &Display::default())
        .unwrap();
    let environment = hairline_sky::load(&path, 0.0, 1.0, true).unwrap();
    for (a, b) in environment.background().rgb.iter().zip(&map.rgb) {
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-3));
    }
}

#[test]
fn files_that_are_no_maps_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    let whole = radiance_file(8, 4, "", [128, 128, 128, 129]);
    let exr = {
        let path = folder.path().join("whole.exr");
        Output::check(&path)
            .unwrap()
            .write_picture(&Picture::new([64, 32]), &Display::default())
            .unwrap();
        fs::read(&path).unwrap()
    };
    let square = {
        let path = folder.path().join("square.exr");
        Output::check(&path)
            .unwrap()
            .write_picture(&Picture::new([32, 32]), &Display::default())
            .unwrap();
        path
    };
    type Check = fn(&Error) -> bool;
    let cases: [(PathBuf, Check, &str); 12] = [
        (
            folder.path().join("none.hdr"),
            |e| matches!(e, Error::CannotRead { .. }),
            "no such file",
        ),
        (
            folder.path().join("none.exr"),
            |e| matches!(e, Error::CannotRead { .. }),
            "no such file",
        ),
        (
            file("map.jpg", b"x"),
            |e| matches!(e, Error::UnknownEnding { .. }),
            ".hdr",
        ),
        (
            file("cut.hdr", &whole[..whole.len() - 5]),
            |e| matches!(e, Error::Truncated { .. }),
            "truncated",
        ),
        (
            file("head.hdr", &whole[..11]),
            |e| matches!(e, Error::Corrupt { .. }),
            "EOF",
        ),
        (
            file("cut.exr", &exr[..exr.len() - 5]),
            |e| matches!(e, Error::Truncated { .. } | Error::Corrupt { .. }),
            "cut.exr",
        ),
        (
            file("text.hdr", b"this is no picture, but long enough"),
            |e| matches!(e, Error::Corrupt { .. }),
            "signature",
        ),
        (
            file("text.exr", b"this is no picture, but long enough"),
            |e| matches!(e, Error::Corrupt { .. }),
            "EXR",
        ),
        (
            square,
            |e| matches!(e, Error::NotEquirectangular { .. }),
            "32x32 pixels",
        ),
        (
            file("wide.hdr", &radiance_file(9, 4, "", [0; 4])),
            |e| matches!(e, Error::NotEquirectangular { .. }),
            "twice as wide as high",
        ),
        (
            // Refused before any memory is taken for it.
            file(
                "huge.hdr",
                b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 2000000\n",
            ),
            |e| matches!(e, Error::TooLarge { .. } | Error::Corrupt { .. }),
            "huge.hdr",
        ),
        (
            file(
                "exposure.hdr",
                &radiance_file(4, 2, "EXPOSURE=bright\n", [0; 4]),
            ),
            |e| matches!(e, Error::Corrupt { .. }),
            "EXPOSURE",
        ),
    ];
    for (path, check, text) in cases {
        let error = hairline_sky::load(&path, 0.0, 1.0, true).unwrap_err();
        let message = error.to_string();
        assert!(check(&error), "{error:?}");
        assert!(message.contains(text), "{message}");
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(message.contains(name), "{message}");
    }
}
