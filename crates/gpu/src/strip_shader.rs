//! A strip of a picture: its stages in their order, from the visibility to the film.

use std::ops::Range;

use wgpu::BufferUsages;

use crate::bindings::{Layouts, bind};
use crate::compute_pass::{Recording, in_a_row};
use crate::device::Gpu;
use crate::error::Error;
use crate::film::Film;
use crate::frame::{Counted, Rounds, View, frame, halo_rows};
use crate::layout::{Frame, PixelPoint};
use crate::passes::{ScratchPasses, Shade};
use crate::pipelines::compiled;
use crate::scan::ScanPasses;
use crate::shadow_picks::Scratched;
use crate::shadow_room::ShadowRoom;
use crate::strip::{
    BounceRoom, GROUP, Lists, MadeLists, Samples, StripRoom, TILE_PX, chunks_most, strip_points,
    tile_count,
};
use crate::timing::Timing;
use crate::visibility::VisibilityPass;

/// The passes that every scene needs, and the frame that all passes read.
pub(crate) struct StripShader {
    pub gpu: Gpu,
    visibility: VisibilityPass,
    pub scans: ScanPasses,
    frame: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    pub timing: Timing,
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

    /// One step of the rows of a film, in as many strips as the tile lists need.
    pub(crate) async fn shade(
        &self,
        view: &View<'_>,
        film: &Film,
        room: &mut StripRoom,
        rows: Range<u32>,
    ) -> Result<(), Error> {
        let film_row = rows.start;
        let mut strips = vec![rows];
        while let Some(strip) = strips.pop() {
            let halves = self.shade_strip(view, film, film_row, room, &strip).await?;
            strips.extend(halves.into_iter().flatten());
        }
        Ok(())
    }

    /// One step of a strip; or, if the lists of its tiles do not fit on the device, the two halves to shade in its place, the lower
    /// one first.
    async fn shade_strip(
        &self,
        view: &View<'_>,
        film: &Film,
        film_row: u32,
        room: &mut StripRoom,
        strip: &Range<u32>,
    ) -> Result<Option<[Range<u32>; 2]>, Error> {
        let (gpu, scans, passes) = (&self.gpu, &self.scans, &view.uploaded.passes);
        let rows = strip.len() as u32;
        let tiles = tile_count(room.width_px, rows);
        if let Some(scratches) = passes.scratches() {
            // Lists of the first step serve the other steps.
            let made = room.lists.made.as_ref();
            let kept = view.step > 0 && made.is_some_and(|made| made.rows == *strip);
            if !kept
                && !self
                    .make_lists(view, scratches, film_row, room, strip)
                    .await?
            {
                return self.halves(strip).map(Some);
            }
        }
        let lists = room.lists.made.as_ref();
        let entries = lists.map_or(0, |made| made.entries);
        let mut counted = Counted {
            entries,
            groups: tiles,
        };
        let mut points = strip_points(room.width_px, rows);
        if view.step > 0 {
            counted.groups = self.count_groups(view, film, film_row, room, strip).await?;
            points = u64::from(counted.groups) * u64::from(GROUP);
        }
        let groups = counted.groups;
        if groups == 0 {
            return Ok(None);
        }
        let mut chunks = match passes.scratches() {
            None => groups,
            Some(_) => chunks_most(tiles, entries),
        };
        let grating_chunks = passes.grating_chunks(groups);
        if !Samples::fit(gpu, points, chunks + grating_chunks)
            || view
                .shadows()
                .is_some_and(|shadows| !ShadowRoom::fit(gpu, points, shadows.layers))
            || view.bounces().is_some() && !BounceRoom::fit(gpu, points)
        {
            return self.halves(strip).map(Some);
        }
        room.samples.make_room(gpu, scans, points, groups).await?;
        if let Some(scratches) = passes.scratches() {
            self.write_frame(view, strip, film_row, view.step_samples().start, counted);
            self.submit(view, |recording| {
                let shade = &scratches.shade;
                shade.record_chunks(recording, scans, room, groups);
            });
            if view.step > 0 {
                chunks = self.read_u32(&room.samples.chunk_starts, groups).await?;
            }
            if !Samples::fit(gpu, points, chunks + grating_chunks) {
                return self.halves(strip).map(Some);
            }
        } else {
            room.samples.one_chunk_a_group(gpu, groups);
        }
        let all_chunks = chunks + grating_chunks;
        room.samples.make_room_for_chunks(gpu, all_chunks).await?;
        self.submit(view, |recording| {
            if view.step == 0 && strip.start == film_row {
                film.clear(recording.encoder);
            }
            // Not every place of a group has a sample.
            let bytes = points * size_of::<PixelPoint>() as u64;
            (recording.encoder).clear_buffer(&room.samples.points, 0, Some(bytes));
        });
        for sample in view.step_samples() {
            self.write_frame(view, strip, film_row, sample, counted);
            self.submit(view, |recording| {
                let rows = rows + 2 * halo_rows(view.scene);
                self.visibility.record(recording, room, rows);
                let resources = room.resources().and(film.resources());
                passes.surface.run(recording, &resources, room.tiles(rows));
            });
        }
        if let Some(ScratchPasses { share, .. }) = passes.scratches().filter(|_| view.step > 0) {
            self.submit(view, |recording| {
                let resources = room.resources().and(film.resources());
                share.run(recording, &resources, room.tiles(rows));
            });
        }
        let shadows = match &passes.shade {
            Shade::Own { .. } => view.shadows(),
            Shade::Other(_) => None,
        };
        self.submit(view, |recording| {
            let resources = room.resources().and(film.resources());
            match &passes.shade {
                Shade::Own {
                    base,
                    scratches,
                    gratings,
                } => {
                    base.run(recording, &resources, in_a_row(groups));
                    if let Some(scratches) = scratches {
                        scratches.shade.record(recording, room, chunks);
                    }
                    if let Some(gratings) = gratings {
                        gratings.run(recording, &resources, in_a_row(groups));
                    }
                }
                Shade::Other(pass) => pass.run(recording, &resources, in_a_row(groups)),
            }
            if shadows.is_none() {
                passes.resolve.run(recording, &resources, room.tiles(rows));
            }
        });
        if let Some(shadows) = shadows {
            let on = Scratched { groups, chunks };
            let rounds = Rounds {
                now: view.rounds(),
                seed: 0,
            };
            self.shade_shadows(view, shadows, room, film, points, &on, rounds)
                .await?;
            let bounces = view.bounces();
            if let Some(bounces) = bounces
                && !self
                    .shade_bounces(view, bounces, room, film, points, &on)
                    .await?
            {
                return self.halves(strip).map(Some);
            }
            self.finish_found(view, shadows, room, film, groups, rounds.now.count);
            self.submit(view, |recording| {
                let resources = room.resources().and(film.resources());
                let tiles = room.tiles(rows);
                passes.resolve.run(recording, &resources, tiles);
                if let (Some(shadow_room), Some(_)) = (&room.shadows, &film.found) {
                    let resources = resources.and(shadow_room.resources());
                    shadows.film.run(recording, &resources, tiles);
                }
            });
        }
        Ok(None)
    }

    /// Counts the groups of the samples on a strip's edges.
    async fn count_groups(
        &self,
        view: &View<'_>,
        film: &Film,
        film_row: u32,
        room: &mut StripRoom,
        strip: &Range<u32>,
    ) -> Result<u32, Error> {
        let tiles = tile_count(room.width_px, strip.len() as u32);
        let first = view.step_samples().start;
        self.write_frame(view, strip, film_row, first, Counted::default());
        self.submit(view, |recording| {
            let edges = &view.uploaded.passes.edges;
            let resources = room.resources().and(film.resources());
            edges.run(recording, &resources, in_a_row(tiles));
            room.group_scan.set_count(&self.gpu, tiles + 1);
            let scan = &room.group_scan;
            self.scans.record(recording.encoder, scan, recording.timing);
        });
        self.read_u32(&room.group_starts, tiles).await
    }

    pub(crate) async fn read_u32(&self, buffer: &wgpu::Buffer, index: u32) -> Result<u32, Error> {
        let at = 4 * u64::from(index);
        let bytes = self.gpu.read(buffer, at..at + 4).await?;
        Ok(bytemuck::pod_read_unaligned(&bytes))
    }

    /// Makes the tile lists of a strip; false if they do not fit on the device.
    async fn make_lists(
        &self,
        view: &View<'_>,
        passes: &ScratchPasses,
        film_row: u32,
        room: &mut StripRoom,
        strip: &Range<u32>,
    ) -> Result<bool, Error> {
        let (gpu, scans) = (&self.gpu, &self.scans);
        let tiles = tile_count(room.width_px, strip.len() as u32);
        let segments = view.uploaded.data.buffers.segment_count();
        room.lists.made = None;
        room.lists
            .make_room_for_segments(gpu, scans, segments)
            .await?;
        let sample = view.step_samples().start;
        self.write_frame(view, strip, film_row, sample, Counted::default());
        self.submit(view, |recording| {
            passes.bin.record_count(recording, scans, room, segments);
        });
        // The sum of all lies behind them.
        let starts = &room.lists.entry_starts;
        let entries = self.read_u32(starts, segments).await?;
        if entries > Lists::entries_most(gpu) {
            return Ok(false);
        }
        room.lists.make_room(gpu, scans, entries).await?;
        let groups = 0;
        self.write_frame(view, strip, film_row, sample, Counted { entries, groups });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut recording = self.recording(&mut encoder, view);
        let counts = [segments, entries];
        let sorted = passes
            .bin
            .record(&mut recording, scans, room, tiles, counts);
        let sorted = sorted.await?;
        gpu.queue.submit([encoder.finish()]);
        room.lists.made = Some(MadeLists {
            rows: strip.clone(),
            entries,
            sorted,
        });
        Ok(true)
    }

    /// The halves of a strip, of whole tiles.
    fn halves(&self, strip: &Range<u32>) -> Result<[Range<u32>; 2], Error> {
        let upper = (strip.len() as u32 / 2).next_multiple_of(TILE_PX);
        let middle = strip.start + upper;
        if middle >= strip.end {
            let what = "tile lists of a row of tiles";
            let allowed = u64::from(Lists::entries_most(&self.gpu));
            return Err(self.gpu.too_large(what, allowed + 1, allowed, "entries"));
        }
        Ok([middle..strip.end, strip.start..middle])
    }

    fn write_frame(
        &self,
        view: &View,
        strip: &Range<u32>,
        film_row: u32,
        sample: u32,
        counted: Counted,
    ) {
        let uniform = frame(view, strip, film_row, sample, counted);
        let queue = &self.gpu.queue;
        queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(&uniform));
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
