//! A pass for each kind of light that a scene has, which all write to the same sums.

use crate::compute_pass::{ComputePass, Recording, Workgroups};
use crate::light_ranges::RANGE_STRIDE;
use crate::lights::LightKind;
use crate::pipelines::Orders;
use crate::resources::Resources;
use crate::shaders::Module;
use crate::variant::Constant;

/// One pass for each kind of light that the scene has; spheres where it has none, for the mask.
pub(crate) struct KindPasses(Vec<(LightKind, ComputePass)>);

/// A pass over no light, as the shader calls it. Twin: pair_light.wgsl.
pub(crate) const LIGHTS_NONE: u32 = LightKind::ALL.len() as u32;

impl KindPasses {
    /// Makes the passes with `more` constants besides that of the kind.
    pub(crate) fn new(
        orders: &mut Orders,
        name: &'static str,
        module: (&'static Module, &'static str),
        more: &[Constant],
    ) -> Self {
        let has = orders.variant().has;
        let pass = |kind: LightKind| (kind, over_lights(orders, name, module, kind as u32, more));
        Self(has.lights.over_scratches().map(pass).collect())
    }

    /// Records the passes over all lights, as many at once as there is room for.
    pub(crate) fn run(
        &self,
        recording: &mut Recording,
        resources: &Resources,
        workgroups: &Workgroups,
    ) {
        let ranges = &recording.scene.light_ranges;
        for (kind, pass) in &self.0 {
            let group = pass.bind(recording, resources);
            let own = ranges.of.iter().enumerate().filter(|(_, of)| *of == kind);
            for (i, _) in own {
                let offset = (i as u64 * RANGE_STRIDE) as u32;
                pass.dispatch(recording, &group, &[offset], workgroups);
            }
        }
    }
}

/// The pass for one kind of light, or [`LIGHTS_NONE`].
pub(crate) fn over_lights(
    orders: &mut Orders,
    name: &'static str,
    module: (&'static Module, &'static str),
    lights: u32,
    more: &[Constant],
) -> ComputePass {
    let mut constants = more.to_vec();
    constants.push(("SCRATCH_LIGHTS", f64::from(lights)));
    ComputePass::order(orders, name, module, &constants)
}
