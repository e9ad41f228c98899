//! Pass: the triangle and the object that each pixel sees.
//!
//! Inputs: frame, vertices. Outputs: the strip's visibility and depth. One draw for each object, without an index buffer:
//! the shader divides the vertex's number by three, which works on every device.

use crate::bindings::Layouts;
use crate::compute_pass::Recording;
use crate::device::Gpu;
use crate::shaders;
use crate::strip::{DEPTH_FORMAT, StripRoom, VISIBILITY_FORMAT};

pub(crate) struct VisibilityPass {
    objects: wgpu::RenderPipeline,
    /// The shapes of lights, of which the camera sees the fronts.
    lamps: wgpu::RenderPipeline,
}

impl VisibilityPass {
    pub(crate) fn new(gpu: &Gpu, layouts: &Layouts) -> Self {
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("visibility"),
                source: wgpu::ShaderSource::Wgsl(shaders::compose(&[&shaders::VISIBILITY]).into()),
            });
        let layout = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("visibility"),
                bind_group_layouts: &[Some(&layouts.frame), Some(&layouts.scene)],
                immediate_size: 0,
            });
        let pipeline = |cull_mode| {
            gpu.device
                .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                    label: Some("visibility"),
                    layout: Some(&layout),
                    vertex: wgpu::VertexState {
                        module: &module,
                        entry_point: Some("visibility_vertex"),
                        compilation_options: Default::default(),
                        buffers: &[],
                    },
                    primitive: wgpu::PrimitiveState {
                        cull_mode,
                        ..Default::default()
                    },
                    depth_stencil: Some(wgpu::DepthStencilState {
                        format: DEPTH_FORMAT,
                        depth_write_enabled: Some(true),
                        // Reversed: one at the near plane, zero at infinity.
                        depth_compare: Some(wgpu::CompareFunction::Greater),
                        stencil: Default::default(),
                        bias: Default::default(),
                    }),
                    multisample: Default::default(),
                    fragment: Some(wgpu::FragmentState {
                        module: &module,
                        entry_point: Some("visibility_fragment"),
                        compilation_options: Default::default(),
                        targets: &[Some(VISIBILITY_FORMAT.into())],
                    }),
                    multiview_mask: None,
                    cache: None,
                })
        };
        Self {
            // Both sides of a sheet are seen.
            objects: pipeline(None),
            lamps: pipeline(Some(wgpu::Face::Back)),
        }
    }

    pub(crate) fn record(&self, recording: &mut Recording, room: &StripRoom, rows: u32) {
        let Recording {
            encoder,
            frame,
            scene,
            timing,
        } = recording;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("visibility"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &room.visibility,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &room.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: timing.render("visibility"),
            ..Default::default()
        });
        pass.set_viewport(
            0.0,
            0.0,
            room.width_px as f32,
            // A row more above and below.
            (rows + 2) as f32,
            0.0,
            1.0,
        );
        pass.set_pipeline(&self.objects);
        pass.set_bind_group(0, *frame, &[]);
        pass.set_bind_group(1, &scene.buffers.group, &[]);
        for (object, triangles) in (0..).zip(scene.triangles()) {
            if object == scene.lamps {
                pass.set_pipeline(&self.lamps);
            }
            pass.draw(3 * triangles.start..3 * triangles.end, object..object + 1);
        }
    }
}
