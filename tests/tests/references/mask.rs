//! Comparison of the masks with the highlight that remains by the whole field.

use super::pictures::{mean, sampled};
use super::scenes::{View, plate, scratch_alike, sphere};
use hairline_optics::mask::Mask;
use hairline_reference::{Model, Settings};
use hairline_scene::{Base, Scene};

const VIEW: View = View {
    angle_rad: 0.2,
    pixel_um: 60.0,
    size_px: 4,
};

fn scene(width_um: f32, depth_nm: f32) -> Scene {
    let mut scene = plate(Base::Mirror, VIEW);
    scene.materials[0].roughness = 0.0;
    // Seen in the mirror: the whole peak, and little of what scratches send.
    scene.lights = vec![sphere(VIEW, 0.0, 0.0, 0.03)];
    if width_um > 0.0 {
        scratch_alike(&mut scene, VIEW, 6, width_um, depth_nm);
    }
    scene
}

#[test]
fn energy_is_nearer_than_density() {
    let seen = |scene: &Scene, model, mask| {
        let settings = Settings {
            model,
            mask,
            ..Settings::default()
        };
        mean(&sampled(scene, settings, 2).beauty().rgb)
    };
    // Without scratches: GGX sends a percent past the light, the field nothing.
    let clean = scene(0.0, 0.0);
    let [of_full, of_separable] =
        [Model::Full, Model::Separable].map(|m| seen(&clean, m, Mask::Energy));
    let (mut energy_error, mut density_error, mut cells) = (0.0, 0.0, 0.0);
    for depth_nm in [40.0, 130.0, 220.0, 400.0] {
        for width_um in [1.0, 2.0, 4.0] {
            let scene = scene(width_um, depth_nm);
            let full = seen(&scene, Model::Full, Mask::Energy);
            let [energy, density] = [Mask::Energy, Mask::Density].map(|mask| {
                let separable = seen(&scene, Model::Separable, mask);
                (0..3)
                    .map(|c| (separable[c] / of_separable[c] - full[c] / of_full[c]).abs())
                    .sum::<f64>()
                    / 3.0
            });
            println!(
                "depth {depth_nm} nm, width {width_um} um: energy mask off by {:.2} %, density mask by {:.2} %",
                100.0 * energy,
                100.0 * density
            );
            energy_error += energy;
            density_error += density;
            cells += 1.0;
        }
    }
    println!(
        "in the mean: energy mask off by {:.2} %, density mask by {:.2} %",
        100.0 * energy_error / cells,
        100.0 * density_error / cells
    );
    assert!(energy_error < density_error);
}
