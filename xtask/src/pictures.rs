//! `cargo xtask pictures`: the pictures of the docs, each by the command that it prints.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

/// Width and height of a picture, pixels, where no exception is made.
const SIZE: &str = "640x360";

/// Pictures that are made with more than the options that a user begins with. The first opens the README. A lens has a point for each four samples,
/// and light that goes by two mirrors takes more than a few rays.
const EXCEPTIONS: [(&str, &[&str]); 3] = [
    ("hairline", &["--size", "960x540"]),
    ("bokeh", &["--size", "480x270", "--samples", "64"]),
    (
        "mirror",
        &["--size", SIZE, "--bounces", "2", "--samples", "96"],
    ),
];

/// Options of `pictures`.
#[derive(clap::Args)]
pub struct Pictures {
    /// Renderer. The CPU renderer is the default: its pictures are the same everywhere.
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
        let exception = EXCEPTIONS.iter().find(|(of, _)| *of == name);
        let options = exception.map_or(&["--size", SIZE][..], |&(_, options)| options);
        let mut arguments = vec!["run", "--release", "-q", "-p", "hairline", "--", "render"];
        arguments.extend(scene_file.as_deref());
        arguments.extend(["-o", &file, "--backend", &self.backend]);
        arguments.extend(options);
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
