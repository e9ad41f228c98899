//! A light behind an object.

use super::pictures::{LINEAR, mean, picked, sampled};
use super::scenes::{View, add_quad, plate, scratch, sphere};
use glam::{DVec3, Vec3};
use hairline_image::Image;
use hairline_reference::{Model, Settings};
use hairline_scene::{Base, Scene};

const VIEW: View = View {
    angle_rad: 0.8,
    pixel_um: 30.0,
    size_px: 24,
};
const LIGHT_RAD: f64 = 0.03;
const SCREEN_M: f64 = 5e-3;

/// A plate under a light.
fn scene(base: Base, view: View) -> Scene {
    let mut scene = plate(base, view);
    scene.materials[0].roughness = 0.5;
    scene.lights = vec![sphere(view, 0.0, 0.0, LIGHT_RAD)];
    scene
}

/// Half a plane, x > 0, across the way to the light, out of the viewer's sight.
fn add_screen(scene: &mut Scene) {
    let (sin, cos) = VIEW.angle_rad.sin_cos();
    let middle = SCREEN_M * DVec3::new(0.0, sin, cos);
    let up = 2e-3 * DVec3::new(0.0, -cos, sin);
    let right = 2e-2 * DVec3::X;
    let corners = [
        middle - up,
        middle - up + right,
        middle + up + right,
        middle + up,
    ];
    let corners: [Vec3; 4] = corners.map(|c| c.as_vec3());
    add_quad(scene, Base::Mirror, 0.5, corners);
}

const WHITE: Base = Base::Dielectric {
    ior: 1.5,
    base_color: [0.9, 0.7, 0.5],
};

/// Columns of the image, `count` from `first` on.
fn columns(image: &Image, first: u32, count: u32) -> Image {
    picked(image, [count, image.size_px[1]], |x, y| [first + x, y])
}

#[test]
fn umbra_penumbra_and_light() {
    for (model, size_px, scratches) in [(Model::Separable, 24, 12), (Model::Full, 24, 0)] {
        let view = View { size_px, ..VIEW };
        let mut open = scene(WHITE, view);
        if scratches > 0 {
            scratch(&mut open, view, scratches);
        }
        let mut screened = open.clone();
        add_screen(&mut screened);
        let settings = Settings { model, ..LINEAR };
        let shadows = Settings {
            shadows: true,
            ..settings
        };
        let lit = sampled(&open, settings, 4);
        let image = sampled(&screened, shadows, 4);
        // Nothing hides anything where shadows are off, or where nothing is in the way.
        assert!(sampled(&screened, settings, 4) == lit);
        assert!(sampled(&open, shadows, 4) == lit);
        // The penumbra is as wide as the light seen from the screen: +-150 um, 5 pixels, and the filter has three more.
        let (left, right) = (columns(&image, 0, 3), columns(&image, 21, 3));
        assert!(left.base == columns(&lit, 0, 3).base);
        assert!(left.scratches == columns(&lit, 0, 3).scratches);
        assert!(
            right.beauty().rgb.iter().all(|p| *p == [0.0; 3]),
            "dark in the umbra"
        );
        assert!(columns(&lit, 21, 3).base.iter().all(|p| p[1] > 0.0));
    }
}

/// Half of the light is left on the line under the screen's edge: plate, light and viewer are symmetric about
/// it.
#[test]
fn half_the_light_at_the_edge() {
    let open = scene(WHITE, VIEW);
    let mut screened = open.clone();
    add_screen(&mut screened);
    let shadows = Settings {
        shadows: true,
        ..LINEAR
    };
    let middle = |image: &Image| mean(&columns(image, 11, 2).base)[1];
    let image = sampled(&screened, shadows, 6);
    let share = middle(&image) / middle(&sampled(&open, shadows, 6));
    let noise = columns(&image, 11, 2).noise.unwrap().base;
    let error = noise.iter().map(|v| f64::from(v[1])).sum::<f64>().sqrt()
        / noise.len() as f64
        / middle(&image)
        * share;
    println!("at the edge of the shadow: {share:.4} +- {error:.4} of the light");
    assert!(
        error < 0.01 && (share - 0.5).abs() < 4.0 * error,
        "{share} +- {error}"
    );
}
