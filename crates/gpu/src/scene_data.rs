//! A scene as it lies on the device: buffers, textures and the lights of each dispatch. It knows no pass.

use std::ops::Range;

use glam::DVec3;

use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::error::Error;
use crate::light_ranges::LightRanges;
use crate::scene_buffers::{SceneBuffers, check_size};
use crate::source::Source;
use crate::texture_array::TextureArray;
use crate::textures::SceneTextures;
use crate::transfer::{Transfer, Written};

/// What the passes read of a scene, all but the camera.
pub(crate) struct SceneData {
    pub buffers: SceneBuffers,
    pub textures: SceneTextures,
    pub light_count: u32,
    /// Of the lights, those that do not shine on scratches alone: they come first.
    pub base_light_count: u32,
    pub light_ranges: LightRanges,
    /// The first of the objects that are the shapes of lights.
    pub lamps: u32,
    pub written: Vec<Written>,
    device: wgpu::Device,
}

impl SceneData {
    /// Uploads what `last` does not have. Nothing of `last` is written to: it stays as good as it was.
    ///
    /// # Errors
    /// [`Error::TooLarge`] before anything is allocated, [`Error::OutOfMemory`].
    pub(crate) async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        source: &Source<'_>,
        last: Option<&Self>,
    ) -> Result<Self, Error> {
        check_size(gpu, source)?;
        // What lies on a device that was lost is of no use to the next one.
        let last = last.filter(|last| last.device == gpu.device);
        let (last_buffers, last_textures) = (
            last.map(|last| &last.buffers),
            last.map(|last| &last.textures),
        );
        let array = TextureArray::new(source.scene);
        let mut transfer = Transfer::new(gpu);
        let buffers =
            SceneBuffers::upload(&mut transfer, layouts, source, &array, last_buffers).await?;
        let textures =
            SceneTextures::upload(&mut transfer, layouts, source, &array, last_textures).await?;
        let light_ranges = LightRanges::upload(gpu, source.scene).await?;
        gpu.check()?;
        Ok(Self {
            buffers,
            textures,
            light_count: source.scene.scratch_lights().count() as u32,
            base_light_count: source.scene.all_lights().count() as u32,
            light_ranges,
            lamps: source
                .scene
                .objects
                .iter()
                .take_while(|object| !object.is_lamp)
                .count() as u32,
            written: transfer.end(),
            device: gpu.device.clone(),
        })
    }

    /// What uploaded positions are relative to, world space.
    pub(crate) fn origin_m(&self) -> DVec3 {
        self.buffers.vertices.origin_m
    }

    /// Triangles of each object, counted over the whole scene.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = &Range<u32>> {
        self.buffers.vertices.triangles()
    }
}
