//! `cargo xtask rooms`: modules of a crate that import each other in a circle. There must be none.
//!
//! A module is a file. It imports what its code names by `crate::`, `super::`, a child module or a name of its `use` lines. What a
//! module hands on by `pub use` is an import of who names it, from where it is written. Comments, strings and tests are not read.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, ensure};

/// The command's arguments.
#[derive(clap::Args)]
pub struct Rooms {
    /// Names the imports of each circle.
    #[arg(long)]
    why: bool,
    /// Folders of crates.
    #[arg(default_values_os_t = crates(), value_name = "CRATE")]
    folders: Vec<PathBuf>,
}

/// `["canvas", "area"]` is `crate::canvas::area`.
type Name = Vec<String>;

/// Names in the code of a module.
#[derive(Default)]
struct Module {
    /// Whole paths that it names.
    named: BTreeSet<Name>,
    /// Names from its `use` lines, with the whole path that each stands for.
    aliases: BTreeMap<String, Name>,
}

impl Rooms {
    /// Prints the circles.
    pub fn run(&self) -> anyhow::Result<()> {
        let mut count = 0;
        for folder in &self.folders {
            let modules = modules(&folder.join("src"))?;
            for circle in circles(&modules) {
                count += 1;
                let names: Vec<_> = circle.iter().map(|name| name.join("::")).collect();
                println!(
                    "{}: {} modules: {}",
                    folder.display(),
                    names.len(),
                    names.join(", ")
                );
                for from in circle.iter().filter(|_| self.why) {
                    for to in imports(&modules, from).intersection(&circle) {
                        println!("    {} -> {}", from.join("::"), to.join("::"));
                    }
                }
            }
        }
        ensure!(
            count == 0,
            "{count} circles of modules; each must be opened"
        );
        Ok(())
    }
}

/// Folders of all crates that have sources of their own; others are looked at when they are named.
fn crates() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let libraries = std::fs::read_dir(root.join("crates")).into_iter().flatten();
    let libraries = libraries.flatten().map(|entry| entry.path());
    let programs = ["apps/hairline", "apps/hairline-viewer", "xtask"].map(|name| root.join(name));
    let mut folders: Vec<_> = libraries.chain(programs).collect();
    folders.sort();
    folders
}

/// The modules below `src`, tests left out.
fn modules(src: &Path) -> anyhow::Result<BTreeMap<Name, Module>> {
    let mut texts = BTreeMap::new();
    let mut folders = vec![(src.to_owned(), Name::new())];
    while let Some((folder, name)) = folders.pop() {
        let entries = std::fs::read_dir(&folder)
            .with_context(|| format!("{} cannot be read", folder.display()))?;
        for path in entries.flatten().map(|entry| entry.path()) {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let child = || name.iter().cloned().chain([stem.to_string()]).collect();
            if stem == "tests" {
                continue;
            }
            if path.is_dir() {
                folders.push((path.clone(), child()));
            } else if path.extension().is_some_and(|e| e == "rs") {
                let root = name.is_empty() && ["lib", "main"].contains(&&*stem);
                texts.insert(
                    if root { Name::new() } else { child() },
                    std::fs::read_to_string(&path)?,
                );
            }
        }
    }
    let names: BTreeSet<_> = texts.keys().cloned().collect();
    let read =
        |(name, text): (Name, String)| (name.clone(), Module::read(&tokens(&text), &name, &names));
    Ok(texts.into_iter().map(read).collect())
}

/// Words, `::` and the other signs, each by itself, up to the tests at the end of the file.
pub(crate) fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = text.split("\nmod tests {").next().unwrap_or_default();
    while let Some(first) = rest.chars().next() {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if first == '"' {
            string_length(rest)
        } else if rest.starts_with("'\"'") || rest.starts_with("::") {
            2
        } else {
            rest.find(|c| !is_name(c))
                .unwrap_or(rest.len())
                .max(first.len_utf8())
        };
        let (token, after) = rest.split_at(length);
        if !(first.is_whitespace() || first == '"' || token.starts_with("//")) {
            tokens.push(token.to_owned());
        }
        rest = after
            .strip_prefix("'")
            .filter(|_| token == "'\"")
            .unwrap_or(after);
    }
    tokens
}

/// Length of a string literal with its quotes.
fn string_length(text: &str) -> usize {
    let mut escaped = false;
    let end = text[1..].find(|c| {
        let ends = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        ends
    });
    end.map_or(text.len(), |end| end + 2)
}

impl Module {
    fn read(tokens: &[String], name: &Name, modules: &BTreeSet<Name>) -> Self {
        let mut module = Self::default();
        let child = |word: &str| modules.contains(&[&name[..], &[word.to_owned()]].concat());
        let mut i = 0;
        while i < tokens.len() {
            let used = i > 0 && tokens[i - 1] == "use";
            let handed_on = used && i > 1 && ["pub", ")"].contains(&tokens[i - 2].as_str());
            let path =
                tokens.get(i + 1).is_some_and(|t| t == "::") && (i == 0 || tokens[i - 1] != "::");
            let base = match tokens[i].as_str() {
                "crate" => Some(Name::new()),
                "super" => Some(name[..name.len().saturating_sub(1)].to_vec()),
                "self" => Some(name.clone()),
                word if child(word) => Some([&name[..], &[word.to_owned()]].concat()),
                word => module.aliases.get(word).cloned(),
            };
            match base {
                Some(base) if path => i = module.tree(tokens, i + 1, base, [used, handed_on]),
                _ => i += 1,
            }
        }
        module
    }

    /// The paths of a tree of names, from the `::` or the sign after `base` on; returns where it ends.
    fn tree(&mut self, tokens: &[String], mut i: usize, mut base: Name, uses: [bool; 2]) -> usize {
        let [used, handed_on] = uses;
        let at = |i: usize| tokens.get(i).map_or("", String::as_str);
        while at(i) == "::" {
            i += 1;
            match at(i) {
                "{" => {
                    while at(i) != "}" && i < tokens.len() {
                        let base = base.clone();
                        i = match at(i + 1) {
                            "}" => i + 1,
                            "self" => self.tree(tokens, i + 2, base, uses),
                            word => self.tree(
                                tokens,
                                i + 2,
                                [base, vec![word.to_owned()]].concat(),
                                uses,
                            ),
                        };
                    }
                    return i + 1;
                }
                "super" => drop(base.pop()),
                "*" if handed_on => drop(self.aliases.insert("*".to_owned(), base.clone())),
                "*" | "<" => break,
                word => base.push(word.to_owned()),
            }
            i += 1;
        }
        let alias = if at(i) == "as" {
            at(i + 1)
        } else {
            base.last().map_or("", |last| last)
        };
        if used {
            self.aliases.insert(alias.to_owned(), base.clone());
        }
        if !handed_on {
            self.named.insert(base);
        }
        if at(i) == "as" { i + 2 } else { i }
    }
}

/// The modules whose items `from` names.
fn imports(modules: &BTreeMap<Name, Module>, from: &Name) -> BTreeSet<Name> {
    let home = |path: &Name| {
        let mut path = path.clone();
        for _ in 0..8 {
            let length = (0..=path.len())
                .rev()
                .find(|&n| modules.contains_key(&path[..n]))
                .unwrap_or(0);
            let module = &path[..length];
            let aliases = &modules[module].aliases;
            let named = |item| {
                aliases
                    .get(item)
                    .map(|to| [to, &path[length + 1..]].concat())
            };
            let any = |_| aliases.get("*").map(|to| [to, &path[length..]].concat());
            let item = path.get(length).filter(|_| module != from);
            match item.and_then(|item| named(item).or_else(|| any(item))) {
                Some(further) => path = further,
                None => return module.to_vec(),
            }
        }
        path
    };
    modules[from]
        .named
        .iter()
        .map(home)
        .filter(|to| to != from)
        .collect()
}

/// Groups of modules that reach each other.
fn circles(modules: &BTreeMap<Name, Module>) -> BTreeSet<BTreeSet<Name>> {
    let reach = |from: &Name| {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(name) = next.pop() {
            next.extend(
                imports(modules, &name)
                    .into_iter()
                    .filter(|to| seen.insert(to.clone())),
            );
        }
        seen
    };
    let reached: BTreeMap<_, _> = modules.keys().map(|name| (name, reach(name))).collect();
    let mutual = |a: &Name| {
        reached[a]
            .iter()
            .filter(|b| reached[b].contains(a))
            .cloned()
            .collect::<BTreeSet<_>>()
    };
    modules
        .keys()
        .map(mutual)
        .filter(|circle| circle.len() > 1)
        .collect()
}
