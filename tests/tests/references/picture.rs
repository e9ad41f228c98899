//! A rectangle light with a picture: look-ups in parts for a lobe and for each chord, against every direction by chance.

use super::pictures::{LINEAR, closed, compared, sampled};
use super::scenes::{View, off_the_mirror, plate, scratch};
use conformance::two_renderers::{compare, on_the_cpu, on_the_gpu};
use glam::DVec3;
use hairline_image::Layer;
use hairline_optics::metal::Metal;
use hairline_scene::{Base, Light, Scene, Texture};
use std::sync::Arc;

/// A soft box: bright in the middle, warm to the left, with a dark bar.
fn soft_box() -> Texture {
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

#[test]
fn a_soft_box() {
    let bodied = Base::Dielectric {
        ior: 1.5,
        base_color: [0.5; 3],
    };
    let mut failures = Vec::new();
    for (base, angle_rad) in [(Base::Metal(Metal::Aluminium), 0.4), (bodied, 0.9)] {
        let view = View {
            angle_rad,
            pixel_um: 20.0,
            size_px: 16,
        };
        let scene = lit(base, view, Some(0));
        if let Some(gpu) = on_the_gpu(&scene, 1) {
            compare("soft box", &scene, &gpu, &on_the_cpu(&scene, 1)).unwrap();
        }
        let (exact, reference) = (closed(&scene), sampled(&scene, LINEAR, 8));
        let name = format!("soft box on {base:?} from {angle_rad} rad");
        let [scratches, base_layer] =
            [Layer::Scratches, Layer::Base].map(|layer| compared(&name, &exact, &reference, layer));
        // Without the picture it would be another light.
        let even = closed(&lit(base, view, None));
        let even = compared("even", &even, &reference, Layer::Scratches);
        let [at_least, _] = scratches.beyond.relative_rms_within(2.0);
        failures.extend((at_least > 0.02).then_some(scratches));
        failures.extend((base_layer.rms().0 > 0.03).then_some(base_layer));
        failures.extend((even.rms().0 < 0.2).then_some(even));
    }
    assert!(failures.is_empty(), "{failures:?}");
}
