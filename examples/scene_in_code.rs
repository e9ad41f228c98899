//! Builds a scene without a scene file, a square of gold with wavy scratches of growing depth, and renders it:
//! `cargo run --release --example scene_in_code [PICTURE]`.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3, Vec4};
use hairline_cpu::closed_form::{Prepared, RenderOptions};
use hairline_image::{Display, Output};
use hairline_optics::metal::Metal;
use hairline_scene::{
    Base, Camera, Lens, Light, Material, Mesh, Object, Profile, RenderSettings, Scene, Scratch,
    Segment,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let picture = std::env::args().nth(1);
    let picture = picture.unwrap_or("scene_in_code.png".into());
    let scene = Scene {
        camera: Camera {
            position_m: DVec3::new(0.0, -0.008, 0.010),
            target_m: DVec3::ZERO,
            up: DVec3::Z,
            fov_y_rad: 0.4,
            shift_tan: Default::default(),
            exposure_ev: 0.0,
            lens: Lens::default(),
        },
        render: RenderSettings {
            size_px: [320, 240],
            filter_std_px: 0.5,
            tone_map: Default::default(),
        },
        environment: None,
        textures: Arc::default(),
        observer: Default::default(),
        materials: vec![Material::plain(
            "gold".into(),
            Base::Metal(Metal::Gold.into()),
            0.05,
        )],
        objects: vec![scratched_square(0.004)],
        shadow_catcher: None,
        lights: vec![Light::sphere(DVec3::new(0.0, 0.12, 0.36), 0.03, [200.0; 3])],
        notes: Vec::new(),
        tables: Arc::default(),
    };
    let image = Prepared::new(&scene).render(&RenderOptions::default(), &|_| {});
    Output::check(Path::new(&picture))?.write_image(&image, &Display::default())?;
    println!("{picture}");
    Ok(())
}

/// In the plane z = 0. Scratches lie on the surface in world space, in segments; each segment knows its triangle and the normal there.
fn scratched_square(half_m: f32) -> Object {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0) * half_m;
    let mesh = Mesh {
        positions_m: vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ],
        normals: vec![Vec3::Z; 4],
        tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4],
        uvs: vec![Vec2::ZERO; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        triangle_materials: vec![0; 2],
        ..Mesh::default()
    };
    let (mut scratches, mut segments) = (Vec::new(), Vec::new());
    for wave in 0..30_u8 {
        let first = segments.len() as u32;
        let at = |i: u8| {
            let (x, y) = (0.05 * f32::from(i), 0.06 * f32::from(wave));
            corner(x - 0.9, y - 0.9 + 0.03 * (10.0 * x).sin())
        };
        segments.extend((0..36).map(|i| Segment {
            start_m: at(i),
            end_m: at(i + 1),
            normal: Vec3::Z,
            triangle: 0,
        }));
        scratches.push(Scratch {
            profile: Profile {
                width_um: 2.0,
                depth_nm: 60.0 + 12.0 * f32::from(wave),
                ..Profile::default()
            },
            layer: 0,
            closed: false,
            segments: first..first + 36,
        });
    }
    Object {
        name: "square".into(),
        mesh: Arc::new(mesh),
        scratches: Arc::new(scratches),
        segments: Arc::new(segments),
        parts: Arc::default(),
        gratings: Vec::new(),
        is_lamp: false,
    }
}
