//! The programs that tasks run or pack.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::ensure;

/// Builds a program of the workspace for use.
pub fn build(root: &Path, name: &str) -> anyhow::Result<PathBuf> {
    let status = Command::new("cargo")
        .current_dir(root)
        .args(["build", "--release", "-p", name])
        .status()?;
    ensure!(status.success(), "cargo build -p {name}: {status}");
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    let file = format!("release/{name}{}", std::env::consts::EXE_SUFFIX);
    Ok(target.join(file))
}
