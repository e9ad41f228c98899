//! Runs a case and says what is wrong with how it ended.

use std::fs::File;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

use super::Case;

/// On a machine with much else to do, a case may take so many times its processor time.
const PATIENCE: u64 = 10;
/// A message of one line is no longer than this.
const LONGEST_MESSAGE: usize = 4096;

/// What a case may take.
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
    super::write(case, folder)?;
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
    let status = loop {
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
    Ok(finding(status, &text, folder))
}

/// The program with limits of its processor time and memory, where there is a shell that sets them.
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
