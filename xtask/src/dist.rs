//! What is handed out, for the machine that it is made on: programs, packages, the page; with their sums, sizes and the crates that are in them.

mod crates;
mod documents;
mod old_machines;
mod target;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use clap::{Args, ValueEnum};
use sha2::{Digest, Sha256};

use crate::archive::{self, copy};
use crate::wheel::{self, MATURIN};
use crate::{blender, package, wasm, web};
use target::{Place, Target};

#[derive(Args)]
pub struct Dist {
    /// Folder for all files.
    #[arg(short, long, default_value = "target/dist")]
    output: PathBuf,
    /// The interpreter, with venv, whose pip brings what builds programs for old machines, the wheel and Blender's zip.
    #[arg(long, default_value = "python3")]
    python: PathBuf,
    /// Make these parts alone, with commas between.
    #[arg(long, value_enum, value_delimiter = ',')]
    only: Vec<Part>,
}

/// A part of what is handed out.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, ValueEnum)]
enum Part {
    /// The archive with both programs.
    Programs,
    /// The package for Python.
    Wheel,
    /// The extension for Blender.
    Blender,
    /// The packages for npm.
    Npm,
    /// The viewer for browsers.
    Page,
}

const PROGRAMS: [&str; 2] = ["hairline", "hairline-viewer"];

/// Files of the repository that are copied beside the programs.
const COPIED: [(&str, &str); 7] = [
    ("README.md", "README.md"),
    ("CHANGELOG.md", "CHANGELOG.md"),
    (LICENCES[0], LICENCES[0]),
    (LICENCES[1], LICENCES[1]),
    ("scenes", "scenes"),
    ("docs", "docs"),
    // The icon, and the file that lists the program in menus.
    ("crates/viewer/assets", "desktop"),
];

/// Hairline's own licences.
const LICENCES: [&str; 2] = ["LICENSE-MIT", "LICENSE-APACHE"];

const COMPLETIONS: [(&str, &str); 5] = [
    ("bash", "hairline.bash"),
    ("zsh", "_hairline"),
    ("fish", "hairline.fish"),
    ("elvish", "hairline.elv"),
    ("powershell", "_hairline.ps1"),
];

/// What was made, and what is needed to make it.
struct Release {
    at: Place,
    output: PathBuf,
    python: PathBuf,
    target: Target,
    /// The wheel, and what it asks of a machine.
    wheel: Option<(PathBuf, String)>,
    /// Names of files, with what each asks of a machine.
    files: BTreeMap<String, String>,
    left_out: BTreeMap<Part, String>,
    crates: crates::Crates,
}

impl Dist {
    pub fn run(self) -> anyhow::Result<()> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let root = folder.parent().context("no repository")?.to_owned();
        let output = std::path::absolute(&self.output)?;
        let work = output.join("work");
        fs::create_dir_all(&work)?;
        for entry in fs::read_dir(&output)? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            if entry.path().is_file() && (name.starts_with("hairline") || LISTS.contains(&&*name)) {
                fs::remove_file(entry.path())?;
            }
        }
        let target = Target::of_this_machine()?;
        let packages = [&[MATURIN, wheel::PACKER], target.packages()].concat();
        let tools = wheel::environment(&self.python, &work, &packages)
            .map_err(|error| format!("no Python with venv and {}: {error}", packages.join(", ")));
        let mut release = Release {
            crates: crates::Crates::read(&root)?,
            at: Place {
                time: archive::time(&root)?,
                root,
                work,
                tools,
            },
            python: self.python,
            wheel: None,
            files: BTreeMap::new(),
            left_out: BTreeMap::new(),
            output,
            target,
        };
        for part in Part::value_variants() {
            if !self.only.is_empty() && !self.only.contains(part) {
                release.left_out.insert(*part, "not asked for".to_owned());
                continue;
            }
            match release.missing(*part) {
                Some(reason) => drop(release.left_out.insert(*part, reason)),
                None => release.make(*part)?,
            }
        }
        release.list()
    }
}

/// Lists that are made last.
const LISTS: [&str; 2] = ["CONTENTS.txt", "SHA256SUMS"];

impl Release {
    /// Why a part cannot be made here.
    fn missing(&self, part: Part) -> Option<String> {
        let no_tools = || self.at.tools.as_ref().err().cloned();
        let no_wasm = || {
            wasm::toolchain(&self.at.root)
                .err()
                .map(|it| it.to_string())
        };
        let has_npm = || Command::new("npm").arg("--version").output().is_ok();
        match part {
            Part::Programs if !cfg!(target_os = "linux") => None,
            Part::Programs | Part::Wheel => no_tools(),
            Part::Blender if !blender::IS_FOR_THIS_MACHINE => Some(blender::ELSEWHERE.to_owned()),
            Part::Blender => no_tools(),
            Part::Npm if !has_npm() => Some("no npm".to_owned()),
            Part::Npm | Part::Page => no_wasm(),
        }
    }

    fn make(&mut self, part: Part) -> anyhow::Result<()> {
        println!("== {part:?}");
        match part {
            Part::Programs => self.programs(),
            Part::Wheel => {
                let (wheel, asks) = self.wheel()?;
                self.hand_out(&wheel, format!("{asks}, Python 3.9 or later with numpy"))
            }
            Part::Blender => {
                let (wheel, asks) = self.wheel()?;
                let folder = self.at.work.join("blender");
                fs::create_dir_all(&folder)?;
                let time = self.at.time.to_string();
                let mut make = blender::make(&self.python, &self.at.root, &wheel, &folder);
                wheel::run(make.env("SOURCE_DATE_EPOCH", time))?;
                self.hand_out_all(&folder, "zip", &format!("{asks}, Blender 4.5 or 5.0"))
            }
            Part::Npm => {
                self.crates
                    .link(&["hairline-engine-web"], &[wasm::TARGET], "npm")?;
                self.crates.add_three("npm")?;
                let folder = self.at.work.join("npm");
                package::for_npm(&self.at.root, &folder, |package| {
                    self.crates.copy_licences("npm", &package.join("licences"))
                })?;
                self.hand_out_all(&folder, "tgz", "a browser with WebGPU")
            }
            Part::Page => {
                self.crates
                    .link(&["hairline-web"], &[wasm::TARGET], "page")?;
                let folder = self.at.work.join(self.versioned("hairline-page"));
                web::make(&folder)?;
                self.crates
                    .copy_licences("page", &folder.join("licences"))?;
                let asks = "a web server, and a browser with WebGPU (https, or localhost)";
                self.pack(&folder, asks.to_owned())
            }
        }
    }

    fn versioned(&self, name: &str) -> String {
        format!("{name}-{}", env!("CARGO_PKG_VERSION"))
    }

    /// The archive that is unpacked and run, without Rust and without this repository.
    fn programs(&mut self) -> anyhow::Result<()> {
        let triples = self.target.triples();
        self.crates.link(&PROGRAMS, &triples, "programs")?;
        let name = format!("{}-{}", self.versioned("hairline"), self.target.name());
        let folder = self.at.work.join(name);
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        fs::create_dir_all(&folder)?;
        // The first one starts the second, which lies beside it.
        let built = self.target.build(&self.at, &PROGRAMS, &folder)?;
        let asks = built.iter().map(|it| old_machines::asks(it));
        let asks = asks.collect::<anyhow::Result<Vec<_>>>()?;
        for (from, to) in COPIED {
            copy(&self.at.root.join(from), &folder.join(to))?;
        }
        documents::without_dead_links(&folder)?;
        let say = |arguments: &[&str], file: PathBuf| -> anyhow::Result<()> {
            let said = Command::new(&built[0]).args(arguments).output()?;
            ensure!(said.status.success(), "hairline {arguments:?} failed");
            fs::create_dir_all(file.parent().context("a file without a folder")?)?;
            Ok(fs::write(file, said.stdout)?)
        };
        for (shell, file) in COMPLETIONS {
            say(
                &["completions", shell],
                folder.join("completions").join(file),
            )?;
        }
        say(&["man"], folder.join("man/hairline.1"))?;
        let licences = folder.join("licences");
        self.crates.copy_licences("programs", &licences)?;
        copy(
            &self.at.root.join("crates/document/assets/text.txt"),
            &licences.join("text.ttf.txt"),
        )?;
        let viewer = "the viewer: a display (X11 or Wayland), its libraries, a graphics driver";
        let asks = asks.into_iter().max().unwrap_or_default();
        self.pack(&folder, format!("{asks}; {viewer}"))
    }

    /// The wheel, which is made once, and what it asks of a machine.
    fn wheel(&mut self) -> anyhow::Result<(PathBuf, String)> {
        if let Some(made) = &self.wheel {
            return Ok(made.clone());
        }
        let tools = self.at.tools.clone().map_err(anyhow::Error::msg)?;
        let triples = self.target.triples();
        self.crates.link(&["hairline-python"], &triples, "wheel")?;
        let folder = self.at.work.join("wheel");
        fs::create_dir_all(&folder)?;
        let set = |maturin: &mut Command| self.target.set_wheel(maturin, &self.at);
        let package = self.at.root.join("crates/python");
        let built = wheel::build(&package, &tools, &folder, set)?;
        let mut asks = String::new();
        let wheel = wheel::repack(
            &built,
            &tools,
            &folder,
            self.at.time,
            |unpacked, licences| {
                for licence in LICENCES {
                    copy(&self.at.root.join(licence), &licences.join(licence))?;
                }
                self.crates.copy_licences("wheel", licences)?;
                asks = old_machines::asks_of_wheel(unpacked)?;
                Ok(())
            },
        )?;
        Ok(self.wheel.insert((wheel, asks)).clone())
    }

    fn pack(&mut self, folder: &Path, asks: String) -> anyhow::Result<()> {
        let name = folder.file_name().context("a folder without a name")?;
        let file = format!("{}.tar.gz", name.to_string_lossy());
        let count = archive::pack(folder, &self.output.join(&file), self.at.time)?;
        println!("{file}: {count} files");
        self.files.insert(file, asks);
        Ok(())
    }

    fn hand_out_all(&mut self, folder: &Path, ending: &str, asks: &str) -> anyhow::Result<()> {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.extension().is_some_and(|it| it == ending) {
                self.hand_out(&path, asks.to_owned())?;
            }
        }
        Ok(())
    }

    fn hand_out(&mut self, file: &Path, asks: String) -> anyhow::Result<()> {
        let name = file.file_name().context("a file without a name")?;
        copy(file, &self.output.join(name))?;
        self.files.insert(name.to_string_lossy().into_owned(), asks);
        Ok(())
    }

    /// Writes the bill of materials, the list of all files, and their sums.
    fn list(mut self) -> anyhow::Result<()> {
        ensure!(
            !self.files.is_empty(),
            "nothing can be made: {:?}",
            self.left_out
        );
        let bill = format!(
            "{}-{}.cdx.json",
            self.versioned("hairline"),
            self.target.name()
        );
        fs::write(self.output.join(&bill), self.crates.bill()?)?;
        let meaning = "software bill of materials, CycloneDX";
        self.files.insert(bill, meaning.to_owned());
        let (mut contents, mut sums) = (String::new(), String::new());
        for (name, asks) in &self.files {
            let bytes = fs::read(self.output.join(name))?;
            contents += &format!("{:>11}  {name}\n{:13}{asks}\n", bytes.len(), "");
            sums += &format!("{}  {name}\n", sum(&bytes));
        }
        for (part, reason) in &self.left_out {
            contents += &format!("{:>11}  {part:?}: {reason}\n", "left out");
        }
        print!("{contents}");
        let [list, of_sums] = LISTS;
        sums += &format!("{}  {list}\n", sum(contents.as_bytes()));
        fs::write(self.output.join(list), contents)?;
        Ok(fs::write(self.output.join(of_sums), sums)?)
    }
}

fn sum(bytes: &[u8]) -> String {
    let sum = Sha256::digest(bytes);
    sum.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_is_handed_out_has_one_version() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let version = env!("CARGO_PKG_VERSION");
        for (file, line) in [
            (
                "packages/hairline-shaders/package.json",
                "\"version\": \"VERSION\"",
            ),
            (
                "packages/hairline-viewer/package.json",
                "\"version\": \"VERSION\"",
            ),
            (
                "packages/hairline-blender/addon/blender_manifest.toml",
                "\nversion = \"VERSION\"",
            ),
        ] {
            let text = fs::read_to_string(root.join(file)).unwrap();
            assert!(text.contains(&line.replace("VERSION", version)), "{file}");
        }
    }
}
