//! `cargo xtask touches`: how many files a new parameter of a groove and a new shape of light would touch.
//!
//! A file counts if its code names all that there is of the kind today: what handles both width and depth has to handle a third
//! parameter, what tells spheres from polygons a third shape. Tests do not count, nor does the method of 2018, which stays as it
//! was published.

use std::path::{Path, PathBuf};

use anyhow::{Context, ensure};

use crate::rooms::tokens;

/// The command's arguments.
#[derive(clap::Args)]
pub struct Touches;

/// A thing to add, and the most files that it may touch.
struct Thing {
    what: &'static str,
    most: usize,
    /// The names of the existing variants, in each way that files write them.
    names: &'static [&'static [&'static str]],
}

const THINGS: [Thing; 2] = [
    Thing {
        what: "a parameter of a groove",
        // The count includes the tables of gratings.
        most: 28,
        names: &[
            &["width_um", "depth_nm"],
            &["width_depth"],
            &["DEFAULT_WIDTH_UM", "DEFAULT_DEPTH_NM"],
            &["SCRATCH_WIDTH_UM", "SCRATCH_DEPTH_NM"],
        ],
    },
    Thing {
        what: "a shape of light",
        most: 13,
        names: &[
            &["Sphere", "Polygon"],
            &["LIGHT_SPHERE", "LIGHT_POLYGON"],
            &["SCRATCH_LIGHTS"],
        ],
    },
];

impl Touches {
    /// Prints the files.
    pub fn run(&self) -> anyhow::Result<()> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut files = Vec::new();
        for folder in ["crates", "apps"] {
            add_files(&root.join(folder), &mut files)?;
        }
        files.sort();
        for Thing { what, most, names } in THINGS {
            let mut count = 0;
            for file in &files {
                let tokens = tokens(&std::fs::read_to_string(file)?);
                let has = |name: &&str| tokens.iter().any(|token| token == name);
                if names.iter().any(|names| names.iter().all(has)) {
                    count += 1;
                    println!("{what}: {}", file.strip_prefix(&root)?.display());
                }
            }
            println!("{what} touches {count} files, at most {most}");
            ensure!(
                count <= most,
                "{what} touches {count} files, more than {most}"
            );
        }
        Ok(())
    }
}

/// The product code below a folder.
fn add_files(folder: &Path, files: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    let entries = std::fs::read_dir(folder);
    for entry in entries.with_context(|| format!("{} cannot be read", folder.display()))? {
        let path = entry?.path();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let is_left_out = ["tests", "benches", "examples", "target", "published"];
        if is_left_out.contains(&&*stem) {
            continue;
        }
        if path.is_dir() {
            add_files(&path, files)?;
        } else if path.extension().is_some_and(|e| e == "rs" || e == "wgsl") {
            files.push(path);
        }
    }
    Ok(())
}
