//! The passes over a scene, by the method and the scene's contents.

use crate::bin::BinPasses;
use crate::bindings::Layouts;
use crate::compute_pass::ComputePass;
use crate::device::Gpu;
use crate::error::Error;
use crate::kind_passes::KindPasses;
use crate::pipelines::Orders;
use crate::shade_scratches::ShadeScratchesPass;
use crate::sizes::{self, CHUNKS, ENTRIES, GROUPS};
use crate::variant::{RayOrigin, ShadeVariant};
use crate::{shade_gratings, shaders};

/// Passes that are compiled for a method and a scene's contents.
pub(crate) struct ScenePasses {
    pub edges: ComputePass,
    /// Sizes by the number of entries, of groups and of chunks.
    pub sizes: [ComputePass; 3],
    pub surface: ComputePass,
    pub shade: Shade,
    pub resolve: ComputePass,
}

/// Passes that shade base and scratches.
pub(crate) enum Shade {
    /// Hairline's own method.
    Own {
        base: ComputePass,
        /// Passes for scratches; none where the scene has none.
        scratches: Option<Box<ScratchPasses>>,
        /// Pass for gratings; none where the scene has none.
        gratings: Option<KindPasses>,
    },
    /// One of others, which does without tile lists.
    Other(ComputePass),
}

pub(crate) struct ScratchPasses {
    pub bin: BinPasses,
    pub share: ComputePass,
    pub shade: ShadeScratchesPass,
}

impl ScenePasses {
    /// Passes of tile lists, if scratches are shaded by them.
    pub(crate) fn scratches(&self) -> Option<&ScratchPasses> {
        match &self.shade {
            Shade::Own { scratches, .. } => scratches.as_deref(),
            Shade::Other(_) => None,
        }
    }

    /// Number of chunks of sums that gratings need behind those of scratches, for `groups` groups.
    pub(crate) fn grating_chunks(&self, groups: u32) -> u32 {
        match &self.shade {
            Shade::Own {
                gratings: Some(_), ..
            } => groups,
            _ => 0,
        }
    }

    /// Compiles the passes that the device does not have yet.
    pub(crate) async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        variant: &ShadeVariant,
    ) -> Result<Self, Error> {
        let mut orders = Orders::new(gpu, layouts, variant);
        let module = &shaders::SHARE_SCRATCHES;
        let shade = if let Some(other) = &variant.method.other {
            let module = other.module();
            let name = module.name.rsplit('/').next().unwrap_or(module.name);
            Shade::Other(orders.pass(name, module, name))
        } else {
            Shade::Own {
                base: orders.pass("base", &shaders::SHADE_BASE, "shade_base"),
                scratches: variant.has.scratches.then(|| {
                    Box::new(ScratchPasses {
                        bin: BinPasses::new(&mut orders),
                        share: orders.pass("share scratches", module, "share_scratches"),
                        shade: ShadeScratchesPass::new(&mut orders, RayOrigin::ByCamera),
                    })
                }),
                gratings: (variant.has.gratings)
                    .then(|| shade_gratings::kinds(&mut orders, "gratings", &[])),
            }
        };
        let passes = Self {
            sizes: [ENTRIES, GROUPS, CHUNKS]
                .map(|counted| sizes::pass(&mut orders, counted, RayOrigin::ByCamera)),
            edges: orders.pass("edges", &shaders::EDGES, "edges"),
            surface: orders.pass("surface", &shaders::SURFACE, "surface"),
            resolve: orders.pass("resolve", &shaders::RESOLVE, "resolve"),
            shade,
        };
        orders.compile().await?;
        Ok(passes)
    }
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
