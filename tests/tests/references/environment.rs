//! Scratches and base under a smooth sky: cells of the band and the split sum against every direction by chance.

use crate::pictures::{LINEAR, closed, compared, sampled};
use crate::scenes::{View, plate, scratch};
use glam::DVec3;
use hairline_image::{Layer, Picture};
use hairline_optics::metal::Metal;
use hairline_scene::environment::lookup::environment_dir;
use hairline_scene::{Base, Environment};

/// Blue above, pale at the horizon, and brighter to one side: no edge and no sun.
fn sky() -> Environment {
    let [width, height] = [128, 64];
    let mut map = Picture::new([width, height]);
    for (i, texel) in map.rgb.iter_mut().enumerate() {
        let (x, y) = (i as u32 % width, i as u32 / width);
        let dir = environment_dir(glam::DVec2::new(
            (f64::from(x) + 0.5) / f64::from(width),
            (f64::from(y) + 0.5) / f64::from(height),
        ));
        let horizon = 1.0 - dir.y.abs();
        let side = 1.0 + 0.5 * dir.x - 0.3 * dir.z;
        let rgb = DVec3::new(0.25, 0.45, 0.9) + DVec3::new(0.7, 0.5, 0.2) * horizon;
        *texel = (side * rgb).as_vec3().to_array();
    }
    Environment::from_map(map, 0.0, 1.0, false).with_up(DVec3::Z, 0.7)
}

#[test]
fn a_smooth_sky() {
    for (base, angle_rad) in [(Base::Mirror, 0.4), (Base::Metal(Metal::Aluminium), 0.9)] {
        let view = View {
            angle_rad,
            pixel_um: 20.0,
            size_px: 16,
        };
        let mut scene = plate(base, view);
        scene.materials[0].roughness = 0.3;
        scene.environment = Some(sky());
        scratch(&mut scene, view, 20);
        let (exact, reference) = (closed(&scene), sampled(&scene, LINEAR, 4));
        let name = format!("sky on {base:?} from {angle_rad} rad");
        let [scratches, base] =
            [Layer::Scratches, Layer::Base].map(|layer| compared(&name, &exact, &reference, layer));
        // Cells of the band's middle line: 0.2 to 1 % for skies without an edge (docs/model.md, (30)).
        let [at_least, _] = scratches.beyond.relative_rms_within(2.0);
        assert!(at_least < 0.01, "{scratches:?}");
        assert!((scratches.mean_ratio - 1.0).abs() < 0.01 + 3.0 * scratches.mean_ratio_error);
        // The split sum takes the lobe for one around the mirror's direction, and its Fresnel reflectance for that of the
        // whole lobe.
        assert!(base.rms().0 < 0.04, "{base:?}");
    }
}
