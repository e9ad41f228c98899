//! One scratched plate under each kind of light, by the closed form and by chance: the figures of docs/accuracy/lights.md.

use super::picture::soft_box;
use super::pictures::{Compared, LINEAR, closed, compared, sampled};
use super::scenes::{View, off_the_mirror, outline, panel, plate, scratch, sphere, tube};
use hairline_image::Layer;
use hairline_optics::metal::Metal;
use hairline_scene::{Base, Cone, Light, Scene};
use std::sync::Arc;

const VIEW: View = View {
    angle_rad: 0.6,
    pixel_um: 40.0,
    size_px: 8,
};

/// Aluminium whose highlight is wide enough for the base to be lit, under two lights beside the mirror's direction.
fn scene(light: impl Fn(f64, f64) -> Light) -> Scene {
    let mut scene = plate(Base::Metal(Metal::Aluminium.into()), VIEW);
    scene.materials[0].roughness = 0.2;
    scene.textures = Arc::new(vec![soft_box()]);
    scene.lights = vec![light(0.12, -0.05), light(0.0, -0.16)];
    scratch(&mut scene, VIEW, 24);
    scene
}

/// A square, its vertices as those of a rectangle with a picture.
fn square(x: f64, y: f64) -> Light {
    Light {
        radiance: [1.0; 3],
        ..panel(VIEW, x, y, [0.06, 0.06])
    }
}

/// A lamp whose cone ends beside the plate: the plate lies where the light falls off.
fn spot(x: f64, y: f64) -> Light {
    let lamp = sphere(VIEW, x, y, 0.02);
    let middle = lamp.bounding_sphere().0;
    let beside = middle.any_orthonormal_vector() * 0.15_f64.tan();
    Light {
        cone: Some(Cone {
            axis: (beside - middle.normalize()).normalize(),
            cos_outer: 0.3_f64.cos(),
            cos_inner: 1.0,
            doors: None,
        }),
        ..lamp
    }
}

fn star(x: f64, y: f64) -> Light {
    let corner = |i: i32| if i % 2 == 0 { 0.09 } else { 0.05 };
    outline(VIEW, x, y, (0..10).map(corner))
}

/// A sun as wide as ours.
fn sun(x: f64, y: f64) -> Light {
    let radius_rad = 0.265_f64.to_radians();
    Light::sun(
        off_the_mirror(VIEW.angle_rad, x, y),
        radius_rad,
        [1.0, 0.9, 0.8],
    )
}

/// Prints a row of a table of Markdown.
fn row(kind: &str, found: [&Compared; 2]) {
    let cells = found.map(|layer| {
        let [least, most] = layer.beyond.relative_rms_within(1.0).map(|rms| 100.0 * rms);
        format!(
            "{:.4} ± {:.4} | {:.2} ({least:.2} to {most:.2})",
            layer.mean_ratio,
            layer.mean_ratio_error,
            100.0 * layer.rms().0
        )
    });
    println!("| {kind} | {} |", cells.join(" | "));
}

/// Limits of the rms on the base and on scratches. A spot has one cone for all of its points, a sun is about as wide as the band of light that a
/// scratch sends.
#[test]
fn a_plate_under_each_kind_of_light() {
    check(8);
}

/// The table of docs/accuracy/lights.md.
#[test]
#[ignore = "long: cargo long"]
fn a_plate_under_each_kind_of_light_by_many_samples() {
    check(16);
}

fn check(batches: u32) {
    let rectangle_with_picture = |x, y| Light {
        picture: Some(0),
        ..square(x, y)
    };
    let kinds: [(&str, Scene, [f64; 2]); 8] = [
        (
            "sphere",
            scene(|x, y| sphere(VIEW, x, y, 0.06)),
            [0.01, 0.01],
        ),
        (
            "disk",
            scene(|x, y| outline(VIEW, x, y, [0.06; 24])),
            [0.01, 0.01],
        ),
        ("rectangle", scene(square), [0.01, 0.01]),
        (
            "rectangle with a picture",
            scene(rectangle_with_picture),
            [0.03, 0.02],
        ),
        ("polygon (a star)", scene(star), [0.01, 0.01]),
        (
            "tube",
            scene(|x, y| tube(VIEW, x, y, 0.05, 0.03)),
            [0.01, 0.01],
        ),
        ("spot", scene(spot), [0.06, 0.06]),
        ("sun", scene(sun), [0.01, 0.02]),
    ];
    for (kind, scene, limits) in kinds {
        let (exact, reference) = (closed(&scene), sampled(&scene, LINEAR, batches));
        let of = |image, layer| compared(kind, image, &reference, layer);
        let found = [Layer::Base, Layer::Scratches].map(|layer| of(&exact, layer));
        row(kind, found.each_ref());
        // More light must be seen.
        let mut wrong = scene.clone();
        for light in &mut wrong.lights {
            light.radiance = light.radiance.map(|c| c * 1.15);
        }
        let wrong = closed(&wrong);
        let wrong = [Layer::Base, Layer::Scratches].map(|layer| of(&wrong, layer));
        for ((found, wrong), limit) in found.iter().zip(&wrong).zip(limits) {
            let is_right = |found: &Compared| {
                let [at_least, _] = found.beyond.relative_rms_within(2.0);
                at_least < limit
                    && (found.mean_ratio - 1.0).abs() < limit + 3.0 * found.mean_ratio_error
            };
            assert!(is_right(found), "{kind}: {found:?}");
            assert!(!is_right(wrong), "{kind}: {wrong:?}");
        }
    }
}
