//! A map of uneven light mirrored in a curved surface: neighbouring pixels look it up at different levels.

use conformance::Sequence;
use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use hairline_image::Picture;
use hairline_scene::{Environment, Scene};

const BALLS: &str = r#"
[camera]
position_m = [0.0, -0.05, 0.3]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
fov_y_deg = 24.0

[render]
size_px = [256, 160]

[[material]]
name = "gold"
kind = "metal"
metal = "gold"
roughness = 0.08

[[object]]
name = "large"
shape = { sphere = { radius_m = 0.04 } }
material = "gold"
translation_m = [-0.025, 0.0, 0.0]

[[object]]
name = "small"
shape = { sphere = { radius_m = 0.01 } }
material = "gold"
translation_m = [0.05, 0.01, 0.0]
"#;

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
    let mut scene = Scene::from_toml(BALLS, "balls.toml", ".").unwrap();
    scene.environment = Some(Environment::from_map(starry_sky(), 0.4, 1.0, true));
    let Some(gpu) = on_the_gpu(&scene, 1) else {
        return;
    };
    compare("balls", &scene, &gpu, &on_the_cpu(&scene, 1)).unwrap();
}
