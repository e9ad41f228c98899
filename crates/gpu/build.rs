//! The structs that host and shaders share, made from the shaders' own text; and for a page the shaders without comments and indentation, two
//! thirds of the text, since a page has to download each byte. A program has the full text.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=shaders");
    let output = env::var_os("OUT_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    let layout = fs::read_to_string("shaders/scene/layout.wgsl")?;
    fs::write(output.join("layout.rs"), host_layout(&layout))?;
    if env::var("CARGO_CFG_TARGET_FAMILY").is_ok_and(|family| family == "wasm") {
        copy(Path::new("shaders"), &output)?;
    }
    Ok(())
}

/// Structs that the host has from elsewhere, or does not have as a whole.
const NOT_MADE: [&str; 3] = ["Film", "FoundLight", "FoundPixel"];

/// Rust for the structs and the numbers of a shader. Members are documented there.
fn host_layout(text: &str) -> String {
    let mut made = String::from("shared! {\n");
    let mut numbers = String::new();
    let (mut lines, mut above) = (text.lines(), String::new());
    while let Some(line) = lines.next() {
        if let Some(name) = line
            .strip_prefix("struct ")
            .and_then(|it| it.strip_suffix(" {"))
        {
            let members: Vec<&str> = lines.by_ref().take_while(|line| *line != "}").collect();
            if !NOT_MADE.contains(&name) {
                made += &format!("{}{name} {{\n{}}}\n", doc(&above), host_members(&members));
            }
        } else if let Some((number, value)) = line
            .strip_prefix("const ")
            .and_then(|it| it.strip_suffix("u;")?.split_once(" = "))
        {
            let _ = writeln!(
                numbers,
                "{}#[allow(dead_code, reason = \"shaders need more of them\")]\npub(crate) const {number} = {value};",
                doc(&above)
            );
        }
        above = match line.strip_prefix("//") {
            Some(comment) => above + comment,
            None => String::new(),
        };
    }
    made + "}\n" + &numbers
}

fn doc(comment: &str) -> String {
    match comment.trim() {
        "" => String::new(),
        text => format!("#[doc = {text:?}]\n"),
    }
}

/// Members at the offsets that WGSL gives them: gaps become members of their own.
fn host_members(members: &[&str]) -> String {
    let mut made = String::new();
    let (mut offset, mut widest, mut gaps) = (0, 4, 0);
    let mut gap = |made: &mut String, offset: &mut usize, align: usize| {
        let words = (offset.next_multiple_of(align) - *offset) / 4;
        if words > 0 {
            let _ = writeln!(made, "pad_{gaps}: [u32; {words}],");
            *offset += 4 * words;
            gaps += 1;
        }
    };
    for line in members {
        let code = line.split("//").next().unwrap_or("").trim();
        let Some((name, ty)) = code.trim_end_matches(',').split_once(": ") else {
            continue;
        };
        let (host, align, size) = host_type(ty);
        gap(&mut made, &mut offset, align);
        let _ = writeln!(made, "{name}: {host},");
        offset += size;
        widest = widest.max(align);
    }
    gap(&mut made, &mut offset, widest);
    made
}

/// Type of the host, alignment and size in bytes in a shader.
fn host_type(ty: &str) -> (&'static str, usize, usize) {
    match ty {
        "f32" => ("f32", 4, 4),
        "i32" => ("i32", 4, 4),
        "u32" => ("u32", 4, 4),
        "vec2f" => ("[f32; 2]", 8, 8),
        "vec2u" => ("[u32; 2]", 8, 8),
        "vec3f" => ("[f32; 3]", 16, 12),
        "vec3u" => ("[u32; 3]", 16, 12),
        "vec4f" => ("[f32; 4]", 16, 16),
        "mat3x3f" => ("[[f32; 4]; 3]", 16, 48),
        _ => panic!("layout.wgsl: no type of the host for {ty}"),
    }
}

fn copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let copied = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy(&entry.path(), &copied)?;
        } else {
            fs::write(copied, bare(&fs::read_to_string(entry.path())?))?;
        }
    }
    Ok(())
}

/// WGSL has no strings in which two strokes could stand, and the shaders no comments between other signs.
fn bare(text: &str) -> String {
    text.lines()
        .map(|line| line.split("//").next().unwrap_or("").trim())
        .filter(|line| !line.is_empty())
        .flat_map(|line| [line, "\n"])
        .collect()
}
