//! The package for Python: a wheel, tested in an environment that has nothing else.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use clap::Args;

#[derive(Args)]
pub struct Wheel {
    /// Where the wheel goes.
    #[arg(short, long, default_value = "target/wheel")]
    output: PathBuf,
    /// The interpreter that it is tested with.
    #[arg(long, default_value = "python3")]
    python: PathBuf,
    /// Compare all scenes with the command line, also those that take long.
    #[arg(long)]
    all_scenes: bool,
}

/// What builds it and what tests it.
const TOOLS: [&str; 8] = [
    "maturin>=1.9,<2",
    "numpy",
    "pillow",
    "pytest",
    "mypy",
    "typing_extensions",
    "distributed",
    "matplotlib",
];

impl Wheel {
    pub fn run(self) -> anyhow::Result<()> {
        ensure!(
            cfg!(target_os = "linux"),
            "made on Linux alone; docs/python.md says how elsewhere"
        );
        let root = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("..")
            .canonicalize()?;
        let package = root.join("crates/python");
        std::fs::create_dir_all(&self.output)?;
        let output = self.output.canonicalize()?;
        let environment = output.join("environment");
        run(Command::new(&self.python)
            .args(["-m", "venv", "--clear"])
            .arg(&environment))?;
        let programs = environment.join("bin");
        let python = || Command::new(programs.join("python"));
        let quietly = [
            "-m",
            "pip",
            "install",
            "--quiet",
            "--disable-pip-version-check",
        ];
        run(python().args(quietly).args(TOOLS))?;

        for old in wheels(&output)? {
            std::fs::remove_file(old)?;
        }
        run(Command::new(programs.join("maturin"))
            .args(["build", "--release", "--quiet", "--out"])
            .arg(&output)
            .arg("--manifest-path")
            .arg(package.join("Cargo.toml"))
            .env("CARGO", package.join("cargo-of-workspace")))?;
        let wheels = wheels(&output)?;
        let wheel = wheels.first().context("maturin made no wheel")?;
        run(python().args(quietly).arg("--no-deps").arg(wheel))?;

        // From elsewhere: the package that is tested is the one that was installed.
        let target = root.join("target");
        let target = std::env::var_os("CARGO_TARGET_DIR").map_or(target, PathBuf::from);
        run(python()
            .current_dir(&output)
            .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
            .arg(package.join("tests"))
            .env("HAIRLINE_PROGRAM", target.join("release/hairline"))
            .env("HAIRLINE_REPOSITORY", &root)
            .env(
                "HAIRLINE_ALL_SCENES",
                if self.all_scenes { "1" } else { "" },
            ))?;
        let notebooks = root.join("docs/notebooks/run.py");
        run(python().current_dir(&output).arg(notebooks))?;
        let types = ["-m", "mypy", "--cache-dir=/dev/null"];
        run(python().current_dir(&package).args(types))?;
        let bytes = std::fs::metadata(wheel)?.len();
        println!("{}: {:.1} MB", wheel.display(), bytes as f64 / 1e6);
        Ok(())
    }
}

fn wheels(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let paths = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
    let paths: Vec<PathBuf> = paths.collect::<std::io::Result<_>>()?;
    let is_wheel = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "whl");
    Ok(paths.into_iter().filter(is_wheel).collect())
}

fn run(command: &mut Command) -> anyhow::Result<()> {
    let status = command.status().with_context(|| format!("{command:?}"))?;
    ensure!(status.success(), "{command:?}: {status}");
    Ok(())
}
