//! Files of the package, and the npm packages of its tests.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use serde_json::Value;

use crate::archive;

/// Runs a test in its folder, with its npm packages installed there.
pub(super) fn node(folder: &Path, script: &[&str], output: &Path) -> anyhow::Result<()> {
    install(folder)?;
    let status = Command::new("node")
        .current_dir(folder)
        .args(script)
        .arg(output.canonicalize()?)
        .status()
        .context("node cannot be run")?;
    ensure!(status.success(), "{} failed", script.join(" "));
    Ok(())
}

/// Installs the packages that the tests need from npm, at the versions of the lock file.
pub(super) fn install(folder: &Path) -> anyhow::Result<()> {
    let changed =
        |file: &str| std::fs::metadata(folder.join(file)).and_then(|data| data.modified());
    let installed = changed("node_modules/.package-lock.json");
    if installed.is_ok_and(|at| changed("package-lock.json").is_ok_and(|lock| lock <= at)) {
        return Ok(());
    }
    let status = Command::new("npm")
        .current_dir(folder)
        .args(["ci", "--no-audit", "--no-fund"])
        .status()
        .context("npm cannot be run")?;
    ensure!(status.success(), "npm ci failed");
    Ok(())
}

/// Packs a package into the file that npm installs, beside its folder; returns its path.
pub(super) fn pack(package: &Path) -> anyhow::Result<PathBuf> {
    let output = package.parent().context("a package without a folder")?;
    let described: Value = serde_json::from_slice(&std::fs::read(package.join("package.json"))?)?;
    let [name, version] = ["name", "version"].map(|key| described[key].as_str().unwrap_or(""));
    let packed = output.join(format!("{name}-{version}.tgz"));
    // npm leaves out the first folder of paths, whatever its name.
    archive::pack(package, &packed, archive::time(package)?)?;
    println!("{}: what npm installs", packed.display());
    Ok(packed)
}

pub(super) fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    std::fs::write(path, bytes).with_context(|| format!("{} cannot be written", path.display()))
}
