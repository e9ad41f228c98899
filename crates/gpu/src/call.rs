//! Calls a WGSL function with a table of numbers, so that a test can hold it against its f64 twin.
//!
//! ```no_run
//! # use hairline_gpu::{call::Call, headless, shaders};
//! let Some(gpu) = headless::test_gpu() else { return };
//! let call = Call { modules: &[&shaders::LAYOUT], snippet: "y[0] = sqrt(x[0]);", tables: &[] };
//! let rows: Vec<[f32; 1]> = gpu.block_on(call.run(gpu, &[[4.0], [9.0]])).unwrap();
//! assert_eq!(rows, [[2.0], [3.0]]);
//! ```

use wgpu::util::DeviceExt;

use crate::device::Gpu;
use crate::error::Error;
use crate::shaders::{self, Module};

/// Code that runs for each row: the inputs are `x[0]`, `x[1]`, ..., the outputs `y[0]`, `y[1]`, ... (zero unless set),
/// both f32, and the tables are `table_0`, `table_1`, ...
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    /// Modules that hold the function.
    pub modules: &'a [&'a Module],
    /// Statements in WGSL.
    pub snippet: &'a str,
    /// Textures that the snippet may pass on.
    pub tables: &'a [Table<'a>],
}

/// A texture of four numbers a texel, read by `textureLoad`.
#[derive(Clone, Copy, Debug)]
pub struct Table<'a> {
    /// Width and height.
    pub size: [u32; 2],
    /// `None` for a `texture_2d`, a count for a `texture_2d_array`.
    pub layers: Option<u32>,
    /// Layer by layer, row by row.
    pub texels: Texels<'a>,
}

/// Texels of a [`Table`].
#[derive(Clone, Copy, Debug)]
pub enum Texels<'a> {
    /// Texels of a texture of f32.
    Floats(&'a [[f32; 4]]),
    /// Texels of a texture of u32.
    Integers(&'a [[u32; 4]]),
}

const WORKGROUP: u32 = 64;

impl Call<'_> {
    /// Runs the snippet once for each row. Compilation errors come back as [`Error::Validation`].
    pub async fn run<const N: usize, const M: usize>(
        &self,
        gpu: &Gpu,
        rows: &[[f32; N]],
    ) -> Result<Vec<[f32; M]>, Error> {
        let mut results = Vec::with_capacity(rows.len());
        // Limits of one dispatch: workgroups in one dimension, and bytes in one binding.
        let limits = gpu.limits();
        let by_groups = u64::from(limits.max_compute_workgroups_per_dimension * WORKGROUP);
        let by_bytes = limits.max_storage_buffer_binding_size / (4 * N.max(M).max(1) as u64);
        let pipeline = self.pipeline(gpu, N, M).await?;
        for rows in rows.chunks(by_groups.min(by_bytes) as usize) {
            results.extend(self.run_chunk::<N, M>(gpu, &pipeline, rows).await?);
        }
        Ok(results)
    }

    async fn run_chunk<const N: usize, const M: usize>(
        &self,
        gpu: &Gpu,
        pipeline: &wgpu::ComputePipeline,
        rows: &[[f32; N]],
    ) -> Result<Vec<[f32; M]>, Error> {
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::COPY_SRC;
        let input = gpu
            .buffer("inputs", (rows.len() * N * 4) as u64, usage)
            .await?;
        gpu.queue
            .write_buffer(&input, 0, bytemuck::cast_slice(rows.as_flattened()));
        let output_bytes = (rows.len() * M * 4) as u64;
        let output = gpu.buffer("outputs", output_bytes, usage).await?;

        let views: Vec<_> = self.tables.iter().map(|table| table.upload(gpu)).collect();
        let mut entries = vec![
            wgpu::BindGroupEntry {
                binding: 0,
                resource: input.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: output.as_entire_binding(),
            },
        ];
        entries.extend(
            views
                .iter()
                .enumerate()
                .map(|(i, view)| wgpu::BindGroupEntry {
                    binding: 2 + i as u32,
                    resource: wgpu::BindingResource::TextureView(view),
                }),
        );
        let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("call"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });

        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.dispatch_workgroups((rows.len() as u32).div_ceil(WORKGROUP), 1, 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.read(&output, 0..output_bytes).await?;
        Ok(bytemuck::pod_collect_to_vec::<u8, f32>(&bytes)
            .as_chunks::<M>()
            .0
            .to_vec())
    }

    async fn pipeline(
        &self,
        gpu: &Gpu,
        inputs: usize,
        outputs: usize,
    ) -> Result<wgpu::ComputePipeline, Error> {
        let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("call"),
                source: wgpu::ShaderSource::Wgsl(self.source(inputs, outputs).into()),
            });
        let pipeline = gpu
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("call"),
                layout: None,
                module: &module,
                entry_point: Some("call_main"),
                compilation_options: Default::default(),
                cache: None,
            });
        match scope.pop().await {
            Some(error) => Err(Error::Validation {
                description: error.to_string(),
            }),
            None => Ok(pipeline),
        }
    }

    fn source(&self, inputs: usize, outputs: usize) -> String {
        let tables = self.tables.iter().enumerate().map(|(i, table)| {
            let kind = if table.layers.is_some() {
                "texture_2d_array"
            } else {
                "texture_2d"
            };
            let scalar = match table.texels {
                Texels::Floats(_) => "f32",
                Texels::Integers(_) => "u32",
            };
            // An automatic layout leaves out what is not used; a query of the size uses every table.
            (
                format!(
                    "@group(0) @binding({}) var table_{i}: {kind}<{scalar}>;\n",
                    2 + i
                ),
                format!("    call_touched += textureDimensions(table_{i}).x;\n"),
            )
        });
        let (declarations, touches): (String, String) = tables.unzip();
        let modules = shaders::compose(self.modules);
        let snippet = self.snippet;
        format!(
            "{modules}
@group(0) @binding(0) var<storage, read> call_input: array<f32>;
@group(0) @binding(1) var<storage, read_write> call_output: array<f32>;
{declarations}
@compute @workgroup_size({WORKGROUP})
fn call_main(@builtin(global_invocation_id) call_id: vec3u) {{
    let call_row = call_id.x;
    var call_touched = 0u;
{touches}
    if call_row >= arrayLength(&call_input) / {inputs}u || call_touched == 0xffffffffu {{
        return;
    }}
    var x: array<f32, {inputs}>;
    var y: array<f32, {outputs}>;
    for (var i = 0u; i < {inputs}u; i += 1u) {{
        x[i] = call_input[call_row * {inputs}u + i];
    }}
    {{
        {snippet}
    }}
    for (var i = 0u; i < {outputs}u; i += 1u) {{
        call_output[call_row * {outputs}u + i] = y[i];
    }}
}}
"
        )
    }
}

impl Table<'_> {
    fn upload(&self, gpu: &Gpu) -> wgpu::TextureView {
        let (format, bytes): (_, &[u8]) = match self.texels {
            Texels::Floats(texels) => (
                wgpu::TextureFormat::Rgba32Float,
                bytemuck::cast_slice(texels),
            ),
            Texels::Integers(texels) => (
                wgpu::TextureFormat::Rgba32Uint,
                bytemuck::cast_slice(texels),
            ),
        };
        let layers = self.layers.map_or(1, |layers| gpu.array_layers(layers));
        let texel_bytes = 16;
        let mut bytes: Vec<u8> = bytes.to_vec();
        bytes.resize(
            (self.size[0] * self.size[1] * layers * texel_bytes) as usize,
            0,
        );
        let texture = gpu.device.create_texture_with_data(
            &gpu.queue,
            &wgpu::TextureDescriptor {
                label: Some("table"),
                size: wgpu::Extent3d {
                    width: self.size[0],
                    height: self.size[1],
                    depth_or_array_layers: layers,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            Default::default(),
            &bytes,
        );
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(match self.layers {
                Some(_) => wgpu::TextureViewDimension::D2Array,
                None => wgpu::TextureViewDimension::D2,
            }),
            ..Default::default()
        })
    }
}
