//! `cargo xtask pictures`: the pictures of the docs, each by the command that it prints.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

/// The options that a picture is rendered with.
#[derive(Clone, Copy)]
struct RenderOptions {
    /// Width and height, pixels.
    size: &'static str,
    /// Rays of each pixel to each light, and samples of its edges.
    samples: &'static str,
    /// None: as many as without the option.
    bounces: Option<&'static str>,
}

const DEFAULT: RenderOptions = RenderOptions {
    size: "640x360",
    samples: "32",
    bounces: None,
};

/// Pictures that need something else: more samples for what is mirrored or out of focus, fewer where nothing is.
const EXCEPTIONS: [(&str, RenderOptions); 13] = [
    // It opens the README.
    ("hairline", sized("960x540", sampled("64"))),
    ("baubles", sampled("48")),
    ("bokeh", sized("480x270", sampled("56"))),
    ("dvd", sampled("16")),
    ("groove", sampled("16")),
    ("lid", sampled("64")),
    ("lighter", sampled("16")),
    (
        "mirror",
        RenderOptions {
            bounces: Some("2"),
            ..sampled("96")
        },
    ),
    ("movement", sampled("64")),
    ("phone", sampled("16")),
    ("record", sampled("16")),
    ("seal", sampled("16")),
    ("sundial", sampled("16")),
];

const fn sampled(samples: &'static str) -> RenderOptions {
    RenderOptions { samples, ..DEFAULT }
}

const fn sized(size: &'static str, options: RenderOptions) -> RenderOptions {
    RenderOptions { size, ..options }
}

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
        let exception = EXCEPTIONS.iter().find(|(of, _)| *of == name);
        let RenderOptions {
            size,
            samples,
            bounces,
        } = exception.map_or(DEFAULT, |&(_, options)| options);
        let mut arguments = vec!["run", "--release", "-q", "-p", "hairline", "--", "render"];
        arguments.extend(scene_file.as_deref());
        arguments.extend(["-o", &file, "--size", size, "--samples", samples]);
        arguments.extend(["--backend", &self.backend]);
        if let Some(bounces) = bounces {
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
