//! Runs a case and judges how it ended.

use std::fs::File;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

use super::case::Case;

/// Largest factor of a case's time over its processor time, on a machine with much else to do.
const PATIENCE: u64 = 10;
/// A message of one line is no longer than this.
const LONGEST_MESSAGE: usize = 4096;

/// Memory of the program itself and tolerance of its estimate of a scene, in MiB.
const UNCOUNTED_MEBIBYTES: u64 = 192;

/// Limits of time and memory of a case.
pub struct Limits {
    pub seconds: u64,
    pub mebibytes: u64,
}

/// Renders the case's scene in `folder`. `None` where all is well: a picture, or a message and no picture.
pub fn judge(
    program: &Path,
    case: &Case,
    folder: &Path,
    limits: &Limits,
) -> Result<Option<String>> {
    case.write(folder)?;
    let message = folder.join("stderr");
    let mut child = limited(program, limits)
        .args(["render", "scene.toml", "-o", "out.png", "--backend", "cpu"])
        .args(["--samples", "1", "--size", "16x9"])
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(&message)?)
        .spawn()
        .context("start hairline")?;
    let start = Instant::now();
    let mut most_mebibytes = 0;
    let status = loop {
        most_mebibytes = most_mebibytes.max(resident_mebibytes(child.id()));
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if start.elapsed() > Duration::from_secs(PATIENCE * limits.seconds) {
            child.kill()?;
            child.wait()?;
            return Ok(Some(format!("hung for {} s", PATIENCE * limits.seconds)));
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let text = String::from_utf8_lossy(&std::fs::read(&message)?).into_owned();
    if let Some(finding) = finding(status, &text, folder) {
        return Ok(Some(finding));
    }
    if status.success() && most_mebibytes > UNCOUNTED_MEBIBYTES {
        let estimate = estimated_mebibytes(program, folder, limits)?;
        if most_mebibytes > estimate + UNCOUNTED_MEBIBYTES {
            return Ok(Some(format!(
                "took {most_mebibytes} MiB, where {estimate} MiB were estimated"
            )));
        }
    }
    Ok(None)
}

/// Peak memory of a process, in MiB; 0 where the system does not report it.
fn resident_mebibytes(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse().ok());
    kibibytes.unwrap_or(0_u64) / 1024
}

/// Memory of the scene by `hairline info`.
fn estimated_mebibytes(program: &Path, folder: &Path, limits: &Limits) -> Result<u64> {
    let output = limited(program, limits)
        .args(["info", "--json", "scene.toml"])
        .current_dir(folder)
        .output()
        .context("start hairline")?;
    let contents: serde_json::Value =
        serde_json::from_slice(&output.stdout).context("read what hairline info says")?;
    let bytes = contents["memory"]["estimate_bytes"].as_f64();
    Ok((bytes.context("no estimate_bytes")? / f64::from(1 << 20)) as u64)
}

/// Command that runs the program with limits of processor time and memory, where there is a shell that
/// sets them.
fn limited(program: &Path, limits: &Limits) -> Command {
    if cfg!(unix) {
        let mut shell = Command::new("sh");
        let script = format!(
            "ulimit -v {}; ulimit -t {}; ulimit -c 0; exec \"$0\" \"$@\"",
            limits.mebibytes * 1024,
            limits.seconds
        );
        shell.args(["-c", &script]).arg(program);
        return shell;
    }
    Command::new(program)
}

fn finding(status: ExitStatus, text: &str, folder: &Path) -> Option<String> {
    let last = text.lines().last().unwrap_or_default();
    let is_picture = folder.join("out.png").exists();
    let left = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut left = left.map(|entry| entry.file_name().to_string_lossy().into_owned());
    if text.contains("internal error") || text.contains("panicked") {
        return Some(format!("panicked: {text}"));
    }
    if let Some(name) = left.find(|name| name.ends_with(".tmp")) {
        return Some(format!("left {name}"));
    }
    if text.len() > LONGEST_MESSAGE || text.chars().any(|c| c.is_control() && c != '\n') {
        return Some(format!(
            "said {} bytes, or what a terminal obeys",
            text.len()
        ));
    }
    match (status.code(), is_picture) {
        (Some(0), true) => None,
        (Some(1 | 2), false) if last.starts_with("error: ") => None,
        (Some(code), _) => Some(format!(
            "exit code {code}, {} picture: {text}",
            if is_picture { "a" } else { "no" }
        )),
        (None, _) => Some(format!("ended by a signal ({status}): {text}")),
    }
}
