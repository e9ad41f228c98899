//! Takes the shader module `scratch_light` into a wgpu program of one's own: `cargo run --release --example shader_module`. Prints what
//! one scratch in gold sends to a viewer straight above while a small light moves away from the mirror direction.

use hairline_gpu::shaders::{SCRATCH_LIGHT, compose};
use hairline_optics::metal::Metal;
use hairline_optics::table::{COLUMNS, ROWS, ScratchTable};
use wgpu::util::{DeviceExt, TextureDataOrder};

/// The module has no binding and no entry point: these are the program's own.
const MAIN: &str = "
@group(0) @binding(0) var<storage, read_write> radiance: array<vec3f, 64>;
@group(0) @binding(1) var tables: texture_2d_array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) i: u32) {
    var point: LitPoint;
    point.wo = vec3f(0.0, 0.0, 1.0);
    point.distance_m = 0.5;
    point.footprint_x_um = vec2f(10.0, 0.0);
    point.footprint_y_um = vec2f(0.0, 10.0);
    point.coherence_um = 20.0;
    point.table = 0u;
    // A scratch of 4 mm along y, 2 um wide and 180 nm deep.
    let seen = scratch_seen(point, vec2f(0.0, -2000.0), vec2f(0.0, 2000.0), Profile(2.0, 180.0, 0u), 0.0);
    let angle = radians(f32(i));
    let light_m = vec3f(sin(angle), 0.0, cos(angle));
    radiance[i] = seen.share.segment * scratch_sphere(tables, point, seen, light_m, 0.01);
}";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Any device serves: the module needs no feature. Hairline's own is opened here because it says what is missing.
    let gpu = hairline_gpu::headless::open(&Default::default())?;
    let (device, queue) = (&gpu.device, &gpu.queue);

    let size = wgpu::Extent3d {
        width: COLUMNS as u32,
        height: ROWS as u32,
        depth_or_array_layers: 1,
    };
    let descriptor = wgpu::TextureDescriptor {
        label: Some("spectra of scratches in gold"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let table = ScratchTable::new(|nm| Metal::Gold.reflectance(1.0, nm));
    let texels = bytemuck::cast_slice(&table.texels);
    let texture =
        device.create_texture_with_data(queue, &descriptor, TextureDataOrder::default(), texels);
    let tables = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let buffer = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("radiance"),
            size: 64 * 16,
            usage,
            mapped_at_creation: false,
        })
    };
    let radiance = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);

    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("my shader"),
        source: wgpu::ShaderSource::Wgsl((compose(&[&SCRATCH_LIGHT]) + MAIN).into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("my pass"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: radiance.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&tables),
            },
        ],
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &bind_group, &[]);
    pass.dispatch_workgroups(1, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&radiance, 0, &read, 0, 64 * 16);
    queue.submit([encoder.finish()]);

    read.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let view = read.slice(..).get_mapped_range()?;
    for (degrees, rgb) in bytemuck::cast_slice::<u8, [f32; 4]>(&view)
        .iter()
        .enumerate()
    {
        println!(
            "{degrees:2} deg: {:.3e} {:.3e} {:.3e}",
            rgb[0], rgb[1], rgb[2]
        );
    }
    Ok(())
}
