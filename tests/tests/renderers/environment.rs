//! A map of uneven light mirrored in a curved surface: neighbouring pixels look it up at different levels.

use conformance::Sequence;
use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use glam::{DVec2, DVec3};
use hairline_document::DEFAULT_SAMPLES;
use hairline_fixtures::SceneFile;
use hairline_image::Picture;
use hairline_scene::environment::lookup::environment_dir;

fn balls() -> SceneFile {
    SceneFile::seen_from([0.0, -0.05, 0.3])
        .up([0.0, 1.0, 0.0])
        .fov_y_deg(24.0)
        .metal("gold", "gold")
        .with_lines("roughness = 0.08")
        .object("large", "gold", "sphere = { radius_m = 0.04 }")
        .with_lines("translation_m = [-0.025, 0.0, 0.0]")
        .object("small", "gold", "sphere = { radius_m = 0.01 }")
        .with_lines("translation_m = [0.05, 0.01, 0.0]")
}

/// Dark, with a bright texel here and there.
fn starry_sky() -> Picture {
    let mut random = Sequence(7);
    let mut map = Picture::new([128, 64]);
    for texel in &mut map.rgb {
        let bright = if random.next() < 0.03 { 40.0 } else { 0.05 };
        *texel = [0.2, 0.6, 1.0].map(|c| c + bright * random.next());
    }
    map
}

#[test]
fn balls_mirror_a_map_alike() {
    let mut scene = balls().size_px([256, 160]).scene();
    scene.environment = Some(hairline_sky::from_map(starry_sky(), 0.4, 1.0, true));
    let Some(gpu) = on_the_gpu(&scene, DEFAULT_SAMPLES) else {
        return;
    };
    compare("balls", &scene, &gpu, &on_the_cpu(&scene, DEFAULT_SAMPLES)).unwrap();
}

/// Scratched balls under a sky with a sun as small as the real one.
#[test]
fn balls_under_a_sun() {
    let mut scene = balls()
        .size_px([128, 80])
        .random("large", 400)
        .with_lines("seed = 3\nlength_m = 0.01\nwidth_um = 3.0\ndepth_nm = 250.0")
        .scene();
    let mut map = Picture::new([2048, 1024]);
    let sun = DVec3::new(0.3, 0.6, 0.74).normalize();
    for (i, texel) in map.rgb.iter_mut().enumerate() {
        let at = DVec2::new((i % 2048) as f64 + 0.5, (i / 2048) as f64 + 0.5);
        let direction = environment_dir(at / DVec2::new(2048.0, 1024.0));
        let is_sun = direction.angle_between(sun) < 0.0047;
        *texel = [0.2, 0.4, 0.8].map(|c| if is_sun { 3e4 } else { c });
    }
    let environment = hairline_sky::with_suns_parted(map, 0.0, 1.0, true);
    assert_eq!(environment.suns().len(), 1);
    scene.environment = Some(environment);
    let Some(gpu) = on_the_gpu(&scene, DEFAULT_SAMPLES) else {
        return;
    };
    compare(
        "balls under a sun",
        &scene,
        &gpu,
        &on_the_cpu(&scene, DEFAULT_SAMPLES),
    )
    .unwrap();
}
