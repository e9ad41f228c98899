//! The element `<hairline-viewer>`: one script, bundled of packages/hairline-viewer, the package for engines and three.js, and what it fetches; and a
//! look at it in Chromium.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};

use super::browser::{Folders, answers};
use super::files::{install, pack};
use super::pictures::write_model;
use crate::archive::copy;

/// The least share of the picture's pixels in which scratches have a colour: with grey lamps nothing else has one.
const COLOURED: f64 = 0.005;

/// What unpacks compressed meshes and pictures, in three.js: fetched for models that need it.
const DECODERS: [&str; 4] = [
    "draco/gltf/draco_decoder.wasm",
    "draco/gltf/draco_wasm_wrapper.js",
    "basis/basis_transcoder.js",
    "basis/basis_transcoder.wasm",
];

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
        .arg(shaders.join("src/engine_worker.js"))
        .args([
            "--bundle",
            "--format=esm",
            "--minify",
            "--log-level=warning",
        ])
        .args([alias("three"), alias("gltf")])
        .args([
            "--entry-names=[name]".to_owned(),
            format!("--outdir={}", element.display()),
        ])
        .env("NODE_PATH", &modules)
        .status()
        .context("esbuild cannot be run")?;
    ensure!(status.success(), "esbuild failed");
    for file in ["package.json", "README.md"] {
        copy(&by_hand.join(file), &element.join(file))?;
    }
    let types = "hairline-viewer.d.ts";
    copy(&by_hand.join("src").join(types), &element.join(types))?;
    for file in DECODERS.map(Path::new) {
        let name = file.file_name().context("a decoder without a name")?;
        copy(
            &modules.join("three/examples/jsm/libs").join(file),
            &element.join("decoders").join(name),
        )?;
    }
    let program = "engine_bg.wasm";
    copy(
        &shaders.join("engine").join(program),
        &element.join(program),
    )?;
    for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
        copy(&root.join(licence), &element.join(licence))?;
    }
    pack(&element)?;
    Ok(script.metadata()?.len())
}

/// Shows models, plain and packed, and checks that they have scratches in colour.
pub(super) fn look(root: &Path, output: &Path) -> anyhow::Result<()> {
    let tests = root.join("packages/hairline-viewer/test");
    let plate = root.join("packages/hairline-shaders/test/plate.toml");
    let models = output.join("models");
    write_model(&plate, &models.join("plate.glb"))?;
    for name in ["draco", "meshopt", "tiles"] {
        let scene = tests.join(format!("{name}.toml"));
        write_model(&scene, &models.join(format!("{name}.glb")))?;
    }
    let folders: Folders = vec![
        ("/element/", output.join("hairline-viewer")),
        ("/pages/", models),
        ("/test/", tests),
    ];
    let drawn = answers(folders, "/test/page.html")?;
    ensure!(drawn.len() == 4, "the page sent {} pictures", drawn.len());
    for (name, picture) in &drawn {
        println!(
            "hairline-viewer: {name}: {:.1} % of its pixels are coloured",
            100.0 * coloured(picture)?
        );
    }
    Ok(())
}

/// The share of a picture's pixels that have a colour, of codes of RGBA; an error where scratches would have more.
pub(super) fn coloured(picture: &[u8]) -> anyhow::Result<f64> {
    let (pixels, _) = picture.as_chunks::<4>();
    let is_coloured = |[r, g, b, _]: &&[u8; 4]| {
        let (least, most) = (*r.min(g).min(b), *r.max(g).max(b));
        most - least > 30
    };
    let share = pixels.iter().filter(is_coloured).count() as f64 / pixels.len() as f64;
    ensure!(share > COLOURED, "found no scratches in colour");
    Ok(share)
}
