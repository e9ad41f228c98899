//! A turned and worn steel plate under a lamp that sways and a soft box: `cargo run --example plate`. With the name of a picture it saves one of
//! the window and ends.

#[path = "save/mod.rs"]
mod save;

use std::f32::consts::PI;

use bevy::camera::Exposure;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::light::RectLight;
use bevy::prelude::*;
use hairline_bevy::{Metal, ScratchedMaterial, ScratchedPlugin, ScratchedTextures, Scratches};

/// Metres.
const LAMP_RADIUS: f32 = 0.004;

fn main() -> AppExit {
    App::new()
        .add_plugins((
            DefaultPlugins.set(save::renderer()).set(save::window()),
            ScratchedPlugin,
            save::save_to(std::env::args().nth(1)),
        ))
        .insert_resource(ClearColor(Color::srgb(0.02, 0.02, 0.025)))
        // Bevy's own is white at the camera's exposure.
        .insert_resource(GlobalAmbientLight::NONE)
        .add_systems(Startup, setup)
        .add_systems(Update, sway)
        .run()
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ScratchedMaterial>>,
    textures: Res<ScratchedTextures>,
) -> Result {
    // A disk in the xy plane that faces +z.
    let plate = Mesh::from(Circle::new(0.09).mesh().resolution(128));
    // The keys of scene files. Widths that hardly differ keep the orders of the rainbow apart.
    let turned = "
        pattern = 'circular'
        count = 1500
        length_m = { mean = 0.05, spread = 0.5 }
        width_um = { mean = 5.0, spread = 0.1 }
        depth_nm = { mean = 180.0, spread = 0.12 }";
    let worn = "
        pattern = 'random'
        count = 900
        length_m = { mean = 0.03, spread = 0.6 }
        width_um = { mean = 4.0, spread = 0.12 }
        depth_nm = { mean = 195.0, spread = 0.12 }";
    let scratches = Scratches::on_mesh(&plate, &[turned, worn])?;
    let base = StandardMaterial {
        perceptual_roughness: 0.1,
        ..default()
    };
    let steel = textures.material(Some(Metal::StainlessSteel), base, &scratches);
    commands.spawn((
        Mesh3d(meshes.add(plate)),
        MeshMaterial3d(materials.add(steel)),
    ));

    // A sphere of radiance L sends 4 pi^2 r^2 L lumens, as Bevy counts them; a rectangle pi A L.
    commands.spawn((
        PointLight {
            color: Color::linear_rgb(1.0, 0.94, 0.86),
            intensity: 900.0 * 4.0 * (PI * LAMP_RADIUS).powi(2),
            radius: LAMP_RADIUS,
            ..default()
        },
        Lamp,
    ));
    commands.spawn((
        RectLight {
            color: Color::linear_rgb(0.75, 0.87, 1.0),
            intensity: 0.8 * PI * 0.4 * 0.3,
            width: 0.4,
            height: 0.3,
            ..default()
        },
        Transform::from_xyz(-0.35, 0.3, 0.3).looking_at(Vec3::ZERO, Vec3::Z),
    ));
    commands.spawn((
        Camera3d::default(),
        Projection::from(PerspectiveProjection {
            fov: 0.5,
            near: 0.01,
            ..default()
        }),
        // Exposure by which a luminance of 1 is 1 before the tone curve.
        Exposure {
            ev100: -1.2_f32.log2(),
        },
        Tonemapping::AcesFitted,
        Transform::from_xyz(0.0, -0.26, 0.29).looking_at(Vec3::ZERO, Vec3::Z),
    ));
    Ok(())
}

#[derive(Component)]
struct Lamp;

/// Colours run along the scratches.
fn sway(time: Res<Time>, mut lamp: Single<&mut Transform, With<Lamp>>) {
    let across = 0.06 * (time.elapsed_secs() / 2.0).sin();
    lamp.translation = Vec3::new(across, 0.24, 0.3);
}
