//! Programs for browsers: compiled for WebAssembly, with the JavaScript that calls them.

mod features;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use wasm_bindgen_cli_support::Bindgen;

use crate::program::without_paths;

pub(crate) const TARGET: &str = "wasm32-unknown-unknown";

/// Compiles a package of the workspace in a separate build folder and writes it, by a name, to a folder: `NAME_bg.wasm`, and `NAME.js`, which calls it.
/// Quick programs are for tests: little is optimised, and warnings are errors. Returns the path of the first file.
pub(crate) fn write(
    root: &Path,
    package: &str,
    is_quick: bool,
    name: &str,
    output: &Path,
) -> anyhow::Result<PathBuf> {
    let built = compile(root, package, is_quick)?;
    features::check(&built)?;
    // wasm-bindgen's version is the library's, to the last digit: both share a crate of which there is one
    // version at a time.
    Bindgen::new()
        .input_path(&built)
        .web(true)?
        .typescript(false)
        .remove_name_section(true)
        .remove_producers_section(true)
        .out_name(name)
        .generate(output)?;
    Ok(output.join(format!("{name}_bg.wasm")))
}

fn compile(root: &Path, package: &str, is_quick: bool) -> anyhow::Result<PathBuf> {
    let folder = root.join("target/browser");
    let profile = if is_quick { "web-quick" } else { "web" };
    // All browsers with WebGPU support SIMD, and the program is a fifteenth smaller with it.
    let mut flags = vec!["-Ctarget-feature=+simd128".to_owned()];
    if is_quick {
        // Code for browsers alone is compiled by no other check.
        flags.push("-Dwarnings".to_owned());
    } else {
        flags.extend(without_paths(root)?);
    }
    let mut cargo = Command::new("cargo");
    cargo
        .current_dir(root)
        .args(["build", "--profile", profile, "--package", package])
        .args(["--target", TARGET])
        .env("CARGO_TARGET_DIR", &folder)
        .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"));
    if let Some(toolchain) = toolchain(root)? {
        cargo
            .env("RUSTC", toolchain.join("bin/rustc"))
            .env("LD_LIBRARY_PATH", toolchain.join("lib"));
    }
    let status = cargo.status().context("cargo cannot be run")?;
    ensure!(status.success(), "{package} does not compile for {TARGET}");
    let file = format!("{}.wasm", package.replace('-', "_"));
    Ok(folder.join(TARGET).join(profile).join(file))
}

/// The toolchain that compiles for browsers, if it is not the one at hand.
///
/// # Errors
/// Where there is none.
pub(crate) fn toolchain(root: &Path) -> anyhow::Result<Option<PathBuf>> {
    let asked = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", TARGET])
        .output()?;
    if Path::new(String::from_utf8(asked.stdout)?.trim()).is_dir() {
        return Ok(None);
    }
    let toolchain = Command::new(root.join(".ci/browser-toolchain"))
        .arg(root.join("target/browser-toolchain"))
        .stderr(std::process::Stdio::inherit())
        .output();
    let toolchain = toolchain.ok().filter(|it| it.status.success());
    let toolchain = toolchain.with_context(|| {
        format!("no standard library for {TARGET}: `rustup target add {TARGET}` fetches one")
    })?;
    let path = String::from_utf8(toolchain.stdout)?;
    Ok(Some(PathBuf::from(path.trim())))
}
