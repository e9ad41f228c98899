use hairline_optics::mask::Mask;

use super::*;
use crate::headless;
use crate::method::Method;
use crate::variant::Contents;

#[test]
fn a_kind_is_compiled_once_for_all_renderers() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    // An empty scene compiles fastest.
    let has = Contents::default();
    let resolve = |method| {
        // Another renderer would have layouts of its own.
        let (gpu, layouts) = (gpu.clone(), Layouts::new(gpu));
        let variant = ShadeVariant { method, has };
        let passes = gpu.block_on(ScenePasses::new(&gpu, &layouts, &variant));
        passes.unwrap().resolve.pipeline().clone()
    };
    let first = resolve(Method::default());
    assert_eq!(first, resolve(Method::default()));
    let other = Method {
        mask: Mask::Linear,
        ..Method::default()
    };
    assert_ne!(first, resolve(other));
}
