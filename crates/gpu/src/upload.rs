//! From a scene to buffers and textures on the device, the first time and after an edit.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use hairline_index::ScratchIndex;
use hairline_optics::method::Method;
use hairline_scene::{Scene, ScratchTables};

use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::error::Error;
use crate::host::light_kinds;
use crate::passes::ScenePasses;
use crate::scene_buffers::{SceneBuffers, check_size};
use crate::shade_scratches::LightRanges;
use crate::textures::{SceneTextures, TextureArray};
use crate::transfer::{Transfer, Written};

/// A scene on the device, for one method: everything but the camera.
pub struct GpuScene {
    pub(crate) buffers: SceneBuffers,
    pub(crate) textures: SceneTextures,
    pub(crate) light_count: u32,
    pub(crate) light_ranges: LightRanges,
    pub(crate) passes: Arc<ScenePasses>,
    written: Vec<Written>,
    device: wgpu::Device,
}

/// What is to lie on the device.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub scene: &'a Scene,
    pub index: &'a Arc<ScratchIndex>,
    pub tables: &'a ScratchTables,
    pub method: &'a Method,
}

impl GpuScene {
    /// Uploads what `last` does not have. Nothing of `last` is written to: it stays as good as it was.
    ///
    /// # Errors
    /// [`Error::TooLarge`] before anything is allocated, [`Error::OutOfMemory`].
    pub(crate) async fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        source: &Source<'_>,
        passes: Arc<ScenePasses>,
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
        let has_environment = source.scene.environment.is_some();
        let kinds = light_kinds(source.scene);
        let light_ranges = LightRanges::upload(gpu, kinds, has_environment).await?;
        gpu.check()?;
        Ok(Self {
            buffers,
            textures,
            light_count: kinds.all,
            light_ranges,
            passes,
            written: transfer.end(),
            device: gpu.device.clone(),
        })
    }

    /// What the last upload or update wrote, beside what it copied on the device; nothing about what stayed as it was.
    pub fn written(&self) -> &[Written] {
        &self.written
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
