//! Every struct and number that host and shaders share: made of `shaders/scene/layout.wgsl`, which documents them, when this crate is built
//! (`build/layout.rs`). The tests hold names, offsets and sizes equal by naga's reflection of the text.
//!
//! Not encase: it writes structs member by member, where arrays of millions of these are copied as they lie in memory.

use bytemuck::{Pod, Zeroable};

/// Offset of the pixels of a film in its buffer, bytes. A count comes first: invocations whose loops were cut short.
pub(crate) const FILM_PIXELS_OFFSET: u64 = 16;

/// Name, size, and name and offset of each member.
#[cfg(test)]
type HostStruct = (&'static str, usize, Vec<(&'static str, usize)>);

macro_rules! shared {
    ($($(#[$doc:meta])* $name:ident { $($member:ident: $type:ty,)* })*) => {
        $(
            $(#[$doc])*
            #[repr(C)]
            #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
            #[allow(missing_docs, reason = "documented in layout.wgsl")]
            pub(crate) struct $name {
                $(pub $member: $type,)*
            }
        )*

        /// Every struct.
        #[cfg(test)]
        fn host_structs() -> Vec<HostStruct> {
            vec![$((
                stringify!($name),
                size_of::<$name>(),
                vec![$((stringify!($member), std::mem::offset_of!($name, $member))),*],
            )),*]
        }
    };
}

/// Layout of a struct that another crate has.
#[cfg(test)]
macro_rules! of_image {
    ($name:ident { $($member:ident),* }) => {{
        use hairline_image::$name;
        let offsets = vec![$((stringify!($member), std::mem::offset_of!($name, $member))),*];
        (stringify!($name), size_of::<$name>(), offsets)
    }};
}

// A member whose name begins with `pad` is room that WGSL leaves without a name.
include!(concat!(env!("OUT_DIR"), "/layout.rs"));

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders;
    use naga::{Module, TypeInner};

    /// Structs of this crate and those that a film holds for another one.
    fn all_host_structs() -> Vec<HostStruct> {
        let mut all = host_structs();
        all.push(of_image!(TracedLight {
            open,
            around,
            weight,
            seen,
            bounced,
            share_moments,
            bounced_moments
        }));
        all.push(of_image!(TracedPixel {
            rest,
            roughness,
            object,
            diffuse,
            specular,
            scratches
        }));
        all
    }

    fn reflect() -> Module {
        let text = shaders::compose(&[&shaders::LAYOUT]);
        naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)))
    }

    fn wgsl_struct<'a>(module: &'a Module, name: &str) -> Option<(&'a [naga::StructMember], u32)> {
        module.types.iter().find_map(|(_, ty)| match &ty.inner {
            TypeInner::Struct { members, span } if ty.name.as_deref() == Some(name) => {
                Some((members.as_slice(), *span))
            }
            _ => None,
        })
    }

    /// Describes the difference of a host struct from the shader's, if there is one.
    fn difference(
        module: &Module,
        name: &str,
        size: usize,
        members: &[(&str, usize)],
    ) -> Option<String> {
        let Some((shader_members, shader_size)) = wgsl_struct(module, name) else {
            return Some(format!("layout.wgsl has no struct {name}"));
        };
        if shader_size as usize != size {
            return Some(format!(
                "{name}: {size} bytes on the host, {shader_size} in the shader"
            ));
        }
        let host: Vec<_> = members
            .iter()
            .filter(|(member, _)| !member.starts_with("pad"))
            .copied()
            .collect();
        let shader: Vec<_> = shader_members
            .iter()
            .map(|m| (m.name.as_deref().unwrap_or(""), m.offset as usize))
            .collect();
        (host != shader).then(|| format!("{name}:\n  host   {host:?}\n  shader {shader:?}"))
    }

    #[test]
    fn host_and_shader_structs_are_equal() {
        let module = reflect();
        let differences: Vec<_> = all_host_structs()
            .iter()
            .filter_map(|(name, size, members)| difference(&module, name, *size, members))
            .collect();
        assert!(differences.is_empty(), "{}", differences.join("\n"));
    }

    /// The comparison must be able to fail: a renamed member, a swapped pair, another size.
    #[test]
    fn a_drifted_struct_is_seen() {
        let module = reflect();
        let right = [("first", 0), ("end", 4), ("adds", 8)];
        assert_eq!(difference(&module, "LightRange", 12, &right), None);
        assert!(difference(&module, "LightRange", 16, &right).is_some());
        let renamed = [("start", 0), ("end", 4), ("adds", 8)];
        assert!(difference(&module, "LightRange", 12, &renamed).is_some());
        let swapped = [("end", 0), ("first", 4), ("adds", 8)];
        assert!(difference(&module, "LightRange", 12, &swapped).is_some());
    }

    /// Every struct of the shader has its host twin, and array strides are the structs' sizes.
    #[test]
    fn no_shader_struct_is_left_out() {
        let module = reflect();
        let host = all_host_structs();
        for (_, ty) in module.types.iter() {
            let name = ty.name.as_deref().unwrap_or("");
            if let TypeInner::Struct { members, .. } = &ty.inner {
                let known = host.iter().any(|(known, ..)| *known == name);
                // An array without an end follows its head.
                if name == "Film" {
                    assert_eq!(u64::from(members[2].offset), FILM_PIXELS_OFFSET);
                } else {
                    assert!(known, "{name} has no host twin");
                }
            }
            if let TypeInner::Array { base, stride, .. } = ty.inner
                && let Some((_, size, _)) = host
                    .iter()
                    .find(|(n, ..)| module.types[base].name.as_deref() == Some(n))
            {
                assert_eq!(stride as usize, *size);
            }
        }
    }
}
