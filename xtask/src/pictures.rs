//! `cargo xtask pictures`: the pictures of the docs, each by the command that it prints.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

/// Width and height of the built-in scene's picture, which opens the README.
const BUILT_IN_SIZE: &str = "960x540";
/// Width and height of the pictures of scenes/.
const SCENE_SIZE: &str = "640x360";

/// Rays of each pixel to each light, and samples of its edges.
const SAMPLES: &str = "32";
/// Scenes whose picture shows more than one bounce.
const BOUNCES: [(&str, &str); 1] = [("mirror", "2")];

/// Options of `pictures`.
#[derive(clap::Args)]
pub struct Pictures {
    /// What renders. The CPU renderer is the default: its pictures are the same everywhere.
    #[arg(long, default_value = "cpu")]
    backend: String,

    /// Only these, by the names of their scenes; the built-in one is called hairline.
    names: Vec<String>,
}

impl Pictures {
    /// Renders the built-in scene and every scene of scenes/.
    pub fn run(self) -> Result<()> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        std::fs::create_dir_all(root.join("docs/pictures")).context("make docs/pictures")?;
        let mut scenes = vec![None];
        scenes.extend(scene_files(&root)?.into_iter().map(Some));
        for scene in scenes {
            let name = scene.as_deref().and_then(Path::file_stem);
            let name = name.and_then(OsStr::to_str).unwrap_or("hairline");
            if self.names.is_empty() || self.names.iter().any(|n| n == name) {
                self.picture(&root, name, scene.as_deref())?;
            }
        }
        Ok(())
    }

    fn picture(&self, root: &Path, name: &str, scene: Option<&Path>) -> Result<()> {
        let file = format!("docs/pictures/{name}.png");
        let scene_file = scene.map(|path| path.display().to_string().replace('\\', "/"));
        let size = if scene.is_some() {
            SCENE_SIZE
        } else {
            BUILT_IN_SIZE
        };
        let mut arguments = vec!["run", "--release", "-q", "-p", "hairline", "--", "render"];
        arguments.extend(scene_file.as_deref());
        arguments.extend(["-o", &file, "--size", size, "--samples", SAMPLES]);
        arguments.extend(["--backend", &self.backend]);
        if let Some((_, bounces)) = BOUNCES.iter().find(|(of, _)| *of == name) {
            arguments.extend(["--bounces", bounces]);
        }
        println!("cargo {}", arguments.join(" "));
        let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
        let status = Command::new(cargo)
            .args(arguments)
            .current_dir(root)
            .status()
            .context("start cargo")?;
        ensure!(status.success(), "no picture of {name}: {status}");
        let bytes = std::fs::metadata(root.join(&file))?.len();
        println!("  {file}: {} KiB", bytes.div_ceil(1024));
        Ok(())
    }
}

/// Paths from the root, in the order of their names.
pub fn scene_files(root: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(root.join("scenes")).context("list scenes")? {
        let name = PathBuf::from(entry?.file_name());
        if name.extension() == Some(OsStr::new("toml")) {
            files.push(Path::new("scenes").join(name));
        }
    }
    files.sort();
    Ok(files)
}
