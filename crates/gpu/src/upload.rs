//! A scene on the device, and the passes that are compiled for it.

use hairline_scene::Scene;

use crate::bindings::Layouts;
use crate::bounces::Bounces;
use crate::device::Gpu;
use crate::error::Error;
use crate::passes::ScenePasses;
use crate::scene_data::SceneData;
use crate::shadows::Shadows;
use crate::source::Source;
use crate::transfer::{Transfer, Written};
use crate::triangle_tree::TriangleTree;
use crate::variant::{Contents, ShadeVariant};

/// A scene on the device, for one method: everything but the camera.
pub struct GpuScene {
    pub(crate) data: SceneData,
    pub(crate) passes: ScenePasses,
    /// Shadow passes; none: nothing hides a light.
    pub(crate) shadows: Option<Shadows>,
    /// Bounce passes; none: light goes by no other object.
    pub(crate) bounces: Option<Bounces>,
    /// Tree for shadows, of this scene or of the one before.
    tree: Option<TriangleTree>,
    variant: ShadeVariant,
}

impl GpuScene {
    /// Compiles the passes that the device does not have yet, and uploads the data that `last` does not have. Nothing of
    /// `last` is written to.
    ///
    /// # Errors
    /// [`Error::Refused`] if the driver cannot compile a pass, [`Error::TooLarge`] before anything is allocated,
    /// [`Error::OutOfMemory`].
    pub(crate) async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        source: &Source<'_>,
        last: Option<&Self>,
    ) -> Result<Self, Error> {
        let variant = ShadeVariant {
            method: source.method.clone(),
            has: Contents::new(source.scene, source.tables, source.method),
        };
        let passes = ScenePasses::new(gpu, layouts, &variant).await?;
        let data = SceneData::new(gpu, layouts, source, last.map(|last| &last.data)).await?;
        Ok(Self {
            data,
            passes,
            shadows: None,
            bounces: None,
            tree: last.and_then(|last| last.tree.clone()),
            variant,
        })
    }

    /// Lets the objects of the scene hide lights from one another, and light go by up to `bounces` others.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) async fn add_shadows(
        &mut self,
        gpu: &Gpu,
        layouts: &Layouts,
        scene: &Scene,
        bounces: u32,
    ) -> Result<(), Error> {
        let Self { data, variant, .. } = self;
        let kept = self.tree.take();
        let tree = match kept.filter(|tree| tree.is_of(gpu, scene, data.origin_m())) {
            Some(tree) => tree,
            None => {
                let mut transfer = Transfer::new(gpu);
                let tree = TriangleTree::upload(&mut transfer, scene, data.origin_m()).await?;
                data.written.extend(transfer.end());
                tree
            }
        };
        self.tree = Some(tree.clone());
        let shadows = Shadows::new(gpu, layouts, scene, data, variant, tree).await?;
        self.bounces = match bounces {
            0 => None,
            count => Some(Bounces::new(gpu, layouts, data, variant, &shadows, count).await?),
        };
        self.shadows = Some(shadows);
        Ok(())
    }

    /// Arrays that the last upload or update wrote. Arrays that it copied on the device or left unchanged are not among
    /// them.
    pub fn written(&self) -> &[Written] {
        &self.data.written
    }
}
