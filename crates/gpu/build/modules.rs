//! The shader modules of a folder, as statics of Rust: what a module needs is a line of the comment at its top. What it binds, its entry points and
//! its overrides are what the compiler finds. The build script of another crate, whose modules stand on those of this one, has this file too.

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

use naga::front::wgsl::{Frontend, Options};
use naga::{
    AddressSpace, GlobalVariable, ImageClass, ScalarKind, ShaderStage, StorageAccess, TypeInner,
};

/// A uniform of this type is a part of an array: each dispatch chooses one.
const PART: &str = "LightRange";

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
    reflection: OnceCell<Reflection>,
}

/// What the compiler finds in the text of a pass, and of the modules that it needs.
#[derive(Default)]
pub struct Reflection {
    /// Bindings of group 3, in the order of their numbers.
    pub bindings: Vec<Binding>,
    /// Names of the compute passes.
    pub entry_points: Vec<String>,
    pub overrides: Vec<String>,
}

pub struct Binding {
    pub number: u32,
    pub name: String,
    /// The variant of `BindingKind`.
    pub kind: BindingKind,
}

/// Twin: src/shaders.rs.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code, reason = "written as Rust, by its debug text")]
pub enum BindingKind {
    Storage { is_read_only: bool },
    Uniform,
    UniformPart { bytes: u64 },
    Integers,
    Numbers,
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
                        reflection: OnceCell::new(),
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
    pub fn with_base(mut self, below: Self) -> Self {
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
            let Reflection {
                bindings,
                entry_points,
                overrides,
            } = self.reflection(short);
            let bindings = bindings.iter().map(|Binding { number, name, kind }| {
                format!(
                    "Binding {{ number: {number}, name: {name:?}, kind: BindingKind::{kind:?} }}, "
                )
            });
            let _ = writeln!(
                made,
                "#[doc = {:?}]\npub static {constant}: Module = Module {{ name: {:?}, source: include_str!(concat!({folder}, \"/{}.wgsl\")), \
                 needs: &[{}], bindings: &[{}], entry_points: &{entry_points:?}, overrides: &{overrides:?} }};",
                first_sentence(&module.text),
                module.name,
                module.file,
                needs.collect::<String>(),
                bindings.collect::<String>(),
            );
            let _ = write!(all, "&{constant}, ");
        }
        made + &format!(
            "/// Every module and every pass.\npub static ALL: &[&Module] = &[{all}];\n"
        )
    }

    /// What the compiler finds in a pass; nothing of modules that are none.
    pub fn reflection(&self, short: &str) -> &Reflection {
        let module = self.get(short);
        let is_pass = module.file.starts_with("passes/");
        let reflection = || match is_pass {
            true => self.reflect(short),
            false => Reflection::default(),
        };
        module.reflection.get_or_init(reflection)
    }

    fn reflect(&self, short: &str) -> Reflection {
        let parsed = self.parse(short);
        let variables = parsed.global_variables.iter();
        let mut bindings: Vec<Binding> = variables
            .filter_map(|(_, variable)| {
                let place = variable.binding.filter(|place| place.group == 3)?;
                Some(Binding {
                    number: place.binding,
                    name: variable.name.clone().unwrap_or_default(),
                    kind: binding_kind(short, &parsed, variable),
                })
            })
            .collect();
        bindings.sort_by_key(|binding| binding.number);
        let compute =
            (parsed.entry_points.iter()).filter(|entry| entry.stage == ShaderStage::Compute);
        Reflection {
            bindings,
            entry_points: compute.map(|entry| entry.name.clone()).collect(),
            overrides: (parsed.overrides.iter())
                .filter_map(|(_, constant)| constant.name.clone())
                .collect(),
        }
    }

    /// Parses a module with what it needs before it.
    ///
    /// # Panics
    /// If it is no WGSL: the message is the compiler's.
    pub fn parse(&self, short: &str) -> naga::Module {
        let mut joined = Vec::new();
        self.join(short, &mut joined);
        let text: String = joined.iter().map(|name| &*self.get(name).text).collect();
        let mut options = Options::new();
        options.parse_doc_comments = true;
        let parsed = Frontend::new_with_options(options).parse(&text);
        parsed.unwrap_or_else(|error| panic!("{short}.wgsl:\n{}", error.emit_to_string(&text)))
    }

    /// The short names of the modules that are not of another crate.
    #[allow(dead_code, reason = "for the crate whose passes it orders")]
    pub fn own(&self) -> impl Iterator<Item = &str> {
        let own = self.modules.iter().filter(|(_, module)| module.is_own);
        own.map(|(short, _)| &**short)
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

fn binding_kind(short: &str, parsed: &naga::Module, variable: &GlobalVariable) -> BindingKind {
    let ty = &parsed.types[variable.ty];
    match (variable.space, &ty.inner) {
        (AddressSpace::Uniform, _) if ty.name.as_deref() == Some(PART) => {
            BindingKind::UniformPart {
                bytes: ty.inner.size(parsed.to_ctx()).into(),
            }
        }
        (AddressSpace::Uniform, _) => BindingKind::Uniform,
        (AddressSpace::Storage { access }, _) => BindingKind::Storage {
            is_read_only: access == StorageAccess::LOAD,
        },
        (_, TypeInner::Image { class, .. }) => match class {
            ImageClass::Sampled { kind, .. } if *kind == ScalarKind::Float => BindingKind::Numbers,
            _ => BindingKind::Integers,
        },
        (_, other) => panic!("{short}.wgsl: no binding of the host for {other:?}"),
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

/// The first sentence of a shader.
fn first_sentence(text: &str) -> String {
    let top = top(text);
    let first = top.split(". ").next().unwrap_or_default();
    first.trim_end_matches('.').to_owned() + "."
}
