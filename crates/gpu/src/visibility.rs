//! Pass: the triangle and the object that each pixel sees.
//!
//! Inputs: frame, vertices; materials and textures of what is cut out. Outputs: the strip's visibility and depth. One draw for each object, without an index buffer:
//! the shader divides the vertex's number by three, which works on every device.

use crate::bindings::Layouts;
use crate::compute_pass::Recording;
use crate::device::Gpu;
use crate::pipelines::shader;
use crate::shaders;
use crate::strip::{DEPTH_FORMAT, StripBuffers, VISIBILITY_FORMAT};

pub(crate) struct VisibilityPass {
    objects: wgpu::RenderPipeline,
    /// Objects with cutouts.
    cutouts: wgpu::RenderPipeline,
    /// Pipeline for the shapes of lights, of which the camera sees the fronts.
    lamps: wgpu::RenderPipeline,
}

impl VisibilityPass {
    pub(crate) fn new(gpu: &Gpu, layouts: &Layouts) -> Self {
        let groups = [
            Some(&layouts.frame),
            Some(&layouts.scene),
            Some(&layouts.textures),
        ];
        let layout = |groups: &[Option<&wgpu::BindGroupLayout>]| {
            gpu.device
                .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some("visibility"),
                    bind_group_layouts: groups,
                    immediate_size: 0,
                })
        };
        let whole = shader(gpu, &shaders::VISIBILITY);
        let cut = shader(gpu, &shaders::VISIBILITY_CUTOUTS);
        let of_whole = layout(&groups[..2]);
        let of_cut = layout(&groups);
        let entries = ["visibility_vertex", "visibility_fragment"];
        let of_cut_entries = ["cutout_vertex", "cutout_fragment"];
        Self {
            // Both sides of a sheet are seen.
            objects: pipeline(gpu, &whole, entries, &of_whole, None),
            cutouts: pipeline(gpu, &cut, of_cut_entries, &of_cut, None),
            lamps: pipeline(gpu, &whole, entries, &of_whole, Some(wgpu::Face::Back)),
        }
    }

    /// Records the pass over so many rows of a strip, with those above and below it.
    pub(crate) fn record(&self, recording: &mut Recording, buffers: &StripBuffers, rows: u32) {
        let Recording {
            encoder,
            frame,
            scene,
            timing,
            ..
        } = recording;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("visibility"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &buffers.visibility,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &buffers.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: timing.render("visibility"),
            ..Default::default()
        });
        pass.set_viewport(0.0, 0.0, buffers.width_px as f32, rows as f32, 0.0, 1.0);
        pass.set_bind_group(0, *frame, &[]);
        pass.set_bind_group(1, &scene.buffers.group, &[]);
        pass.set_bind_group(2, &scene.textures.group, &[]);
        for (object, triangles) in (0..).zip(scene.triangles()) {
            pass.set_pipeline(match object {
                lamp if lamp >= scene.lamps => &self.lamps,
                cut if scene.cutouts[cut as usize] => &self.cutouts,
                _ => &self.objects,
            });
            pass.draw(3 * triangles.start..3 * triangles.end, object..object + 1);
        }
    }
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    [vertex, fragment]: [&str; 2],
    layout: &wgpu::PipelineLayout,
    cull_mode: Option<wgpu::Face>,
) -> wgpu::RenderPipeline {
    let descriptor = wgpu::RenderPipelineDescriptor {
        label: Some("visibility"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
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
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(VISIBILITY_FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    };
    gpu.device.create_render_pipeline(&descriptor)
}
