//! The passes over a scene: which ones a method and what a scene has ask for, and what a device has compiled already.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::bin::BinPasses;
use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::edges::EdgesPass;
use crate::error::Error;
use crate::pipelines::Orders;
use crate::project::ProjectPass;
use crate::resolve::ResolvePass;
use crate::shade_base::ShadeBasePass;
use crate::shade_published::ShadePublishedPass;
use crate::shade_scratches::ShadeScratchesPass;
use crate::surface::SurfacePass;
use crate::variant::ShadeVariant;

/// The passes that are compiled for a method and for what a scene has.
pub(crate) struct ScenePasses {
    pub edges: EdgesPass,
    pub surface: SurfacePass,
    pub shade: Shade,
    pub resolve: ResolvePass,
}

/// How base and scratches are shaded.
pub(crate) enum Shade {
    /// By Hairline's own method.
    Own {
        base: ShadeBasePass,
        /// None where the scene has none.
        scratches: Option<Box<ScratchPasses>>,
    },
    /// By the method of 2018.
    Published(ShadePublishedPass),
}

pub(crate) struct ScratchPasses {
    pub project: ProjectPass,
    pub bin: BinPasses,
    pub shade: ShadeScratchesPass,
}

impl ScenePasses {
    /// Those of tile lists, if scratches are shaded by them.
    pub fn scratches(&self) -> Option<&ScratchPasses> {
        match &self.shade {
            Shade::Own { scratches, .. } => scratches.as_deref(),
            Shade::Published(_) => None,
        }
    }

    async fn new(gpu: &Gpu, layouts: &Layouts, variant: &ShadeVariant) -> Result<Self, Error> {
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
                        shade: ShadeScratchesPass::new(&mut orders),
                    })
                }),
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

/// The passes over scenes that a device has compiled: that takes seconds, so that all its renderers share them. Clones are the same.
#[derive(Clone, Default)]
pub(crate) struct Compiled(Arc<Mutex<HashMap<ShadeVariant, Arc<ScenePasses>>>>);

impl Compiled {
    /// The passes of a variant, compiled if the device has not had it. Two renderers that ask for the same at once both compile.
    pub async fn passes(
        &self,
        gpu: &Gpu,
        layouts: &Layouts,
        variant: &ShadeVariant,
    ) -> Result<Arc<ScenePasses>, Error> {
        let had = self.had(|passes| passes.get(variant).map(Arc::clone));
        if let Some(passes) = had {
            return Ok(passes);
        }
        let passes = ScenePasses::new(gpu, layouts, variant).await?;
        Ok(self.had(|all| Arc::clone(all.entry(*variant).or_insert(Arc::new(passes)))))
    }

    /// Never held while something is compiled or awaited.
    fn had<T>(&self, look: impl FnOnce(&mut HashMap<ShadeVariant, Arc<ScenePasses>>) -> T) -> T {
        look(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests {
    use hairline_optics::mask::Mask;
    use hairline_optics::method::Method;

    use super::*;
    use crate::headless;
    use crate::variant::Contents;

    #[test]
    fn a_kind_is_compiled_once_for_all_renderers() {
        let Some(gpu) = headless::test_gpu() else {
            return;
        };
        // What compiles soonest: a scene that has nothing.
        let has = Contents::default();
        let passes = |method| {
            // As another renderer, with layouts of its own.
            let (gpu, layouts) = (gpu.clone(), Layouts::new(gpu));
            let variant = ShadeVariant { method, has };
            gpu.block_on(gpu.compiled.passes(&gpu, &layouts, &variant))
                .unwrap()
        };
        let first = passes(Method::default());
        assert!(Arc::ptr_eq(&first, &passes(Method::default())));
        let other = Method {
            mask: Mask::Linear,
            ..Method::default()
        };
        assert!(!Arc::ptr_eq(&first, &passes(other)));
    }
}
