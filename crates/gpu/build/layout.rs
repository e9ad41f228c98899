//! The structs that host and shaders share, made of layout.wgsl as the compiler reads it: members at its offsets, gaps as members of their own.

use std::fmt::Write as _;

use naga::{Handle, Literal, Module, ScalarKind, StructMember, Type, TypeInner, VectorSize};

/// Structs that the host has from elsewhere, or does not have as a whole.
const NOT_MADE: [&str; 3] = ["Film", "TracedLight", "TracedPixel"];

/// Rust for the structs and the numbers of a shader. Members are documented there.
pub fn rust(module: &Module) -> String {
    let mut made = String::from("shared! {\n");
    let docs = module.doc_comments.as_deref();
    for (handle, ty) in module.types.iter() {
        if let (TypeInner::Struct { members, span }, Some(name)) = (&ty.inner, &ty.name)
            && !NOT_MADE.contains(&&**name)
        {
            let about = docs.and_then(|docs| docs.types.get(&handle));
            let members = host_members(module, members, *span);
            made += &format!("{}{name} {{\n{members}}}\n", doc(about));
        }
    }
    made += "}\n";
    for (handle, constant) in module.constants.iter() {
        let value = &module.global_expressions[constant.init];
        if let (naga::Expression::Literal(Literal::U32(value)), Some(name)) =
            (value, &constant.name)
        {
            let about = docs.and_then(|docs| docs.constants.get(&handle));
            let _ = writeln!(
                made,
                "{}#[allow(dead_code, reason = \"shaders need more of them\")]\npub(crate) const {name}: u32 = {value};",
                doc(about)
            );
        }
    }
    made
}

fn doc(lines: Option<&Vec<String>>) -> String {
    let lines = lines.into_iter().flatten();
    let text: String = lines.map(|line| line.trim_start_matches('/')).collect();
    match text.trim() {
        "" => String::new(),
        text => format!("#[doc = {text:?}]\n"),
    }
}

fn host_members(module: &Module, members: &[StructMember], span: u32) -> String {
    let mut made = String::new();
    let (mut end, mut gaps) = (0, 0);
    let mut gap = |made: &mut String, end: u32, offset: u32| {
        if offset > end {
            let _ = writeln!(made, "pad_{gaps}: [u32; {}],", (offset - end) / 4);
            gaps += 1;
        }
    };
    for member in members {
        gap(&mut made, end, member.offset);
        let (host, words) = host_type(module, member.ty);
        let name = member.name.as_deref().unwrap_or_default();
        let _ = writeln!(made, "{name}: {host},");
        end = member.offset + 4 * words;
    }
    gap(&mut made, end, span);
    made
}

/// Type of the host, and its size in words.
fn host_type(module: &Module, ty: Handle<Type>) -> (String, u32) {
    let number = |kind| match kind {
        ScalarKind::Float => "f32",
        ScalarKind::Sint => "i32",
        _ => "u32",
    };
    match module.types[ty].inner {
        TypeInner::Scalar(scalar) => (number(scalar.kind).to_owned(), 1),
        TypeInner::Vector { size, scalar } => {
            let size = size as u32;
            (format!("[{}; {size}]", number(scalar.kind)), size)
        }
        // A column has the room of four numbers.
        TypeInner::Matrix {
            columns: VectorSize::Tri,
            rows: VectorSize::Tri,
            ..
        } => ("[[f32; 4]; 3]".to_owned(), 12),
        ref other => panic!("layout.wgsl: no type of the host for {other:?}"),
    }
}
