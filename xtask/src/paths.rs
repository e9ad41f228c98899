//! `cargo xtask paths`: files that the documents and the first lines of shaders name, in backticks or after "Twin:", must exist.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};

const DOCUMENTS: [&str; 5] = [
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "RELEASING.md",
    "docs/model.md",
];

/// Endings of paths to files of ours.
const ENDINGS: [&str; 4] = [".rs", ".wgsl", ".toml", ".md"];

/// Prints the paths that name no file.
///
/// # Errors
/// Where there is one.
pub fn run() -> anyhow::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let listed = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard"])
        .current_dir(&root)
        .output()
        .context("git ls-files")?;
    let listed = String::from_utf8(listed.stdout)?;
    let files: Vec<String> = listed.lines().map(|file| format!("/{file}")).collect();
    let mut missing = 0;
    let mut check = |place: &str, named: &str| {
        if !files
            .iter()
            .any(|file| file.ends_with(&format!("/{named}")))
        {
            missing += 1;
            println!("{place}: {named} is no file");
        }
    };
    let read =
        |name: &str| std::fs::read_to_string(root.join(name)).with_context(|| name.to_owned());
    for document in DOCUMENTS {
        for (i, line) in read(document)?.lines().enumerate() {
            // Every second part lies between backticks.
            for code in line.split('`').skip(1).step_by(2) {
                if is_path(code) && code.contains('/') {
                    check(&format!("{document}:{}", i + 1), code);
                }
            }
        }
    }
    for file in files.iter().filter(|file| file.ends_with(".wgsl")) {
        let text = read(&file[1..])?;
        for (i, line) in text.lines().enumerate() {
            let twins = line.split("Twin: ").chain(line.split("Twins: ")).skip(1);
            for twin in twins.flat_map(|twins| twins.split([' ', ',', ';'])) {
                let twin = twin.trim_end_matches('.');
                if is_path(twin) {
                    check(&format!("{}:{}", &file[1..], i + 1), twin);
                }
            }
        }
    }
    ensure!(missing == 0, "{missing} paths name no file");
    Ok(())
}

fn is_path(word: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    ENDINGS.iter().any(|ending| word.ends_with(ending)) && word.chars().all(is_plain)
}
