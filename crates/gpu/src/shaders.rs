//! The shader modules, and how they are joined.
//!
//! Modules lie in four folders. `physics` has no binding and no entry point: its data comes by arguments, so that another engine can
//! lift it. `engine` is what only other engines call: `cargo xtask package` packs it with the physics. `scene` reads what is bound.
//! `passes` has the entry points. A [method](crate::method) of others brings its own.
//!
//! A file names the modules that it needs in the comment at its top, `// Needs: scene, lights.`; its first sentence says what it is. A build script
//! makes the statics of this room of it, with the bindings, entry points and overrides that the compiler finds.
//!
//! Modules are joined by concatenation, what a module needs before it, each once; their module-level names are therefore unique
//! over all modules.

use hairline_optics::table;

/// One file of WGSL and the modules that it calls.
#[derive(Debug)]
pub struct Module {
    /// The file below `shaders/`, without its ending.
    pub name: &'static str,
    /// The text.
    pub source: &'static str,
    /// Modules that must come before it.
    pub needs: &'static [&'static Module],
    /// What a pass binds in group 3, which each pass has for itself, in the order of their numbers: its own and those of what it needs.
    pub bindings: &'static [Binding],
    /// Names of its compute passes.
    pub entry_points: &'static [&'static str],
    /// Names of the constants that pipelines may set, its own and those of what it needs.
    pub overrides: &'static [&'static str],
}

/// A binding that a shader declares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Binding {
    /// Its number in the group.
    pub number: u32,
    /// Name of the variable in the shader.
    pub name: &'static str,
    /// What is bound.
    pub kind: BindingKind,
}

/// What a shader binds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BindingKind {
    /// A buffer.
    Storage {
        /// Whether the shader only reads it.
        is_read_only: bool,
    },
    /// A buffer of uniforms.
    Uniform,
    /// A part of a buffer of uniforms, which each dispatch chooses.
    UniformPart {
        /// Size of the part.
        bytes: u64,
    },
    /// A texture of integers.
    Integers,
    /// A texture of numbers that are not filtered.
    Numbers,
}

include!(concat!(env!("OUT_DIR"), "/modules.rs"));

/// Modules that `cargo xtask package` packs for other engines, with those that they need.
pub static FOR_ENGINES: &[&Module] = &[
    &SCRATCHED_SURFACE,
    &BRUSHED_BASE,
    &GRATED_SURFACE,
    &PIXEL_FRAME,
];

/// The text of a module as it is packed for other engines, whose tables have half of the renderer's columns.
pub fn for_engines(module: &Module) -> String {
    let text = module.source.trim_end();
    if module.name != SCRATCH_TABLE.name {
        return text.to_owned();
    }
    let columns = |count: usize| format!("COLUMNS: i32 = {count};");
    text.replace(&columns(table::COLUMNS), &columns(table::ENGINE_COLUMNS))
}

/// `modules` and everything that they need, each once and after its own needs.
pub fn with_needs<'a>(modules: &[&'a Module]) -> Vec<&'a Module> {
    fn visit<'a>(module: &'a Module, joined: &mut Vec<&'a Module>) {
        if joined.iter().any(|other| other.name == module.name) {
            return;
        }
        for need in module.needs {
            visit(need, joined);
        }
        joined.push(module);
    }
    let mut joined = Vec::new();
    for module in modules {
        visit(module, &mut joined);
    }
    joined
}

/// The text of `modules` and of everything that they need.
pub fn compose(modules: &[&Module]) -> String {
    let text = |module: &Module| {
        let source = module.source.trim_end();
        format!("// ---- {}.wgsl\n{source}\n", module.name)
    };
    with_needs(modules).into_iter().map(text).collect()
}

/// Parses and validates the text of a module.
#[cfg(test)]
pub(crate) fn assert_valid(module: &Module, text: &str) {
    let parsed = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{}:\n{}", module.name, error.emit_to_string(text)));
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        // Half floats in words: every WebGPU device packs and unpacks them.
        naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32,
    )
    .validate(&parsed)
    .unwrap_or_else(|error| panic!("{}:\n{}", module.name, error.emit_to_string(text)));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lifted module must stand on its own needs.
    #[test]
    fn each_module_is_valid_with_what_it_needs() {
        for module in ALL {
            assert_valid(module, &compose(&[module]));
        }
    }

    /// Modules that other engines lift bind nothing and need no module that does.
    #[test]
    fn physics_binds_nothing() {
        let is_physics = |module: &Module| module.name.starts_with("physics/");
        for module in ALL.iter().filter(|module| is_physics(module)) {
            assert!(!module.source.contains("@group"), "{}", module.name);
            let other = module.needs.iter().find(|need| !is_physics(need));
            assert!(other.is_none(), "{} needs {other:?}", module.name);
        }
    }

    /// Modules for engines alone bind nothing either, and naga_oil takes no member of a struct that ends in a digit.
    #[test]
    fn what_engines_take_binds_nothing_and_its_members_end_in_letters() {
        for module in with_needs(FOR_ENGINES) {
            assert!(!module.source.contains("@group"), "{}", module.name);
            let folder = module.name.split('/').next();
            assert!(
                matches!(folder, Some("physics" | "engine")),
                "{}",
                module.name
            );
            let structs = module.source.split("\nstruct ").skip(1);
            for line in structs.flat_map(|text| text.split("\n}").next().unwrap_or("").lines()) {
                let name = line.split(':').next().unwrap_or("").trim();
                assert!(
                    !name.ends_with(|c: char| c.is_ascii_digit()),
                    "{}: {name}",
                    module.name
                );
            }
        }
    }

    #[test]
    fn a_module_is_joined_once_and_after_its_needs() {
        let text = compose(&[&BINDINGS, &LAYOUT]);
        assert_eq!(text.matches("// ---- scene/layout.wgsl").count(), 1);
        assert!(text.find("// ---- scene/layout.wgsl") < text.find("// ---- scene/bindings.wgsl"));
    }
}
