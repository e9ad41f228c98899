//! `hairline-viewer`: the viewer in a window.
//!
//! Exit codes: 0 done; 1 the work failed; 2 the command line or the scene is wrong.

mod examples;
mod window;

use std::path::Path;
use std::process::ExitCode;

use anyhow::anyhow;
use clap::Parser;
use hairline_console::{Backend, EXIT_CODES, View, tell};
use hairline_document::{Description, probe};
use hairline_render::failure::Failure;
use hairline_viewer::window::{Error, Renderer};
use hairline_viewer::{Options, open, progressive};

/// Edit a scene in a window: scratches, lights and materials, live.
#[derive(Debug, Parser)]
#[command(name = "hairline-viewer", version, after_help = EXIT_CODES)]
struct Cli {
    #[command(flatten)]
    view: View,
}

fn main() -> ExitCode {
    hairline_console::tell_of_panics();
    hairline_console::quiet_the_search_for_wayland();
    match run(&Cli::parse().view) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            tell(format_args!("error: {failure}"));
            failure.exit_code()
        }
    }
}

/// Opens the viewer and returns when its window is closed.
fn run(arguments: &View) -> Result<(), Failure> {
    if let Some(path) = &arguments.scene {
        if path == Path::new("-") {
            return Err(Failure::Input(anyhow!(
                "the viewer needs a file, which it can save to; give the path of a scene (.toml) or a model (.glb, .gltf, .obj, .stl)"
            )));
        }
        hairline_console::refuse_other_files(path)?;
        // The window opens all the same, and shows it too.
        if let Err(error) = check(path) {
            tell(format_args!("error: {error}"));
        }
    }
    let renderer = match arguments.backend {
        Backend::Auto => Renderer::Auto,
        Backend::Gpu => Renderer::Gpu,
        Backend::Cpu => Renderer::Cpu,
    };
    let state_dir = arguments.state_dir.clone();
    let options = Options {
        scene: arguments.scene.clone(),
        built_in: hairline_console::BUILT_IN,
        backend: progressive::Backend::Cpu,
        state_dir: state_dir.or_else(hairline_viewer::state_dir),
        native_dialogs: !arguments.plain_dialogs,
        transport: hairline_console::transport(arguments.shadows, arguments.bounces)?,
        examples: &examples::EXAMPLES,
    };
    let opened = window::in_one_sentence(|| open(options, renderer))?;
    opened.map_err(|error| match error {
        Error::NoWindow(reason) => window::failure(&reason),
        Error::Lost(_) => Failure::Work(anyhow!("{error}")),
        Error::Scene(error) => error.into(),
    })
}

/// Checks a scene, or a model that is shown in a scene of its own.
fn check(path: &Path) -> Result<(), hairline_document::Error> {
    match Description::is_model(path) {
        true => probe::mesh(path).map(drop),
        false => probe::scene(path).map(drop),
    }
}
