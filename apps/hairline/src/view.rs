//! `hairline view`: the window.

use hairline_viewer::engine::Backend;
use hairline_viewer::window::{Error, Renderer};
use hairline_viewer::{Options, open};

use crate::failure::Failure;
use crate::{cli, scene_file};

/// Opens the viewer and returns when its window is closed.
pub fn run(arguments: &cli::View) -> Result<(), Failure> {
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
    };
    open(options, renderer).map_err(|error| match error {
        Error::NoWindow(_) => Failure::Work(anyhow::anyhow!(
            "{error}; `hairline render` needs no window, and `hairline --help` tells the rest"
        )),
        Error::Lost(_) => Failure::Work(anyhow::anyhow!("{error}")),
        Error::Scene(error) => error.into(),
    })
}
