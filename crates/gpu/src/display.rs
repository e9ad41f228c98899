//! Pass: the film on a display.
//!
//! Inputs: the films of a canvas, exposure and tone curve. Output: a target of 8 bits a channel whose format does not encode to sRGB
//! by itself (the shader does, and dithers), of the picture's size. One triangle a band.

use hairline_image::Display;
use wgpu::BufferUsages;

use crate::bindings::bind;
use crate::canvas::Canvas;
use crate::device::Gpu;
use crate::error::Error;
use crate::layout::DisplaySettings;
use crate::pipelines::shader;
use crate::shaders;
use crate::timing::Timing;

pub(crate) struct DisplayPass {
    pipeline: wgpu::RenderPipeline,
    settings: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
}

impl DisplayPass {
    pub(crate) async fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Result<Self, Error> {
        let module = shader(gpu, &shaders::DISPLAY);
        let pipeline = gpu
            .device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("display"),
                layout: None,
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("display_vertex"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("display_fragment"),
                    compilation_options: Default::default(),
                    targets: &[Some(format.into())],
                }),
                multiview_mask: None,
                cache: None,
            });
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let settings = gpu
            .buffer(
                "display settings",
                size_of::<DisplaySettings>() as u64,
                usage,
            )
            .await?;
        Ok(Self {
            settings,
            layout: pipeline.get_bind_group_layout(0),
            pipeline,
        })
    }

    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        (encoder, timing): (&mut wgpu::CommandEncoder, &Timing),
        canvas: &Canvas,
        display: &Display,
        target: &wgpu::TextureView,
    ) {
        let settings = DisplaySettings {
            size_px: canvas.size_px(),
            tone_map: display.tone_map.shader_index(),
            gain: display.exposure_ev.exp2() as f32,
        };
        gpu.queue
            .write_buffer(&self.settings, 0, bytemuck::bytes_of(&settings));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: Default::default(),
            })],
            timestamp_writes: timing.render("display"),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        for (rows, film) in canvas.films() {
            let resources = [
                self.settings.as_entire_binding(),
                film.buffer.as_entire_binding(),
            ];
            let group = bind(gpu, "display", &self.layout, &resources);
            pass.set_bind_group(0, &group, &[]);
            pass.set_scissor_rect(0, rows.start, canvas.size_px()[0], rows.len() as u32);
            // The shader learns by the instance where the band begins.
            pass.draw(0..3, rows.start..rows.start + 1);
        }
    }
}

/// A target to be read back.
pub(crate) struct ReadbackTarget {
    pub size_px: [u32; 2],
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
}

impl ReadbackTarget {
    pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

    pub(crate) async fn new(gpu: &Gpu, size_px: [u32; 2]) -> Result<Self, Error> {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let what = "shown picture";
        let texture = gpu.target(what, size_px, Self::FORMAT, usage).await?;
        Ok(Self {
            size_px,
            view: texture.create_view(&Default::default()),
            texture,
        })
    }
}
