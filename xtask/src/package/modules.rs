//! The shader modules as engines take them: one file of WGSL, and a WESL module each.

use std::collections::BTreeSet;
use std::fmt::Write;

use hairline_gpu::shaders::{Module, for_engines, with_needs};

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The name within the package.
pub(super) fn short_name(module: &Module) -> &'static str {
    module.name.rsplit('/').next().unwrap_or(module.name)
}

fn without_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or("").trim()
}

/// A line without the spaces that no token needs.
fn without_spaces(line: &str) -> String {
    let mut short = String::with_capacity(line.len());
    let mut rest = line.chars().peekable();
    while let Some(c) = rest.next() {
        let (before, after) = (short.chars().last(), rest.peek().copied());
        let [is_before, is_after] =
            [before, after].map(|c| c.is_some_and(|c| "=*/,;:{}()+-&|!".contains(c)));
        // `- -x` is no decrement, `vec2<f32> =` no comparison, and `/ *x` no comment.
        let pairs = [('-', '-'), ('>', '='), ('/', '*')];
        let is_pair = before.zip(after).is_some_and(|pair| pairs.contains(&pair));
        if c != ' ' || !(is_before || is_after) || is_pair {
            short.push(c);
        }
    }
    short
}

/// Modules in the order of their needs as one file, without comments and spaces: a fifteenth smaller, compressed.
pub(super) fn single_file(modules: &[&Module]) -> String {
    let mut text = format!(
        "// hairline-shaders {VERSION}, MIT OR Apache-2.0. Made by `cargo xtask package`; the modules in the folder wesl have the comments.\n"
    );
    for module in modules {
        for line in for_engines(module).lines().map(without_comment) {
            if !line.is_empty() {
                text.push_str(&without_spaces(line));
                text.push('\n');
            }
        }
    }
    text
}

/// Validates the module by naga.
pub(super) fn validate(text: &str) -> anyhow::Result<()> {
    let parsed = naga::front::wgsl::parse_str(text)
        .map_err(|error| anyhow::anyhow!("{}", error.emit_to_string(text)))?;
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32,
    )
    .validate(&parsed)
    .map_err(|error| anyhow::anyhow!("{}", error.emit_to_string(text)))?;
    Ok(())
}

/// The names that a module declares.
fn declared(module: &Module) -> BTreeSet<&'static str> {
    module
        .source
        .lines()
        .filter_map(|line| {
            let (kind, rest) = line.split_once(' ')?;
            let is_declaration = matches!(kind, "fn" | "struct" | "const" | "alias");
            let end = rest.find(|c: char| !is_name(c)).unwrap_or(rest.len());
            is_declaration.then(|| &rest[..end])
        })
        .collect()
}

fn is_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// The names that a text uses, members of structs left out.
fn used(text: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for line in text.lines().map(without_comment) {
        let mut before = ' ';
        let mut name = String::new();
        for c in line.chars().chain([' ']) {
            if is_name(c) {
                name.push(c);
                continue;
            }
            if !name.is_empty() {
                if before != '.' {
                    names.insert(std::mem::take(&mut name));
                }
                name.clear();
            }
            before = c;
        }
    }
    names
}

/// A module with the imports of WESL (<https://wesl-lang.dev>).
pub(super) fn wesl(module: &Module, all: &[&Module]) -> String {
    let text = for_engines(module);
    let uses = used(&text);
    let needs = with_needs(&[module]);
    let mut out = String::new();
    let _ = writeln!(
        out,
        "// hairline-shaders {VERSION}, module {}. MIT OR Apache-2.0. Made by `cargo xtask package`.",
        short_name(module)
    );
    let _ = writeln!(
        out,
        "// Units end names: _m metres, _um micrometres, _nm nanometres, _rad radians; _sq is squared. Binds nothing, has no entry point.\n"
    );
    let mut imported = BTreeSet::new();
    // Modules in the order of all, so that a name comes from the first that declares it.
    for other in all.iter().filter(|other| other.name != module.name) {
        if !needs.iter().any(|need| need.name == other.name) {
            continue;
        }
        let names: Vec<_> = declared(other)
            .into_iter()
            .filter(|name| uses.contains(*name) && imported.insert(*name))
            .collect();
        if !names.is_empty() {
            let _ = writeln!(
                out,
                "import package::{}::{{{}}};",
                short_name(other),
                names.join(", ")
            );
        }
    }
    out.push('\n');
    out.push_str(&text);
    out.push('\n');
    out
}

/// The two files as a JavaScript module.
pub(super) fn script(whole: &str) -> String {
    let quoted = |text: &str| {
        text.replace('\\', "\\\\")
            .replace('`', "\\`")
            .replace('$', "\\$")
    };
    format!(
        "// Made by `cargo xtask package`.\nexport const hairlineWgsl = `{}`;\n",
        quoted(whole)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_spaces_that_no_token_needs_go() {
        let line = "let a: vec2<f32> = select(b - -c, 2.0 / *d, e < f && g >= -h);";
        let short = "let a:vec2<f32> =select(b- -c,2.0/ *d,e < f&&g >=-h);";
        assert_eq!(without_spaces(line), short);
    }
}
