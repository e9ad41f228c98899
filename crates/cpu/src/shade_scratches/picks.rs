//! Scratches that stand for all: a few pairs of a scratch and a light, each drawn with the probability of its part of the light that the scratches
//! of a point send, and a few scratches by the energy that they take of the base. Rays start from them.

use super::course::Course;
use super::row_spread::RowSpread;
use crate::sampling::luminance;
use glam::DVec3;
use hairline_index::IndexedProfile;
use hairline_optics::band::{Along, BandPlace};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// A scratch under a point, or a grating.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pick {
    pub course: Course,
    pub place: BandPlace,
    pub along: Along,
    pub profile: IndexedProfile,
    /// Spread of a grating's grooves; none for a scratch.
    pub row: Option<RowSpread>,
    /// Share of the point that it covers.
    pub share: f64,
    /// Index of the light in [`LightViews::views`](crate::light_view::LightViews::views); the number of views for the environment.
    pub source: usize,
    /// Light of the source that the scratch reflects, or energy that the scratch takes from the base.
    pub radiance: DVec3,
}

/// Random choice of a few items out of many, each with a probability in proportion to its luminance.
#[derive(Default)]
pub(crate) struct Reservoirs {
    /// The sum of all luminances.
    total: f64,
    /// The least of the picks' thresholds.
    next: f64,
    /// Threshold that the total must exceed for the pick to be drawn anew, and the pick.
    picks: Vec<(f64, Option<Pick>)>,
}

impl Reservoirs {
    fn clear(&mut self, count: u32) {
        self.total = 0.0;
        self.next = 0.0;
        self.picks.clear();
        self.picks.resize(count as usize, (0.0, None));
    }

    /// Weighted reservoirs (M.-T. Chao, 1982): the newest replaces a pick with the probability of its share of the sum. A pick drawn at a
    /// sum s stays up to a sum S with the probability s/S, so one random number tells the sum at which it ends.
    #[inline]
    fn add(&mut self, random: &mut Pcg32, luminance: f64, pick: impl FnOnce() -> Pick) {
        self.total += luminance.max(0.0);
        if self.total <= self.next {
            return;
        }
        let pick = pick();
        self.next = f64::INFINITY;
        for (threshold, kept) in &mut self.picks {
            if self.total > *threshold {
                *kept = Some(pick);
                *threshold = self.total / (1.0 - random.random::<f64>());
            }
            self.next = self.next.min(*threshold);
        }
    }

    /// The sum of the luminances that were drawn from.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Returns the pick of a round: all or none are there.
    pub fn get(&self, round: u32) -> Option<&Pick> {
        self.picks.get(round as usize)?.1.as_ref()
    }
}

/// Picks of a point.
pub(crate) struct Picks {
    /// Light that all scratches reflect from all sources.
    pub radiance: DVec3,
    /// Energy that all scratches take of the base.
    pub energy: DVec3,
    /// Pairs of a scratch and a source, by the light that the scratch sends of the source.
    pub lit: Reservoirs,
    /// Scratches by the energy that they take.
    pub by_energy: Reservoirs,
    random: Pcg32,
}

impl Picks {
    pub fn new() -> Self {
        Self {
            radiance: DVec3::ZERO,
            energy: DVec3::ZERO,
            lit: Reservoirs::default(),
            by_energy: Reservoirs::default(),
            random: Pcg32::seed_from_u64(0),
        }
    }

    /// Empties it for a point, `count` picks of each kind.
    pub fn clear(&mut self, count: u32, seed: u64) {
        self.random = Pcg32::seed_from_u64(seed);
        (self.radiance, self.energy) = (DVec3::ZERO, DVec3::ZERO);
        self.lit.clear(count);
        self.by_energy.clear(count);
    }

    /// Adds the light that a scratch reflects from a source.
    #[inline]
    pub fn add_light(&mut self, source: usize, radiance: DVec3, pick: impl FnOnce() -> Pick) {
        self.radiance += radiance;
        let pick = || Pick {
            source,
            radiance,
            ..pick()
        };
        self.lit.add(&mut self.random, luminance(radiance), pick);
    }

    /// Adds the energy that a scratch takes from the base.
    #[inline]
    pub(crate) fn add_energy(&mut self, energy: DVec3, pick: impl FnOnce() -> Pick) {
        self.energy += energy;
        let pick = || Pick {
            radiance: energy,
            ..pick()
        };
        self.by_energy
            .add(&mut self.random, luminance(energy), pick);
    }

    /// Lets the only pick, which was drawn by a bound of its light, stand for all pairs; `light` returns the light of the pick.
    pub(crate) fn light_one(&mut self, light: impl FnOnce(&Pick) -> DVec3) {
        let (mut radiance, bounds) = (DVec3::ZERO, self.lit.total);
        if let Some((_, Some(pick))) = self.lit.picks.first_mut() {
            radiance = light(pick) * (bounds / luminance(pick.radiance));
            pick.radiance = radiance;
        }
        self.radiance = radiance;
        self.lit.total = luminance(radiance);
        if !(self.lit.total > 0.0) {
            self.radiance = DVec3::ZERO;
            self.lit.picks.clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// Each of five scratches is picked as often as its luminance says.
    #[test]
    fn picks_follow_luminance() {
        let mut picks = Picks::new();
        let parts = [0.1, 0.0, 0.4, 0.2, 0.3];
        let (mut counts, rounds, each) = ([0.0; 5], 4000, 5);
        for seed in 0..rounds {
            picks.clear(each, seed);
            for (i, part) in parts.into_iter().enumerate() {
                picks.add_light(i, DVec3::splat(part), || Pick {
                    course: Course::straight(DVec2::X),
                    place: BandPlace::new([0.0; 2], 0.0, 1.0),
                    along: Along {
                        steps_um: [0.0; 2],
                        blur_um: 0.0,
                        ends: [0.0; 2],
                    },
                    profile: IndexedProfile::rectangle(1.0, 0.0),
                    row: None,
                    share: 1.0,
                    source: 0,
                    radiance: DVec3::ZERO,
                });
            }
            for round in 0..each {
                counts[picks.lit.get(round).unwrap().source] += 1.0;
            }
        }
        let all = f64::from(rounds as u32 * each);
        for (count, part) in counts.into_iter().zip(parts) {
            let std = (part * (1.0 - part) / all).sqrt();
            assert!((count / all - part).abs() <= 4.0 * std, "{counts:?}");
        }
    }
}
