//! A strip of a picture: its stages in their order, from the visibility to the film.

use std::mem::offset_of;
use std::ops::Range;

use wgpu::BufferUsages;

use crate::bindings::{Layouts, bind};
use crate::compute_pass::{Recording, in_a_row};
use crate::device::Gpu;
use crate::error::Error;
use crate::film::Film;
use crate::frame::{View, frame, halo_rows};
use crate::layout::Frame;
use crate::pass_bindings;
use crate::passes::{ScratchPasses, Shade};
use crate::pipelines::compiled;
use crate::scan::ScanPasses;
use crate::shadow_picks::Scratched;
use crate::sizes::{CHUNKS, ENTRIES, GROUPS, Points, Sizes, SizesPass};
use crate::strip::{GROUP, MadeLists, StripBuffers, TILE_PX, strip_points, tile_count};
use crate::strip_sizes::{half, numbers_most};
use crate::timing::Timing;
use crate::visibility::VisibilityPass;

/// Place in the frame of what is counted on the device, and its size: the numbers of entries and of groups.
const COUNTED_OFFSET: u64 = offset_of!(Frame, entry_count) as u64;
const COUNTED_BYTES: u64 = 8;

/// The passes that every scene needs, and the frame that all passes read.
pub(crate) struct StripShader {
    pub gpu: Gpu,
    visibility: VisibilityPass,
    pub scans: ScanPasses,
    frame: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    pub timing: Timing,
}

/// A step of a strip whose samples send rays.
pub(crate) struct StripRays<'s, 'v> {
    pub strip: &'s StripShader,
    pub view: &'s View<'v>,
    pub film: &'s Film,
    pub points: Points,
}

impl StripShader {
    pub(crate) async fn new(gpu: &Gpu, layouts: &Layouts) -> Result<Self, Error> {
        let visibility = compiled(gpu, || VisibilityPass::new(gpu, layouts)).await?;
        let scans = compiled(gpu, || ScanPasses::new(gpu)).await?;
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let frame = gpu
            .buffer("frame", size_of::<Frame>() as u64, usage)
            .await?;
        Ok(Self {
            gpu: gpu.clone(),
            visibility,
            scans,
            frame_group: bind(gpu, "frame", &layouts.frame, &[frame.as_entire_binding()]),
            frame,
            timing: Timing::default(),
        })
    }

    /// One step of the rows of a film, in as many strips as the device needs. Nothing is waited for but memory: [`StripBuffers::settle`] tells whether
    /// there was room for all.
    pub(crate) async fn shade(
        &self,
        view: &View<'_>,
        film: &Film,
        buffers: &mut StripBuffers,
        rows: Range<u32>,
    ) -> Result<(), Error> {
        buffers.most = numbers_most(&self.gpu, view);
        let points_most = u64::from(GROUP) * u64::from(buffers.most[GROUPS]);
        while strip_points(buffers.width_px, buffers.strip_rows) > points_most
            && buffers.strip_rows > TILE_PX
        {
            buffers.strip_rows = half(buffers.strip_rows);
        }
        let strip_rows = buffers.strip_rows;
        for start in rows.clone().step_by(strip_rows as usize) {
            let strip = start..(start + strip_rows).min(rows.end);
            self.shade_strip(view, film, rows.start, buffers, strip)
                .await?;
        }
        Ok(())
    }

    /// One step of a strip.
    async fn shade_strip(
        &self,
        view: &View<'_>,
        film: &Film,
        film_row: u32,
        buffers: &mut StripBuffers,
        strip: Range<u32>,
    ) -> Result<(), Error> {
        let passes = &view.uploaded.passes;
        let rows = strip.len() as u32;
        let tiles = tile_count(buffers.width_px, rows);
        let points = self.make_room(view, buffers, rows).await?;
        self.write_frame(view, &strip, film_row, view.step_samples().start);
        self.group(view, film, film_row, buffers, &strip);
        for sample in view.step_samples() {
            self.write_frame(view, &strip, film_row, sample);
            self.submit(view, |recording| {
                let rows = rows + 2 * halo_rows(view.scene);
                self.visibility.record(recording, buffers, rows);
                passes.record_surface(recording, buffers, film, rows);
            });
        }
        let on = Scratched {
            groups: buffers.groups(view.step, tiles),
            chunks: buffers.sizes.workgroups(CHUNKS),
        };
        let shadows = match &passes.shade {
            Shade::Own { .. } => view.shadows(),
            Shade::Other(_) => None,
        };
        self.submit(view, |recording| {
            if let Some(scratches) = passes.scratches() {
                if view.step > 0 {
                    scratches.record_share(recording, buffers, film, rows);
                }
                scratches.shade.record(recording, buffers, &on.chunks);
            }
            passes.shade.record(recording, buffers, film, &on.groups);
            if shadows.is_none() {
                passes.record_resolve(recording, buffers, film, rows);
            }
        });
        if let Some(shadows) = shadows {
            let rays = StripRays {
                strip: self,
                view,
                film,
                points,
            };
            rays.shade(shadows, buffers, &on, rows).await?;
        }
        Ok(())
    }

    /// Makes room for a step of so many rows. Says how many samples there is room for.
    async fn make_room(
        &self,
        view: &View<'_>,
        buffers: &mut StripBuffers,
        rows: u32,
    ) -> Result<Points, Error> {
        let (gpu, scans, passes) = (&self.gpu, &self.scans, &view.uploaded.passes);
        let tiles = tile_count(buffers.width_px, rows);
        let first = strip_points(buffers.width_px, rows);
        buffers.make_room(gpu, scans, passes, tiles, first).await?;
        let most = u64::from(GROUP) * u64::from(buffers.sizes.capacity[GROUPS]);
        if passes.scratches().is_some() {
            let segments = view.uploaded.data.buffers.segment_count();
            let lists = &mut buffers.lists;
            lists.make_room_for_segments(gpu, scans, segments).await?;
        } else {
            buffers.samples.one_chunk_a_group(gpu);
        }
        buffers.group_scan.set_count(gpu, tiles + 1);
        Ok(Points {
            first,
            most: most.max(first),
        })
    }

    /// Makes the tile lists, and counts the groups of samples and the chunks of their lists.
    fn group(
        &self,
        view: &View,
        film: &Film,
        film_row: u32,
        buffers: &mut StripBuffers,
        strip: &Range<u32>,
    ) {
        let (scans, passes) = (&self.scans, &view.uploaded.passes);
        let tiles = tile_count(buffers.width_px, strip.len() as u32);
        // Lists of the first step serve the other steps.
        let made = buffers.lists.made.take();
        buffers.lists.made = made.filter(|made| view.step > 0 && made.rows == *strip);
        let kept = buffers.lists.made.is_some();
        let mut sorted = None;
        self.submit(view, |recording| {
            if view.step == 0 && strip.start == film_row {
                film.clear(recording.encoder);
            }
            if let Some(scratches) = passes.scratches().filter(|_| !kept) {
                sorted = Some(self.make_lists(recording, view, scratches, film, buffers, tiles));
            }
            if view.step > 0 {
                passes.record_edges(recording, buffers, film, tiles);
                scans.record(recording.encoder, &buffers.group_scan, recording.timing);
                // Not every place of a group has a sample.
                let points = &buffers.samples.points;
                recording.encoder.clear_buffer(points, 0, None);
            }
            let sizes = &buffers.sizes;
            let starts = &buffers.group_starts;
            self.size(recording, &passes.sizes[GROUPS], starts, sizes, film);
            if let Some(scratches) = passes.scratches() {
                scratches.shade.record_chunks(recording, scans, buffers);
            }
            let starts = &buffers.samples.chunk_starts;
            self.size(recording, &passes.sizes[CHUNKS], starts, sizes, film);
        });
        if let Some(sorted) = sorted {
            let rows = strip.clone();
            buffers.lists.made = Some(MadeLists { rows, sorted });
        }
    }

    /// Makes the tile lists of a strip. Returns which of the two buffers holds them.
    fn make_lists(
        &self,
        recording: &mut Recording,
        view: &View,
        passes: &ScratchPasses,
        film: &Film,
        buffers: &StripBuffers,
        tiles: u32,
    ) -> usize {
        let (bin, scans) = (&passes.bin, &self.scans);
        let segments = view.uploaded.data.buffers.segment_count();
        bin.record_count(recording, scans, buffers, segments);
        let size = &view.uploaded.passes.sizes[ENTRIES];
        let starts = &buffers.lists.entry_starts;
        self.size(recording, size, starts, &buffers.sizes, film);
        bin.record(recording, scans, buffers, tiles, segments)
    }

    /// Sizes dispatches by prefix sums, and hands the numbers of entries and groups to the passes to come.
    pub(crate) fn size(
        &self,
        recording: &mut Recording,
        pass: &SizesPass,
        totals: &wgpu::Buffer,
        sizes: &Sizes,
        film: &Film,
    ) {
        let bound = pass_bindings::Sizes {
            totals,
            sizes: &sizes.buffer,
            film: &film.buffer,
        };
        pass.run(recording, &bound, &in_a_row(1));
        let (from, to) = (&sizes.buffer, &self.frame);
        (recording.encoder).copy_buffer_to_buffer(from, 0, to, COUNTED_OFFSET, COUNTED_BYTES);
    }

    /// Writes what the host knows of a frame.
    fn write_frame(&self, view: &View, strip: &Range<u32>, film_row: u32, sample: u32) {
        let uniform = frame(view, strip, film_row, sample);
        let known = &bytemuck::bytes_of(&uniform)[..COUNTED_OFFSET as usize];
        self.gpu.queue.write_buffer(&self.frame, 0, known);
    }

    /// Submits the commands that `record` records.
    pub(crate) fn submit(&self, view: &View, record: impl FnOnce(&mut Recording)) {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        record(&mut self.recording(&mut encoder, view));
        self.gpu.queue.submit([encoder.finish()]);
    }

    fn recording<'a>(
        &'a self,
        encoder: &'a mut wgpu::CommandEncoder,
        view: &View<'a>,
    ) -> Recording<'a> {
        Recording {
            gpu: &self.gpu,
            encoder,
            frame: &self.frame_group,
            scene: &view.uploaded.data,
            timing: &self.timing,
        }
    }
}
