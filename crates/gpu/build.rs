//! Shaders for a page, without comments and indentation: two thirds of the text, since a page has to download each byte. A program has the full
//! text.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=shaders");
    if env::var("CARGO_CFG_TARGET_FAMILY").is_ok_and(|family| family == "wasm") {
        let output = env::var_os("OUT_DIR").map(PathBuf::from);
        copy(Path::new("shaders"), &output.unwrap_or_default())?;
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let copied = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy(&entry.path(), &copied)?;
        } else {
            fs::write(copied, bare(&fs::read_to_string(entry.path())?))?;
        }
    }
    Ok(())
}

/// WGSL has no strings in which two strokes could stand, and the shaders no comments between other signs.
fn bare(text: &str) -> String {
    text.lines()
        .map(|line| line.split("//").next().unwrap_or("").trim())
        .filter(|line| !line.is_empty())
        .flat_map(|line| [line, "\n"])
        .collect()
}
