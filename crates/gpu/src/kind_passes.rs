//! A pass for each kind of light that a scene has, which all write to the same sums.

use crate::compute_pass::{ComputePass, Recording, Workgroups};
use crate::light_ranges::RANGE_STRIDE;
use crate::lights::LightKind;
use crate::pass_bindings::{EntryPoint, PassBindings};
use crate::pipelines::Orders;
use crate::variant::Constant;

/// One pass for each kind of light that the scene has; spheres where it has none, for the mask.
pub(crate) struct KindPasses<B>(Vec<(LightKind, ComputePass<B>)>);

/// A pass over no light, as the shader calls it. Twin: pair_light.wgsl.
pub(crate) const LIGHTS_NONE: u32 = LightKind::ALL.len() as u32;

impl<B: PassBindings> KindPasses<B> {
    /// Makes the passes with `more` constants besides that of the kind.
    pub(crate) fn new(
        orders: &mut Orders,
        name: &'static str,
        entry_point: EntryPoint<B>,
        more: &[Constant],
    ) -> Self {
        let has = orders.variant().has;
        let pass = |kind: LightKind| {
            (
                kind,
                over_lights(orders, name, entry_point, kind as u32, more),
            )
        };
        Self(has.lights.over_scratches().map(pass).collect())
    }

    /// Records the passes over all lights, as many at once as there is room for.
    pub(crate) fn run(
        &self,
        recording: &mut Recording,
        bound: &B::With<'_>,
        workgroups: &Workgroups,
    ) {
        let ranges = &recording.scene.light_ranges;
        for (kind, pass) in &self.0 {
            let group = pass.bind(recording.gpu, bound);
            let own = ranges.of.iter().enumerate().filter(|(_, of)| *of == kind);
            for (i, _) in own {
                let offset = (i as u64 * RANGE_STRIDE) as u32;
                pass.dispatch(recording, &group, &[offset], workgroups);
            }
        }
    }
}

/// The pass for one kind of light, or [`LIGHTS_NONE`].
pub(crate) fn over_lights<B: PassBindings>(
    orders: &mut Orders,
    name: &'static str,
    entry_point: EntryPoint<B>,
    lights: u32,
    more: &[Constant],
) -> ComputePass<B> {
    let mut constants = more.to_vec();
    constants.push(("SCRATCH_LIGHTS", f64::from(lights)));
    ComputePass::order(orders, name, entry_point, &constants)
}
