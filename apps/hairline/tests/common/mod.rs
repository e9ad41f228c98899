//! Helpers of the tests of the command line: a folder, a run in it, its output and the files that it leaves
//! behind.

#![allow(dead_code, reason = "each test file takes what it needs of it")]

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use hairline_fixtures::scenes::scratched_plate;

/// A plate under a lamp and a panel, with scratches, 24 x 16 pixels: small, and with all that a reference samples.
pub static SCRATCHED: LazyLock<String> = LazyLock::new(|| scratched_plate().to_string());

/// A new folder with one scene in it.
pub fn folder_with(name: &str, scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), scene).unwrap();
    folder
}

/// Makes a command to be run in `folder`; the arguments are separated by spaces.
pub fn command(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::cargo_bin("hairline").unwrap();
    command
        .current_dir(folder)
        .args(arguments.split_whitespace());
    command
}

/// Runs it.
pub fn hairline(folder: &Path, arguments: &str) -> Assert {
    command(folder, arguments).assert()
}

/// Standard output: the result.
pub fn stdout_of(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

/// Standard error: the messages.
pub fn stderr_of(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

/// Names in a folder, sorted.
pub fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}
