//! A rectangle light with a picture: look-ups in parts for a lobe and for each chord, against every direction by chance.

use super::pictures::{Compared, LINEAR, closed, compared, sampled};
use super::scenes::{View, off_the_mirror, plate, scratch};
use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use glam::DVec3;
use hairline_image::Layer;
use hairline_optics::grating::Grating as Row;
use hairline_optics::metal::Metal;
use hairline_scene::{Base, Coat, Grating, GrooveField, Light, Scene, Texture};
use std::sync::Arc;

/// A soft box: bright in the middle, warm to the left, with a dark bar.
pub(super) fn soft_box() -> Texture {
    const SIDE: u32 = 128;
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE) - 0.5;
    let texel = |i: u32| {
        let (x, y) = (at(i % SIDE), at(i / SIDE));
        let hot = 0.25 + 0.75 * (-8.0 * (x * x + y * y)).exp();
        let bar = if (0.1..0.16).contains(&y) { 0.3 } else { 1.0 };
        let rgb = [1.0, 0.9 + 0.2 * x, 0.8 + 0.4 * x].map(|c| c * hot * bar);
        let [r, g, b] = rgb.map(|c: f64| (255.0 * c.powf(1.0 / 2.2)) as u8);
        [r, g, b, 255]
    };
    Texture::of_colors([SIDE; 2], (0..SIDE * SIDE).map(texel).collect())
}

/// A square before the plate, of so many metres at one metre, beside the mirror's direction.
fn lit(base: Base, view: View, picture: Option<usize>) -> Scene {
    let mut scene = plate(base, view);
    scene.materials[0].roughness = 0.3;
    scratch(&mut scene, view, 20);
    let axis = off_the_mirror(view.angle_rad, 0.05, 0.08);
    let right = axis.cross(DVec3::X).normalize();
    let up = axis.cross(right);
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let vertices_m = corners
        .map(|[x, y]| axis + 0.3 * (x * right - y * up))
        .into();
    let mut light = Light::polygon(vertices_m, [5.0; 3], true);
    light.picture = picture;
    scene.textures = Arc::new(vec![soft_box()]);
    scene.lights = vec![light];
    scene
}

/// Lists the errors of a scene under the soft box: both renderers, and the CPU's layers against every direction by chance, with limits of the
/// relative rms on scratches and base. `even` is the scene without the picture: another light, as one of its layers must show.
fn wrong(name: &str, scene: &Scene, even: &Scene, limits: [f64; 2]) -> Vec<Compared> {
    if let Some(gpu) = on_the_gpu(scene, 1) {
        compare(name, scene, &gpu, &on_the_cpu(scene, 1)).unwrap();
    }
    let (exact, reference) = (closed(scene), sampled(scene, LINEAR, 4));
    let [scratches, base] =
        [Layer::Scratches, Layer::Base].map(|layer| compared(name, &exact, &reference, layer));
    let [at_least, _] = scratches.beyond.relative_rms_within(2.0);
    let mut wrong = Vec::new();
    wrong.extend((at_least > limits[0]).then_some(scratches));
    wrong.extend((base.rms().0 > limits[1]).then_some(base));
    let even = compared("even", &closed(even), &reference, Layer::Scratches);
    wrong.extend((even.rms().0 < 0.2).then_some(even));
    wrong
}

const VIEW: View = View {
    angle_rad: 0.4,
    pixel_um: 40.0,
    size_px: 8,
};

const BODIED: Base = Base::Dielectric {
    ior: 1.5,
    base_color: [0.5; 3],
};

#[test]
fn a_soft_box() {
    let mut failures = Vec::new();
    for (base, angle_rad) in [(Base::Metal(Metal::Aluminium.into()), 0.4), (BODIED, 0.9)] {
        let view = View { angle_rad, ..VIEW };
        let [scene, even] = [Some(0), None].map(|picture| lit(base.clone(), view, picture));
        let name = format!("soft box on {base:?} from {angle_rad} rad");
        failures.extend(wrong(&name, &scene, &even, [0.02, 0.03]));
    }
    assert!(failures.is_empty(), "{failures:?}");
}

/// A clear layer over gold and over a part of a body.
#[test]
fn a_soft_box_on_a_coat() {
    let mut failures = Vec::new();
    for (base, weight) in [(Base::Metal(Metal::Gold.into()), 1.0), (BODIED, 0.6)] {
        let [scene, even] = [Some(0), None].map(|picture| {
            let mut scene = lit(base.clone(), VIEW, picture);
            scene.materials[0].coat = Some(Coat {
                weight,
                roughness: 0.15,
            });
            scene
        });
        let name = format!("soft box on a coat on {weight} of {base:?}");
        failures.extend(wrong(&name, &scene, &even, [0.02, 0.03]));
    }
    assert!(failures.is_empty(), "{failures:?}");
}

/// Slightly displaced grooves under scratches.
#[test]
fn a_soft_box_on_a_grating() {
    check_on_gratings(&[(0.1, 0.03, 20)], false);
}

/// Regular grooves too, without scratches.
#[test]
#[ignore = "long: cargo long"]
fn a_soft_box_on_gratings_with_rigorous_orders() {
    check_on_gratings(&[(0.0, 0.0, 0), (0.0, 0.03, 0), (0.1, 0.03, 20)], true);
}

/// Checks gratings by the jitter of their grooves in micrometres and radians, with so many scratches on top.
fn check_on_gratings(gratings: &[(f64, f64, u32)], is_rigorous: bool) {
    let mut failures = Vec::new();
    for &(jitter_um, angle_std_rad, scratches) in gratings {
        let [scene, even] = [Some(0), None].map(|picture| {
            let mut scene = lit(Base::Metal(Metal::Aluminium.into()), VIEW, picture);
            if scratches == 0 {
                scene.objects[0].scratches = Arc::default();
                scene.objects[0].segments = Arc::default();
            }
            scene.objects[0].gratings = vec![Grating {
                row: Row {
                    pitch_um: 1.6,
                    width_um: 0.6,
                    depth_nm: 110.0,
                    depth_spread: 0.0,
                    jitter_um,
                },
                field: GrooveField::Along {
                    direction: DVec3::X,
                    center_m: DVec3::ZERO,
                },
                angle_std_rad,
                coverage: 0.8,
                radii_m: [0.0, f64::INFINITY],
                mask: None,
                seed: 1,
                is_rigorous,
            }];
            scene
        });
        let name = format!(
            "soft box on grooves of jitter {jitter_um} um and {angle_std_rad} rad under {scratches}"
        );
        failures.extend(wrong(&name, &scene, &even, [0.02, 0.03]));
        if jitter_um > 0.0 {
            // The error is 5 % with one depth for the whole chord.
            let reference = sampled(&even, LINEAR, 4);
            let even = compared("even", &closed(&even), &reference, Layer::Scratches);
            let [at_least, _] = even.beyond.relative_rms_within(2.0);
            failures.extend((at_least > 0.01).then_some(even));
        }
    }
    assert!(failures.is_empty(), "{failures:?}");
}
