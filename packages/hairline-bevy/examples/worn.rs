//! A file of `hairline export`: `cargo run --example worn -- worn.glb`, with the camera and the lights that it has. With the name of a picture it
//! saves one of the window and ends.

#[path = "save/mod.rs"]
mod save;

use std::path::{Path, absolute};

use bevy::camera::Exposure;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use hairline_bevy::ScratchedPlugin;

fn main() -> AppExit {
    let mut args = std::env::args().skip(1);
    let Some(file) = args.next() else {
        eprintln!("worn: found no file; must be a .glb that `hairline export` wrote");
        return AppExit::error();
    };
    let file = absolute(&file).unwrap_or(file.into());
    let folder = file.parent().unwrap_or(Path::new("/"));
    let files = AssetPlugin {
        file_path: folder.to_string_lossy().into_owned(),
        ..default()
    };
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let scene = GltfAssetLabel::Scene(0).from_asset(name.into_owned());
    App::new()
        .add_plugins((
            DefaultPlugins
                .set(files)
                .set(save::renderer())
                .set(save::window()),
            ScratchedPlugin,
            save::save_to(args.next()),
        ))
        .insert_resource(ClearColor(Color::BLACK))
        .insert_resource(GlobalAmbientLight::NONE)
        .add_systems(
            Startup,
            move |mut commands: Commands, server: Res<AssetServer>| {
                commands.spawn(WorldAssetRoot(server.load(scene.clone())));
            },
        )
        .add_observer(expose)
        .run()
}

/// Files are in nits, of which 683 are Hairline's 1.
fn expose(camera: On<Add, Camera3d>, mut commands: Commands) {
    commands.entity(camera.entity).insert((
        Exposure {
            ev100: (683.0_f32 / 1.2).log2(),
        },
        Tonemapping::AcesFitted,
    ));
}
