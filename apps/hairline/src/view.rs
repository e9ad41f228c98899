//! `hairline view`: starts the viewer, a program of its own that lies beside this one.

use std::env;
use std::ffi::OsString;
use std::process::Command;

use anyhow::anyhow;
use hairline_render::failure::Failure;

/// Hands `arguments` to the viewer, and ends as it ends.
pub fn run(arguments: impl Iterator<Item = OsString>) -> Result<(), Failure> {
    let name = format!("hairline-viewer{}", env::consts::EXE_SUFFIX);
    let beside = env::current_exe().map(|program| program.with_file_name(&name));
    let Some(viewer) = beside.ok().filter(|viewer| viewer.is_file()) else {
        return Err(Failure::Work(anyhow!(
            "the viewer is a program of its own, and {name} does not lie beside this one: take it from the same release, or build it by \
             `cargo build --release -p hairline-viewer`; `hairline render` needs no window"
        )));
    };
    let mut command = Command::new(&viewer);
    command.args(arguments);
    let failed = |error: std::io::Error| {
        Failure::Work(anyhow!("{}: cannot be started: {error}", viewer.display()))
    };
    // In the place of this program where the system can do that: who waits for this one, or stops it, has the viewer.
    #[cfg(unix)]
    return Err(failed(std::os::unix::process::CommandExt::exec(
        &mut command,
    )));
    #[cfg(not(unix))]
    {
        let status = command.status().map_err(failed)?;
        std::process::exit(status.code().unwrap_or(1));
    }
}
