//! The shader modules of a folder, as statics of Rust: what a module needs is a line of the comment at its top, what a pass binds is what the compiler
//! finds. The build script of another crate, whose modules stand on those of this one, has this file too.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

use naga::front::wgsl::{Frontend, Options};
use naga::{AddressSpace, ImageClass, ScalarKind, StorageAccess, TypeInner};

/// Modules by their short names, which differ over all folders.
pub struct Shaders {
    modules: BTreeMap<String, Module>,
}

struct Module {
    /// The file below the folder, without its ending.
    file: String,
    /// What Rust calls it.
    name: String,
    text: String,
    /// The path of Rust in which it lies.
    path: &'static str,
    needs: Vec<String>,
    is_own: bool,
}

impl Shaders {
    /// Reads a folder. `prefix` is what the names begin with, `path` where Rust finds the statics.
    pub fn read(folder: &Path, prefix: &str, path: &'static str) -> io::Result<Self> {
        let mut modules = BTreeMap::new();
        let mut folders = vec![String::new()];
        while let Some(inner) = folders.pop() {
            for entry in fs::read_dir(folder.join(&inner))? {
                let entry = entry?;
                let name = format!("{inner}{}", entry.file_name().to_string_lossy());
                if entry.file_type()?.is_dir() {
                    folders.push(format!("{name}/"));
                } else if let Some(file) = name.strip_suffix(".wgsl") {
                    let text = fs::read_to_string(entry.path())?;
                    let short = file.rsplit('/').next().unwrap_or(file).to_owned();
                    let module = Module {
                        needs: needs(&text),
                        name: format!("{prefix}{file}"),
                        file: file.to_owned(),
                        text,
                        path,
                        is_own: true,
                    };
                    let other = modules.insert(short, module);
                    assert!(other.is_none(), "two shaders are called {file}");
                }
            }
        }
        Ok(Self { modules })
    }

    /// Adds modules that others may need, and that are not made.
    #[allow(dead_code, reason = "for crates that stand on this one")]
    pub fn on(mut self, below: Self) -> Self {
        for (short, mut module) in below.modules {
            module.is_own = false;
            self.modules.insert(short, module);
        }
        self
    }

    /// Statics of all modules that are own, and a list of them. `folder` is Rust for the folder of their files.
    pub fn rust(&self, folder: &str) -> String {
        let mut made = String::new();
        let mut all = String::new();
        for (short, module) in self.modules.iter().filter(|(_, module)| module.is_own) {
            let constant = short.to_uppercase();
            let needs = module.needs.iter().map(|need| {
                let (path, constant) = (self.get(need).path, need.to_uppercase());
                format!("&{path}::{constant}, ")
            });
            let is_pass = module.text.contains("@compute") || module.text.contains("@vertex");
            let bindings = match is_pass {
                true => self.bindings(short),
                false => String::new(),
            };
            let _ = writeln!(
                made,
                "#[doc = {:?}]\npub static {constant}: Module = Module {{ name: {:?}, source: include_str!(concat!({folder}, \"/{}.wgsl\")), \
                 needs: &[{}], bindings: &[{bindings}] }};",
                about(&module.text),
                module.name,
                module.file,
                needs.collect::<String>(),
            );
            let _ = write!(all, "&{constant}, ");
        }
        made + &format!(
            "/// Every module and every pass.\npub static ALL: &[&Module] = &[{all}];\n"
        )
    }

    /// What a module binds in group 3, and the modules that it needs.
    fn bindings(&self, short: &str) -> String {
        let parsed = self.parse(short);
        let bound = parsed.global_variables.iter();
        let bound = bound.filter_map(|(_, it)| Some((it.binding?, it)));
        let mut bound: Vec<_> = bound.filter(|(at, _)| at.group == 3).collect();
        bound.sort_by_key(|(at, _)| at.binding);
        let each = bound.into_iter().map(|(at, it)| {
            let kind = match (it.space, &parsed.types[it.ty].inner) {
                (AddressSpace::Uniform, _) => "Uniform".to_owned(),
                (AddressSpace::Storage { access }, _) => {
                    let is_read_only = access == StorageAccess::LOAD;
                    format!("Storage {{ is_read_only: {is_read_only} }}")
                }
                (_, TypeInner::Image { class, .. }) => match class {
                    ImageClass::Sampled { kind, .. } if *kind == ScalarKind::Float => "Numbers",
                    _ => "Integers",
                }
                .to_owned(),
                (_, other) => panic!("{short}: no binding of the host for {other:?}"),
            };
            let (number, name) = (at.binding, it.name.as_deref().unwrap_or_default());
            format!("Binding {{ number: {number}, name: {name:?}, kind: BindingKind::{kind} }}, ")
        });
        each.collect()
    }

    /// Parses a module with what it needs before it.
    ///
    /// # Panics
    /// If it is no WGSL: the message is the compiler's.
    pub fn parse(&self, short: &str) -> naga::Module {
        let mut joined = Vec::new();
        self.join(short, &mut joined);
        let text: String = joined.iter().map(|it| &*self.get(it).text).collect();
        let mut options = Options::new();
        options.parse_doc_comments = true;
        let parsed = Frontend::new_with_options(options).parse(&text);
        parsed.unwrap_or_else(|error| panic!("{short}.wgsl:\n{}", error.emit_to_string(&text)))
    }

    fn join<'a>(&'a self, short: &'a str, joined: &mut Vec<&'a str>) {
        if !joined.contains(&short) {
            for need in &self.get(short).needs {
                self.join(need, joined);
            }
            joined.push(short);
        }
    }

    fn get(&self, short: &str) -> &Module {
        let found = self.modules.get(short);
        found.unwrap_or_else(|| panic!("a shader needs {short}, and there is no {short}.wgsl"))
    }
}

/// The comment at the top of a text, in one line.
fn top(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("//"));
    let words: Vec<&str> = lines.flat_map(str::split_whitespace).collect();
    words.join(" ")
}

/// The modules that its line `Needs: a, b.` names.
fn needs(text: &str) -> Vec<String> {
    let top = top(text);
    let named = top.split("Needs: ").nth(1).unwrap_or_default();
    let names = named.split('.').next().unwrap_or_default().split(", ");
    let names = names.map(str::to_owned);
    names.filter(|name| !name.is_empty()).collect()
}

/// Its first sentence.
fn about(text: &str) -> String {
    let top = top(text);
    let first = top.split(". ").next().unwrap_or_default();
    first.trim_end_matches('.').to_owned() + "."
}
