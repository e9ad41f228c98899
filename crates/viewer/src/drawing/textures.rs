//! The images that egui draws with, on the window's device.

use std::collections::HashMap;

use egui::epaint::{ImageData, ImageDelta, textures::TexturesDelta};
use egui::{TextureFilter, TextureId, TextureOptions, TextureWrapMode};

/// Images by egui's names for them.
pub(super) struct Textures {
    layout: wgpu::BindGroupLayout,
    held: HashMap<TextureId, Held>,
    samplers: HashMap<TextureOptions, wgpu::Sampler>,
    /// Drawn for the last time.
    freed: Vec<TextureId>,
}

struct Held {
    texture: wgpu::Texture,
    options: TextureOptions,
    binding: wgpu::BindGroup,
}

impl Textures {
    pub fn new(device: &wgpu::Device) -> Self {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("image of the interface"),
            entries: &[
                entry(
                    0,
                    wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: true },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: false,
                    },
                ),
                entry(
                    1,
                    wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                ),
            ],
        });
        Self {
            layout,
            held: HashMap::new(),
            samplers: HashMap::new(),
            freed: Vec::new(),
        }
    }

    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    pub fn binding(&self, id: TextureId) -> Option<&wgpu::BindGroup> {
        self.held.get(&id).map(|held| &held.binding)
    }

    /// Takes over what has changed. What is freed can be drawn until the next call.
    pub fn change(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        deltas: &mut TexturesDelta,
    ) {
        for id in self.freed.drain(..) {
            self.held.remove(&id);
        }
        for (id, deltas) in deltas.set.drain() {
            for delta in deltas {
                self.set(device, queue, id, &delta);
            }
        }
        self.freed.extend(deltas.free.drain());
    }

    fn set(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        id: TextureId,
        delta: &ImageDelta,
    ) {
        let ImageData::Color(image) = &delta.image;
        let [width, height] = image.size.map(|side| side as u32);
        if width == 0 || height == 0 {
            return;
        }
        let size = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        let held = self.held.get(&id);
        let is_as_before =
            held.is_some_and(|held| held.texture.size() == size && held.options == delta.options);
        if delta.is_whole() && !is_as_before {
            let held = self.create(device, size, delta.options);
            self.held.insert(id, held);
        }
        let Some(held) = self.held.get(&id) else {
            return;
        };
        let [x, y] = delta.pos.unwrap_or([0, 0]).map(|at| at as u32);
        queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x, y, z: 0 },
                ..held.texture.as_image_copy()
            },
            bytemuck::cast_slice(&image.pixels),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * width),
                rows_per_image: None,
            },
            size,
        );
    }

    fn create(
        &mut self,
        device: &wgpu::Device,
        size: wgpu::Extent3d,
        options: TextureOptions,
    ) -> Held {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("image of the interface"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let sampler = self
            .samplers
            .entry(options)
            .or_insert_with(|| sampler(device, options));
        let binding = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("image of the interface"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(
                        &texture.create_view(&Default::default()),
                    ),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::Sampler(sampler),
                },
            ],
        });
        Held {
            texture,
            options,
            binding,
        }
    }
}

fn sampler(device: &wgpu::Device, options: TextureOptions) -> wgpu::Sampler {
    let filter = |filter| match filter {
        TextureFilter::Nearest => wgpu::FilterMode::Nearest,
        TextureFilter::Linear => wgpu::FilterMode::Linear,
    };
    let wrap = match options.wrap_mode {
        TextureWrapMode::ClampToEdge => wgpu::AddressMode::ClampToEdge,
        TextureWrapMode::Repeat => wgpu::AddressMode::Repeat,
        TextureWrapMode::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
    };
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("image of the interface"),
        address_mode_u: wrap,
        address_mode_v: wrap,
        mag_filter: filter(options.magnification),
        min_filter: filter(options.minification),
        ..Default::default()
    })
}
