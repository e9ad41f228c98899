use super::*;
use crate::sine_integral::SineIntegral;
use glam::DVec3;
use hairline_cpu::surface::surface_point;
use hairline_fixtures::SceneFile;
use hairline_scene::Scene;

/// A parallel brushed plate under a panel and a sphere.
fn scene() -> Scene {
    const PANEL_M: [[f64; 3]; 4] = [
        [-0.1, 0.05, 0.3],
        [-0.1, 0.15, 0.3],
        [0.1, 0.15, 0.3],
        [0.1, 0.05, 0.3],
    ];
    SceneFile::seen_from([0.0, -0.1, 0.3])
        .up([0.0, 1.0, 0.0])
        .metal("m", "gold")
        .object("o", "m", "plane = { size_m = [0.01, 0.01] }")
        .laid("o", "parallel", 400)
        .with_lines(
            "direction = [1.0, 0.0, 0.0]\nlength_m = 0.01\nwidth_um = 2.0\ndepth_nm = 150.0",
        )
        .polygon(&PANEL_M, 1.0)
        .with_lines("two_sided = true")
        .sphere([0.0, 0.3, 0.3], 0.05, 1.0)
        .scene()
}

/// Light of the plate's middle, by a method that `change` may have spoilt.
fn middle(prepared: &Prepared, si: SineIntegral, change: impl Fn(&mut Published)) -> Masked {
    let scene = prepared.scene();
    let to_camera = scene.camera.position_m;
    let direction = -to_camera.normalize();
    let hit = prepared
        .triangles()
        .intersect(to_camera + DVec3::splat(1e-5), direction)
        .unwrap();
    let footprint = |_| [DVec3::X * 4e-5, DVec3::Y * 4e-5];
    let position_m = to_camera + direction * hit.distance_m;
    let tables = prepared.tables();
    let point = surface_point(scene, tables, position_m, -direction, footprint, &hit);
    let mut views = LightViews::new(scene);
    views.look_from(&point);
    let method = PublishedMethod {
        si,
        ..PublishedMethod::default()
    };
    let mut published = Published::new(prepared, method, Mask::Density);
    change(&mut published);
    published.scratches(&point, &hit, &views)
}

/// A method uses the look-ups that it is given.
#[test]
fn a_missing_triangle_and_a_wrong_wavelength_are_seen() {
    let scene = scene();
    let prepared = Prepared::new(&scene);
    let green = |si, change: &dyn Fn(&mut Published)| middle(&prepared, si, change).scratches[1];
    let exact = |change: &dyn Fn(&mut Published)| green(SineIntegral::Exact, change);
    let right = exact(&|_| {});
    assert!(right > 0.0);
    let half = exact(&|published| {
        published.triangles[0].pop();
    });
    let none = exact(&|published| published.triangles[0].clear());
    println!("{right:.4}, half the panel {half:.4}, none {none:.4}");
    assert!(half < 0.95 * right && none < 0.95 * half && none > 0.0);
    let red = exact(&|published| {
        for wavelength in &mut published.spectra[0].wavelengths {
            wavelength.wavelength_um *= 1.05;
        }
    });
    assert!((red / right - 1.0).abs() > 1e-3, "{red} {right}");
    let fast = green(SineIntegral::Fast, &|_| {});
    assert!((1e-5..0.05).contains(&(fast / right - 1.0).abs()), "{fast}");
}

/// The density mask of the published footprint is the width in the pixel, twice, over its area.
#[test]
fn parallel_scratches_take_their_density() {
    let scene = scene();
    let prepared = Prepared::new(&scene);
    let taken = middle(&prepared, SineIntegral::Fast, |_| {}).taken;
    // 400 on 10 mm, 2 um wide, cover 0.08 in the mean; some five lie in this pixel of 140 um.
    println!("{taken:?}");
    assert!(taken[0] > 0.04 && taken[0] < 0.4);
    // Whole scratches: the count in the box times 2 W over its side.
    let each = 2.0 * 2.0 / (12f64.sqrt() * 40.0);
    let count = taken[0] / each;
    assert!((count - count.round()).abs() < 0.05, "{count}");
}
