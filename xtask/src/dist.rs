//! A release: an archive that is unpacked and run, without Rust and without this repository.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail, ensure};
use clap::Args;
use serde_json::Value;

use crate::program;

#[derive(Args)]
pub struct Dist {
    /// Path of the archive.
    #[arg(short, long, default_value = "target/dist")]
    output: PathBuf,
}

const PROGRAMS: [&str; 2] = ["hairline", "hairline-viewer"];

/// Files of the repository that are copied beside the programs.
const COPIED: [&str; 8] = [
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "scenes",
    "docs",
];

impl Dist {
    pub fn run(self) -> anyhow::Result<()> {
        ensure!(
            cfg!(target_os = "linux"),
            "archives are made on Linux alone so far; elsewhere: cargo install --path apps/hairline, and apps/hairline-viewer"
        );
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let name = format!(
            "hairline-{}-{}-linux",
            env!("CARGO_PKG_VERSION"),
            std::env::consts::ARCH
        );
        fs::create_dir_all(&self.output)?;
        let output = self.output.canonicalize()?;
        let folder = output.join(&name);
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        fs::create_dir(&folder)?;

        let metadata = metadata(&root)?;
        // The first one starts the second, which lies beside it.
        for name in PROGRAMS {
            let program = folder.join(name);
            fs::copy(program::build(&root, name)?, &program)?;
            run(Command::new("strip").arg(&program))?;
        }
        for name in COPIED {
            copy(&root.join(name), &folder.join(name))?;
        }
        // The icon, and the file that lists the program in menus.
        copy(&root.join("crates/viewer/assets"), &folder.join("desktop"))?;
        let licences = folder.join("licences");
        copy_licences(&root, &metadata, &licences)?;
        copy(
            &root.join("crates/scene/assets/text.txt"),
            &licences.join("text.ttf.txt"),
        )?;

        let archive = output.join(format!("{name}.tar.gz"));
        run(Command::new("tar")
            .args(["--owner=0", "--group=0", "--sort=name", "-czf"])
            .arg(&archive)
            .arg("-C")
            .arg(&output)
            .arg(&name))?;
        println!("{}", archive.display());
        Ok(())
    }
}

fn run(command: &mut Command) -> anyhow::Result<()> {
    let status = command.status().with_context(|| format!("{command:?}"))?;
    ensure!(status.success(), "{command:?}: {status}");
    Ok(())
}

fn metadata(root: &Path) -> anyhow::Result<Value> {
    let output = Command::new("cargo")
        .current_dir(root)
        .args(["metadata", "--format-version", "1", "--locked"])
        .output()?;
    ensure!(
        output.status.success(),
        "cargo metadata: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    Ok(serde_json::from_slice(&output.stdout)?)
}

/// Copies a file, or a folder with all its contents.
fn copy(from: &Path, to: &Path) -> anyhow::Result<()> {
    if !from.is_dir() {
        fs::create_dir_all(to.parent().context("a file without a folder")?)?;
        fs::copy(from, to).with_context(|| from.display().to_string())?;
        return Ok(());
    }
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        copy(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}

/// Copies the licence files of the crates that are linked into the program, a folder for each crate, and a list of all with the names
/// of their licences.
fn copy_licences(root: &Path, metadata: &Value, to: &Path) -> anyhow::Result<()> {
    let linked = linked(root)?;
    let mut list = String::new();
    let packages = metadata["packages"].as_array().context("no packages")?;
    for package in packages {
        let text = |key: &str| package[key].as_str().unwrap_or_default();
        let name = format!("{} {}", text("name"), text("version"));
        // Packages without a source are Hairline's own.
        if package["source"].is_null() || !linked.contains(&name) {
            continue;
        }
        list += &format!("{name}: {}\n", text("license"));
        let manifest = Path::new(text("manifest_path"));
        let folder = manifest.parent().context("a manifest without a folder")?;
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            let file = entry.file_name().to_string_lossy().to_uppercase();
            let is_licence = ["LICENSE", "LICENCE", "COPYING", "NOTICE"]
                .iter()
                .any(|start| file.starts_with(start));
            if is_licence && entry.path().is_file() {
                let crate_folder = to.join(name.replace(' ', "-"));
                copy(&entry.path(), &crate_folder.join(entry.file_name()))?;
            }
        }
    }
    if list.is_empty() {
        bail!("cargo metadata names no dependency");
    }
    fs::write(to.join("LIST.txt"), list)?;
    Ok(())
}

/// "NAME VERSION" of all crates that are linked into the program on this machine.
fn linked(root: &Path) -> anyhow::Result<BTreeSet<String>> {
    let output = Command::new("cargo")
        .current_dir(root)
        .args([
            "tree",
            "--locked",
            "-p",
            "hairline",
            "-p",
            "hairline-viewer",
            "-e",
            "normal",
        ])
        .args(["--prefix", "none", "--format", "{p}"])
        .output()?;
    ensure!(output.status.success(), "cargo tree failed");
    let text = String::from_utf8(output.stdout)?;
    let names = text.lines().filter_map(|line| {
        let mut words = line.split_whitespace();
        let (name, version) = (words.next()?, words.next()?);
        Some(format!("{name} {}", version.strip_prefix('v')?))
    });
    Ok(names.collect())
}
