//! So many scratches that a tile of the GPU's picture lists more than five hundred and a pixel sees a hundred, and so many that it lights them
//! batch after batch.

use hairline_gpu::headless;
use hairline_image::Layer;
use hairline_image::metrics::layer_difference;
use hairline_optics::method::{LightAt, Method};
use hairline_reference::closed_form;
use hairline_scene::Scene;

/// The middle of a disk.
const DENSE: &str = r#"
[camera]
position_m = [0.0, -0.1365, 0.236425]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = FOV

[render]
size_px = [120, 88]
filter_std_px = 0.2887

[[material]]
name = "steel"
kind = "metal"
metal = "iron"
roughness = 0.1

[[object]]
name = "disk"
shape = { disk = { radius_m = 0.05 } }
material = "steel"

[[scratches]]
object = "disk"
pattern = "random"
count = 300_000
length_m = 0.00236
width_um = 3.0
depth_nm = 220.0

[[light]]
kind = "sphere"
center_m = [0.0, 0.2, 0.34641]
radius_m = 0.04
radiance = 40.0
"#;

/// Rounding, over a hundred scratches for each pixel.
const PIXELS_MOST: f64 = 1e-3;
/// What lies between stations.
const SCRATCHES_MOST: f64 = 6e-3;

/// Pixels of 0.45 mm.
#[test]
fn lists_hold_them_all() {
    is_the_cpus("8.0");
}

/// Pixels of 0.65 mm, which see some two hundred: more than a batch holds.
#[test]
fn batches_follow_one_another() {
    is_the_cpus("11.5");
}

fn is_the_cpus(fov_y_deg: &str) {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let text = DENSE.replace("FOV", fov_y_deg);
    let scene = Scene::from_toml(&text, "dense", ".").unwrap_or_else(|e| panic!("{e}"));
    let method = Method {
        light_at: LightAt::Pixels,
        ..Method::default()
    };
    let options = closed_form::RenderOptions { samples: 1, method };
    let wanted = closed_form::render(&scene, &options, &|_| {});
    for (light_at, most) in [
        (LightAt::Pixels, PIXELS_MOST),
        (LightAt::Scratches, SCRATCHES_MOST),
    ] {
        let method = Method { light_at, ..method };
        let options = hairline_gpu::RenderOptions::default();
        let image = headless::render(gpu, &scene, &method, &options, &|_| {}).unwrap();
        for layer in [Layer::Scratches, Layer::Density] {
            let difference = layer_difference(&image, &wanted, layer, None);
            let rms = difference.relative_rms();
            println!("{light_at:?}, {}: {:.4} %", layer.name(), 100.0 * rms);
            let is_right = difference.not_finite == 0 && rms < most;
            assert!(is_right, "{light_at:?}, {}: {rms}", layer.name());
        }
    }
}
