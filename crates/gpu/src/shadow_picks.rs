//! Shadow rays by way of picks: scratches, or gratings, that were chosen for a sample.
//!
//! Some pairs of a sample, each of a scratch or a grating with a light, stand for all. They are picked by lighting all of them once more; a round
//! takes one of the picks.

use crate::compute_pass::{ComputePass, Recording, Workgroups};
use crate::kind_passes::KindPasses;
use crate::lights::LightKind;
use crate::pipelines::Orders;
use crate::resources::Resources;
use crate::shadow_buffers::ShadowBuffers;
use crate::variant::{RayOrigin, Way};
use crate::{shade_gratings, shade_scratches, shaders};

/// Passes that pick scratches or gratings, and draw rays by way of them.
pub(crate) struct PickPasses {
    /// Finds where the running sums of a group begin by which the second lighting picks.
    begin: ComputePass,
    pick: KindPasses,
    /// One pass for each kind of light that the rays go to.
    rays: Vec<ComputePass>,
    /// Lobe by which light leaves the samples.
    pub way: Way,
}

/// Groups and chunks of scratches to be picked from, a workgroup each.
#[derive(Clone)]
pub(crate) struct Scratched {
    pub groups: Workgroups,
    pub chunks: Workgroups,
}

impl PickPasses {
    /// Makes the passes for scratches of samples that are seen by the camera or by rays.
    pub(crate) fn of_scratches(orders: &mut Orders, seen: RayOrigin) -> Self {
        let constants = [("PICKS", 1.0), seen.constant()];
        let pick = shade_scratches::kinds(orders, "shadow picks", &constants);
        Self::new(orders, "shadow_picks", pick, Way::Scratches)
    }

    /// Makes the passes for gratings.
    pub(crate) fn of_gratings(orders: &mut Orders) -> Self {
        let pick = shade_gratings::kinds(orders, "shadow picks", &[("PICKS", 1.0)]);
        Self::new(orders, "shadow_grating_picks", pick, Way::Gratings)
    }

    fn new(orders: &mut Orders, begin: &'static str, pick: KindPasses, way: Way) -> Self {
        let mut kinds: Vec<_> = orders.variant().has.lights.of_rays().collect();
        if kinds.is_empty() {
            // Then there is no pick, which one pass must tell.
            kinds.push(LightKind::Spheres);
        }
        let rays = kinds.into_iter().map(|kind| {
            let module = (&shaders::SHADOW_PICKED_RAYS, "shadow_picked_rays");
            let mut constants = kind.constants().to_vec();
            constants.push(("OF_GRATINGS", (way == Way::Gratings).into()));
            ComputePass::order(orders, "shadow rays", module, &constants)
        });
        let rays = rays.collect();
        let module = (&shaders::SHADOW_PICKS, begin);
        Self {
            begin: ComputePass::order(orders, "shadow picks", module, &[]),
            pick,
            rays,
            way,
        }
    }

    /// Picks for each sample as many as the round that was written says.
    pub(crate) fn record_picks(
        &self,
        recording: &mut Recording,
        resources: &Resources,
        shadow_buffers: &ShadowBuffers,
        on: &Scratched,
    ) {
        self.begin.run(recording, resources, &on.groups);
        let into_picks = into_picks(resources, shadow_buffers);
        let workgroups = match self.way {
            Way::Gratings => &on.groups,
            _ => &on.chunks,
        };
        self.pick.run(recording, &into_picks, workgroups);
    }

    /// Draws a ray of each sample by way of the round's pick.
    pub(crate) fn record_rays(
        &self,
        recording: &mut Recording,
        resources: &Resources,
        groups: &Workgroups,
    ) {
        for pass in &self.rays {
            pass.run(recording, resources, groups);
        }
    }
}

/// Passes of light with these resources write to the picks in place of the sums.
pub(crate) fn into_picks(resources: &Resources, shadow_buffers: &ShadowBuffers) -> Resources {
    let picks = &shadow_buffers.picks;
    resources
        .clone()
        .buffer("chunk_words", picks)
        .buffer("grating_words", picks)
}
