//! A scene as it lies on the device: buffers, textures and the lights of each dispatch. It knows no pass.

use std::ops::Range;

use glam::DVec3;
use hairline_scene::{Object, Scene};

use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::error::Error;
use crate::light_ranges::LightRanges;
use crate::method_tables;
use crate::scene_buffers::{SceneBuffers, check_size};
use crate::source::Source;
use crate::texture_array::TextureArray;
use crate::textures::SceneTextures;
use crate::transfer::{Transfer, Written};

/// Data of a scene that the passes read, all but the camera.
pub(crate) struct SceneData {
    pub buffers: SceneBuffers,
    pub textures: SceneTextures,
    pub light_count: u32,
    pub light_ranges: LightRanges,
    /// Tables of a method that is not Hairline's own.
    pub method_tables: Vec<wgpu::TextureView>,
    /// The first of the objects that are the shapes of lights.
    pub lamps: u32,
    /// Whether each object has a cutout.
    pub cutouts: Vec<bool>,
    pub written: Vec<Written>,
    device: wgpu::Device,
}

fn cutouts(scene: &Scene) -> Vec<bool> {
    let is_cut: Vec<bool> = scene
        .materials
        .iter()
        .map(|it| it.cutout.is_some())
        .collect();
    let any = is_cut.contains(&true);
    let of_object = |object: &Object| {
        let mut materials = object.mesh.triangle_materials.iter();
        any && materials.any(|material| is_cut[*material as usize])
    };
    scene.objects.iter().map(of_object).collect()
}

impl SceneData {
    /// Uploads the data that `last` does not have. Nothing of `last` is written to: it stays as good as
    /// it was.
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
        // Arrays on a lost device cannot be used on the next one.
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
        let origin_m = buffers.vertices.origin_m;
        let method_tables = method_tables::upload(&mut transfer, source, origin_m).await?;
        gpu.check()?;
        Ok(Self {
            buffers,
            textures,
            light_count: source.scene.all_lights().count() as u32,
            light_ranges,
            method_tables,
            lamps: source
                .scene
                .objects
                .iter()
                .take_while(|object| !object.is_lamp)
                .count() as u32,
            cutouts: cutouts(source.scene),
            written: transfer.end(),
            device: gpu.device.clone(),
        })
    }

    /// Origin of the uploaded positions, world space.
    pub(crate) fn origin_m(&self) -> DVec3 {
        self.buffers.vertices.origin_m
    }

    /// Triangles of each object, counted over the whole scene.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = &Range<u32>> {
        self.buffers.vertices.triangles()
    }
}
