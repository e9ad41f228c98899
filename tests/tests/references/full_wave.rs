//! The full-wave model against the separable one: alike where waves are alone, fringes where two meet, alike in the mean of many.

use super::pictures::{LINEAR, closed, compared, mean, sampled};
use super::scenes::{View, plate, scratch, sphere};
use conformance::lay;
use glam::Vec3;
use hairline_image::Layer;
use hairline_image::metrics::Verdict;
use hairline_optics::diffraction::sinc;
use hairline_optics::scratch::phase_step_energy;
use hairline_optics::section::Section;
use hairline_optics::spectrum;
use hairline_reference::{Model, Settings};
use hairline_scene::{Base, Scene};
use std::f64::consts::PI;
use std::sync::Arc;

const FULL: Settings = Settings {
    model: Model::Full,
    ..LINEAR
};

fn mirror(view: View) -> Scene {
    let mut scene = plate(Base::Mirror, view);
    scene.materials[0].roughness = 0.0;
    scene
}

/// A scratch along x through the picture.
fn lay_along_x(scene: &mut Scene, y_um: f32, width_um: f32, depth_nm: f32) {
    let end = |x: f32| Vec3::new(x, y_um * 1e-6, 0.0);
    lay(scene, end(-2e-3), end(2e-3), width_um, depth_nm, 1);
}

#[test]
fn one_scratch_alone() {
    let view = View {
        angle_rad: 0.15,
        pixel_um: 15.0,
        size_px: 8,
    };
    let mut scene = mirror(view);
    // A hundred standard deviations of the peak away from it.
    scene.lights = vec![sphere(view, 0.0, 0.3, 0.06)];
    lay_along_x(&mut scene, 3.0, 2.0, 130.0);
    let (full, separable) = (sampled(&scene, FULL, 16), sampled(&scene, LINEAR, 16));
    let found = compared(
        "one scratch, full and separable",
        &full,
        &separable,
        Layer::Scratches,
    );
    assert_eq!(found.z.verdict, Verdict::ExplainedByNoise);
    // The window's fall across a groove of a tenth of it, which only the field knows, is below half a percent.
    assert!((found.mean_ratio - 1.0).abs() < 5e-3 + 3.0 * found.mean_ratio_error);
    assert!(found.mean_ratio_error < 5e-3);
    assert!(
        mean(&full.base)[1].abs() < 1e-6 * mean(&full.scratches)[1],
        "no light by way of the base here"
    );
}

/// Two slits: 1 + v cos(2 pi q distance / lambda), v being how alike the window is at both, in the mean over the places between.
#[test]
fn two_parallel_scratches_draw_fringes() {
    let (width_um, depth_nm, distance_um, sigma_um) = (1.5, 130.0, 12.0, 20.0);
    let view = View {
        angle_rad: 0.0,
        pixel_um: 60.0,
        size_px: 4,
    };
    let alike = (-distance_um * distance_um / (4.0_f64 * sigma_um * sigma_um)).exp();
    for order in [1.0, 1.5, 2.0, 2.5] {
        let q = order * 0.55 / distance_um;
        let mut scene = mirror(view);
        scene.lights = vec![sphere(view, 0.0, q, 0.002)];
        for y_um in [-0.5, 0.5] {
            lay_along_x(
                &mut scene,
                y_um * distance_um as f32,
                width_um as f32,
                depth_nm as f32,
            );
        }
        let [full, separable] =
            [FULL, LINEAR].map(|settings| mean(&sampled(&scene, settings, 16).scratches)[1]);
        // Light of each wavelength, and its interference.
        let (mut sum, mut alone) = (0.0, 0.0);
        for sample in spectrum::samples() {
            let um = sample.wavelength_nm * 1e-3;
            let one = sample.weight[1]
                * phase_step_energy(depth_nm, sample.wavelength_nm)
                * sinc(PI * width_um * q / um).powi(2)
                / um;
            alone += one;
            sum += one * (1.0 + alike * (2.0 * PI * q * distance_um / um).cos());
        }
        let (found, right) = (full / separable, sum / alone);
        println!("two scratches, order {order}: {found:.3}, by the two slits {right:.3}");
        // The light's breadth takes 1 % of the contrast, and wavelengths by chance leave another.
        assert!((found - right).abs() < 0.03, "{found} {right}");
    }
}

#[test]
fn many_scratches_are_alike_in_the_mean() {
    let view = View {
        angle_rad: 0.3,
        pixel_um: 40.0,
        size_px: 12,
    };
    let mut scene = mirror(view);
    scene.lights = vec![sphere(view, 0.1, 0.12, 0.12)];
    scratch(&mut scene, view, 20);
    let (full, separable) = (sampled(&scene, FULL, 4), sampled(&scene, LINEAR, 8));
    let found = compared(
        "many scratches, full and separable",
        &full,
        &separable,
        Layer::Scratches,
    );
    // Some twenty scratches that meet one another at random: their fringes cancel but for a few percent.
    assert!((found.mean_ratio - 1.0).abs() < 0.05 && found.mean_ratio_error < 0.015);
}

/// Profiles, widths in micrometres, and bounds of the error.
const ALONE: [(Section, f32, f64); 6] = [
    (Section::V, 2.0, 0.05),
    (Section::Shoulders, 4.0, 0.05),
    (Section::Rectangle, 30.0, 0.02),
    (Section::Round, 3.0, 0.05),
    (Section::Rectangle, 100.0, 0.02),
    // Two halves stand for slopes all along.
    (Section::Shoulders, 30.0, 0.12),
];

/// One groove of a profile, and wide ones, whose light comes from their edges: the closed form against the whole field.
#[test]
fn profiles_and_wide_grooves_alone() {
    check_alone(&ALONE[..3]);
}

#[test]
#[ignore = "long: cargo long"]
fn all_profiles_and_wide_grooves_alone() {
    check_alone(&ALONE);
}

fn check_alone(grooves: &[(Section, f32, f64)]) {
    let view = View {
        angle_rad: 0.15,
        pixel_um: 80.0,
        size_px: 4,
    };
    for (section, width_um, limit) in grooves {
        let (width_um, limit) = (*width_um, *limit);
        let mut scene = mirror(view);
        scene.lights = vec![sphere(view, 0.0, 0.2, 0.06)];
        lay_along_x(&mut scene, 3.0, width_um, 200.0);
        let narrow = {
            let mut scene = scene.clone();
            Arc::make_mut(&mut scene.objects[0].scratches)[0]
                .profile
                .width_um = 4.0;
            scene
        };
        let profile = &mut Arc::make_mut(&mut scene.objects[0].scratches)[0].profile;
        profile.section = section.clone();
        let (full, ours) = (sampled(&scene, FULL, 16), closed(&scene));
        let name = format!("{section:?}, {width_um} um, closed form and full");
        let found = compared(&name, &ours, &full, Layer::Scratches);
        let mean_limit = 0.03 + 3.0 * found.mean_ratio_error;
        assert!(
            (found.mean_ratio - 1.0).abs() < mean_limit,
            "{name}: {found:?}"
        );
        let [at_least, _] = found.beyond.relative_rms_within(2.0);
        assert!(at_least < limit, "{name}: {found:?}");
        let wrong = compared("narrower", &closed(&narrow), &full, Layer::Scratches);
        assert!(wrong.rms().0 > 0.1, "{name}: {wrong:?}");
    }
}
