//! The passes over a scene: which ones a method and what a scene has ask for, and what a device has compiled already.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use hairline_optics::method::Lookup;

use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::error::Error;
use crate::film::RoomNeeds;
use crate::pipelines::Orders;
use crate::shade::ShadePass;
use crate::shade_bundles::BundlesPasses;
use crate::tiles::TilesPasses;
use crate::variant::ShadeVariant;

/// The passes that are compiled for a method and for what a scene has.
pub(crate) struct ScenePasses {
    /// Where the method wants tiles, and there are scratches to find.
    pub tiles: Option<TilesPasses>,
    /// Where the method gathers by grids.
    pub bundles: Option<BundlesPasses>,
    pub shade: ShadePass,
}

impl ScenePasses {
    async fn new(gpu: &Gpu, layouts: &Layouts, variant: &ShadeVariant) -> Result<Self, Error> {
        let method = &variant.method;
        let has_tiles =
            method.is_default_path() && method.lookup == Lookup::Tiles && variant.has.scratches;
        let has_bundles = method.gather.has_grids() && variant.has.scratches;
        let mut orders = Orders::new(gpu, layouts, variant);
        // What takes the longest begins first.
        let shade = ShadePass::new(&mut orders, has_tiles);
        let tiles = has_tiles.then(|| TilesPasses::new(&mut orders));
        let bundles = has_bundles.then(|| BundlesPasses::new(&mut orders));
        orders.compile().await?;
        Ok(Self {
            tiles,
            bundles,
            shade,
        })
    }

    /// For what they need a place, with so many straight pieces of scratches.
    pub fn needs(&self, segments: u32) -> RoomNeeds {
        let has_records = self.tiles.as_ref().is_some_and(TilesPasses::has_records);
        RoomNeeds {
            tiles: self.tiles.is_some() || self.bundles.is_some(),
            records: if has_records { segments } else { 0 },
            walks: self.bundles.is_some(),
        }
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
    use hairline_optics::method::{Method, SphereBase};

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
            sphere_base: SphereBase::Pivot,
            ..Method::default()
        };
        assert!(!Arc::ptr_eq(&first, &passes(other)));
    }
}
