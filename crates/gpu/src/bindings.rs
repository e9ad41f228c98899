//! What the passes bind, group by group. Twin: `shaders/bindings.wgsl` and `shaders/film.wgsl`.
//!
//! Group 0 the frame, group 1 the scene's buffers, group 2 its tables and textures, group 3 visibility and film: five
//! storage buffers in all, of the eight that every WebGPU device has.

use wgpu::ShaderStages;

use crate::device::Gpu;
use crate::storage_textures::{self, NUMBERS_FORMAT, TEXEL_FORMAT};
use crate::tile_room::TILE_LISTS_FORMAT;

/// Names of the scene's buffers in the order of their bindings.
pub const SCENE_BUFFERS: [&str; 6] = [
    "triangles",
    "objects",
    "materials",
    "lights",
    "scratch tree",
    "scratch segments",
];

/// From this one on they lie in textures.
const FIRST_ROWS: u32 = 2;

/// The layouts that the passes share.
pub(crate) struct Layouts {
    pub frame: wgpu::BindGroupLayout,
    pub scene: wgpu::BindGroupLayout,
    pub textures: wgpu::BindGroupLayout,
    pub film: wgpu::BindGroupLayout,
    /// Group 3 of the pass that makes the tiles' lists, instead.
    pub tiles: wgpu::BindGroupLayout,
}

impl Layouts {
    pub fn new(gpu: &Gpu) -> Self {
        let both = ShaderStages::VERTEX | ShaderStages::COMPUTE;
        let compute = ShaderStages::COMPUTE;
        let scene: Vec<_> = (0..SCENE_BUFFERS.len() as u32)
            // Rasterising reads the vertices alone.
            .map(|i| match i {
                0 => entry(i, both, storage(true)),
                i if i < FIRST_ROWS => entry(i, compute, storage(true)),
                i => entry(
                    i,
                    compute,
                    storage_textures::binding(gpu, TEXEL_FORMAT, wgpu::TextureViewDimension::D2),
                ),
            })
            .collect();
        let numbers =
            storage_textures::binding(gpu, NUMBERS_FORMAT, wgpu::TextureViewDimension::D2);
        let textures = [
            storage_textures::binding(gpu, TEXEL_FORMAT, wgpu::TextureViewDimension::D2Array),
            numbers,
            numbers,
            numbers,
            texture(wgpu::TextureViewDimension::D2, true),
            texture(wgpu::TextureViewDimension::D2, true),
            texture(wgpu::TextureViewDimension::D2Array, true),
            texture(wgpu::TextureViewDimension::D2, false),
            integers(),
            integers(),
        ];
        let textures: Vec<_> = (0..)
            .zip(textures)
            .map(|(i, ty)| entry(i, compute, ty))
            .collect();
        let written = wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: TILE_LISTS_FORMAT,
            view_dimension: wgpu::TextureViewDimension::D2,
        };
        let queues = entry(3, compute, storage(false));
        let tiles = [
            entry(0, compute, integers()),
            entry(1, compute, written),
            queues,
        ];
        Self {
            frame: layout(gpu, "frame", &[entry(0, both, uniform())]),
            scene: layout(gpu, "scene", &scene),
            textures: layout(gpu, "textures", &textures),
            film: layout(
                gpu,
                "film",
                &[
                    entry(0, compute, integers()),
                    entry(1, compute, storage(false)),
                    entry(
                        2,
                        compute,
                        storage_textures::binding(
                            gpu,
                            TEXEL_FORMAT,
                            wgpu::TextureViewDimension::D2,
                        ),
                    ),
                    queues,
                    entry(4, compute, storage(false)),
                ],
            ),
            tiles: layout(gpu, "tiles", &tiles),
        }
    }
}

pub(crate) fn layout(
    gpu: &Gpu,
    label: &str,
    entries: &[wgpu::BindGroupLayoutEntry],
) -> wgpu::BindGroupLayout {
    gpu.device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries,
        })
}

pub(crate) fn entry(
    binding: u32,
    visibility: ShaderStages,
    ty: wgpu::BindingType,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty,
        count: None,
    }
}

pub(crate) fn uniform() -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

pub(crate) fn storage(read_only: bool) -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

fn texture(view_dimension: wgpu::TextureViewDimension, filterable: bool) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension,
        multisampled: false,
    }
}

fn integers() -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Uint,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

/// A bind group of `resources` in the order of their bindings.
pub(crate) fn bind(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding,
            resource: resource.clone(),
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}
