//! Closed forms with light from other objects against the path tracer with as many bounces.

use super::environment::over_plate;
use super::filtered::grain;
use super::pictures::{LINEAR, compared, sampled};
use super::scenes::{add_quad, plate, scratch, sphere};
use super::shadowed::{
    VIEW, WHITE, alone, bounced, closed, fewer_rays_error, luminance, prepared, with_rows,
};
use glam::{DVec3, Vec3};
use hairline_cpu::closed_form::Prepared;
use hairline_document::DEFAULT_SAMPLES;
use hairline_fixtures::SceneFile;
use hairline_image::{Image, Layer};
use hairline_optics::metal::Metal;
use hairline_reference::Settings;
use hairline_scene::{Base, Scene};
use hairline_sky::BuiltInMap;
use std::sync::Arc;

/// A scratched plate and a wall on it, both lit from before the wall: all that the camera sees mirrored is the wall.
fn before_a_wall(base: Base, wall: Base) -> Scene {
    let mut scene = plate(base, VIEW);
    scene.materials[0].roughness = 0.3;
    scratch(&mut scene, VIEW, 40);
    scene.lights = vec![sphere(VIEW, 0.3, -1.1, 0.08)];
    let corners = [
        [-2e-3, 4.5e-4, 0.0],
        [2e-3, 4.5e-4, 0.0],
        [2e-3, 4.5e-4, 3e-3],
        [-2e-3, 4.5e-4, 3e-3],
    ];
    add_quad(&mut scene, wall, 0.5, corners.map(Vec3::from_array));
    scene
}

/// A scratched plate that the camera sees in a mirror alone.
fn in_a_mirror() -> Scene {
    let mut scene = plate(Base::Metal(Metal::Silver.into()), VIEW);
    scene.materials[0].roughness = 0.1;
    scratch(&mut scene, VIEW, 40);
    scene.lights = vec![sphere(VIEW, 0.35, -0.3, 0.08)];
    seen_in_a_mirror(scene)
}

/// `in_a_mirror` with all scratches along an axis, so that their boxes have no width: the distance to which a point looks decides which
/// of them it sees.
pub(super) fn along_an_axis_in_a_mirror() -> Scene {
    let mut scene = in_a_mirror();
    scene.lights = vec![sphere(VIEW, 0.0, -0.3, 0.08)];
    for segment in Arc::make_mut(&mut scene.objects[0].segments) {
        segment.end_m.y = segment.start_m.y;
    }
    scene
}

/// A scene whose camera sees it in a mirror alone.
fn seen_in_a_mirror(mut scene: Scene) -> Scene {
    let from_m = scene.camera.position_m;
    let middle_m = 0.5 * from_m;
    let normal = (from_m.normalize() + DVec3::X).normalize();
    let behind_m = (from_m - middle_m).dot(normal) * normal;
    scene.camera.position_m = from_m - 2.0 * behind_m;
    scene.camera.target_m = middle_m;
    let (u, v) = normal.any_orthonormal_pair();
    let corner = |a: f64, b: f64| (middle_m + 4e-3 * (a * u + b * v)).as_vec3();
    let corners = [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ];
    add_quad(&mut scene, Base::Mirror, 0.02, corners);
    scene
}

/// A wall that the camera sees in a scratched plate with gratings, which it sees in a mirror.
pub(super) fn a_wall_in_a_mirror() -> Scene {
    seen_in_a_mirror(with_rows(before_a_wall(Base::Mirror, WHITE)))
}

pub(super) fn scenes() -> [(&'static str, Scene); 5] {
    [
        ("a wall", before_a_wall(WHITE, WHITE)),
        (
            "a gold wall",
            before_a_wall(Base::Mirror, Base::Metal(Metal::Gold.into())),
        ),
        (
            "a mirror",
            before_a_wall(Base::Metal(Metal::Copper.into()), Base::Mirror),
        ),
        (
            "a wall by rows of grooves",
            with_rows(before_a_wall(Base::Mirror, WHITE)),
        ),
        ("in a mirror", in_a_mirror()),
    ]
}

fn settings(bounces: u32) -> Settings {
    Settings {
        shadows: true,
        bounces,
        ..LINEAR
    }
}

/// No ray from a convex body meets it: at its rims and folds nothing is darker than without rays, and nothing brighter with bounces.
#[test]
fn a_convex_body_neither_hides_nor_lights_itself() {
    for shape in [
        "cylinder = { radius_m = 0.15, height_m = 0.3 }",
        "sphere = { radius_m = 0.2 }",
        "box = { size_m = [0.2, 0.3, 0.25] }",
    ] {
        let scene = SceneFile::seen_from([0.8, 0.9, 1.0])
            .fov_y_deg(22.0)
            .size_px([80, 60])
            .part("[[material]]\nname = \"m\"\nkind = \"metal\"\nbase_color = [1, 1, 1]\nroughness = 0.2")
            .object("body", "m", shape)
            .part("[[light]]\nkind = \"sun\"\ndirection = [-0.5, -1, -0.3]\nirradiance = 3.14159265")
            .part("[studio]\nhidden = true")
            .scene();
        let open = closed(&scene, 8, false);
        let lit = bounced(&scene, 8, true, 1);
        let mut bright = 0;
        for (open, lit) in open.base.iter().flatten().zip(lit.base.iter().flatten()) {
            bright += usize::from(*open > 1e-3);
            assert!(
                (open - lit).abs() < 1e-4 * open.max(0.1),
                "{shape}: {lit}, not {open}"
            );
        }
        assert!(bright > 100, "{shape}: {bright}");
    }
}

#[test]
fn light_by_way_of_objects_is_that_of_the_path_tracer() {
    check_light_by_way(&[1, 2, 4]);
}

#[test]
#[ignore = "long: cargo long"]
fn light_by_way_of_objects_is_that_of_the_path_tracer_in_all_scenes() {
    check_light_by_way(&[0, 1, 2, 3, 4]);
}

/// Checks scenes by their numbers.
fn check_light_by_way(numbers: &[usize]) {
    // Rays by way of rows of grooves scatter the most.
    let settings_of = [(1, 512), (1, 768), (4, 512), (1, 1024), (1, 768)];
    let all: Vec<_> = settings_of.into_iter().zip(scenes()).collect();
    for ((bounces, samples), (name, scene)) in numbers.iter().map(|i| all[*i].clone()) {
        let reference = sampled(&scene, settings(bounces), 6);
        let image = bounced(&scene, samples, true, bounces);
        let direct = bounced(&scene, 16, true, 0);
        // Rows send colours out of gamut, of which no channel may be negative.
        let of_scratches = if name.contains("rows") { 0.09 } else { 0.04 };
        for (layer, limit) in [(Layer::Base, 0.02), (Layer::Scratches, of_scratches)] {
            if luminance(&reference, layer).iter().sum::<f64>() == 0.0 {
                // Light in a mirror belongs to its base alone.
                continue;
            }
            let name = format!("{name}, {bounces}");
            let found = compared(&name, &image, &reference, layer);
            let [at_least, _] = found.beyond.relative_rms_within(2.0);
            assert!(at_least < limit, "{name}: {found:?}");
            let off = (found.mean_ratio - 1.0).abs();
            let error = 3.0 * found.mean_ratio_error;
            assert!(off < 0.01 + error, "{name}: {found:?}");
            let wrong = compared(&format!("{name}, direct"), &direct, &reference, layer);
            assert!(wrong.mean_ratio < 0.9, "{name}: {wrong:?}");
        }
    }
}

/// A place that a ray meets may see the bright half of a sky and not its dark one, or the other way round: both are found with one ray
/// a place.
#[test]
fn light_of_a_sky_by_way_of_a_wall() {
    let mut scene = before_a_wall(WHITE, WHITE);
    scene.lights.clear();
    let sky = BuiltInMap::Overcast.picture([256, 128]);
    scene.environment = Some(over_plate(hairline_sky::from_map(sky, 0.0, 1.0, false)));
    let sum = |image: &Image| luminance(image, Layer::Base).iter().sum::<f64>();
    let by_wall = |of: &dyn Fn(u32) -> Image| sum(&of(1)) - sum(&of(0));
    let expected = by_wall(&|bounces| sampled(&scene, settings(bounces), 16));
    let found = by_wall(&|bounces| bounced(&scene, 512, true, bounces)) / expected;
    let all = expected / sum(&bounced(&scene, 1, false, 0));
    println!("{found:.4} of the light by way of a wall, which is {all:.3} of all");
    assert!((found - 1.0).abs() < 0.03 && all > 0.02, "{found} {all}");
}

/// Few rays are right in the mean, and the error falls by three tenths or more for four times as many.
#[test]
fn few_rays_find_the_light_of_objects_in_the_mean() {
    check_few_rays(&[2, 32]);
}

#[test]
#[ignore = "long: cargo long"]
fn few_rays_find_the_light_of_objects_in_the_mean_at_each_step() {
    check_few_rays(&[2, 8, 32]);
}

fn check_few_rays(numbers: &[u32]) {
    for (name, scene) in scenes() {
        let scene = Prepared::new(&scene);
        let of = |samples| luminance(&prepared(&scene, samples, true, 1), Layer::Base);
        let truth = of(256);
        let count = truth.len() as f64;
        let mean = truth.iter().sum::<f64>() / count;
        let mut last = (1, f64::INFINITY);
        for &samples in numbers {
            let image = of(samples);
            let errors = image.iter().zip(&truth).map(|(a, b)| a - b);
            let bias = errors.clone().sum::<f64>() / count;
            let rms = (errors.map(|e| e * e).sum::<f64>() / count).sqrt();
            let z = bias / (rms / count.sqrt());
            println!(
                "{name}, {samples} rays: rms {:.2} % of the mean, z {z:+.2}",
                100.0 * rms / mean
            );
            assert!(z.abs() < 4.0, "{name}");
            assert!(rms < fewer_rays_error(last, samples), "{name}");
            last = (samples, rms);
        }
    }
}

/// Scratches show in a mirror.
#[test]
fn scratches_are_seen_in_a_mirror() {
    let mut scene = in_a_mirror();
    let seen = luminance(&bounced(&scene, 4, true, 1), Layer::Base);
    scene.objects[0].scratches = Arc::default();
    scene.objects[0].segments = Arc::default();
    let without = luminance(&bounced(&scene, 4, true, 1), Layer::Base);
    let changed = |(a, b): (&f64, &f64)| (a / b - 1.0).abs() > 0.1;
    let share = seen
        .iter()
        .zip(&without)
        .filter(|pair| changed(*pair))
        .count();
    assert!(share > seen.len() / 4, "{share} of {}", seen.len());
}

/// A bounce changes no bit where light has no object to go by.
#[test]
fn without_objects_bounces_change_nothing() {
    let mut scene = before_a_wall(WHITE, WHITE);
    scene.objects.truncate(1);
    let [some, none] = [3, 0].map(|bounces| alone(bounced(&scene, 4, true, bounces)));
    assert!(some == none);
}

/// A coin upright on the floor of the studio: its face shows the floor alone, which each ray lights by one of the lamps.
#[test]
fn a_floor_in_a_mirror_has_little_noise() {
    let scene = SceneFile::seen_from([0.0, -0.09, 0.05])
        .looking_at([0.0, 0.0, 0.012])
        .fov_y_deg(18.0)
        .size_px([64, 48])
        .metal("silver", "silver")
        .with_lines("roughness = 0.06")
        .object(
            "coin",
            "silver",
            "cylinder = { radius_m = 0.012, height_m = 0.002 }",
        )
        .with_lines("rotation_deg = [90, 0, 0]\ntranslation_m = [0, 0, 0.012]")
        .part("[studio]\n\n[ground]")
        .scene();
    let noise = grain(&bounced(&scene, DEFAULT_SAMPLES, true, 1), 24..40, 18..34);
    println!("{noise:.4}");
    assert!(noise < 0.18, "{noise}");
}
