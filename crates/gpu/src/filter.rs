//! Passes: the filter of the light that rays found, before a canvas is shown. Twin: image/src/filter.rs.
//!
//! Inputs: the films of a canvas. Output: base and scratches there. The light that rays found stays: more
//! samples may come.

use hairline_image::filter::{
    LEAST_ALIKE, LEAST_AROUND, MIRROR_STEP_PX, NORMAL_POWER, OFF_PLANE, OUTLIER_STD, OUTLINE_PX,
    PASSES, ROUGH_NORMALS, ROUGH_STEP_PX, VARIANCE_PX, noise_std,
};
use wgpu::{BindingResource, BufferUsages, TextureFormat, TextureUsages};

use crate::canvas::Canvas;
use crate::device::Gpu;
use crate::error::Error;
use crate::film::{Film, FilmTraced};
use crate::layout::FilterSettings;
use crate::pipelines::{alone, compiled, shader};
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
    buffers: Option<FilterBuffers>,
}

struct Pass {
    name: &'static str,
    pipeline: wgpu::ComputePipeline,
    /// Those that its entry point uses.
    bindings: &'static [u32],
}

/// Textures and buffers that the passes leave for one another.
struct FilterBuffers {
    size_px: [u32; 2],
    guides: wgpu::TextureView,
    /// Two pairs of textures that take turns, each of shares and of bounced light.
    signals: [[wgpu::TextureView; 2]; 2],
    settings: wgpu::Buffer,
    settings_max: u64,
}

impl FilterPasses {
    pub(crate) async fn new(gpu: &Gpu) -> Result<Self, Error> {
        compiled(gpu, || {
            let module = shader(gpu, &shaders::FILTER);
            let pass = |name, bindings| Pass {
                name,
                pipeline: alone(gpu, &module, name),
                bindings,
            };
            Self {
                signals: pass("filter_signals", &[0, 1, 2, 6, 7, 8]),
                variances: pass("filter_variances", &[0, 3, 4, 5, 7, 8]),
                step: pass("filter_step", &[0, 3, 4, 5, 7, 8]),
                film: pass("filter_film", &[0, 1, 2, 4, 5]),
                buffers: None,
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
        let traced = films.iter().map(|(_, film)| film.traced.as_ref());
        // A band that has none yet is not to be read.
        let Some(traced) = traced.collect::<Option<Vec<&FilmTraced>>>() else {
            return Ok(());
        };
        let size_px = canvas.size_px();
        let per_layer = 2 * films.len() as u64 + u64::from(PASSES) + 1;
        let settings_max = per_layer * u64::from(LAYERS);
        let last = self.buffers.take();
        let buffers = match last.filter(|last| last.are_enough(size_px, settings_max)) {
            Some(last) => last,
            None => FilterBuffers::new(gpu, size_px, settings_max).await?,
        };
        let mut settings = Vec::new();
        let mut run = |pass: &Pass, film, turn, own, size_px: [u32; 2]| {
            let resources = resources(&buffers, film, turn, settings.len());
            settings.push(own);
            pass.run(gpu, (encoder, timing), &resources, size_px);
        };
        for layer in 0..LAYERS {
            let whole = settings_of_layer(size_px, traced[0].rounds, layer);
            let in_band = |rows: &std::ops::Range<u32>| FilterSettings {
                first_row: rows.start,
                rows: rows.len() as u32,
                ..whole
            };
            // The first pass reads the film and writes the first textures, then both sets take turns.
            for (rows, film) in &films {
                let size_px = [size_px[0], rows.len() as u32];
                run(&self.signals, film, 1, in_band(rows), size_px);
            }
            let mut at = 0;
            for pass in 0..=PASSES {
                let (own, step) = match pass {
                    0 => (&self.variances, 0),
                    _ => (&self.step, 1 << (pass - 1)),
                };
                let with = FilterSettings { step, ..whole };
                run(own, films[0].1, at, with, size_px);
                at = 1 - at;
            }
            for (rows, film) in &films {
                let size_px = [size_px[0], rows.len() as u32];
                run(&self.film, film, at, in_band(rows), size_px);
            }
        }
        buffers.write(gpu, &settings);
        self.buffers = Some(buffers);
        Ok(())
    }
}

/// Settings over a whole picture.
fn settings_of_layer(size_px: [u32; 2], rounds: u32, layer: u32) -> FilterSettings {
    FilterSettings {
        size_px,
        rounds,
        layer,
        noise_std: noise_std(rounds),
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
    }
}

impl Pass {
    /// Records one dispatch over so many pixels.
    fn run(
        &self,
        gpu: &Gpu,
        (encoder, timing): (&mut wgpu::CommandEncoder, &Timing),
        resources: &[BindingResource; 9],
        size_px: [u32; 2],
    ) {
        let entries: Vec<_> = self
            .bindings
            .iter()
            .map(|&binding| wgpu::BindGroupEntry {
                binding,
                resource: resources[binding as usize].clone(),
            })
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("filter"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(self.name),
            timestamp_writes: timing.compute(self.name),
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        let [x, y] = size_px.map(|n| n.div_ceil(WORKGROUP_PX));
        pass.dispatch_workgroups(x, y, 1);
    }
}

/// All bindings in their order, which read the signals of one turn and write those of the other. Twin: filter.wgsl.
fn resources<'a>(
    buffers: &'a FilterBuffers,
    film: &'a Film,
    turn: usize,
    settings: usize,
) -> [BindingResource<'a>; 9] {
    let view = BindingResource::TextureView;
    let settings = BindingResource::Buffer(wgpu::BufferBinding {
        buffer: &buffers.settings,
        offset: settings as u64 * SETTINGS_STRIDE,
        size: wgpu::BufferSize::new(size_of::<FilterSettings>() as u64),
    });
    let traced = film.traced.as_ref().map_or(&film.buffer, |it| &it.buffer);
    let [read, written] = [&buffers.signals[turn], &buffers.signals[1 - turn]];
    [
        settings,
        film.buffer.as_entire_binding(),
        traced.as_entire_binding(),
        view(&buffers.guides),
        view(&read[0]),
        view(&read[1]),
        view(&buffers.guides),
        view(&written[0]),
        view(&written[1]),
    ]
}

const GUIDES_FORMAT: TextureFormat = TextureFormat::Rgba32Uint;
const SIGNALS_FORMAT: TextureFormat = TextureFormat::Rgba32Float;

impl FilterBuffers {
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

    /// Whether they serve a picture of this size and so many settings.
    fn are_enough(&self, size_px: [u32; 2], settings_max: u64) -> bool {
        self.size_px == size_px && self.settings_max >= settings_max
    }

    /// Writes the settings of all dispatches.
    fn write(&self, gpu: &Gpu, settings: &[FilterSettings]) {
        let mut bytes = Vec::with_capacity(settings.len() * SETTINGS_STRIDE as usize);
        for one in settings {
            bytes.extend_from_slice(bytemuck::bytes_of(one));
            bytes.resize(bytes.len().next_multiple_of(SETTINGS_STRIDE as usize), 0);
        }
        gpu.queue.write_buffer(&self.settings, 0, &bytes);
    }
}
