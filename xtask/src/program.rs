//! The programs that tasks run or pack.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};

/// Builds a program of the workspace for use.
pub fn build(root: &Path, name: &str) -> anyhow::Result<PathBuf> {
    run(Command::new("cargo")
        .current_dir(root)
        .args(["build", "--release", "-p", name]))?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    let file = format!("release/{name}{}", std::env::consts::EXE_SUFFIX);
    Ok(target.join(file))
}

/// Runs a command, which must succeed.
pub fn run(command: &mut Command) -> anyhow::Result<()> {
    let status = command.status().with_context(|| format!("{command:?}"))?;
    ensure!(status.success(), "{command:?}: {status}");
    Ok(())
}

/// Flags of the compiler that leave the paths of this machine out of a program.
pub fn without_paths(root: &Path) -> anyhow::Result<Vec<String>> {
    let home = std::env::home_dir().context("no home folder")?;
    let cargo = std::env::var_os("CARGO_HOME").map_or(home.join(".cargo"), PathBuf::from);
    let replaced = [(root, "/hairline"), (&*cargo, "/cargo")];
    let flag = |(from, to): (&Path, &str)| format!("--remap-path-prefix={}={to}", from.display());
    Ok(replaced.map(flag).to_vec())
}
