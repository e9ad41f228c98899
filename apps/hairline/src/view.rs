//! `hairline view`: the window.

mod window;

use std::path::Path;

use anyhow::anyhow;
use hairline_published::Method;
use hairline_scene::{Description, probe};
use hairline_viewer::engine::Backend;
use hairline_viewer::window::{Error, Renderer};
use hairline_viewer::{Options, open};

use crate::console::tell;
use crate::render::transport;
use crate::{cli, scene_file};
use hairline_work::failure::Failure;

/// Opens the viewer and returns when its window is closed.
pub fn run(arguments: &cli::View) -> Result<(), Failure> {
    if let Some(path) = &arguments.scene {
        if path == Path::new("-") {
            return Err(Failure::Input(anyhow!(
                "the viewer needs a file, which it can save to; give the path of a scene (.toml) or a model (.glb, .gltf)"
            )));
        }
        scene_file::refuse_other_files(path)?;
        // The window opens all the same, and shows it too.
        if let Err(error) = check(path) {
            tell(format_args!("error: {error}"));
        }
    }
    let renderer = match arguments.backend {
        cli::Backend::Auto => Renderer::Auto,
        cli::Backend::Gpu => Renderer::Gpu,
        cli::Backend::Cpu => Renderer::Cpu,
    };
    let state_dir = arguments.state_dir.clone();
    let options = Options {
        scene: arguments.scene.clone(),
        built_in: scene_file::BUILT_IN,
        backend: Backend::Cpu,
        state_dir: state_dir.or_else(hairline_viewer::state_dir),
        native_dialogs: !arguments.plain_dialogs,
        transport: transport(arguments.shadows, arguments.bounces, &Method::default())?,
    };
    let opened = window::in_one_sentence(|| open(options, renderer))?;
    opened.map_err(|error| match error {
        Error::NoWindow(reason) => window::failure(&reason),
        Error::Lost(_) => Failure::Work(anyhow!("{error}")),
        Error::Scene(error) => error.into(),
    })
}

/// Checks a scene, or a model that is shown in a scene of its own.
fn check(path: &Path) -> Result<(), hairline_scene::Error> {
    match Description::is_model(path) {
        true => probe::mesh(path).map(drop),
        false => probe::scene(path).map(drop),
    }
}
