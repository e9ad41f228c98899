//! How the interface is drawn where a software driver draws it.
//!
//! egui's own shader has a filter by hand, wrapping and dither in it, behind conditions that are the same for every pixel. A
//! GPU steps over what is not wanted; a software driver computes all of it and throws it away. Here the same
//! triangles go through a shader that does the one thing that is wanted.

#[cfg(test)]
mod tests;
mod textures;

use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui_wgpu::{
    Callback, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor,
};
use egui::epaint::textures::TexturesDelta;
use egui::epaint::{ClippedPrimitive, ClippedShape, Primitive, Vertex};
use egui::{FullOutput, PaintCallbackInfo, Rect, TextureId};

use textures::Textures;

/// Takes egui's triangles and images from it at the end of each pass, and draws them in its place.
pub(crate) struct Drawing(Arc<Mutex<Device>>);

impl Drawing {
    pub fn new(state: &RenderState) -> Self {
        let device = Device::new(&state.device, state.target_format);
        Self(Arc::new(Mutex::new(device)))
    }
}

impl egui::Plugin for Drawing {
    fn debug_name(&self) -> &'static str {
        "drawing on a software driver"
    }

    fn output_hook(&mut self, ctx: &egui::Context, output: &mut FullOutput) {
        let shapes = std::mem::take(&mut output.shapes);
        let primitives = ctx.tessellate(shapes, output.pixels_per_point);
        let mut device = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        device
            .images
            .append(std::mem::take(&mut output.textures_delta));
        device.primitives = primitives;
        let everywhere = ctx.input(|input| input.viewport_rect());
        let all = Callback::new_paint_callback(everywhere, All(Arc::clone(&self.0)));
        output.shapes = vec![ClippedShape::new(Rect::EVERYTHING, all)];
    }
}

/// The whole interface as one thing that egui draws.
struct All(Arc<Mutex<Device>>);

impl CallbackTrait for All {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        _encoder: &mut wgpu::CommandEncoder,
        _resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let mut drawing = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        drawing.prepare(device, queue, screen);
        Vec::new()
    }

    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _resources: &CallbackResources,
    ) {
        let drawing = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        drawing.draw(pass);
    }
}

/// What there is on the device, and what waits to get there.
struct Device {
    pipeline: wgpu::RenderPipeline,
    per_point: wgpu::Buffer,
    per_point_binding: wgpu::BindGroup,
    textures: Textures,
    vertices: Grown,
    indices: Grown,
    draws: Vec<Draw>,
    size_px: [u32; 2],
    images: TexturesDelta,
    primitives: Vec<ClippedPrimitive>,
}

/// Triangles with one image.
struct Draw {
    /// Left, top, width, height, pixels.
    clip_px: [u32; 4],
    image: TextureId,
    indices: std::ops::Range<u32>,
    first_vertex: i32,
}

impl Device {
    fn new(device: &wgpu::Device, target: wgpu::TextureFormat) -> Self {
        let textures = Textures::new(device);
        let per_point = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("size of the interface"),
            size: 8,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("size of the interface"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let per_point_binding = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("size of the interface"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: per_point.as_entire_binding(),
            }],
        });
        Self {
            pipeline: pipeline(device, target, &[Some(&layout), Some(textures.layout())]),
            per_point,
            per_point_binding,
            textures,
            vertices: Grown::new(wgpu::BufferUsages::VERTEX),
            indices: Grown::new(wgpu::BufferUsages::INDEX),
            draws: Vec::new(),
            size_px: [0, 0],
            images: TexturesDelta::default(),
            primitives: Vec::new(),
        }
    }

    fn prepare(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, screen: &ScreenDescriptor) {
        self.textures.change(device, queue, &mut self.images);
        self.size_px = screen.size_in_pixels;
        let [width, height] = self.size_px.map(|side| side.max(1) as f32);
        let scale = 2.0 * screen.pixels_per_point;
        let per_point = [scale / width, -scale / height];
        queue.write_buffer(&self.per_point, 0, bytemuck::cast_slice(&per_point));
        let (mut vertices, mut indices) = (Vec::<Vertex>::new(), Vec::<u32>::new());
        self.draws.clear();
        for ClippedPrimitive {
            clip_rect,
            primitive,
        } in std::mem::take(&mut self.primitives)
        {
            // No widget of the viewer draws by itself.
            let Primitive::Mesh(mesh) = primitive else {
                continue;
            };
            let Some(clip_px) = clip_px(clip_rect, screen) else {
                continue;
            };
            let first = indices.len() as u32;
            self.draws.push(Draw {
                clip_px,
                image: mesh.texture_id,
                indices: first..first + mesh.indices.len() as u32,
                first_vertex: vertices.len() as i32,
            });
            vertices.extend_from_slice(&mesh.vertices);
            indices.extend_from_slice(&mesh.indices);
        }
        self.vertices
            .write(device, queue, bytemuck::cast_slice(&vertices));
        self.indices
            .write(device, queue, bytemuck::cast_slice(&indices));
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'static>) {
        let (Some(vertices), Some(indices)) = (&self.vertices.buffer, &self.indices.buffer) else {
            return;
        };
        let [width, height] = self.size_px.map(|side| side as f32);
        pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.per_point_binding, &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        for draw in &self.draws {
            let Some(binding) = self.textures.binding(draw.image) else {
                continue;
            };
            let [x, y, width, height] = draw.clip_px;
            pass.set_scissor_rect(x, y, width, height);
            pass.set_bind_group(1, binding, &[]);
            pass.draw_indexed(draw.indices.clone(), draw.first_vertex, 0..1);
        }
    }
}

/// Left, top, width and height of what is on the screen, pixels; none if nothing is.
fn clip_px(clip: Rect, screen: &ScreenDescriptor) -> Option<[u32; 4]> {
    let [width, height] = screen.size_in_pixels;
    let px = |point: f32, most: u32| {
        let px = (point * screen.pixels_per_point).round();
        px.clamp(0.0, most as f32) as u32
    };
    let (left, right) = (px(clip.min.x, width), px(clip.max.x, width));
    let (top, bottom) = (px(clip.min.y, height), px(clip.max.y, height));
    (left < right && top < bottom).then(|| [left, top, right - left, bottom - top])
}

fn pipeline(
    device: &wgpu::Device,
    target: wgpu::TextureFormat,
    groups: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("drawing/shader.wgsl"));
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("interface"),
        bind_group_layouts: groups,
        immediate_size: 0,
    });
    let over = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::OneMinusSrcAlpha,
        operation: wgpu::BlendOperation::Add,
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("interface"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Unorm8x4],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("pixel"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: target,
                blend: Some(wgpu::BlendState { color: over, alpha: over }),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// A buffer that is replaced by a larger one when it is too small.
struct Grown {
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

impl Grown {
    fn new(usage: wgpu::BufferUsages) -> Self {
        Self {
            usage,
            buffer: None,
        }
    }

    fn write(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, bytes: &[u8]) {
        let size = bytes.len() as u64;
        let fitting = self.buffer.take().filter(|buffer| buffer.size() >= size);
        let buffer = fitting.unwrap_or_else(|| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("triangles of the interface"),
                size: size.next_power_of_two().max(1 << 16),
                usage: self.usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        });
        queue.write_buffer(&buffer, 0, bytes);
        self.buffer = Some(buffer);
    }
}
