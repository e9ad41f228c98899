//! `cargo lab models`: opens each glTF file below some folders as `hairline render FILE` does, and renders it small. Writes
//! docs/accuracy/models.md: what became of each file, and what it was told to lack.
//!
//! All files are opened in one process: they share the environment. A panic is an outcome as others are. Layers of wear are left away:
//! the question is what is read.

mod opened;
mod text;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use hairline_document::SceneBuilder;
use hairline_document::description::Description;
use hairline_image::output::write_atomically;
use opened::{Opened, Outcome, Source};

/// Options of `models`.
#[derive(clap::Args)]
pub struct Models {
    /// Folders, one for each source, called as the source is. A source's files lie in it at any depth.
    #[arg(required = true)]
    sources: Vec<PathBuf>,

    /// Folder for the pictures, if they are to be looked at.
    #[arg(long)]
    pictures: Option<PathBuf>,

    /// Only files whose path contains this; nothing is written but pictures then.
    #[arg(long)]
    only: Option<String>,
}

impl Models {
    /// Opens all, and writes the table.
    pub fn run(self) -> Result<()> {
        let start = Instant::now();
        let mut builder = SceneBuilder::new();
        let mut sources = Vec::new();
        for folder in &self.sources {
            let name = folder.file_name().unwrap_or(folder.as_os_str());
            let mut source = Source {
                name: name.to_string_lossy().replacen('+', "/", 1),
                files: Vec::new(),
            };
            let mut paths = Vec::new();
            list(folder, &mut paths)?;
            paths.sort();
            for path in paths {
                let name = path.strip_prefix(folder)?.to_string_lossy().into_owned();
                if self.only.as_ref().is_some_and(|only| !name.contains(only)) {
                    continue;
                }
                let picture = self.pictures.as_ref().map(|pictures| {
                    let file = format!("{}/{name}", source.name).replace('/', "+");
                    pictures.join(file + ".png")
                });
                let begun = Instant::now();
                let opened = Opened::new(name, &path, &mut builder, picture.as_deref())?;
                let seconds = begun.elapsed().as_secs_f64();
                println!(
                    "{}/{}: {} ({seconds:.1} s)",
                    source.name, opened.name, opened.outcome
                );
                source.files.push(opened);
            }
            sources.push(source);
        }
        println!("{:.0} s in all", start.elapsed().as_secs_f64());
        if self.only.is_none() {
            let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/accuracy/models.md");
            write_atomically(&document, text::document(&sources).as_bytes())?;
            println!("{}", document.display());
        }
        let all = || sources.iter().flat_map(|source| &source.files);
        let panics = all().filter(|file| matches!(file.outcome, Outcome::Panicked(_)));
        match panics.count() {
            0 => Ok(()),
            count => bail!("{count} files end in a panic"),
        }
    }
}

/// Adds all models below a folder.
fn list(folder: &Path, paths: &mut Vec<PathBuf>) -> Result<()> {
    for entry in fs::read_dir(folder).with_context(|| format!("list {}", folder.display()))? {
        let path = entry?.path();
        if path.is_dir() {
            list(&path, paths)?;
        } else if Description::is_model(&path) {
            paths.push(path);
        }
    }
    Ok(())
}
