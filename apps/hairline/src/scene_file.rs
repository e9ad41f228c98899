//! From the command line to a scene: the file, what flags change in it, and how far the reading has come.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use hairline_scene::description::Description;
use hairline_scene::{Loader, Scene, Stage};

use crate::failure::Failure;
use crate::progress::Progress;

/// The scene that is there without a file.
pub const BUILT_IN: &str = include_str!("built_in_scene.toml");

/// What flags put in the place of what the scene file says.
#[derive(Clone, Copy, Debug, Default)]
pub struct Overrides {
    /// Width and height.
    pub size_px: Option<[u32; 2]>,
    /// In stops.
    pub exposure_ev: Option<f64>,
    /// Added to the seed of each layer of scratches.
    pub scratch_seed: u64,
}

/// A scene with what it was made from.
pub struct Loaded {
    /// The scene itself.
    pub scene: Scene,
    /// What was built: the file's, with the flags' changes in it.
    pub description: Description,
    /// What the files that it names are relative to.
    pub folder: PathBuf,
}

/// Reads a scene file, or the built-in scene where there is none.
pub fn load(path: Option<&Path>, overrides: &Overrides) -> Result<Loaded, Failure> {
    let source = Source::read(path)?;
    let mut description = Description::from_toml(&source.text, &source.name)?;
    if let Some(size_px) = overrides.size_px {
        description.render.size_px = size_px;
    }
    if let Some(exposure_ev) = overrides.exposure_ev {
        description.camera.exposure_ev = exposure_ev;
    }
    for scratches in &mut description.scratches {
        if let Some(seed) = scratches.layer.seed_mut() {
            *seed = seed.wrapping_add(overrides.scratch_seed);
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
    for note in &scene.notes {
        eprintln!("note: {note}");
    }
    if let Some(environment) = &scene.environment
        && environment.repaired_texels() > 0
    {
        eprintln!(
            "warning: {} texels of the environment map held a negative or non-finite value; they count as black, or as \
             bright as can be if infinite",
            environment.repaired_texels()
        );
    }
    Ok(Loaded {
        scene,
        description,
        folder: source.folder,
    })
}

/// The scene's name with another ending, in the current folder: where a picture goes that no flag has named.
pub fn picture_path(scene: Option<&Path>, ending: &str) -> PathBuf {
    let stem = scene.and_then(Path::file_stem);
    // Not with_extension: a name may hold dots of its own.
    let mut name = stem.unwrap_or("hairline".as_ref()).to_owned();
    name.push(ending);
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
                text: BUILT_IN.to_owned(),
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
