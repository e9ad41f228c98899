//! Gratings: the closed form against Monte Carlo of the same model, and against the whole field of rows whose grooves all have their phases.

use super::pictures::{self, LINEAR, closed, mean, sampled};
use super::scenes::{View, plate, sphere};
use glam::DVec3;
use hairline_image::{Image, Layer};
use hairline_optics::cover::Cover;
use hairline_optics::grating::Grating as Row;
use hairline_optics::metal::Metal;
use hairline_reference::{Model, Settings};
use hairline_scene::{Base, Bearing, Grating, GrooveField, Scene};

const FULL: Settings = Settings {
    model: Model::Full,
    ..LINEAR
};

const VIEW: View = View {
    angle_rad: 0.3,
    pixel_um: 40.0,
    size_px: 4,
};

/// Grooves across the plane of view, under a light about the direction of the first order at 550 nm.
fn grated(row: Row, angle_std_rad: f64, light_rad: f64) -> Scene {
    let mut scene = plate(Base::Mirror, VIEW);
    scene.materials[0].roughness = 0.0;
    scene.objects[0].gratings = vec![Grating {
        row,
        field: GrooveField::Along {
            direction: DVec3::X,
            center_m: DVec3::ZERO,
        },
        angle_std_rad,
        coverage: 1.0,
        radii_m: [0.0, f64::INFINITY],
        mask: None,
        seed: 1,
        is_rigorous: true,
    }];
    scene.lights = vec![sphere(VIEW, 0.0, -0.55 / row.pitch_um, light_rad)];
    scene
}

/// Relative error of the gratings' light, all channels together, and its standard error.
fn compared(name: &str, exact: &Image, reference: &Image) -> (f64, f64) {
    let [a, b] = [exact, reference].map(|image| mean(&image.scratches));
    let rms = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    let pixels = reference.scratches.len() as f64;
    let noise = reference.noise.as_ref().expect("by Monte Carlo");
    let variance: f64 = noise
        .scratches
        .iter()
        .flatten()
        .map(|v| f64::from(*v))
        .sum();
    let off = rms(std::array::from_fn(|c| a[c] - b[c])) / rms(b);
    let error = variance.sqrt() / pixels / rms(b);
    println!(
        "gratings, {name}: {:.2} % off, standard error {:.2} %",
        100.0 * off,
        100.0 * error
    );
    (off, error)
}

/// Pixels that are narrower than a pitch of 40 um.
const NEAR: View = View {
    pixel_um: 8.0,
    size_px: 12,
    ..VIEW
};

/// Grooves every 40 um from nearby, by a field, in a window.
fn single_grooves(field: GrooveField, coherence_um: f64, jitter: f64) -> Scene {
    let mut scene = plate(Base::Mirror, NEAR);
    scene.materials[0].roughness = 0.0;
    scene.materials[0].coherence_um = coherence_um;
    scene.objects[0].gratings = grated(row(40.0, 4.0, jitter, 0.0), 0.0, 0.1).objects[0]
        .gratings
        .clone();
    scene.objects[0].gratings[0].field = field;
    scene.lights = vec![sphere(NEAR, 0.0, -0.12, 0.04)];
    scene
}

/// Closed form and Monte Carlo agree on the places of single grooves, in windows that show them.
#[test]
fn single_grooves_lie_where_they_are() {
    let field = grated(row(40.0, 4.0, 0.0, 0.0), 0.0, 0.1).objects[0].gratings[0].field;
    for (settings, coherence_um, jitter, batches) in [
        (LINEAR, 8.0, 0.1, 6),
        (LINEAR, 20.0, 0.0, 6),
        (FULL, 8.0, 0.1, 2),
        (FULL, 20.0, 0.0, 2),
    ] {
        let scene = single_grooves(field, coherence_um, jitter);
        let (exact, reference) = (closed(&scene), sampled(&scene, settings, batches));
        let name = format!(
            "single grooves, {:?}, window {coherence_um} um",
            settings.model
        );
        let all = pictures::compared(&name, &exact, &reference, Layer::Scratches);
        let (off, _) = all.rms();
        assert!(off < 0.05, "{name}: {off}");
        let mut wrong = scene.clone();
        wrong.objects[0].gratings[0].seed = 2;
        if jitter > 0.0 {
            let all = pictures::compared(
                "other places",
                &closed(&wrong),
                &reference,
                Layer::Scratches,
            );
            assert!(all.rms().0 > 0.1);
        }
    }
}

/// Grooves from an axis, which branch: those between two others too.
#[test]
fn grooves_that_branch_lie_where_they_are() {
    let field = GrooveField::Around {
        axis: DVec3::Z,
        center_m: -0.04 * DVec3::X,
        bearing: Bearing::Radial,
    };
    let right = single_grooves(field, 8.0, 0.1);
    let mut wrong = right.clone();
    wrong.objects[0].gratings[0].seed = 2;
    let [right_picture, wrong_picture] = [&right, &wrong].map(closed);
    for (settings, batches, most) in [(LINEAR, 6, 0.03), (FULL, 2, 0.06)] {
        let reference = sampled(&right, settings, batches);
        let name = format!("grooves that branch, {:?}", settings.model);
        let off = |name: &str, picture| {
            let all = pictures::compared(name, picture, &reference, Layer::Scratches);
            all.rms().0
        };
        assert!(off(&name, &right_picture) < most, "{name}");
        assert!(off("other places", &wrong_picture) > 0.5);
    }
}

fn row(pitch_um: f64, width_um: f64, jitter: f64, depth_spread: f64) -> Row {
    Row {
        pitch_um,
        width_um,
        depth_nm: 110.0,
        depth_spread,
        jitter_um: jitter * pitch_um,
    }
}

const SPOT_VIEW: View = View {
    size_px: 16,
    ..VIEW
};

/// Spots of grooves under a sphere that is `off_mirror` from the mirror's direction, in cosines, at an angle.
fn spots(
    along_row: DVec3,
    spacing_um: f64,
    angle_deg: f64,
    off_mirror: f64,
    light_rad: f64,
) -> Scene {
    let mut scene = plate(Base::Mirror, SPOT_VIEW);
    scene.materials[0].roughness = 0.0;
    scene.objects[0].gratings = grated(row(2.0, 0.8, 0.1, 0.1), 0.02, 0.1).objects[0]
        .gratings
        .clone();
    scene.objects[0].gratings[0].field = GrooveField::Spots {
        axis: DVec3::Z,
        center_m: DVec3::ZERO,
        along_row,
        spacing_m: 1e-6 * spacing_um,
    };
    let (y, x) = angle_deg.to_radians().sin_cos();
    scene.lights = vec![sphere(SPOT_VIEW, off_mirror * x, off_mirror * y, light_rad)];
    scene
}

/// Angle and place of a light beside the mirror's direction, its radius, and the bound of the error under it.
const LIGHTS_ON_SPOTS: [(f64, f64, f64, f64); 7] = [
    (60.0, 0.3, 0.06, 0.06),
    (100.0, 0.1, 0.1, 0.03),
    // Lines that do not turn with the grooves miss some of a large light.
    (200.0, 0.3, 0.2, 0.11),
    (0.0, 0.3, 0.06, 0.06),
    (130.0, 0.3, 0.06, 0.09),
    (100.0, 0.6, 0.1, 0.04),
    (100.0, 0.0, 0.2, 0.02),
];

/// Spots that are smaller than a pixel: each pixel shows the mean of all their directions, whichever spot its sample meets.
#[test]
fn small_spots_show_their_mean() {
    check_small_spots(&LIGHTS_ON_SPOTS[..3], 4);
}

#[test]
#[ignore = "long: cargo long"]
fn small_spots_show_their_mean_under_all_lights() {
    check_small_spots(&LIGHTS_ON_SPOTS, 12);
}

fn check_small_spots(lights: &[(f64, f64, f64, f64)], batches: u32) {
    // A filter's standard deviation is 20 um.
    for &(angle_deg, off_mirror, light_rad, most) in lights {
        let of = |along_row| spots(along_row, 30.0, angle_deg, off_mirror, light_rad);
        let scene = of(DVec3::X);
        let (exact, reference) = (closed(&scene), sampled(&scene, LINEAR, batches));
        let name = format!(
            "small spots, light of {light_rad} rad {off_mirror} off at {angle_deg} degrees"
        );
        let (off, error) = compared(&name, &exact, &reference);
        let rms = unevenness(&exact);
        println!("{name}: pixels differ by {:.2} % rms", 100.0 * rms);
        assert!(
            off < most + 2.0 * error && rms < 0.05,
            "{name}: {off}, {rms}"
        );
        if angle_deg == 60.0 {
            let (off, _) = compared("rows across", &closed(&of(DVec3::Y)), &reference);
            assert!(off > 0.15, "{off}");
        }
    }
}

/// Pixels show single spots: the mean of many pixels is that of Monte Carlo.
#[test]
fn spots_keep_their_mean() {
    for spacing_um in [83.0, 209.0] {
        // Rows of spots do not run along the pixels, which would meet the same places of many spots.
        let along_row = DVec3::new(0.89, 0.45, 0.0).normalize();
        let scene = spots(along_row, spacing_um, 100.0, 0.3, 0.2);
        let (exact, reference) = (closed(&scene), sampled(&scene, LINEAR, 12));
        let (off, _) = compared(&format!("spots every {spacing_um} um"), &exact, &reference);
        let error = unevenness(&exact) / f64::from(SPOT_VIEW.size_px);
        println!(
            "standard error of the closed form's pixels {:.2} %",
            100.0 * error
        );
        assert!(off < 0.04 + 3.0 * error, "{spacing_um}: {off}");
    }
}

/// Rms deviation of the pixels from their mean, over it.
fn unevenness(image: &Image) -> f64 {
    let lit = mean(&image.scratches)[1];
    let off = image
        .scratches
        .iter()
        .map(|v| (f64::from(v[1]) / lit - 1.0).powi(2));
    (off.sum::<f64>() / image.scratches.len() as f64).sqrt()
}

#[test]
fn rows_of_grooves() {
    for (row, angle_std_rad, light_rad) in [
        (row(0.74, 0.35, 0.0, 0.0), 0.0, 0.05),
        (row(1.6, 0.6, 0.0, 0.0), 0.0, 0.3),
        (row(1.6, 0.6, 0.1, 0.1), 0.0, 0.02),
        (row(1.6, 0.6, 0.05, 0.0), 0.05, 0.1),
        (row(10.0, 3.0, 0.2, 0.0), 0.0, 0.05),
        (row(30.0, 5.0, 0.0, 0.2), 0.0, 0.05),
    ] {
        let scene = grated(row, angle_std_rad, light_rad);
        let (exact, reference) = (closed(&scene), sampled(&scene, LINEAR, 20));
        let name = format!("{row:?}, angles {angle_std_rad}, light of {light_rad} rad");
        let (off, error) = compared(&name, &exact, &reference);
        // Most of the error is that of one depth for a chord, as for scratches.
        assert!(off < 0.03 + 2.0 * error && error < 0.02, "{name}: {off}");
    }
}

#[test]
fn rows_of_grooves_with_all_phases() {
    check_all_phases(&[(row(10.0, 3.0, 0.2, 0.0), 0.05, 0.03)], 8, 0.04);
}

#[test]
#[ignore = "long: cargo long"]
fn rows_of_grooves_with_all_phases_of_many_pitches() {
    let rows = [
        (row(0.74, 0.35, 0.0, 0.0), 0.05, 0.03),
        (row(1.6, 0.6, 0.0, 0.0), 0.02, 0.03),
        (row(1.6, 0.6, 0.0, 0.0), 0.002, 0.08),
        (row(10.0, 3.0, 0.2, 0.0), 0.05, 0.03),
        (row(30.0, 5.0, 0.0, 0.0), 0.05, 0.03),
    ];
    check_all_phases(&rows, 12, 0.03);
}

/// Checks rows under lights of a size, each with the bound of its error; `noise` bounds the standard error.
fn check_all_phases(rows: &[(Row, f64, f64)], batches: u32, noise: f64) {
    for &(row, light_rad, limit) in rows {
        let scene = grated(row, 0.0, light_rad);
        let (exact, reference) = (closed(&scene), sampled(&scene, FULL, batches));
        let name = format!("{row:?} with all phases, light of {light_rad} rad");
        let (off, error) = compared(&name, &exact, &reference);
        assert!(off < limit + 2.0 * error && error < noise, "{name}: {off}");
    }
    // The comparison rejects the light of single scratches.
    let scene = grated(row(1.6, 0.6, 0.0, 0.0), 0.0, 0.02);
    let reference = sampled(&scene, FULL, 4);
    let mut wrong = scene.clone();
    wrong.objects[0].gratings[0].row.jitter_um = 1.0;
    let (off, _) = compared("as single scratches", &closed(&wrong), &reference);
    assert!(off > 0.3, "{off}");
}

/// A disc's track under its polycarbonate.
#[test]
fn a_fine_grating_under_a_cover() {
    let cover = |ior| Cover {
        ior,
        thickness_mm: 1.2,
        color: [0.95, 0.9, 0.8],
    };
    let covered = |cover| {
        let mut scene = grated(row(1.6, 0.6, 0.03, 0.05), 0.0, 0.1);
        let metal = Metal::Aluminium.into();
        scene.materials[0].base = Base::Covered { metal, cover };
        scene
    };
    let scene = covered(cover(1.58));
    let reference = sampled(&scene, LINEAR, 20);
    let (off, error) = compared("under a cover", &closed(&scene), &reference);
    assert!(off < 0.04 + 2.0 * error && error < 0.03, "{off}");
    let (off, _) = compared("under another", &closed(&covered(cover(1.3))), &reference);
    assert!(off > 0.1, "{off}");
}

/// Fine gratings in metals: both models have the rigorous orders of the closed form, and scalar ones are told apart.
#[test]
fn fine_gratings_in_metals() {
    let rows = [
        (row(0.74, 0.32, 0.0, 0.0), 0.05, LINEAR, 12, 0.03),
        (row(1.6, 0.6, 0.0, 0.0), 0.05, FULL, 8, 0.05),
    ];
    check_in_metal(&rows, 0.04);
}

#[test]
#[ignore = "long: cargo long"]
fn fine_gratings_of_more_pitches_in_metals() {
    let rows = [
        (row(0.74, 0.32, 0.0, 0.0), 0.05, LINEAR, 20, 0.03),
        (row(1.6, 0.6, 0.05, 0.1), 0.1, LINEAR, 20, 0.03),
        (row(0.74, 0.32, 0.0, 0.0), 0.05, FULL, 12, 0.05),
        (row(1.6, 0.6, 0.0, 0.0), 0.05, FULL, 12, 0.05),
    ];
    check_in_metal(&rows, 0.03);
}

/// Checks rows under lights of a size by a model and so many batches, each with the bound of its error; `noise` bounds the standard error.
fn check_in_metal(rows: &[(Row, f64, Settings, u32, f64)], noise: f64) {
    let metal = |row, light_rad, is_rigorous| {
        let mut scene = grated(row, 0.0, light_rad);
        scene.materials[0].base = Base::Metal(Metal::Aluminium.into());
        scene.objects[0].gratings[0].is_rigorous = is_rigorous;
        scene
    };
    for &(row, light_rad, settings, batches, limit) in rows {
        let scene = metal(row, light_rad, true);
        let reference = sampled(&scene, settings, batches);
        let name = format!("{row:?} in aluminium, {:?}", settings.model);
        let (off, error) = compared(&name, &closed(&scene), &reference);
        assert!(off < limit + 2.0 * error && error < noise, "{name}: {off}");
        if row.pitch_um == 0.74 {
            let scalar = metal(row, light_rad, false);
            let (off, _) = compared("scalar", &closed(&scalar), &reference);
            assert!(off > 0.15, "{off}");
        }
    }
}
