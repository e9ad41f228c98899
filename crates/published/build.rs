//! What Rust knows of the shaders of this crate, made of their own text as that of `hairline-gpu` is.

#[path = "../gpu/build/modules.rs"]
mod modules;

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use modules::Shaders;

fn main() -> io::Result<()> {
    let below = "../gpu/shaders";
    for read in ["shaders", below, "../gpu/build/modules.rs"] {
        println!("cargo::rerun-if-changed={read}");
    }
    let shaders = Shaders::read(Path::new("shaders"), "published/", "crate::shaders")?.on(
        Shaders::read(Path::new(below), "", "hairline_gpu::shaders")?,
    );
    let output = env::var_os("OUT_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    let folder = "env!(\"CARGO_MANIFEST_DIR\"), \"/shaders\"";
    fs::write(output.join("modules.rs"), shaders.rust(folder))
}
