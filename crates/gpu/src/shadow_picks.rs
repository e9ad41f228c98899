//! Shadow rays by way of picks: scratches, or gratings, that were chosen for a sample.
//!
//! Some pairs of a sample, each of a scratch or a grating with a light, stand for all. They are picked by lighting all of them once more; a round
//! takes one of the picks.

use crate::compute_pass::{ComputePass, Recording, Workgroups};
use crate::film::Film;
use crate::kind_passes::KindPasses;
use crate::lights::LightKind;
use crate::pass_bindings::{
    EntryPoint, ShadeGratings, ShadeScratches, ShadowPickedRays, ShadowPicks,
};
use crate::pipelines::Orders;
use crate::shadow_buffers::ShadowBuffers;
use crate::strip::StripBuffers;
use crate::variant::{RayOrigin, Way};
use crate::{shade_gratings, shade_scratches};

/// Passes that pick scratches or gratings, and draw rays by way of them.
pub(crate) struct PickPasses {
    /// Finds where the running sums of a group begin by which the second lighting picks.
    begin: ComputePass<ShadowPicks<'static>>,
    pick: Pick,
    /// One pass for each kind of light that the rays go to.
    rays: Vec<ComputePass<ShadowPickedRays<'static>>>,
}

enum Pick {
    Scratches(KindPasses<ShadeScratches<'static>>),
    Gratings(KindPasses<ShadeGratings<'static>>),
}

/// Samples, and the arrays of their rays.
#[derive(Clone, Copy)]
pub(crate) struct RayBuffers<'a> {
    pub strip: &'a StripBuffers,
    pub shadows: &'a ShadowBuffers,
    pub film: &'a Film,
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
        Self::new(orders, ShadowPicks::SHADOW_PICKS, Pick::Scratches(pick))
    }

    /// Makes the passes for gratings.
    pub(crate) fn of_gratings(orders: &mut Orders) -> Self {
        let pick = shade_gratings::kinds(orders, "shadow picks", &[("PICKS", 1.0)]);
        Self::new(
            orders,
            ShadowPicks::SHADOW_GRATING_PICKS,
            Pick::Gratings(pick),
        )
    }

    fn new(orders: &mut Orders, begin: EntryPoint<ShadowPicks<'static>>, pick: Pick) -> Self {
        let mut kinds: Vec<_> = orders.variant().has.lights.of_rays().collect();
        if kinds.is_empty() {
            // Then there is no pick, which one pass must tell.
            kinds.push(LightKind::Spheres);
        }
        let rays = kinds.into_iter().map(|kind| {
            let entry_point = ShadowPickedRays::SHADOW_PICKED_RAYS;
            let mut constants = kind.constants().to_vec();
            constants.push(("OF_GRATINGS", matches!(pick, Pick::Gratings(_)).into()));
            ComputePass::order(orders, "shadow rays", entry_point, &constants)
        });
        let rays = rays.collect();
        Self {
            begin: orders.pass("shadow picks", begin),
            pick,
            rays,
        }
    }

    /// Lobe by which light leaves the samples.
    pub(crate) fn way(&self) -> Way {
        match self.pick {
            Pick::Scratches(_) => Way::Scratches,
            Pick::Gratings(_) => Way::Gratings,
        }
    }

    /// Picks for each sample as many as the round that was written says.
    pub(crate) fn record_picks(
        &self,
        recording: &mut Recording,
        buffers: RayBuffers,
        on: &Scratched,
    ) {
        let (scene, picks) = (recording.scene, &buffers.shadows.picks);
        let begun = begin(buffers.strip, buffers.shadows, &buffers.shadows.round);
        self.begin.run(recording, &begun, &on.groups);
        match &self.pick {
            Pick::Scratches(pass) => {
                let bound = shade_scratches::bindings(scene, buffers.strip, picks);
                pass.run(recording, &bound, &on.chunks);
            }
            Pick::Gratings(pass) => {
                let bound = shade_gratings::bindings(scene, buffers.strip, buffers.film, picks);
                pass.run(recording, &bound, &on.groups);
            }
        }
    }

    /// Draws a ray of each sample by way of the round's pick.
    pub(crate) fn record_rays(
        &self,
        recording: &mut Recording,
        buffers: RayBuffers,
        groups: &Workgroups,
    ) {
        let (samples, shadows) = (&buffers.strip.samples, buffers.shadows);
        let bound = ShadowPickedRays {
            points: &samples.points,
            chunk_starts: &samples.chunk_starts,
            gratings: recording.scene.buffers.gratings(),
            picks: &shadows.picks,
            rays: &shadows.rays,
            shadow_round: &shadows.round,
            paints: &samples.paints,
        };
        for pass in &self.rays {
            pass.run(recording, &bound, groups);
        }
    }
}

/// Bindings of the pass that begins the picks of a round.
pub(crate) fn begin<'a>(
    strip: &'a StripBuffers,
    shadows: &'a ShadowBuffers,
    shadow_round: &'a wgpu::Buffer,
) -> ShadowPicks<'a> {
    ShadowPicks {
        points: &strip.samples.points,
        chunk_starts: &strip.samples.chunk_starts,
        chunk_sums: &strip.samples.chunk_sums,
        picks: &shadows.picks,
        shadow_round,
    }
}
