//! The crates that are in what is handed out: their licences, and a software bill of materials.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use serde_json::{Value, json};

use crate::archive::copy;

/// Beginnings of names of files that hold a licence; the last is that of Rust's own library.
const LICENCES: [&str; 5] = [
    "LICENSE",
    "LICENCE",
    "COPYING",
    "NOTICE",
    "COPYRIGHT-LIBRARY",
];

/// Crates, and packages of npm, that are linked into a part.
pub struct Crates {
    root: PathBuf,
    /// Rust's own library, which is in all of them.
    std: Id,
    /// All crates that a build may have.
    known: BTreeMap<Id, Crate>,
    /// Those that are linked, with the parts that hold them.
    linked: BTreeMap<Id, BTreeSet<&'static str>>,
}

/// Name and version.
type Id = (String, String);

struct Crate {
    licence: String,
    /// Where its files lie, if they do.
    folder: Option<PathBuf>,
    /// Sum of what the registry hands out.
    sha256: Option<String>,
    registry: &'static str,
}

impl Crates {
    pub fn read(root: &Path) -> anyhow::Result<Self> {
        let asked = Command::new("cargo")
            .current_dir(root)
            .args(["metadata", "--format-version", "1", "--locked"])
            .output()?;
        let said = String::from_utf8_lossy(&asked.stderr);
        ensure!(asked.status.success(), "cargo metadata: {said}");
        let metadata: Value = serde_json::from_slice(&asked.stdout)?;
        let lock: toml::Table = fs::read_to_string(root.join("Cargo.lock"))?.parse()?;
        let sums = lock["package"].as_array().into_iter().flatten();
        let text = |it: &toml::Value, key| Some(it.get(key)?.as_str()?.to_owned());
        let sums: BTreeMap<Id, String> = sums
            .filter_map(|package| {
                Some((
                    (text(package, "name")?, text(package, "version")?),
                    text(package, "checksum")?,
                ))
            })
            .collect();
        let mut known = BTreeMap::new();
        for package in metadata["packages"].as_array().into_iter().flatten() {
            // Packages without a source are Hairline's own.
            if package["source"].is_null() {
                continue;
            }
            let text = |key: &str| package[key].as_str().unwrap_or_default();
            let id = (text("name").to_owned(), text("version").to_owned());
            let sha256 = sums.get(&id).cloned();
            let of = Crate {
                licence: text("license").to_owned(),
                folder: Path::new(text("manifest_path"))
                    .parent()
                    .map(Path::to_owned),
                sha256,
                registry: "cargo",
            };
            known.insert(id, of);
        }
        let rustc = |argument: &str| -> anyhow::Result<String> {
            let said = Command::new("rustc").args(argument.split(' ')).output()?;
            Ok(String::from_utf8(said.stdout)?.trim().to_owned())
        };
        let version = rustc("-V")?;
        let version = version.split_whitespace().nth(1).unwrap_or_default();
        let documents = Path::new(&rustc("--print sysroot")?).join("share/doc/rust");
        let of = Crate {
            licence: "MIT OR Apache-2.0".to_owned(),
            // Without documents the compiler brings no licences.
            folder: documents.is_dir().then_some(documents),
            sha256: None,
            registry: "generic",
        };
        let std = ("rust-std".to_owned(), version.to_owned());
        known.insert(std.clone(), of);
        Ok(Self {
            std,
            root: root.to_owned(),
            known,
            linked: BTreeMap::new(),
        })
    }

    /// Adds the crates that are linked into packages of ours.
    pub fn link(
        &mut self,
        packages: &[&str],
        targets: &[&str],
        part: &'static str,
    ) -> anyhow::Result<()> {
        let asked = Command::new("cargo")
            .current_dir(&self.root)
            .args(["tree", "--locked", "-e", "normal,no-proc-macro"])
            .args(["--prefix", "none", "--format", "{p}"])
            .args(packages.iter().flat_map(|it| ["-p", it]))
            .args(targets.iter().flat_map(|it| ["--target", it]))
            .output()?;
        let said = String::from_utf8_lossy(&asked.stderr);
        ensure!(asked.status.success(), "cargo tree: {said}");
        self.linked
            .entry(self.std.clone())
            .or_default()
            .insert(part);
        for line in String::from_utf8(asked.stdout)?.lines() {
            let mut words = line.split_whitespace();
            if let (Some(name), Some(version)) = (words.next(), words.next()) {
                let version = version.strip_prefix('v').unwrap_or(version);
                let id = (name.to_owned(), version.to_owned());
                if self.known.contains_key(&id) {
                    self.linked.entry(id).or_default().insert(part);
                }
            }
        }
        Ok(())
    }

    /// Adds three.js, which is in the element for pages.
    pub fn add_three(&mut self, part: &'static str) -> anyhow::Result<()> {
        let tests = self.root.join("packages/hairline-shaders/test");
        let lock = fs::read(tests.join("package-lock.json"))?;
        let lock: Value = serde_json::from_slice(&lock)?;
        let three = &lock["packages"]["node_modules/three"];
        let version = three["version"].as_str().context("no version of three")?;
        let id = ("three".to_owned(), version.to_owned());
        let of = Crate {
            licence: three["license"].as_str().unwrap_or("MIT").to_owned(),
            // Installed there before licences are copied.
            folder: Some(tests.join("node_modules/three")),
            sha256: None,
            registry: "npm",
        };
        self.known.insert(id.clone(), of);
        self.linked.entry(id).or_default().insert(part);
        Ok(())
    }

    /// Copies the licence files of a part's crates, a folder for each crate, and a list of all with the names of their licences.
    pub fn copy_licences(&self, part: &'static str, to: &Path) -> anyhow::Result<()> {
        let mut list = String::new();
        for (id, _) in self.linked.iter().filter(|(_, parts)| parts.contains(part)) {
            let (name, version) = id;
            let of = &self.known[id];
            list += &format!("{name} {version}: {}\n", of.licence);
            let Some(folder) = &of.folder else {
                continue;
            };
            for entry in fs::read_dir(folder)? {
                let entry = entry?;
                let file = entry.file_name().to_string_lossy().to_uppercase();
                let is_licence = LICENCES.iter().any(|start| file.starts_with(start));
                if is_licence && entry.path().is_file() {
                    let folder = to.join(format!("{name}-{version}"));
                    copy(&entry.path(), &folder.join(entry.file_name()))?;
                }
            }
        }
        ensure!(!list.is_empty(), "{part} has no crates");
        fs::create_dir_all(to)?;
        Ok(fs::write(to.join("LIST.txt"), list)?)
    }

    /// The bill of all parts, as CycloneDX.
    pub fn bill(&self) -> anyhow::Result<String> {
        let version = env!("CARGO_PKG_VERSION");
        let components = self.linked.iter().map(|(id, parts)| {
            let (name, version) = id;
            let of = &self.known[id];
            let purl = format!("pkg:{}/{name}@{version}", of.registry);
            let parts = parts
                .iter()
                .map(|it| json!({ "name": "hairline:part", "value": it }));
            let sums = of
                .sha256
                .iter()
                .map(|it| json!({ "alg": "SHA-256", "content": it }));
            json!({
                "type": "library",
                "bom-ref": purl,
                "name": name,
                "version": version,
                "purl": purl,
                // As old manifests write it.
                "licenses": [{ "expression": of.licence.replace('/', " OR ") }],
                "hashes": sums.collect::<Vec<_>>(),
                "properties": parts.collect::<Vec<_>>(),
            })
        });
        let bill = json!({
            "bomFormat": "CycloneDX",
            "specVersion": "1.5",
            "version": 1,
            "metadata": { "component": {
                "type": "application",
                "bom-ref": format!("hairline@{version}"),
                "name": "hairline",
                "version": version,
                "licenses": [{ "expression": env!("CARGO_PKG_LICENSE") }],
            }},
            "components": components.collect::<Vec<_>>(),
        });
        Ok(serde_json::to_string_pretty(&bill)? + "\n")
    }
}
