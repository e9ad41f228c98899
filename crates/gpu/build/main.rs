//! What Rust knows of shaders, made of their own text: the modules with what each needs and binds, a struct of the bindings of each pass, and the structs that host and shaders share. For a
//! page also the shaders without comments and indentation, two thirds of the text, since a page has to download each byte. A program has the full text.

mod layout;
mod modules;
mod passes;

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use modules::Shaders;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=shaders");
    println!("cargo::rerun-if-changed=build");
    let output = env::var_os("OUT_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    let shaders = Shaders::read(Path::new("shaders"), "", "crate::shaders")?;
    let is_for_pages = env::var("CARGO_CFG_TARGET_FAMILY").is_ok_and(|family| family == "wasm");
    let folder = match is_for_pages {
        true => "env!(\"OUT_DIR\")",
        false => "env!(\"CARGO_MANIFEST_DIR\"), \"/shaders\"",
    };
    fs::write(output.join("modules.rs"), shaders.rust(folder))?;
    fs::write(output.join("passes.rs"), passes::rust(&shaders))?;
    let layout = shaders.parse("layout");
    fs::write(output.join("layout.rs"), layout::rust(&layout))?;
    if is_for_pages {
        copy(Path::new("shaders"), &output)?;
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
