//! The element `<hairline-viewer>`: one script, bundled of packages/hairline-viewer, the package for engines and three.js; and a look at it in
//! Chromium.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};

use super::browser::{Folders, answers};
use super::files::{copy, install};

/// The least share of the picture's pixels in which scratches have a colour: with grey lamps nothing else has one.
const COLOURED: f64 = 0.005;

/// Makes the element beside the package for engines, and returns the length of its script.
pub(super) fn make(root: &Path, output: &Path) -> anyhow::Result<u64> {
    let by_hand = root.join("packages/hairline-viewer");
    let tests = root.join("packages/hairline-shaders/test");
    install(&tests)?;
    let modules = tests.join("node_modules");
    let shaders = output.canonicalize()?.join("hairline-shaders");
    let element = output.join("hairline-viewer");
    let script = element.join("hairline-viewer.js");
    let alias = |name: &str| {
        let file = shaders.join(format!("src/{name}.js"));
        format!("--alias:hairline-shaders/{name}={}", file.display())
    };
    let status = Command::new(modules.join(".bin/esbuild"))
        .arg(by_hand.join("src/hairline-viewer.js"))
        .args([
            "--bundle",
            "--format=esm",
            "--minify",
            "--log-level=warning",
        ])
        .args([alias("three"), alias("gltf")])
        .arg(format!("--outfile={}", script.display()))
        .env("NODE_PATH", &modules)
        .status()
        .context("esbuild cannot be run")?;
    ensure!(status.success(), "esbuild failed");
    for file in ["package.json", "README.md"] {
        copy(&by_hand.join(file), &element.join(file))?;
    }
    let types = "hairline-viewer.d.ts";
    copy(&by_hand.join("src").join(types), &element.join(types))?;
    let program = "engine_bg.wasm";
    copy(
        &shaders.join("engine").join(program),
        &element.join(program),
    )?;
    Ok(script.metadata()?.len())
}

/// Shows a model that was written for the pictures, and checks that it has scratches in colour.
pub(super) fn look(root: &Path, output: &Path) -> anyhow::Result<()> {
    let folders: Folders = vec![
        ("/element/", output.join("hairline-viewer")),
        ("/pages/", output.join("pages")),
        ("/test/", root.join("packages/hairline-viewer/test")),
    ];
    let drawn = answers(folders, "/test/page.html")?;
    let found = drawn.iter().find(|(path, _)| path == "element");
    let (_, picture) = found.context("the page sent no picture")?;
    let (pixels, _) = picture.as_chunks::<4>();
    let is_coloured = |[r, g, b, _]: &&[u8; 4]| {
        let (least, most) = (*r.min(g).min(b), *r.max(g).max(b));
        most - least > 30
    };
    let coloured = pixels.iter().filter(is_coloured).count() as f64 / pixels.len() as f64;
    println!(
        "hairline-viewer: {:.1} % of its pixels are coloured",
        100.0 * coloured
    );
    ensure!(coloured > COLOURED, "the element shows no scratches");
    Ok(())
}
