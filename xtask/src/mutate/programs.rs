//! Test programs of the copy: how they are built and run.

use std::collections::BTreeMap;
use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, ensure};
use serde_json::Value;

/// Start of the names of programs with unit tests.
const UNIT: &str = "hairline_";

/// A test program, and the folder of its package, in which it runs.
pub(super) struct Program {
    file: PathBuf,
    folder: PathBuf,
}

/// Builds test programs of the copy, for which it takes crates of others from the workspace's own builds.
pub(super) fn build(
    copy: &Path,
    target: &Path,
    names: &[&str],
) -> anyhow::Result<BTreeMap<String, Program>> {
    let mut command = Command::new("cargo");
    command
        .current_dir(copy)
        .env("CARGO_TARGET_DIR", target)
        .args(["test", "--release", "--no-run", "--workspace"])
        .arg("--message-format=json-render-diagnostics");
    if names.iter().any(|name| name.starts_with(UNIT)) {
        command.arg("--lib");
    }
    for name in names.iter().filter(|name| !name.starts_with(UNIT)) {
        command.args(["--test", name]);
    }
    let built = command.stderr(Stdio::inherit()).output()?;
    ensure!(built.status.success(), "{command:?}: {}", built.status);
    let mut programs = BTreeMap::new();
    for line in String::from_utf8(built.stdout)?.lines() {
        let message: Value = serde_json::from_str(line)?;
        let text = |value: &Value| value.as_str().map(str::to_owned);
        let (made, target) = (text(&message["executable"]), &message["target"]);
        let (Some(file), Some(true)) = (made, message["profile"]["test"].as_bool()) else {
            continue;
        };
        let (name, manifest) = (text(&target["name"]), text(&message["manifest_path"]));
        let (name, manifest) = name.zip(manifest).context("a program without a name")?;
        let folder = Path::new(&manifest).parent();
        let program = Program {
            file: file.into(),
            folder: folder.context("a manifest without a folder")?.into(),
        };
        // A library may have the name of a program of tests.
        if target["kind"][0] == "test" || name.starts_with(UNIT) {
            programs.insert(name, program);
        }
    }
    Ok(programs)
}

/// The end of a run.
#[derive(Debug)]
pub(super) struct RunResult {
    pub passed: Vec<String>,
    pub failed: Vec<String>,
    /// How it ended, if not well.
    pub ending: Option<String>,
    pub seconds: f64,
}

impl Program {
    /// Runs the tests that match one of some filters, with the fault of a row, or 0 for none.
    pub fn run(&self, root: &Path, filters: &[&str], mutant: usize) -> anyhow::Result<RunResult> {
        // Efficiencies of gratings are kept there; those of a fault must not outlive it.
        let cache = tempfile::tempdir()?;
        let mut command = Command::new(&self.file);
        command
            .current_dir(&self.folder)
            .args(filters)
            .env("CARGO_MANIFEST_DIR", &self.folder)
            .env("HAIRLINE_MUTANT", mutant.to_string())
            .env("XDG_CACHE_HOME", cache.path());
        // As in .cargo/config.toml.
        for (name, value) in [
            ("GALLIVM_PERF", "nopt".into()),
            ("LP_NATIVE_VECTOR_WIDTH", "128".into()),
            ("MESA_SHADER_CACHE_DIR", root.join("target/shaders")),
            ("XDG_RUNTIME_DIR", PathBuf::from("/nonexistent")),
        ] {
            if env::var_os(name).is_none() {
                command.env(name, value);
            }
        }
        let start = Instant::now();
        let run = command
            .output()
            .with_context(|| self.file.display().to_string())?;
        let lines = String::from_utf8_lossy(&run.stdout);
        let tests = |ending: &str| -> Vec<String> {
            let name = |line: &str| Some(line.strip_prefix("test ")?.strip_suffix(ending)?.into());
            lines.lines().filter_map(name).collect()
        };
        Ok(RunResult {
            passed: tests(" ... ok"),
            failed: tests(" ... FAILED"),
            ending: (!run.status.success()).then(|| run.status.to_string()),
            seconds: start.elapsed().as_secs_f64(),
        })
    }
}
