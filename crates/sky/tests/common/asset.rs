//! Files for tests that are no part of the repository.

use std::io::Write;
use std::path::{Path, PathBuf};

/// Path of an asset that is kept beside the repository and is no part of it; if it is missing, prints so to stderr.
pub fn asset(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/assets")
        .join(name);
    if path.exists() {
        return Some(path);
    }
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    let line = format!("skipped: {test}: no {name} in shared/assets\n");
    // Not eprintln: the test harness hides what it prints unless the test fails.
    let _ = std::io::stderr().write_all(line.as_bytes());
    None
}
