//! Scratches that stand for all: for each light a few, each drawn with the probability of its part of the light that the scratches of a point
//! send. Shadow rays start from them.

use super::row_spread::RowSpread;
use crate::sampling::luminance;
use glam::{DVec2, DVec3};
use hairline_optics::band::{Along, BandPlace};
use hairline_scene::Profile;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// A scratch under a point, or a grating.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pick {
    /// In the surface's frame.
    pub tangent: DVec2,
    pub place: BandPlace,
    pub along: Along,
    pub profile: Profile,
    /// Of a grating; none for a scratch.
    pub row: Option<RowSpread>,
    /// What it sends by way of the light.
    pub radiance: DVec3,
}

/// One light's.
#[derive(Clone, Debug, Default)]
pub(crate) struct SourcePicks {
    /// What all scratches send by way of the light.
    pub radiance: DVec3,
    /// The sum of the scratches' luminances.
    pub luminance: f64,
    /// The least of the picks' thresholds.
    next: f64,
    /// What the luminance must exceed for the pick to be drawn anew, and the pick.
    picks: Vec<(f64, Option<Pick>)>,
}

/// Those of a point: a source for each of [`LightViews::views`], one for the environment, and with bounces one for light of radiance 1 from
/// all around.
pub(crate) struct Picks {
    pub sources: Vec<SourcePicks>,
    random: Pcg32,
}

impl Picks {
    pub fn new() -> Self {
        Self {
            sources: Vec::new(),
            random: Pcg32::seed_from_u64(0),
        }
    }

    /// Empties it for a point with so many sources, `count` picks for each.
    pub fn clear(&mut self, sources: usize, count: u32, seed: u64) {
        self.random = Pcg32::seed_from_u64(seed);
        self.sources.resize_with(sources, Default::default);
        for source in &mut self.sources {
            source.radiance = DVec3::ZERO;
            source.luminance = 0.0;
            source.next = 0.0;
            source.picks.clear();
            source.picks.resize(count as usize, (0.0, None));
        }
    }

    /// Adds what a scratch sends by way of a source.
    ///
    /// Weighted reservoirs (M.-T. Chao, 1982): the newest replaces a pick with the probability of its share of the sum. A pick drawn at a
    /// sum s stays up to a sum S with the probability s/S, so one random number tells the sum at which it ends.
    #[inline]
    pub fn add(&mut self, source: usize, radiance: DVec3, pick: impl Fn(DVec3) -> Pick) {
        let source = &mut self.sources[source];
        source.radiance += radiance;
        source.luminance += luminance(radiance).max(0.0);
        if source.luminance <= source.next {
            return;
        }
        let pick = pick(radiance);
        source.next = f64::INFINITY;
        for (threshold, kept) in &mut source.picks {
            if source.luminance > *threshold {
                *kept = Some(pick);
                *threshold = source.luminance / (1.0 - self.random.random::<f64>());
            }
            source.next = source.next.min(*threshold);
        }
    }
}

impl SourcePicks {
    /// Those that were drawn: all or none.
    pub fn picks(&self) -> impl Iterator<Item = &Pick> {
        self.picks.iter().filter_map(|(_, pick)| pick.as_ref())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each of five scratches is picked as often as its luminance says.
    #[test]
    fn picks_follow_luminance() {
        let mut picks = Picks::new();
        let parts = [0.1, 0.0, 0.4, 0.2, 0.3];
        let (mut counts, rounds, each) = ([0.0; 5], 4000, 5);
        for seed in 0..rounds {
            picks.clear(1, each, seed);
            for (i, part) in parts.into_iter().enumerate() {
                picks.add(0, DVec3::splat(part), |radiance| Pick {
                    tangent: DVec2::X,
                    place: BandPlace::new([0.0; 2], 0.0, 1.0),
                    along: Along {
                        steps_um: [0.0; 2],
                        blur_um: 0.0,
                        ends: [0.0; 2],
                    },
                    profile: Profile {
                        width_um: i as f32,
                        depth_nm: 0.0,
                    },
                    row: None,
                    radiance,
                });
            }
            for pick in picks.sources[0].picks() {
                counts[pick.profile.width_um as usize] += 1.0;
            }
        }
        let all = f64::from(rounds as u32 * each);
        for (count, part) in counts.into_iter().zip(parts) {
            let std = (part * (1.0 - part) / all).sqrt();
            assert!((count / all - part).abs() <= 4.0 * std, "{counts:?}");
        }
    }
}
