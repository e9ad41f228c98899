//! Programs of users of the packed package, packages/hairline-shaders/examples: installed and built as they would be, and looked at in Chromium.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};

use super::browser::{Folders, answers};
use super::element::coloured;
use crate::archive::copy;

const EXAMPLES: [&str; 2] = ["vite", "react"];

/// Builds all examples of the file that npm installs, and checks that each shows scratches in colour and carries no gratings.
pub(super) fn look(root: &Path, output: &Path, packed: &Path) -> anyhow::Result<()> {
    let packed = packed.canonicalize()?;
    let by_hand = root.join("packages/hairline-shaders");
    for name in EXAMPLES {
        let folder = output.join("examples").join(name);
        for entry in std::fs::read_dir(by_hand.join("examples").join(name))? {
            let entry = entry?;
            if entry.file_type()?.is_file() {
                copy(&entry.path(), &folder.join(entry.file_name()))?;
            }
        }
        let install = ["install", "--no-package-lock", "--no-audit", "--no-fund"];
        npm(
            &folder,
            &[&install[..], &[&*packed.to_string_lossy()]].concat(),
        )?;
        npm(&folder, &["run", "build"])?;
        let built = folder.join("dist");
        for entry in std::fs::read_dir(built.join("assets"))? {
            let entry = entry?;
            let file = entry.file_name().to_string_lossy().into_owned();
            println!("example {name}: {file:<40} {:>9}", entry.metadata()?.len());
            ensure!(!file.ends_with(".bin"), "{name}: found {file}, a grating");
        }
        let folders: Folders = vec![
            ("/example/", built),
            ("/test/", by_hand.join("test/examples")),
        ];
        let drawn = answers(folders, "/test/index.html")?;
        let found = drawn.iter().find(|(path, _)| path == "picture");
        let (_, picture) = found.context("the page sent no picture")?;
        println!(
            "example {name}: {:.1} % of its pixels are coloured",
            100.0 * coloured(picture)?
        );
    }
    Ok(())
}

fn npm(folder: &Path, arguments: &[&str]) -> anyhow::Result<()> {
    let status = Command::new("npm")
        .current_dir(folder)
        .args(arguments)
        .status()
        .context("npm cannot be run")?;
    ensure!(status.success(), "npm {} failed", arguments.join(" "));
    Ok(())
}
