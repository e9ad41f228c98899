//! The extension for Blender: a zip of `packages/hairline-blender` with the package for Python inside.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::ensure;

use crate::wheel::{self, MATURIN, run};

/// The command's arguments.
#[derive(clap::Args)]
pub struct Blender {
    /// Where the zip goes.
    #[arg(short, long, default_value = "target/blender")]
    output: PathBuf,
    /// The interpreter: for tests 3.11, which Blender as a module needs.
    #[arg(long, default_value = "python3")]
    python: PathBuf,
    /// Install the zip in Blender as a module, 373 MB of each version, and test it there. Skipped where it cannot be had.
    #[arg(long)]
    test: bool,
    /// A version of Blender to test with, as pip takes it, in the place of all.
    #[arg(long)]
    blender: Vec<String>,
    /// Render the pictures of docs/blender.md into docs/pictures.
    #[arg(long)]
    pictures: bool,
}

/// Whether the zip can be made here.
pub const IS_FOR_THIS_MACHINE: bool = cfg!(all(target_os = "linux", target_arch = "x86_64"));
pub const ELSEWHERE: &str = "made on Linux, x86-64, alone";

/// What makes the zip of a wheel.
pub fn make(python: &Path, root: &Path, wheel: &Path, output: &Path) -> Command {
    let mut make = Command::new(python);
    make.arg(root.join("packages/hairline-blender/make.py"))
        .arg(wheel)
        .arg("--output")
        .arg(output);
    make
}

impl Blender {
    pub fn run(self) -> anyhow::Result<()> {
        ensure!(IS_FOR_THIS_MACHINE, "{ELSEWHERE}");
        let root = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("..")
            .canonicalize()?;
        std::fs::create_dir_all(&self.output)?;
        let output = self.output.canonicalize()?;
        let programs = wheel::environment(&self.python, &output, &[MATURIN])?;
        let wheel = wheel::build(&root.join("crates/python"), &programs, &output, |_| Ok(()))?;
        let mut make = make(&self.python, &root, &wheel, &output);
        for version in &self.blender {
            make.args(["--blender", version]);
        }
        if self.test {
            make.arg("--test");
        }
        if self.pictures {
            make.arg("--pictures").arg(root.join("docs/pictures"));
        }
        run(&mut make)
    }
}
