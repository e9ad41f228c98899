//! Passes: the filter of the light that rays found, before a canvas is shown. Twin: image/src/filter.rs.
//!
//! Inputs: the films of a canvas. Output: base and scratches there. The light that rays found stays: more
//! samples may come.

use hairline_image::filter::{
    LEAST_ALIKE, LEAST_AROUND, MIRROR_STEP_PX, NORMAL_POWER, OFF_PLANE, OUTLIER_STD, OUTLINE_PX,
    PASSES, ROUGH_NORMALS, ROUGH_STEP_PX, VARIANCE_PX, noise_std,
};
use wgpu::{
    BindGroupLayoutEntry, BindingResource, BufferUsages, ShaderStages, TextureFormat, TextureUsages,
};

use crate::bindings::{dynamic_uniform, entry, integers, layout, storage};
use crate::canvas::Canvas;
use crate::device::Gpu;
use crate::error::Error;
use crate::film::FilmFound;
use crate::layout::FilterSettings;
use crate::pipelines::compiled;
use crate::shaders;
use crate::timing::Timing;

/// Diffuse, specular, scratches. Twin: filter.wgsl.
const LAYERS: u32 = 3;
/// Bytes between the settings of two dispatches.
const SETTINGS_STRIDE: u64 = 256;
/// Pixels to a side of a workgroup.
const WORKGROUP_PX: u32 = 8;

pub(crate) struct FilterPasses {
    signals: Pass,
    variances: Pass,
    step: Pass,
    film: Pass,
    room: Option<Room>,
}

struct Pass {
    name: &'static str,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
    bindings: &'static [u32],
}

/// Textures and buffers that the passes leave for one another.
struct Room {
    size_px: [u32; 2],
    guides: wgpu::TextureView,
    /// Two pairs of textures that take turns, each of shares and of bounced light.
    signals: [[wgpu::TextureView; 2]; 2],
    settings: wgpu::Buffer,
    settings_max: u64,
}

impl FilterPasses {
    pub(crate) async fn new(gpu: &Gpu) -> Result<Self, Error> {
        let text = shaders::compose(&[&shaders::FILTER]);
        compiled(gpu, || {
            let module = gpu
                .device
                .create_shader_module(wgpu::ShaderModuleDescriptor {
                    label: Some("filter"),
                    source: wgpu::ShaderSource::Wgsl(text.into()),
                });
            let pass = |entry_point, bindings| Pass::new(gpu, &module, entry_point, bindings);
            Self {
                signals: pass("filter_signals", &[0, 1, 2, 6, 7, 8]),
                variances: pass("filter_variances", &[0, 3, 4, 5, 7, 8]),
                step: pass("filter_step", &[0, 3, 4, 5, 7, 8]),
                film: pass("filter_film", &[0, 1, 2, 4, 5]),
                room: None,
            }
        })
        .await
    }

    /// Filters the light on the films of a canvas; nothing where none has rays.
    pub(crate) async fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        timing: &Timing,
        canvas: &Canvas,
    ) -> Result<(), Error> {
        let films: Vec<_> = canvas.films().collect();
        let founds: Vec<&FilmFound> = films
            .iter()
            .filter_map(|(_, film)| film.found.as_ref())
            .collect();
        // A band that has none yet is not to be read.
        if founds.len() < films.len() {
            return Ok(());
        }
        let size_px = canvas.size_px();
        let per_layer = 2 * films.len() as u64 + u64::from(PASSES) + 1;
        let room = match self.room.take() {
            Some(room)
                if room.size_px == size_px
                    && room.settings_max >= per_layer * u64::from(LAYERS) =>
            {
                room
            }
            _ => Room::new(gpu, size_px, per_layer * u64::from(LAYERS)).await?,
        };
        let all = |n: [u32; 2]| n.map(|n| n.div_ceil(WORKGROUP_PX));
        let mut settings = Vec::new();
        for layer in 0..LAYERS {
            let whole = FilterSettings {
                size_px,
                rounds: founds[0].rounds,
                layer,
                noise_std: noise_std(founds[0].rounds),
                off_plane: OFF_PLANE,
                normal_power: NORMAL_POWER,
                rough_normals: ROUGH_NORMALS,
                outline_px: OUTLINE_PX,
                mirror_step_px: MIRROR_STEP_PX,
                rough_step_px: ROUGH_STEP_PX,
                variance_px: VARIANCE_PX,
                outlier_std: OUTLIER_STD,
                least_around: LEAST_AROUND,
                least_alike: LEAST_ALIKE,
                ..FilterSettings::default()
            };
            let in_band = |rows: &std::ops::Range<u32>| FilterSettings {
                first_row: rows.start,
                rows: rows.len() as u32,
                ..whole
            };
            // The first pass reads the film and writes the first textures, then both sets take turns.
            for (rows, film) in &films {
                let from = Inputs::of(&room, film, 1);
                let size = all([size_px[0], rows.len() as u32]);
                self.signals.run(
                    gpu,
                    (encoder, timing),
                    &from,
                    &mut settings,
                    in_band(rows),
                    size,
                );
            }
            let mut at = 0;
            for pass in 0..=PASSES {
                let from = Inputs::of(&room, films[0].1, at);
                let (own, step) = match pass {
                    0 => (&self.variances, 0),
                    _ => (&self.step, 1 << (pass - 1)),
                };
                let with = FilterSettings { step, ..whole };
                own.run(
                    gpu,
                    (encoder, timing),
                    &from,
                    &mut settings,
                    with,
                    all(size_px),
                );
                at = 1 - at;
            }
            for (rows, film) in &films {
                let from = Inputs::of(&room, film, at);
                let size = all([size_px[0], rows.len() as u32]);
                self.film.run(
                    gpu,
                    (encoder, timing),
                    &from,
                    &mut settings,
                    in_band(rows),
                    size,
                );
            }
        }
        let mut bytes = Vec::with_capacity(settings.len() * SETTINGS_STRIDE as usize);
        for one in &settings {
            bytes.extend_from_slice(bytemuck::bytes_of(one));
            bytes.resize(bytes.len().next_multiple_of(SETTINGS_STRIDE as usize), 0);
        }
        gpu.queue.write_buffer(&room.settings, 0, &bytes);
        self.room = Some(room);
        Ok(())
    }
}

impl Pass {
    fn new(
        gpu: &Gpu,
        module: &wgpu::ShaderModule,
        entry_point: &'static str,
        bindings: &'static [u32],
    ) -> Self {
        let entries: Vec<_> = bindings.iter().map(|binding| used(*binding)).collect();
        let group_layout = layout(gpu, entry_point, &entries);
        let layout = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry_point),
                bind_group_layouts: &[Some(&group_layout)],
                immediate_size: 0,
            });
        let pipeline = gpu
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&layout),
                module,
                entry_point: Some(entry_point),
                compilation_options: Default::default(),
                cache: None,
            });
        Self {
            name: entry_point,
            layout: group_layout,
            pipeline,
            bindings,
        }
    }

    /// Records one dispatch; its settings are added to those of all.
    fn run(
        &self,
        gpu: &Gpu,
        (encoder, timing): (&mut wgpu::CommandEncoder, &Timing),
        inputs: &Inputs<'_>,
        settings: &mut Vec<FilterSettings>,
        own: FilterSettings,
        [x, y]: [u32; 2],
    ) {
        let entries: Vec<_> = self
            .bindings
            .iter()
            .map(|&binding| wgpu::BindGroupEntry {
                binding,
                resource: inputs.0[binding as usize].clone(),
            })
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("filter"),
            layout: &self.layout,
            entries: &entries,
        });
        let offset = settings.len() as u32 * SETTINGS_STRIDE as u32;
        settings.push(own);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(self.name),
            timestamp_writes: timing.compute(self.name),
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[offset]);
        pass.dispatch_workgroups(x, y, 1);
    }
}

/// All bindings in their order. Twin: filter.wgsl.
struct Inputs<'a>([BindingResource<'a>; 9]);

impl<'a> Inputs<'a> {
    /// Makes bindings that read the signals of one turn and write those of the other.
    fn of(room: &'a Room, film: &'a crate::film::Film, turn: usize) -> Self {
        let view = BindingResource::TextureView;
        let settings = BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &room.settings,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<FilterSettings>() as u64),
        });
        let found = film.found.as_ref().map_or(&film.buffer, |it| &it.buffer);
        let [read, written] = [&room.signals[turn], &room.signals[1 - turn]];
        Self([
            settings,
            film.buffer.as_entire_binding(),
            found.as_entire_binding(),
            view(&room.guides),
            view(&read[0]),
            view(&read[1]),
            view(&room.guides),
            view(&written[0]),
            view(&written[1]),
        ])
    }
}

/// Layout of a binding in the shader.
fn used(binding: u32) -> BindGroupLayoutEntry {
    let numbers = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let written = |format| wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format,
        view_dimension: wgpu::TextureViewDimension::D2,
    };
    let kind = match binding {
        0 => dynamic_uniform(),
        1 => storage(false),
        2 => storage(true),
        3 => integers(),
        4 | 5 => numbers,
        6 => written(GUIDES_FORMAT),
        _ => written(SIGNALS_FORMAT),
    };
    entry(binding, ShaderStages::COMPUTE, kind)
}

const GUIDES_FORMAT: TextureFormat = TextureFormat::Rgba32Uint;
const SIGNALS_FORMAT: TextureFormat = TextureFormat::Rgba32Float;

impl Room {
    async fn new(gpu: &Gpu, size_px: [u32; 2], settings_max: u64) -> Result<Self, Error> {
        let view = async |format| {
            let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING;
            let texture = gpu.target("filter", size_px, format, usage).await?;
            Ok::<_, Error>(texture.create_view(&Default::default()))
        };
        let pair =
            async || Ok::<_, Error>([view(SIGNALS_FORMAT).await?, view(SIGNALS_FORMAT).await?]);
        let bytes = settings_max * SETTINGS_STRIDE;
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        Ok(Self {
            size_px,
            guides: view(GUIDES_FORMAT).await?,
            signals: [pair().await?, pair().await?],
            settings: gpu.buffer("filter settings", bytes, usage).await?,
            settings_max,
        })
    }
}
