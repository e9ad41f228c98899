//! Bindings of group 3, which each pass has for itself: those that its shader declares. Nothing else names their kinds and their order.

use wgpu::{BindingType, TextureViewDimension};

use crate::bindings::{dynamic_uniform, integers, numbers, storage, uniform};
use crate::shaders::Module;

/// Name of the uniform whose part each dispatch chooses.
const DYNAMIC: &str = "range";

/// A binding of group 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OwnBinding {
    pub number: u32,
    /// Name of the variable in the shader.
    pub name: &'static str,
    kind: BindingKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum BindingKind {
    Storage { is_read_only: bool },
    Uniform,
    Integers,
    Numbers,
}

impl OwnBinding {
    /// Bindings that a module and the modules that it needs declare.
    pub(crate) fn of(module: &'static Module) -> Vec<Self> {
        let mut found = Vec::new();
        collect(module, &mut found);
        found.sort_by_key(|own| own.number);
        found.dedup();
        found
    }

    /// Parses a line of a shader; none where it declares nothing in group 3.
    fn parse(line: &'static str) -> Option<Self> {
        let (number, variable) = line
            .strip_prefix("@group(3) @binding(")?
            .split_once(") var")?;
        let (kind, rest) = match variable.strip_prefix('<') {
            None if variable.ends_with("<f32>;") => (BindingKind::Numbers, variable),
            None => (BindingKind::Integers, variable),
            Some(space) => {
                let (space, rest) = space.split_once('>')?;
                let is_read_only = space == "storage, read";
                let kind = match space {
                    "uniform" => BindingKind::Uniform,
                    _ => BindingKind::Storage { is_read_only },
                };
                (kind, rest)
            }
        };
        Some(Self {
            number: number.parse().ok()?,
            name: rest.split_once(':')?.0.trim(),
            kind,
        })
    }

    pub(crate) fn is_dynamic(&self) -> bool {
        self.name == DYNAMIC
    }

    pub(crate) fn ty(&self) -> BindingType {
        match self.kind {
            BindingKind::Storage { is_read_only } => storage(is_read_only),
            BindingKind::Uniform if self.is_dynamic() => dynamic_uniform(),
            BindingKind::Uniform => uniform(),
            BindingKind::Integers => integers(),
            BindingKind::Numbers => numbers(TextureViewDimension::D2, false),
        }
    }
}

fn collect(module: &'static Module, found: &mut Vec<OwnBinding>) {
    for needed in module.needs {
        collect(needed, found);
    }
    found.extend(module.source.lines().filter_map(OwnBinding::parse));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders;

    /// The text is read as naga reads it, in every pass.
    #[test]
    fn declarations_are_those_that_the_compiler_finds() {
        for &module in shaders::ALL {
            let own = OwnBinding::of(module);
            let text = shaders::compose(&[module]);
            let parsed = naga::front::wgsl::parse_str(&text).unwrap();
            let mut expected: Vec<_> = parsed
                .global_variables
                .iter()
                .filter_map(|(_, it)| Some((it.binding.filter(|at| at.group == 3)?.binding, it)))
                .collect();
            expected.sort_by_key(|(number, _)| *number);
            let names: Vec<_> = own.iter().map(|own| (own.number, own.name)).collect();
            let expected_names: Vec<_> = expected
                .iter()
                .map(|(number, it)| (*number, it.name.as_deref().unwrap()))
                .collect();
            assert_eq!(names, expected_names, "{}", module.name);
            for (own, (_, it)) in own.iter().zip(expected) {
                use naga::{AddressSpace, StorageAccess};
                let kind = match it.space {
                    AddressSpace::Uniform => BindingKind::Uniform,
                    AddressSpace::Storage { access } => BindingKind::Storage {
                        is_read_only: access == StorageAccess::LOAD,
                    },
                    _ => BindingKind::Integers,
                };
                assert_eq!(own.kind, kind, "{} of {}", own.name, module.name);
            }
        }
    }
}
