//! The viewer for browsers: a folder of static files, for any web server.

mod site;
mod thumbnail;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;
use flate2::Compression;
use flate2::write::GzEncoder;
use hairline_document::Description;
use serde_json::json;

use crate::program::run;
use crate::wasm;
use thumbnail::thumbnail;

#[derive(Args, Default)]
pub struct Web {
    /// Folder for the files.
    #[arg(short, long, default_value = "target/web")]
    output: PathBuf,
    /// Drive it in headless Chromium afterwards, and compare its picture with that of the command line.
    #[arg(long)]
    test: bool,
    /// Run only the steps of the drive that take less than two minutes.
    #[arg(long, requires = "test")]
    short: bool,
    /// The command line to compare with; without this one it is built.
    #[arg(long, requires = "test", value_name = "PATH")]
    program: Option<PathBuf>,
    /// Compile for tests: little is optimised, and warnings are errors.
    #[arg(long)]
    quick: bool,
}

/// Makes the folder as it is handed out.
pub fn make(output: &Path) -> anyhow::Result<()> {
    Web {
        output: output.to_owned(),
        ..Web::default()
    }
    .run()
}

impl Web {
    pub fn run(self) -> anyhow::Result<()> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("..")
            .canonicalize()?;
        if self.output.exists() {
            fs::remove_dir_all(&self.output)?;
        }
        fs::create_dir_all(&self.output)?;
        let output = self.output.canonicalize()?;
        let program = wasm::write(&root, "hairline-web", self.quick, "hairline", &output)?;
        copy_page(&root, &output)?;
        let pages = site::write(&root, &output)?;
        println!("{pages} pages of docs, from README.html on");
        let bytes = fs::metadata(&program)?.len();
        fs::write(
            output.join("size.json"),
            json!({ "bytes": bytes }).to_string(),
        )?;
        let compressed = gzip_bytes(&fs::read(&program)?)?;
        println!(
            "{}: {:.2} MB; {:.2} MB as servers send it, by gzip",
            program.display(),
            bytes as f64 / 1e6,
            compressed as f64 / 1e6
        );
        if self.test {
            return self.drive(&root, &output);
        }
        println!(
            "try it: python3 -m http.server --directory {}",
            self.output.display()
        );
        Ok(())
    }

    /// Drives the page by `tests/web/drive.mjs`.
    fn drive(&self, root: &Path, output: &Path) -> anyhow::Result<()> {
        let tests = root.join("tests/web");
        run(Command::new("npm")
            .current_dir(&tests)
            .args(["ci", "--no-audit", "--no-fund"]))?;
        let program = match &self.program {
            Some(program) => program.canonicalize()?,
            None => crate::program::build(root, "hairline")?,
        };
        run(Command::new("node")
            .current_dir(&tests)
            .arg("drive.mjs")
            .args(self.short.then_some("--short"))
            .arg(output)
            .arg(program))
    }
}

fn gzip_bytes(bytes: &[u8]) -> anyhow::Result<usize> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    packed.write_all(bytes)?;
    Ok(packed.finish()?.len())
}

/// Copies the page itself, with its pictures and scenes.
fn copy_page(root: &Path, output: &Path) -> anyhow::Result<()> {
    for name in ["index.html", "page.css", "page.js"] {
        fs::copy(root.join("apps/web/page").join(name), output.join(name))?;
    }
    fs::copy(
        root.join("crates/viewer/assets/hairline.png"),
        output.join("hairline.png"),
    )?;
    let opening = root.join("docs/pictures/hairline.png");
    thumbnail(&opening, &output.join("opening.jpg"), 800)?;

    let (scenes, copies) = (root.join("scenes"), output.join("scenes"));
    fs::create_dir(&copies)?;
    let mut list = Vec::new();
    for path in crate::pictures::scene_files(root)? {
        let text = fs::read_to_string(&path)?;
        let description = Description::from_toml(&text, &path)?;
        let title = path.file_stem().unwrap_or_default().to_string_lossy();
        let picture = root.join(format!("docs/pictures/{title}.png"));
        if !picture.exists() {
            println!(
                "{title} is not in the gallery: `cargo xtask pictures` has made no picture of it"
            );
            continue;
        }
        let file = format!("{title}.toml");
        fs::write(copies.join(&file), &text)?;
        thumbnail(&picture, &copies.join(format!("{title}.jpg")), 320)?;
        list.push(json!({ "file": file, "title": title, "about": first_sentence(&text) }));
        for input in description.inputs(Path::new("")) {
            let copy = copies.join(&input.path);
            fs::create_dir_all(copy.parent().unwrap_or(&copies))?;
            fs::copy(scenes.join(&input.path), copy)?;
        }
    }
    fs::write(output.join("scenes.json"), json!(list).to_string())?;
    Ok(())
}

/// The first sentence of the comment that a scene begins with.
fn first_sentence(text: &str) -> String {
    let comment = text.lines().map_while(|line| line.strip_prefix('#'));
    let whole = comment.map(str::trim).collect::<Vec<_>>().join(" ");
    let end = whole.find(". ").map_or(whole.len(), |end| end + 1);
    whole[..end].to_owned()
}
