//! `cargo xtask package`: the shaders for other engines, with tables and the JavaScript of packages/hairline-shaders, as one npm package
//! without a build step, and the file that npm installs; prints its sizes. `--pictures` also draws its test pages in Chromium, against the CPU renderer.

mod browser;
mod documents;
mod element;
mod examples;
mod files;
mod modules;
mod pictures;
mod tables;
mod types;

use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use hairline_gpu::shaders::{FOR_ENGINES, with_needs};

use crate::archive::{self, copy};
use crate::wasm;
use files::{install, node, pack, write};

/// The command's arguments.
#[derive(clap::Args, Default)]
pub struct Package {
    /// The folder that the package is made in.
    #[arg(short, long, default_value = "target/package")]
    output: PathBuf,
    /// Test it in Node: shaders by Chrome's compiler, and what it computes.
    #[arg(long)]
    test: bool,
    /// Draw the test pages in Chromium and compare them with the CPU renderer.
    #[arg(long)]
    pictures: bool,
    /// Make the element `<hairline-viewer>` beside it, one script, and look at it in Chromium: needs Node.
    #[arg(long)]
    viewer: bool,
    /// Build the examples for Vite and react-three-fiber of the file that npm installs, and look at them in Chromium: needs Node.
    #[arg(long)]
    examples: bool,
    /// Compile it for tests: little is optimised, and warnings are errors.
    #[arg(long)]
    quick: bool,
    /// Leave out what the package computes on the processor, the one part that is compiled.
    #[arg(long, conflicts_with_all = ["pictures", "viewer", "examples", "serve"])]
    shaders_alone: bool,
    /// Try the files that npm installs as they lie in this folder, in the place of making them: in the examples for Vite and react-three-fiber, and on
    /// plain pages. Needs Node and Chromium.
    #[arg(long, value_name = "FOLDER")]
    packed: Option<PathBuf>,
    /// Serve the example for three.js on this port of this machine, until it is ended.
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "8080")]
    serve: Option<u16>,
}

/// Files that are written by hand, beside the folder `src`.
const FILES: [&str; 2] = ["package.json", "README.md"];

const NAMES: [&str; 2] = ["hairline-shaders", "hairline-viewer"];

/// Makes the files that npm installs: the package for engines and the element for pages, with what `add` puts into each one's folder.
pub fn for_npm(
    root: &Path,
    output: &Path,
    add: impl Fn(&Path) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let package = Package {
        output: output.to_owned(),
        ..Package::default()
    };
    package.run()?;
    element::make(root, output)?;
    for name in NAMES {
        let folder = output.join(name);
        add(&folder)?;
        pack(&folder)?;
    }
    Ok(())
}

impl Package {
    /// Makes the package.
    pub fn run(self) -> anyhow::Result<()> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("..")
            .canonicalize()?;
        if let Some(folder) = &self.packed {
            let [shaders, element] =
                NAMES.map(|name| folder.join(format!("{name}-{}.tgz", env!("CARGO_PKG_VERSION"))));
            archive::unpack(&shaders, &self.output)?;
            archive::unpack(&element, &self.output)?;
            examples::look(&root, &self.output, &shaders)?;
            return element::look(&root, &self.output);
        }
        let by_hand = root.join("packages/hairline-shaders");
        let package = self.output.join("hairline-shaders");
        if package.exists() {
            std::fs::remove_dir_all(&package)?;
        }
        std::fs::create_dir_all(&package)?;
        for file in FILES {
            copy(&by_hand.join(file), &package.join(file))?;
        }
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            copy(&root.join(licence), &package.join(licence))?;
        }
        for entry in std::fs::read_dir(by_hand.join("src"))? {
            let entry = entry?;
            copy(&entry.path(), &package.join("src").join(entry.file_name()))?;
        }

        let all = with_needs(FOR_ENGINES);
        let whole = modules::single_file(&all);
        modules::validate(&whole)?;
        write(&package.join("wgsl/hairline.wgsl"), whole.as_bytes())?;
        for module in &all {
            let file = format!("wesl/{}.wesl", modules::short_name(module));
            write(&package.join(file), modules::wesl(module, &all).as_bytes())?;
        }
        let script = modules::script(&whole);
        write(&package.join("src/wgsl.js"), script.as_bytes())?;
        write(&package.join("src/data.js"), tables::data().as_bytes())?;
        write(&package.join("src/layer.d.ts"), types::layer().as_bytes())?;
        tables::write_gratings(&package.join("gratings"))?;
        let tests = by_hand.join("test");
        if self.test {
            node(&tests, &["check_shaders.mjs"], &self.output)?;
            let programs = documents::programs(&root, &self.output, &whole)?;
            types::check(&tests, &self.output, &programs)?;
        }
        if !self.shaders_alone {
            let engine = package.join("engine");
            wasm::write(&root, "hairline-engine-web", self.quick, "engine", &engine)?;
            print_sizes(&package)?;
            let packed = pack(&package)?;
            if self.test {
                node(&tests, &["check.mjs"], &self.output)?;
            }
            if self.examples {
                examples::look(&root, &self.output, &packed)?;
            }
        }
        if self.pictures {
            pictures::run(&root, &self.output)?;
        }
        if self.viewer {
            let bytes = element::make(&root, &self.output)?;
            println!("{:<28} {bytes:>9}", "hairline-viewer.js");
            element::look(&root, &self.output)?;
        }
        if let Some(port) = self.serve {
            install(&tests)?;
            let folders = vec![
                ("/package/", package),
                ("/three/", tests.join("node_modules/three")),
                ("/", by_hand.join("example")),
            ];
            browser::serve(folders, port)?;
        }
        Ok(())
    }
}

/// Prints the sizes of the files that a page loads, in bytes and compressed.
fn print_sizes(package: &Path) -> anyhow::Result<()> {
    let (mut scripts, mut for_three) = (Vec::new(), Vec::new());
    for entry in std::fs::read_dir(package.join("src"))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.ends_with(".js") {
            let is_for_three = name.starts_with("three") || name.starts_with("gltf");
            let list = if is_for_three {
                &mut for_three
            } else {
                &mut scripts
            };
            list.push(path.clone());
        }
    }
    scripts.sort();
    for_three.sort();
    let parts = [
        ("WGSL, one file", vec![package.join("wgsl/hairline.wgsl")]),
        ("JavaScript, the WGSL in it", scripts),
        ("for three.js", for_three),
        (
            "Hairline's own code",
            ["engine.js", "engine_bg.wasm"]
                .map(|file| package.join("engine").join(file))
                .to_vec(),
        ),
        ("a grating", vec![package.join("gratings/cd.bin")]),
    ];
    println!("{:<28} {:>9} {:>11}", "", "bytes", "compressed");
    for (what, files) in parts {
        let mut bytes = Vec::new();
        for file in files {
            bytes.extend(std::fs::read(file)?);
        }
        println!("{what:<28} {:>9} {:>11}", bytes.len(), compressed(&bytes)?);
    }
    Ok(())
}

/// Size as a server sends it, compressed.
fn compressed(bytes: &[u8]) -> anyhow::Result<usize> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?.len())
}
