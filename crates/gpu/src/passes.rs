//! The passes over a scene, by the method and the scene's contents.

use crate::bin::BinPasses;
use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::edges::EdgesPass;
use crate::error::Error;
use crate::pipelines::Orders;
use crate::project::ProjectPass;
use crate::resolve::ResolvePass;
use crate::shade_base::ShadeBasePass;
use crate::shade_gratings::ShadeGratingsPass;
use crate::shade_published::ShadePublishedPass;
use crate::shade_scratches::ShadeScratchesPass;
use crate::share_scratches::ShareScratchesPass;
use crate::surface::SurfacePass;
use crate::variant::{Seen, ShadeVariant};

/// Passes that are compiled for a method and a scene's contents.
pub(crate) struct ScenePasses {
    pub edges: EdgesPass,
    pub surface: SurfacePass,
    pub shade: Shade,
    pub resolve: ResolvePass,
}

/// Passes that shade base and scratches.
pub(crate) enum Shade {
    /// Hairline's own method.
    Own {
        base: ShadeBasePass,
        /// Passes for scratches; none where the scene has none.
        scratches: Option<Box<ScratchPasses>>,
        /// Pass for gratings; none where the scene has none.
        gratings: Option<ShadeGratingsPass>,
    },
    /// The method of 2018.
    Published(ShadePublishedPass),
}

pub(crate) struct ScratchPasses {
    pub project: ProjectPass,
    pub bin: BinPasses,
    pub share: ShareScratchesPass,
    pub shade: ShadeScratchesPass,
}

impl ScenePasses {
    /// Passes of tile lists, if scratches are shaded by them.
    pub(crate) fn scratches(&self) -> Option<&ScratchPasses> {
        match &self.shade {
            Shade::Own { scratches, .. } => scratches.as_deref(),
            Shade::Published(_) => None,
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
        let shade = if variant.method.published.is_some() {
            Shade::Published(ShadePublishedPass::new(&mut orders))
        } else {
            Shade::Own {
                base: ShadeBasePass::new(&mut orders),
                scratches: variant.has.scratches.then(|| {
                    Box::new(ScratchPasses {
                        project: ProjectPass::new(&mut orders),
                        bin: BinPasses::new(&mut orders),
                        share: ShareScratchesPass::new(&mut orders),
                        shade: ShadeScratchesPass::new(&mut orders, Seen::ByCamera),
                    })
                }),
                gratings: (variant.has.gratings).then(|| ShadeGratingsPass::new(&mut orders)),
            }
        };
        let passes = Self {
            edges: EdgesPass::new(&mut orders),
            surface: SurfacePass::new(&mut orders),
            resolve: ResolvePass::new(&mut orders),
            shade,
        };
        orders.compile().await?;
        Ok(passes)
    }
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
