//! How much room a strip gets on the device: as much as the strips before it needed. The host asks for that when it asks for pixels; where there was too
//! little, it shades again, with more, or in strips of fewer rows.

use std::mem::offset_of;

use crate::compute_pass::{Workgroups, in_a_row};
use crate::device::Gpu;
use crate::error::Error;
use crate::film::Film;
use crate::frame::View;
use crate::layout;
use crate::passes::ScenePasses;
use crate::scan::ScanPasses;
use crate::shadow_buffers::TRACED_BYTES;
use crate::sizes::{CHUNKS, ENTRIES, GROUPS, Numbers};
use crate::strip::{
    CHUNK_BYTES, CHUNK_SEGMENTS, ENTRY_BYTES, GROUP, POINT_BYTES, Samples, StripBuffers, TILE_PX,
};

impl StripBuffers {
    /// Workgroups of a group each: in the first step a group is a tile.
    pub(crate) fn groups(&self, step: u32, tiles: u32) -> Workgroups {
        match step {
            0 => in_a_row(tiles),
            _ => self.sizes.workgroups(GROUPS),
        }
    }

    /// Number of lanes of the chunks that there is room for.
    pub(crate) fn lanes(&self) -> u64 {
        u64::from(GROUP) * u64::from(self.samples.chunks_max)
    }

    /// Makes room for so many groups of so many samples, or for as many as were needed last; and for their lists.
    pub(crate) async fn make_room(
        &mut self,
        gpu: &Gpu,
        scans: &ScanPasses,
        passes: &ScenePasses,
        groups: u32,
        points: u64,
    ) -> Result<(), Error> {
        let wanted = self.sizes.wanted;
        let groups = wanted[GROUPS].min(self.most[GROUPS]).max(groups);
        let points = points.max(u64::from(GROUP) * u64::from(groups));
        let mut chunks = groups + passes.grating_chunks(groups);
        if passes.scratches().is_some() {
            let entries = wanted[ENTRIES].max(GROUP * groups).min(self.most[ENTRIES]);
            self.lists.make_room(gpu, scans, entries).await?;
            chunks += self.lists.entries_max / CHUNK_SEGMENTS;
        }
        let chunks = wanted[CHUNKS].max(chunks).min(self.most[CHUNKS]);
        self.samples
            .make_room(gpu, scans, points, groups, chunks)
            .await?;
        let Samples {
            groups_max,
            chunks_max,
            ..
        } = self.samples;
        let capacity = [
            self.lists.entries_max,
            groups_max.min(self.most[GROUPS]),
            chunks_max,
        ];
        self.sizes.set_capacity(gpu, capacity);
        Ok(())
    }

    /// Waits until all that was submitted is done. Tells of each film from which step on it has nothing, if there was no room; next time there is.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where a row of tiles needs more than the device can hold; [`Error::OutOfMemory`], [`Error::Lost`].
    pub(crate) async fn settle(
        &mut self,
        gpu: &Gpu,
        films: &[&Film],
    ) -> Result<Vec<Option<u32>>, Error> {
        let hits = self.bounces.iter_mut().flat_map(|it| &mut it.hits);
        let mut sizes = vec![&mut self.sizes];
        sizes.extend(hits.map(|buffers| &mut buffers.sizes));
        let needed = offset_of!(layout::Sizes, needed) as u64;
        let needed = needed..needed + size_of::<Numbers>() as u64;
        let of_films = films.iter().map(|film| film.short());
        let of_rooms = sizes.iter().map(|it| (&it.buffer, needed.clone()));
        let parts: Vec<_> = of_films.chain(of_rooms).collect();
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&gpu.read_parts(&parts).await?);
        let (short, needed) = words.split_at(films.len());
        let (needed, _) = needed.as_chunks::<3>();
        let times = |factor: u64| {
            let all = needed
                .iter()
                .flat_map(|needed| needed.iter().zip(&self.most));
            all.map(move |(n, most)| (factor * u64::from(*n), u64::from(*most)))
        };
        let parts = match times(1).find(|(n, most)| n > most) {
            Some((needed, most)) if self.strip_rows <= TILE_PX => {
                let what = "tile lists of a row of tiles";
                return Err(gpu.too_large(what, needed, most, "entries"));
            }
            Some(_) => {
                self.strip_rows = half(self.strip_rows);
                2
            }
            None => {
                if times(2).all(|(n, most)| n <= most) {
                    self.strip_rows =
                        (2 * self.strip_rows).min(self.rows.next_multiple_of(TILE_PX));
                }
                1
            }
        };
        for (sizes, needed) in sizes.into_iter().zip(needed) {
            sizes.want(gpu, *needed, parts);
        }
        let steps = films.iter().zip(short).map(|(film, short)| {
            let step = short.checked_sub(1)?;
            film.forget_short(gpu);
            Some(step)
        });
        Ok(steps.collect())
    }
}

/// Numbers that the device can hold.
pub(crate) fn numbers_most(gpu: &Gpu, view: &View) -> Numbers {
    let bytes = gpu.largest_array();
    let traced = view.shadows().map_or(0, |it| it.layers * TRACED_BYTES);
    let group = u64::from(GROUP) * POINT_BYTES.max(traced);
    [ENTRY_BYTES, group, CHUNK_BYTES].map(|each| u32::try_from(bytes / each).unwrap_or(u32::MAX))
}

/// Half of so many rows, in whole tiles.
pub(crate) fn half(rows: u32) -> u32 {
    (rows / 2).next_multiple_of(TILE_PX)
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
