//! `hairline render`: a scene file to a picture.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use hairline_image::{Display, Output};
use hairline_scene::description::{Description, Layer};
use hairline_scene::{Loader, Scene, Stage};

use crate::backend;
use crate::cli;
use crate::failure::Failure;
use crate::progress::Progress;

/// Loads, renders and writes.
pub fn run(arguments: &cli::Render) -> Result<(), Failure> {
    // Before the work: nobody should wait for a picture that then has no place to go.
    let output = Output::check(&output_path(arguments))?;
    let scene = load(arguments)?;
    let image = backend::render(&scene, arguments.backend, arguments.samples)?;
    let display = Display {
        exposure_ev: scene.camera.exposure_ev,
        tone_map: scene.render.tone_map,
    };
    output.write_image(&image, &display)?;
    Ok(())
}

fn output_path(arguments: &cli::Render) -> PathBuf {
    if let Some(path) = &arguments.output {
        return path.clone();
    }
    let stem = arguments.scene.as_deref().and_then(Path::file_stem);
    // Not with_extension: a name may hold dots of its own.
    let mut name = stem.unwrap_or("hairline".as_ref()).to_owned();
    name.push(".png");
    name.into()
}

/// A scene's text and what it is relative to.
struct Source {
    text: String,
    name: PathBuf,
    folder: PathBuf,
}

impl Source {
    fn read(scene: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = scene else {
            return Ok(Self {
                text: include_str!("built_in_scene.toml").to_owned(),
                name: "built-in scene".into(),
                folder: PathBuf::new(),
            });
        };
        let text = std::fs::read_to_string(path).map_err(|error| {
            let path = path.display();
            Failure::Input(anyhow!(
                "{path}: cannot be read ({error}); give the path of a scene file (TOML)"
            ))
        })?;
        Ok(Self {
            text,
            name: path.to_owned(),
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
        })
    }
}

/// The scene with what the command line changes in it.
fn load(arguments: &cli::Render) -> Result<Scene, Failure> {
    let source = Source::read(arguments.scene.as_deref())?;
    let mut description = Description::from_toml(&source.text, &source.name)?;
    if let Some(size_px) = arguments.size {
        description.render.size_px = size_px;
    }
    if let Some(exposure_ev) = arguments.exposure {
        description.camera.exposure_ev = exposure_ev;
    }
    for scratches in &mut description.scratches {
        if let Layer::Laid(laid) = &mut scratches.layer {
            laid.seed = laid.seed.wrapping_add(arguments.seed);
        }
    }

    let progress = Progress::start("reading the scene");
    let loader = Loader {
        progress: &|at| {
            progress.restart(match at.stage {
                Stage::Meshes => "reading meshes",
                Stage::Environment => "reading the map",
                Stage::Scratches => "laying scratches",
            });
            progress.set(at.done as f64 / at.total.max(1) as f64);
        },
        ..Loader::default()
    };
    let scene = loader
        .build(&description, &source.folder)
        .map_err(|error| error.in_scene_file(&source.text, &source.name))?;
    drop(progress);
    if let Some(environment) = &scene.environment
        && environment.repaired_texels() > 0
    {
        eprintln!(
            "warning: {} texels of the environment map held a negative or non-finite value; they count as black, or as \
             bright as can be if infinite",
            environment.repaired_texels()
        );
    }
    Ok(scene)
}
