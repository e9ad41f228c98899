//! A copy of the workspace that has all faults in it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, anyhow, bail, ensure};
use hairline_gpu::shaders;

use super::table::Mutant;

/// Place where the sources of shader modules are joined: its file, its text, and its text in the copy.
const JOINED: [&str; 3] = [
    "crates/gpu/src/shaders.rs",
    "let source = module.source.trim_end();",
    "let source = crate::mutated(module.name, module.source.trim_end());",
];

/// Change to the copy's profile: of this it depends whether cargo takes a crate of the copy for that of the workspace, as the paths of both
/// within their workspaces are the same. Crates of others have their own number of units.
const PROFILE: [&str; 3] = [
    "Cargo.toml",
    "[profile.release]\n",
    "[profile.release]\ncodegen-units = 15\n",
];

/// Addition to the root of each crate that has a fault.
const CHOSEN: &str = r#"
/// Number of the chosen fault; 0 is none.
pub(crate) static MUTANT: std::sync::LazyLock<u32> = std::sync::LazyLock::new(|| {
    std::env::var("HAIRLINE_MUTANT").map_or(0, |number| number.parse().expect("a number"))
});
"#;

/// Texts of the copy that differ from those of the workspace, by their files.
pub(super) fn faulty_texts(
    root: &Path,
    all: &[Mutant],
) -> anyhow::Result<BTreeMap<PathBuf, String>> {
    let read = |file: &Path| {
        fs::read_to_string(root.join(file)).with_context(|| format!("{}", file.display()))
    };
    let mut texts = BTreeMap::new();
    let mut roots = BTreeSet::from([crate_root(root, Path::new(JOINED[0]))?]);
    let mut arms = String::new();
    let mut places: BTreeMap<&Path, Vec<(usize, usize)>> = BTreeMap::new();
    for (i, row) in all.iter().enumerate() {
        let file = Path::new(&row.file);
        let at = only_place(&read(file)?, &row.from)
            .with_context(|| format!("row `{}`: {}", row.name, row.file))?;
        if row.file.ends_with(".wgsl") {
            let module = check_module(row).with_context(|| format!("row `{}`", row.name))?;
            let (number, from, to) = (i + 1, &row.from, &row.to);
            arms +=
                &format!("        ({number}, {module:?}) => source.replace({from:?}, {to:?}),\n");
        } else {
            places.entry(file).or_default().push((at, i));
            roots.insert(crate_root(root, file)?);
        }
    }
    for (file, mut places) in places {
        let mut text = read(file)?;
        places.sort_unstable();
        // From the last one on, so that the places of the others stay.
        let mut end = text.len();
        for (at, i) in places.into_iter().rev() {
            let Mutant { name, from, to, .. } = &all[i];
            let after = at + from.len();
            ensure!(
                after <= end,
                "row `{name}`: another row changes the same place"
            );
            let number = i + 1;
            let chosen = format!("(if *crate::MUTANT == {number} {{ {to} }} else {{ {from} }})");
            text.replace_range(at..after, &chosen);
            end = at;
        }
        texts.insert(file.to_owned(), text);
    }
    for [file, from, to] in [JOINED, PROFILE] {
        let text = match texts.remove(Path::new(file)) {
            Some(text) => text,
            None => read(Path::new(file))?,
        };
        only_place(&text, from).with_context(|| file.to_owned())?;
        texts.insert(file.into(), text.replacen(from, to, 1));
    }
    let joined = format!(
        "\n/// Text of a module with the chosen fault.\npub(crate) fn mutated(name: &str, source: &str) -> String {{\n    \
         match (*MUTANT, name) {{\n{arms}        _ => source.to_owned(),\n    }}\n}}\n"
    );
    let joining_root = crate_root(root, Path::new(JOINED[0]))?;
    for file in roots {
        let mut text = match texts.remove(&file) {
            Some(text) => text,
            None => read(&file)?,
        };
        text += CHOSEN;
        if file == joining_root {
            text += &joined;
        }
        texts.insert(file, text);
    }
    Ok(texts)
}

/// The place of a text that must be there once outside of the tests at the end of a file.
fn only_place(text: &str, part: &str) -> anyhow::Result<usize> {
    let code = text.split("\nmod tests {").next().unwrap_or_default();
    let mut places = code.match_indices(part).map(|(at, _)| at);
    match (places.next(), places.next()) {
        (Some(at), None) => Ok(at),
        (None, _) => bail!("`{part}` is not there"),
        _ => bail!("`{part}` is there more than once"),
    }
}

/// Path of the root of the crate that a file belongs to.
fn crate_root(root: &Path, file: &Path) -> anyhow::Result<PathBuf> {
    let mut folders = file.ancestors().skip(1);
    let folder = folders.find(|folder| root.join(folder).join("Cargo.toml").exists());
    let folder = folder.with_context(|| format!("{} is in no crate", file.display()))?;
    let names = ["src/lib.rs", "src/main.rs"].map(|name| folder.join(name));
    let found = names.into_iter().find(|name| root.join(name).exists());
    found.with_context(|| format!("{} has no root", folder.display()))
}

/// The name of a row's shader module, which must be valid with the fault: else all tests that compile it fail.
fn check_module(row: &Mutant) -> anyhow::Result<&'static str> {
    let modules = shaders::ALL.iter().chain(hairline_published::shaders::ALL);
    let mut modules = modules.map(|module| (module, format!("/shaders/{}.wgsl", module.name)));
    let (module, _) = modules
        .find(|(_, file)| row.file.ends_with(file))
        .with_context(|| format!("{} is no shader module", row.file))?;
    let text = shaders::compose(&[module]).replace(&row.from, &row.to);
    let parsed = naga::front::wgsl::parse_str(&text)
        .map_err(|error| anyhow!(error.emit_to_string(&text)))?;
    let capabilities = naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32;
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), capabilities)
        .validate(&parsed)
        .map_err(|error| anyhow!(error.emit_to_string(&text)))?;
    Ok(module.name)
}

/// Copies the files that git knows or would take, as they are in the working tree; `texts` replace some. Files that are the same already stay
/// untouched, so that cargo does not compile them again.
pub(super) fn write_copy(
    root: &Path,
    copy: &Path,
    texts: &BTreeMap<PathBuf, String>,
) -> anyhow::Result<()> {
    let listed = Command::new("git")
        .current_dir(root)
        .args([
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
        ])
        .output()?;
    ensure!(listed.status.success(), "git ls-files: {}", listed.status);
    let listed = String::from_utf8(listed.stdout)?;
    let names = listed.split_terminator('\0').map(Path::new);
    let names: BTreeSet<&Path> = names.filter(|name| root.join(name).is_file()).collect();
    if let Some(file) = texts.keys().find(|file| !names.contains(file.as_path())) {
        bail!("git does not list {}", file.display());
    }
    for &name in &names {
        let bytes = match texts.get(name) {
            Some(text) => text.clone().into_bytes(),
            None => fs::read(root.join(name))?,
        };
        let path = copy.join(name);
        if fs::read(&path).ok().is_none_or(|old| old != bytes) {
            fs::create_dir_all(path.parent().context("a file without a folder")?)?;
            fs::write(path, bytes)?;
        }
    }
    remove_others(copy, &names.iter().map(|name| copy.join(name)).collect())
}

/// Removes all files but some, such as tests that the workspace has no longer.
fn remove_others(folder: &Path, kept: &BTreeSet<PathBuf>) -> anyhow::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            remove_others(&path, kept)?;
        } else if !kept.contains(&path) {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}
