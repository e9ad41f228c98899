//! Bindings of the passes, group by group. Twin: `shaders/scene/bindings.wgsl`.
//!
//! Group 0 the frame, group 1 the scene's arrays, group 2 its tables and textures; group 3 is each pass's own. Of the 16 sampled
//! textures of a WebGPU stage 10 are taken, and some by passes; of the 8 storage buffers 2.

use wgpu::{BindingType, ShaderStages, TextureViewDimension};

use crate::device::Gpu;
use crate::shaders::{Binding, BindingKind};

/// Names of the scene's arrays in the order of their bindings.
pub(crate) const SCENE_BUFFERS: [&str; 5] = [
    "triangles",
    "objects",
    "materials",
    "lights",
    "scratch segments",
];

/// Index of the first array of the scene that lies in a texture; those before it are buffers.
const FIRST_ROWS: u32 = 2;
const MATERIALS: u32 = 2;
/// Index of the materials' textures among the scene's tables and textures.
const TEXTURES: u32 = 5;

/// The layouts that the passes share.
pub(crate) struct Layouts {
    pub frame: wgpu::BindGroupLayout,
    pub scene: wgpu::BindGroupLayout,
    pub textures: wgpu::BindGroupLayout,
}

impl Layouts {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let both = ShaderStages::VERTEX | ShaderStages::COMPUTE;
        let compute = ShaderStages::COMPUTE;
        let scene: Vec<_> = (0..SCENE_BUFFERS.len() as u32)
            // Rasterising reads the vertices alone.
            .map(|i| match i {
                0 => entry(i, both, storage(true)),
                i if i < FIRST_ROWS => entry(i, compute, storage(true)),
                // Materials decide which parts of triangles are cut out.
                MATERIALS => entry(i, compute | ShaderStages::FRAGMENT, integers()),
                i => entry(i, compute, integers()),
            })
            .collect();
        let d2 = TextureViewDimension::D2;
        let textures = [
            texture(wgpu::TextureSampleType::Uint, TextureViewDimension::D2Array),
            numbers(d2, false),
            numbers(d2, false),
            numbers(d2, true),
            numbers(d2, true),
            numbers(TextureViewDimension::D2Array, true),
            numbers(d2, false),
        ];
        let textures: Vec<_> = (0..)
            .zip(textures)
            .map(|(i, ty)| match i {
                TEXTURES => entry(i, compute | ShaderStages::FRAGMENT, ty),
                _ => entry(i, compute, ty),
            })
            .collect();
        Self {
            // The sample's number decides which surfaces with partial coverage it meets.
            frame: layout(
                gpu,
                "frame",
                &[entry(0, both | ShaderStages::FRAGMENT, uniform())],
            ),
            scene: layout(gpu, "scene", &scene),
            textures: layout(gpu, "textures", &textures),
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
    ty: BindingType,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty,
        count: None,
    }
}

pub(crate) fn uniform() -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

pub(crate) fn storage(read_only: bool) -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}

/// A part of a buffer that each dispatch chooses.
pub(crate) fn dynamic_uniform() -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: true,
        min_binding_size: None,
    }
}

fn texture(
    sample_type: wgpu::TextureSampleType,
    view_dimension: TextureViewDimension,
) -> BindingType {
    BindingType::Texture {
        sample_type,
        view_dimension,
        multisampled: false,
    }
}

pub(crate) fn numbers(view_dimension: TextureViewDimension, filterable: bool) -> BindingType {
    texture(
        wgpu::TextureSampleType::Float { filterable },
        view_dimension,
    )
}

pub(crate) fn integers() -> BindingType {
    texture(wgpu::TextureSampleType::Uint, TextureViewDimension::D2)
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

impl Binding {
    pub(crate) fn is_dynamic(&self) -> bool {
        matches!(self.kind, BindingKind::UniformPart { .. })
    }

    pub(crate) fn ty(&self) -> BindingType {
        match self.kind {
            BindingKind::Storage { is_read_only } => storage(is_read_only),
            BindingKind::Uniform => uniform(),
            BindingKind::UniformPart { .. } => dynamic_uniform(),
            BindingKind::Integers => integers(),
            BindingKind::Numbers => numbers(TextureViewDimension::D2, false),
        }
    }
}
