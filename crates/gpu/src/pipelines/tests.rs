use super::*;
use crate::headless;
use crate::method::Method;
use crate::pass_bindings::{EntryPoint, Project};
use crate::pipeline_cache::PipelineCache;
use crate::variant::Contents;

/// A refused pipeline is reported, whichever thread it was compiled on.
#[test]
fn one_bad_order_spoils_all() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let layouts = Layouts::new(gpu);
    let variant = ShadeVariant {
        method: Method::default(),
        has: Contents::default(),
    };
    let compile = |bad: Option<usize>| {
        // A device that has compiled nothing yet.
        let mut gpu = gpu.clone();
        gpu.pipelines = PipelineCache::default();
        let gpu = &gpu;
        let mut orders = Orders::new(gpu, &layouts, &variant);
        for i in 0..6 {
            let entry_point = if bad == Some(i) { "nothing" } else { "project" };
            let entry_point = EntryPoint::<Project>::new(&shaders::PROJECT, entry_point);
            orders.pass("project", entry_point);
        }
        gpu.block_on(orders.compile())
    };
    assert_eq!(compile(None), Ok(()));
    for bad in 0..6 {
        let refused = compile(Some(bad));
        assert!(
            matches!(&refused, Err(Error::Validation { description }) if description.contains("nothing")),
            "{refused:?}"
        );
    }
}
