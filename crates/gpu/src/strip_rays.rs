//! The rays of a strip's samples: shadows, and light of other objects.

use hairline_image::Batch;

use crate::bounces::{Bounce, Bounces};
use crate::compute_pass::Workgroups;
use crate::error::Error;
use crate::frame::Rounds;
use crate::layout::ShadowRound;
use crate::lights::{self, LightKind};
use crate::shadow_buffers::ShadowBuffers;
use crate::shadow_picks::{PickPasses, RayBuffers, Scratched};
use crate::shadows::Shadows;
use crate::sizes::CHUNKS;
use crate::strip::{BounceBuffers, StripBuffers};
use crate::strip_shader::StripRays;
use crate::variant::Way;

impl StripRays<'_, '_> {
    /// The light of the samples that rays find, on the film.
    pub(crate) async fn shade(
        &self,
        shadows: &Shadows,
        buffers: &mut StripBuffers,
        on: &Scratched,
        rows: u32,
    ) -> Result<(), Error> {
        let Self { view, film, .. } = *self;
        let rounds = Rounds {
            now: view.rounds(),
            seed: 0,
        };
        self.shadows(shadows, buffers, on, rounds).await?;
        if let Some(bounces) = view.bounces() {
            self.bounces(bounces, buffers, on).await?;
        }
        self.finish(shadows, buffers, &on.groups, rounds.now.count);
        self.strip.submit(view, |recording| {
            let passes = &view.uploaded.passes;
            passes.record_resolve(recording, buffers, film, rows);
            shadows.record_film(recording, buffers, film, rows);
        });
        Ok(())
    }

    /// Finds which part of the light of the samples is seen.
    async fn shadows(
        &self,
        shadows: &Shadows,
        buffers: &mut StripBuffers,
        on: &Scratched,
        rounds: Rounds,
    ) -> Result<(), Error> {
        let Self { view, points, .. } = *self;
        let gpu = &self.strip.gpu;
        let mut shadow_buffers = match buffers.shadows.take() {
            Some(shadow_buffers) => shadow_buffers,
            None => ShadowBuffers::new(gpu).await?,
        };
        let layers = shadows.layers;
        shadow_buffers.make_room(gpu, points.most, layers).await?;
        let lanes = buffers.lanes();
        self.strip.submit(self.view, |recording| {
            shadow_buffers.clear(recording.encoder)
        });
        let light_count = view.uploaded.data.light_count;
        let environment = view.scene.environment.iter().map(|_| light_count);
        let kinds = (0..).zip(lights::kinds(view.scene));
        let around = environment.map(|source| (source, LightKind::Environment));
        let sources: Vec<_> = kinds.chain(around).collect();
        let mut next = ShadowRound {
            rounds: rounds.now.count,
            first_round: rounds.now.first,
            seed: rounds.seed,
            extent_m: shadows.extent_m,
            way: Way::Base as u32,
            ..ShadowRound::default()
        };
        // A ray at a time, so that no submission takes long.
        for round in 0..rounds.now.count {
            for (i, &(source, kind)) in sources.iter().enumerate() {
                next.source = source;
                next.round = round;
                next.ends_round = (i + 1 == sources.len()).into();
                shadow_buffers.write(gpu, &next);
                let rays = self.ray_buffers(buffers, &shadow_buffers);
                self.strip.submit(self.view, |recording| {
                    shadows.record_base_round(kind, recording, rays, &on.groups);
                });
            }
        }
        next.ends_round = 1;
        for (source, by) in (light_count + 1..).zip(&shadows.by_picks) {
            next.source = source;
            next.way = by.way() as u32;
            let room = shadow_buffers.make_room_for_picks(gpu, points, lanes, next.rounds);
            let most = room.await?;
            let rays = self.ray_buffers(buffers, &shadow_buffers);
            self.picked_rounds((shadows, by), rays, on, next, most);
        }
        buffers.shadows = Some(shadow_buffers);
        Ok(())
    }

    /// The rounds from one kind of picks, of which buffers hold those of so many rounds.
    fn picked_rounds(
        &self,
        (shadows, by): (&Shadows, &PickPasses),
        rays: RayBuffers,
        on: &Scratched,
        mut next: ShadowRound,
        most: u32,
    ) {
        for round in 0..next.rounds {
            next.round = round;
            if round % most == 0 {
                next.first_pick = round;
                next.picks = most.min(next.rounds - round);
            }
            rays.shadows.write(&self.strip.gpu, &next);
            self.strip.submit(self.view, |recording| {
                if round == next.first_pick {
                    by.record_picks(recording, rays, on);
                }
                shadows.record_picked_round(by, recording, rays, &on.groups);
            });
        }
    }

    fn ray_buffers<'a>(
        &'a self,
        strip: &'a StripBuffers,
        shadows: &'a ShadowBuffers,
    ) -> RayBuffers<'a> {
        let film = self.film;
        RayBuffers {
            strip,
            shadows,
            film,
        }
    }

    /// Converts the sums of so many rounds to light.
    fn finish(&self, shadows: &Shadows, buffers: &StripBuffers, groups: &Workgroups, rounds: u32) {
        let Some(shadow_buffers) = &buffers.shadows else {
            return;
        };
        let all = ShadowRound {
            rounds,
            ..ShadowRound::default()
        };
        shadow_buffers.write(&self.strip.gpu, &all);
        self.strip.submit(self.view, |recording| {
            let rays = self.ray_buffers(buffers, shadow_buffers);
            shadows.record_light(recording, rays, groups);
        });
    }

    /// Finds the light of other objects that the samples send.
    async fn bounces(
        &self,
        bounces: &Bounces,
        buffers: &mut StripBuffers,
        on: &Scratched,
    ) -> Result<(), Error> {
        let Self {
            strip,
            view,
            points,
            ..
        } = *self;
        let (gpu, scans, passes) = (&strip.gpu, &strip.scans, &view.uploaded.passes);
        let mut bounce_buffers = match buffers.bounces.take() {
            Some(bounce_buffers) => bounce_buffers,
            None => Box::new(BounceBuffers::new(gpu, scans).await?),
        };
        let made =
            bounce_buffers.make_room(gpu, scans, passes, buffers, points.most, bounces.count);
        made.await?;
        let Batch {
            first: first_round,
            count: rounds,
        } = view.rounds();
        let mut most = rounds;
        let lanes = buffers.lanes();
        if bounces.scratches.is_some()
            && let Some(shadow_buffers) = &mut buffers.shadows
        {
            let made = shadow_buffers.make_room_for_picks(gpu, points, lanes, rounds);
            most = made.await?;
        }
        for way in Way::ALL {
            if !bounces.has(way) {
                continue;
            }
            for round in 0..rounds {
                let first_pick = round - round % most;
                let first = ShadowRound {
                    round,
                    rounds,
                    first_round,
                    all_rounds: view.all_rounds(),
                    extent_m: bounces.shadows.extent_m,
                    first_pick,
                    picks: most.min(rounds - first_pick),
                    way: way as u32,
                    ..ShadowRound::default()
                };
                let hits = &mut *bounce_buffers;
                self.go_on(bounces, buffers, hits, on, first).await?;
            }
        }
        buffers.bounces = Some(bounce_buffers);
        Ok(())
    }

    /// Follows a ray of each sample, one from its hit, and so on.
    async fn go_on(
        &self,
        bounces: &Bounces,
        buffers: &StripBuffers,
        bounce_buffers: &mut BounceBuffers,
        on: &Scratched,
        first: ShadowRound,
    ) -> Result<(), Error> {
        let mut on = on.clone();
        for depth in 0..bounces.count {
            let round = match depth {
                0 => first,
                _ => ShadowRound {
                    round: 0,
                    rounds: 1,
                    first_round: 0,
                    all_rounds: 1,
                    first_pick: 0,
                    picks: 1,
                    depth,
                    seed: seed(&first, depth),
                    ..first
                },
            };
            let round = ShadowRound {
                ends_round: (depth + 1 == bounces.count).into(),
                ..round
            };
            bounce_buffers.write(&self.strip.gpu, &round);
            let to = depth as usize % 2;
            self.strip.submit(self.view, |recording| {
                let Some(by) = Bounce::new(buffers, bounce_buffers, self.film, &round, &on.groups)
                else {
                    return;
                };
                if let Some(scratches) = &bounces.scratches
                    && (depth > 0 || by.way == Way::Scratches && round.round == round.first_pick)
                {
                    scratches.record_picks(recording, &by, &on);
                }
                bounces.record_rays(recording, &by);
            });
            let hits = &mut bounce_buffers.hits[to];
            let next = seed(&first, depth + 1);
            self.shade_hits(bounces, hits, &mut on, next).await?;
            self.strip.submit(self.view, |recording| {
                if let Some(by) =
                    Bounce::new(buffers, bounce_buffers, self.film, &round, &on.groups)
                {
                    bounces.record_light(recording, &by);
                }
            });
        }
        Ok(())
    }

    /// Shades hits, with shadows; from now on the chunks are theirs.
    async fn shade_hits(
        &self,
        bounces: &Bounces,
        hits: &mut StripBuffers,
        on: &mut Scratched,
        seed: u32,
    ) -> Result<(), Error> {
        let Self {
            strip, view, film, ..
        } = *self;
        let (scans, passes) = (&strip.scans, &view.uploaded.passes);
        on.chunks = hits.sizes.workgroups(CHUNKS);
        if bounces.scratches.is_none() {
            hits.samples.one_chunk_a_group(&strip.gpu);
        }
        self.strip.submit(self.view, |recording| {
            if let Some(scratches) = &bounces.scratches {
                scratches.record_count(recording, scans, hits, film, &on.groups);
                let starts = &hits.list_starts;
                strip.size(recording, &scratches.size, starts, &hits.sizes, film);
                scratches.record_lists(recording, hits, film, &on.groups);
                scratches.shade.record_chunks(recording, scans, hits);
            }
            let (size, starts) = (&passes.sizes[CHUNKS], &hits.samples.chunk_starts);
            strip.size(recording, size, starts, &hits.sizes, film);
            if let Some(scratches) = &bounces.scratches {
                scratches.shade.record(recording, hits, &on.chunks);
            }
            passes.shade.record(recording, hits, film, &on.groups);
        });
        let rounds = Rounds {
            now: Batch::all(1),
            seed,
        };
        self.shadows(&bounces.shadows, hits, on, rounds).await?;
        self.finish(&bounces.shadows, hits, &on.groups, 1);
        Ok(())
    }
}

/// Seed of the random numbers for the hits of a round: a place may be met again in other rounds.
fn seed(first: &ShadowRound, depth: u32) -> u32 {
    let chain = 3 * (first.first_round + first.round) + first.way;
    let mixed = chain.wrapping_mul(0x9e37_79b9) ^ depth.wrapping_mul(0x85eb_ca6b);
    mixed ^ mixed >> 15
}
