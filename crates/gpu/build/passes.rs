//! A struct for each compute pass over a scene, with a field for each resource that its shader binds. Host code that forgets one, or gives one that the shader
//! does not bind, does not compile.

use crate::modules::{Binding, BindingKind, Reflection, Shaders};

/// Arrays that the pass of another method binds before its tables: no pass by themselves.
const OTHER_METHOD: &str = "other_method";

/// Rust for the structs.
pub fn rust(shaders: &Shaders) -> String {
    shaders.own().map(|short| pass(shaders, short)).collect()
}

fn pass(shaders: &Shaders, short: &str) -> String {
    let Reflection {
        bindings,
        entry_points,
        ..
    } = shaders.reflection(short);
    if bindings.is_empty() || entry_points.is_empty() && short != OTHER_METHOD {
        return String::new();
    }
    let (module, name) = (short.to_uppercase(), camel_case(short));
    let fields = bindings.iter().map(|Binding { name, kind, .. }| {
        let ty = match kind {
            BindingKind::Integers | BindingKind::Numbers => "TextureView",
            _ => "Buffer",
        };
        format!("pub(crate) {name}: &'a wgpu::{ty},\n")
    });
    let entries = bindings.iter().map(|Binding { number, name, kind }| {
        let resource = match kind {
            BindingKind::Integers | BindingKind::Numbers => {
                format!("wgpu::BindingResource::TextureView(bound.{name})")
            }
            BindingKind::UniformPart { bytes } => format!("part(bound.{name}, {bytes})"),
            _ => format!("bound.{name}.as_entire_binding()"),
        };
        format!("wgpu::BindGroupEntry {{ binding: {number}, resource: {resource} }},\n")
    });
    let constants = entry_points.iter().map(|entry_point| {
        let constant = entry_point.to_uppercase();
        format!(
            "pub(crate) const {constant}: EntryPoint<Self> = EntryPoint::new(&shaders::{module}, {entry_point:?});\n"
        )
    });
    format!(
        "/// Bindings of {short}.wgsl.\npub(crate) struct {name}<'a> {{\n{}}}\n\
         impl {name}<'static> {{\n{}}}\n\
         impl PassBindings for {name}<'static> {{\n\
         type With<'a> = {name}<'a>;\n\
         fn entries<'a>(bound: &Self::With<'a>) -> Vec<wgpu::BindGroupEntry<'a>> {{\nvec![\n{}]\n}}\n}}\n",
        fields.collect::<String>(),
        constants.collect::<String>(),
        entries.collect::<String>(),
    )
}

fn camel_case(name: &str) -> String {
    let words = name.split('_');
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    words.map(capital).collect()
}
