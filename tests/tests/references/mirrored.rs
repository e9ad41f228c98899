//! A scratched plate seen in a mirror, and a white sky among many mirrors.

use super::pictures::{LINEAR, compared, mean, picked, sampled};
use super::scenes::{HALF_SIDE_M, View, add_quad, plate, scratch, sphere};
use conformance::furnace;
use glam::{DVec3, Vec3};
use hairline_image::metrics::Verdict;
use hairline_image::{Image, Layer};
use hairline_optics::metal::Metal;
use hairline_reference::{Model, Settings};
use hairline_scene::{Base, Light, Scene};

const ACROSS: DVec3 = DVec3::new(1.0, -1.0, 1.0);

/// A wall that stands on the plate at y = 0 and faces the viewer.
fn add_wall(scene: &mut Scene, base: Base, roughness: f64) {
    let h = HALF_SIDE_M;
    add_quad(
        scene,
        base,
        roughness,
        [
            Vec3::new(-h, 0.0, 0.0),
            Vec3::new(h, 0.0, 0.0),
            Vec3::new(h, 0.0, h),
            Vec3::new(-h, 0.0, h),
        ],
    );
}

/// The plate, before the mirror stands up. The light shines from the viewer's side: on what the mirror shows.
fn scene(view: View, scratches: u32) -> Scene {
    let mut scene = plate(Base::Metal(Metal::Aluminium.into()), view);
    let lamp = sphere(view, -0.12, 0.12, 0.1);
    let (center_m, radius_m) = lamp.bounding_sphere();
    scene.lights = vec![Light::sphere(center_m * ACROSS, radius_m, lamp.radiance)];
    // A mirror's least roughness is 0.002 in alpha: it blurs what it shows by 0.003 rad. The plate's own lobe of 0.01 is
    // wider, as is the light, but for their edges.
    scene.materials[0].roughness = 0.1;
    scratch(&mut scene, view, scratches);
    scene
}

/// The plate in the mirror, and the plate from where the mirror puts the viewer, turned as the mirror turns it. The rows
/// next to the mirror's foot are left out: their pixels see both.
fn both_ways(view: View, scratches: u32, settings: Settings, batches: u32) -> [Image; 2] {
    let direct = scene(view, scratches);
    let mut mirror = direct.clone();
    add_wall(&mut mirror, Base::Mirror, 0.0);
    let bounced = Settings {
        bounces: 1,
        ..settings
    };
    let in_mirror = sampled(&mirror, bounced, batches);
    let mut there = direct;
    there.camera.position_m *= ACROSS;
    there.camera.up *= ACROSS;
    let from_there = sampled(
        &there,
        Settings {
            seed: settings.seed + 1,
            ..settings
        },
        batches,
    );
    let size = [view.size_px, view.size_px / 2 - 2];
    [
        picked(&in_mirror, size, |x, y| [x, y]),
        picked(&from_there, size, |x, y| [view.size_px - 1 - x, y]),
    ]
}

const VIEW: View = View {
    angle_rad: std::f64::consts::FRAC_PI_4,
    pixel_um: 30.0,
    size_px: 24,
};

#[test]
fn a_mirror_shows_the_plate_as_from_behind_it() {
    let [in_mirror, from_there] = both_ways(VIEW, 24, LINEAR, 6);
    assert!(
        mean(&from_there.scratches)[1] > 0.2 * mean(&from_there.base)[1],
        "scratches must matter for the test"
    );
    let found = compared("in a mirror", &in_mirror, &from_there, Layer::Beauty);
    let turned = picked(&from_there, from_there.size_px, |x, y| {
        [VIEW.size_px - 1 - x, y]
    });
    let wrong = compared("in a mirror, turned", &in_mirror, &turned, Layer::Beauty);
    assert_eq!(found.z.verdict, Verdict::ExplainedByNoise);
    assert!((found.mean_ratio - 1.0).abs() < 0.01 + 3.0 * found.mean_ratio_error);
    assert_eq!(wrong.z.verdict, Verdict::MoreThanNoise);
}

#[test]
fn the_field_in_a_mirror() {
    let view = View {
        size_px: 10,
        ..VIEW
    };
    let settings = Settings {
        model: Model::Full,
        ..LINEAR
    };
    let [in_mirror, from_there] = both_ways(view, 4, settings, 6);
    let found = compared(
        "the field in a mirror",
        &in_mirror,
        &from_there,
        Layer::Beauty,
    );
    assert!((found.mean_ratio - 1.0).abs() < 0.01 + 3.0 * found.mean_ratio_error);
    assert!(found.mean_ratio_error < 0.02);
}

#[test]
fn without_bounces_the_mirror_is_dark() {
    let mut mirror = scene(VIEW, 24);
    add_wall(&mut mirror, Base::Mirror, 0.0);
    let image = sampled(&mirror, LINEAR, 1);
    let upper = picked(&image, [VIEW.size_px, VIEW.size_px / 2 - 2], |x, y| [x, y]);
    assert!(
        upper.normal.iter().all(|n| n[1] < -0.9),
        "the mirror fills the upper half"
    );
    println!(
        "the mirror without bounces: {:?}",
        mean(&upper.beauty().rgb)
    );
    assert!(mean(&upper.beauty().rgb)[1] < 1e-4);
}

/// A white corner under a white sky stays white, however often light goes to and fro: a path that ends sees the sky through
/// what stands in its way.
#[test]
fn a_white_corner_under_a_white_sky() {
    let view = View {
        size_px: 12,
        ..VIEW
    };
    let white = Base::Dielectric {
        ior: 1.5,
        base_color: [1.0; 3],
    };
    for (plate_base, wall_base, roughness) in [
        (Base::Mirror, Base::Mirror, 0.0),
        (Base::Mirror, white.clone(), 0.3),
        (white, Base::Mirror, 0.6),
    ] {
        let mut scene = plate(plate_base.clone(), view);
        scene.materials[0].roughness = roughness;
        scene.environment = furnace();
        add_wall(&mut scene, wall_base.clone(), roughness);
        for bounces in [1, 3] {
            let settings = Settings { bounces, ..LINEAR };
            let image = sampled(&scene, settings, 8);
            let of = mean(&image.beauty().rgb);
            let variance = &image.noise.as_ref().unwrap().beauty;
            let error = variance.iter().map(|v| f64::from(v[1])).sum::<f64>().sqrt()
                / variance.len() as f64;
            // 2e-3: the table that the multiple scattering of a rough lobe goes by.
            assert!(
                (of[1] - 1.0).abs() < 2e-3 + 3.0 * error,
                "{of:?} +- {error}"
            );
            println!(
                "white corner, {plate_base:?} and {wall_base:?}, {bounces} bounces: {:.4} +- {error:.4}",
                of[1]
            );
        }
    }
}
