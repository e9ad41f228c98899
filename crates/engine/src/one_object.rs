//! An object by itself as a scene.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hairline_scene::{Base, Camera, Lens, Material, Object, RenderSettings, Scene};

/// Returns a scene of one object, whose one material has a coherence length, in µm, and of nothing else: for the index of its scratches.
pub(crate) fn scene_of(object: Object, coherence_um: f64) -> Scene {
    let material = Material::plain(String::new(), Base::Mirror, 0.0);
    Scene {
        camera: Camera {
            position_m: DVec3::Z,
            target_m: DVec3::ZERO,
            up: DVec3::Y,
            fov_y_rad: 1.0,
            shift_tan: DVec2::ZERO,
            exposure_ev: 0.0,
            lens: Lens::default(),
        },
        render: RenderSettings {
            size_px: [1; 2],
            filter_std_px: 0.5,
            tone_map: Default::default(),
        },
        environment: None,
        textures: Arc::default(),
        materials: vec![Material {
            coherence_um,
            ..material
        }],
        observer: Default::default(),
        objects: vec![object],
        shadow_catcher: None,
        lights: Vec::new(),
        notes: Vec::new(),
        tables: Arc::default(),
    }
}
