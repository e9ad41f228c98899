//! Saves a picture of the window and ends.

use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};

/// Seconds after which files, meshes and textures are there.
const READY_S: f32 = 20.0;

/// A renderer whose pictures have all pipelines.
pub fn renderer() -> RenderPlugin {
    RenderPlugin {
        synchronous_pipeline_compilation: true,
        ..default()
    }
}

/// A window that a software driver fills in seconds.
pub fn window() -> WindowPlugin {
    WindowPlugin {
        primary_window: Some(Window {
            resolution: (640, 400).into(),
            ..default()
        }),
        ..default()
    }
}

/// A plug-in that saves to a file; without one it does nothing.
pub fn save_to(path: Option<String>) -> impl Plugin {
    move |app: &mut App| {
        let Some(path) = path.clone() else {
            return;
        };
        let save =
            move |mut commands: Commands, time: Res<Time<Real>>, mut is_done: Local<bool>| {
                if *is_done || time.elapsed_secs() < READY_S {
                    return;
                }
                *is_done = true;
                let path = path.clone();
                let saved = move |captured: On<ScreenshotCaptured>,
                                  mut exit: MessageWriter<AppExit>|
                      -> Result {
                    let picture = captured.image.clone().try_into_dynamic()?;
                    picture.to_rgb8().save(&path)?;
                    exit.write(AppExit::Success);
                    Ok(())
                };
                commands.spawn(Screenshot::primary_window()).observe(saved);
            };
        app.add_systems(Update, save);
    }
}
