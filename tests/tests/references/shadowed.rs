//! Closed forms with shadow rays against the path tracer with shadows.

use super::environment::{over_plate, sky};
use super::pictures::{LINEAR, compared, sampled};
use super::scenes::{View, add_quad, leaning, off_the_mirror, panel, plate, scratch, sphere, tube};
use glam::{DVec3, Vec3};
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_image::{Image, Layer};
use hairline_optics::grating::Grating as Row;
use hairline_optics::mask::Mask;
use hairline_optics::metal::Metal;
use hairline_reference::Settings;
use hairline_scene::{Base, Bearing, Coat, Environment, Grating, GrooveField, Scene};
use std::sync::LazyLock;

pub(super) const VIEW: View = View {
    angle_rad: 0.7,
    pixel_um: 60.0,
    size_px: 8,
};
pub(super) const WHITE: Base = Base::Dielectric {
    ior: 1.5,
    base_color: [0.9, 0.7, 0.5],
};
const SHADOWS: Settings = Settings {
    shadows: true,
    ..LINEAR
};

/// Renders by the closed form, with rays for shadows or without.
pub(super) fn closed(scene: &Scene, samples: u32, shadows: bool) -> Image {
    bounced(scene, samples, shadows, 0)
}

/// Renders by the closed form with bounces.
pub(super) fn bounced(scene: &Scene, samples: u32, shadows: bool, bounces: u32) -> Image {
    prepared(&Prepared::new(scene), samples, shadows, bounces)
}

/// [`bounced`] of a scene that is prepared once for several pictures.
pub(super) fn prepared(scene: &Prepared<'_>, samples: u32, shadows: bool, bounces: u32) -> Image {
    let options = RenderOptions {
        samples,
        batch: None,
        shadows,
        bounces,
        mask: Mask::Linear,
        method: None,
    };
    scene.render(&options, &|_| {})
}

/// A picture's layers alone: without rays there is no light that rays found.
pub(super) fn alone(image: Image) -> Image {
    Image {
        traced: None,
        ..image
    }
}

fn scratched(base: Base) -> Scene {
    let mut scene = plate(base, VIEW);
    scene.materials[0].roughness = 0.3;
    scratch(&mut scene, VIEW, 40);
    scene
}

/// A rectangle across the way to a light, as far as `reach_m` from the plate's middle and from `low_m` to `high_m` from the way.
fn cover(scene: &mut Scene, towards: DVec3, reach_m: f64, low_m: [f64; 2], high_m: [f64; 2]) {
    let right = towards.cross(DVec3::Y).normalize();
    let up = right.cross(towards);
    let corner = |x: f64, y: f64| -> Vec3 { (towards * reach_m + right * x + up * y).as_vec3() };
    let corners = [
        corner(low_m[0], low_m[1]),
        corner(high_m[0], low_m[1]),
        corner(high_m[0], high_m[1]),
        corner(low_m[0], high_m[1]),
    ];
    add_quad(scene, Base::Mirror, 0.5, corners);
}

/// Two gratings on the plate side by side, scratches on top.
pub(super) fn with_rows(mut scene: Scene) -> Scene {
    let row = |pitch_um: f64| Row {
        pitch_um,
        width_um: 0.4 * pitch_um,
        depth_nm: 110.0,
        depth_spread: 0.2,
        jitter_um: 0.05 * pitch_um,
    };
    let along = Grating {
        row: row(1.6),
        field: GrooveField::Along {
            direction: DVec3::X,
            center_m: DVec3::ZERO,
        },
        angle_std_rad: 0.05,
        coverage: 0.4,
        radii_m: [0.0, f64::INFINITY],
        mask: None,
        seed: 1,
        is_rigorous: true,
    };
    let around = Grating {
        row: row(8.0),
        field: GrooveField::Around {
            axis: DVec3::Z,
            center_m: DVec3::new(-2e-3, 1e-3, 0.0),
            bearing: Bearing::Circular,
        },
        ..along
    };
    scene.objects[0].gratings = vec![along, around];
    scene
}

/// Scenes in which something is hidden, and their names.
pub(super) fn scenes() -> Vec<(&'static str, Scene)> {
    static SCENES: LazyLock<Vec<(&'static str, Scene)>> = LazyLock::new(make_scenes);
    SCENES.clone()
}

fn make_scenes() -> Vec<(&'static str, Scene)> {
    let lamp = |x: f64, y: f64| off_the_mirror(VIEW.angle_rad, x, y);
    let mut edge = scratched(Base::Mirror);
    edge.lights = vec![sphere(VIEW, 0.12, -0.05, 0.08)];
    cover(
        &mut edge,
        lamp(0.12, -0.05),
        3e-3,
        [0.0, -2e-3],
        [2e-3, 2e-3],
    );

    let mut slit = scratched(Base::Metal(Metal::Gold.into()));
    slit.lights = vec![panel(VIEW, -0.1, 0.12, [0.06, 0.05])];
    cover(
        &mut slit,
        lamp(-0.1, 0.1),
        2e-3,
        [6e-5, -2e-3],
        [2e-3, 2e-3],
    );
    cover(
        &mut slit,
        lamp(-0.1, 0.1),
        2e-3,
        [-2e-3, -2e-3],
        [-6e-5, 2e-3],
    );

    let mut lamps = scratched(WHITE);
    lamps.materials[0].roughness = 0.4;
    lamps.materials[0].coat = Some(Coat {
        weight: 0.7,
        roughness: 0.1,
    });
    lamps.lights = vec![
        sphere(VIEW, 0.12, -0.05, 0.05),
        panel(VIEW, -0.1, 0.12, [0.06, 0.05]),
        sphere(VIEW, 0.0, -0.16, 0.08),
    ];
    cover(
        &mut lamps,
        lamp(0.0, -0.16),
        2e-3,
        [-1e-4, -1e-3],
        [1e-4, 1e-3],
    );
    cover(
        &mut lamps,
        lamp(0.12, -0.05),
        4e-3,
        [-1e-3, 1e-4],
        [1e-3, 1e-3],
    );

    // A smooth coat on what leans.
    let mut leans = lamps.clone();
    leans.textures = vec![leaning([0.1, 0.15])].into();
    leans.materials[0].normal_texture = Some((0, 1.0));

    // Two thin sheets a micrometre apart.
    let mut sheets = scratched(Base::Metal(Metal::Aluminium.into()));
    sheets.lights = vec![sphere(VIEW, 0.1, 0.1, 0.06), sphere(VIEW, -0.15, 0.0, 0.06)];
    for reach_m in [1e-3, 1.001e-3] {
        cover(
            &mut sheets,
            lamp(0.1, 0.1),
            reach_m,
            [-1e-3, 0.0],
            [1e-3, 1e-3],
        );
    }

    let mut rod = scratched(Base::Mirror);
    rod.lights = vec![tube(VIEW, 0.1, 0.08, 0.03, 0.03)];
    cover(&mut rod, lamp(0.1, 0.08), 3e-3, [0.0, -2e-3], [2e-3, 2e-3]);

    // A wall that stands on the plate just beyond the picture.
    let mut wall = scratched(WHITE);
    wall.lights = vec![panel(VIEW, 0.0, 0.05, [0.12, 0.12])];
    let corners = [
        [1e-3, 4.5e-4, 0.0],
        [-1e-3, 4.5e-4, 0.0],
        [-1e-3, 4.5e-4, 6e-4],
        [1e-3, 4.5e-4, 6e-4],
    ];
    add_quad(&mut wall, Base::Mirror, 0.5, corners.map(Vec3::from_array));

    let rows = with_rows(wall.clone());

    // An even map takes no time to prepare.
    let even = under_environment(&wall, hairline_sky::uniform([0.6, 0.7, 0.9]));

    vec![
        ("half a lamp", edge),
        ("a slit", slit),
        ("three lamps", lamps),
        ("three lamps on what leans under its coat", leans),
        ("two sheets", sheets),
        ("half a tube", rod),
        ("a wall", wall),
        ("a wall by rows of grooves", rows),
        ("a wall under an even sky", even),
    ]
}

/// A scene under an environment alone.
fn under_environment(scene: &Scene, environment: Environment) -> Scene {
    let mut scene = scene.clone();
    scene.lights.clear();
    scene.environment = Some(over_plate(environment));
    scene
}

/// One of [`scenes`] under an uneven sky.
fn under_a_sky() -> (&'static str, Scene) {
    let map = hairline_sky::from_map(sky([128, 64]), 0.0, 1.0, false);
    let (_, wall) = &scenes()[6];
    ("a wall under the sky", under_environment(wall, map))
}

/// [`scenes`], and a scene whose map takes seconds to prepare.
pub(super) fn all_scenes() -> impl Iterator<Item = (&'static str, Scene)> {
    scenes().into_iter().chain([under_a_sky()])
}

pub(super) fn luminance(image: &Image, layer: Layer) -> Vec<f64> {
    let values = match layer {
        Layer::Base => &image.base,
        _ => &image.scratches,
    };
    values
        .iter()
        .map(|p| p.iter().map(|c| f64::from(*c)).sum())
        .collect()
}

/// Many rays converge to the path tracer's result, as near as the closed forms come without shadows.
#[test]
#[ignore = "long: cargo long"]
fn many_rays_come_to_the_path_tracers_shadows() {
    for (name, scene) in all_scenes() {
        let (exact, reference) = (closed(&scene, 768, true), sampled(&scene, SHADOWS, 6));
        let (open, open_reference) = (closed(&scene, 1, false), sampled(&scene, LINEAR, 4));
        for (layer, limit) in [(Layer::Scratches, 0.03), (Layer::Base, 0.02)] {
            let found = compared(name, &exact, &reference, layer);
            let name = format!("{name} without shadows");
            let [at_least, _] = found.beyond.relative_rms_within(2.0);
            assert!(at_least < limit, "{name}: {found:?}");
            let all = compared(&name, &open, &open_reference, layer);
            let off = (found.mean_ratio / all.mean_ratio - 1.0).abs();
            let error = found.mean_ratio_error + all.mean_ratio_error;
            assert!(off < 5e-3 + 3.0 * error, "{name}: {found:?} {all:?}");
            let wrong = compared(&name, &open, &reference, layer);
            assert!((wrong.mean_ratio - 1.0).abs() > 0.05, "{name}: {wrong:?}");
        }
    }
}

/// Few rays are right in the mean, and the error falls by three tenths or more for four times as many.
#[test]
fn few_rays_are_right_in_the_mean() {
    let kinds = [0, 2, 5, 7, 8];
    check_few_rays(kinds.map(|i| scenes().swap_remove(i)), &[2, 32], 128);
}

#[test]
#[ignore = "long: cargo long"]
fn few_rays_are_right_in_the_mean_of_all_scenes() {
    check_few_rays(all_scenes(), &[2, 8, 32], 256);
}

/// `most` rays are the truth for numbers of fewer.
fn check_few_rays(
    scenes: impl IntoIterator<Item = (&'static str, Scene)>,
    numbers: &[u32],
    most: u32,
) {
    for (name, scene) in scenes {
        let scene = Prepared::new(&scene);
        let truth = prepared(&scene, most, true, 0);
        let images: Vec<_> = (numbers.iter())
            .map(|samples| (*samples, prepared(&scene, *samples, true, 0)))
            .collect();
        for layer in [Layer::Scratches, Layer::Base] {
            let truth = luminance(&truth, layer);
            let mean = truth.iter().sum::<f64>() / truth.len() as f64;
            let mut last = (1, f64::INFINITY);
            for (samples, image) in &images {
                let image = luminance(image, layer);
                let errors: Vec<f64> = image.iter().zip(&truth).map(|(a, b)| a - b).collect();
                let count = errors.len() as f64;
                let bias = errors.iter().sum::<f64>() / count;
                let rms = (errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt();
                let z = bias / (rms / count.sqrt());
                println!(
                    "{name}, {}, {samples} rays: rms {:.2} % of the mean, mean {:+.3} %, z {z:+.2}",
                    layer.name(),
                    100.0 * rms / mean,
                    100.0 * bias / mean
                );
                assert!(z.abs() < 4.0, "{name}");
                assert!(rms < fewer_rays_error(last, *samples), "{name}");
                last = (*samples, rms);
            }
        }
    }
}

/// Bound of the error of so many rays, given that of fewer: by a quarter less for four times as many, where it would be by half less without
/// the error of the truth.
pub(super) fn fewer_rays_error((fewer, rms): (u32, f64), samples: u32) -> f64 {
    rms * 0.75f64.powf((f64::from(samples) / f64::from(fewer)).log(4.0))
}

/// Rays change no bit where nothing is in the way.
#[test]
fn nothing_in_the_way_changes_nothing() {
    check_nothing_in_the_way(scenes());
}

#[test]
#[ignore = "long: cargo long"]
fn nothing_in_the_way_changes_nothing_under_a_sky() {
    check_nothing_in_the_way([under_a_sky()]);
}

fn check_nothing_in_the_way(scenes: impl IntoIterator<Item = (&'static str, Scene)>) {
    for (name, mut scene) in scenes {
        scene.objects.truncate(1);
        let scene = Prepared::new(&scene);
        let [shadowed, open] = [true, false].map(|by| alone(prepared(&scene, 4, by, 0)));
        assert!(shadowed == open, "{name}");
    }
}
