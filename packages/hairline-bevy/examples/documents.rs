//! The programs of docs/engines.md, word for word, which a test of the command line holds them to.

use bevy::camera::Exposure;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use hairline_bevy::{Metal, ScratchedMaterial, ScratchedPlugin, ScratchedTextures, Scratches};

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, ScratchedPlugin))
        .insert_resource(ClearColor(Color::BLACK))
        .insert_resource(GlobalAmbientLight::NONE) // Bevy's own is white at this exposure
        .add_systems(Startup, setup)
        .run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ScratchedMaterial>>,
    textures: Res<ScratchedTextures>,
) -> Result {
    let plate = Mesh::from(Circle::new(0.08).mesh().resolution(96));
    let layer = "pattern = 'random'\ncount = 6000\nlength_m = 0.05\nwidth_um = 4.0\ndepth_nm = { mean = 160.0, spread = 0.1 }"; // as in [[scratches]] of a scene file
    let base = StandardMaterial {
        perceptual_roughness: 0.08,
        ..default()
    };
    let steel = textures.material(
        Some(Metal::StainlessSteel),
        base,
        &Scratches::on_mesh(&plate, &[layer])?,
    );
    commands.spawn((
        Mesh3d(meshes.add(plate)),
        MeshMaterial3d(materials.add(steel)),
    ));
    commands.spawn((
        PointLight {
            intensity: 1.0,
            radius: 0.004,
            ..default()
        },
        Transform::from_xyz(0.05, 0.2, 0.25),
    )); // lumens, metres
    let view = Transform::from_xyz(0.0, -0.2, 0.25).looking_at(Vec3::ZERO, Vec3::Z);
    let lens = Projection::from(PerspectiveProjection {
        fov: 0.52,
        near: 0.01,
        ..default()
    });
    commands.spawn((
        Camera3d::default(),
        lens,
        Tonemapping::AcesFitted,
        Exposure {
            ev100: -1.2_f32.log2(),
        },
        view,
    ));
    Ok(())
}

/// A file of `hairline export`.
#[allow(dead_code, reason = "the other program")]
fn worn(mut commands: Commands, server: Res<AssetServer>) {
    commands.spawn(WorldAssetRoot(server.load("worn.glb#Scene0")));
}
