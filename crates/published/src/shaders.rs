//! The shader modules of the method, which stand on those of [`hairline_gpu::shaders`] and are made of their files as those are.

use hairline_gpu::shaders::{Binding, BindingKind, Module};

include!(concat!(env!("OUT_DIR"), "/modules.rs"));

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_gpu::shaders::compose;

    #[test]
    fn each_module_is_valid_with_what_it_needs() {
        for module in ALL {
            let text = compose(&[module]);
            let parsed = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| {
                panic!("{}:\n{}", module.name, error.emit_to_string(&text))
            });
            let capabilities = naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32;
            naga::valid::Validator::new(naga::valid::ValidationFlags::all(), capabilities)
                .validate(&parsed)
                .unwrap_or_else(|error| {
                    panic!("{}:\n{}", module.name, error.emit_to_string(&text))
                });
        }
    }
}
