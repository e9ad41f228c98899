//! Output of the commands: results to stdout, progress to stderr. Nobody there to listen is no failure.

use std::fmt;
use std::io::{self, Write};
use std::panic::PanicHookInfo;

use anyhow::anyhow;
use hairline_document::text::printable;

use hairline_render::failure::Failure;

/// A line to stderr. Control characters in it are escaped, since parts of it come from files. What cannot be written is left out.
pub fn tell(line: impl fmt::Display) {
    let line = printable(&line.to_string());
    let _ = writeln!(io::stderr().lock(), "{line}");
}

/// A result to stdout.
///
/// # Errors
/// [`Failure::Work`] where it cannot be written, as on a full disk. A reader that has gone has read enough.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| Failure::Work(anyhow!("cannot write to stdout: {error}"))),
    }
}

/// Installs a hook that reports a panic, which is a mistake of this program, in one line, without the folders of the build.
pub fn tell_of_panics() {
    std::panic::set_hook(Box::new(|panic| tell(sentence(panic))));
}

fn sentence(panic: &PanicHookInfo) -> String {
    let payload = panic.payload();
    let what = payload
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("an unknown reason");
    let place = panic.location().map_or_else(String::new, |place| {
        format!(" at {}:{}", without_folders(place.file()), place.line())
    });
    format!("internal error{place}: {what}; please report it with the command and its files")
}

/// `crates/document/src/load.rs` of a path in the workspace, `gltf-1.4.1/src/lib.rs` of one in a registry.
fn without_folders(file: &str) -> String {
    let parts: Vec<&str> = file.split(['/', '\\']).collect();
    let source = parts.iter().rposition(|part| *part == "src");
    match (
        file.starts_with(['/', '\\']) || file.contains(":\\"),
        source,
    ) {
        (true, Some(source)) => parts[source.saturating_sub(1)..].join("/"),
        (true, None) => parts.last().copied().unwrap_or_default().to_owned(),
        (false, _) => file.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::without_folders;

    #[test]
    fn places_are_told_without_the_folders_of_a_machine() {
        assert_eq!(
            without_folders("crates/document/src/load.rs"),
            "crates/document/src/load.rs"
        );
        assert_eq!(
            without_folders("/home/x/.cargo/registry/src/index-1/gltf-1.4.1/src/lib.rs"),
            "gltf-1.4.1/src/lib.rs"
        );
        assert_eq!(
            without_folders("/rustc/abc/library/core/slice.rs"),
            "slice.rs"
        );
    }
}
