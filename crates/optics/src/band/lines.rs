//! The lines that stand for the part of a band which a light covers, in each colour channel (docs/model.md, section 4).

use super::BandLine;
use crate::gaussian::gaussian;
use crate::scratch::band_std;
use crate::spectrum::Observer;
use glam::DVec3;

/// The band is cut off at this many standard deviations; 6e-5 of its energy lies beyond, 5e-4 in red.
pub const BAND_REACH_STD: f64 = 4.0;

/// Standard deviations of a band in xi_t: it is wider the longer the wavelength.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BandStds {
    /// Standard deviation at the wavelength that stands for the visible; lines are placed by it.
    pub mean: f64,
    /// Standard deviations at the mean wavelength of each colour channel.
    pub channels: [f64; 3],
}

/// The band of a scratch on a surface of the given coherence.
pub fn band_stds(coherence_um: f64) -> BandStds {
    band_stds_seen_by(Observer::eye(), coherence_um)
}

/// [`band_stds`] in the channels of an observer.
pub fn band_stds_seen_by(observer: &Observer, coherence_um: f64) -> BandStds {
    BandStds {
        mean: band_std(coherence_um, observer.mean_nm),
        channels: (observer.channel_mean_nm).map(|nm| band_std(coherence_um, nm)),
    }
}

impl BandStds {
    /// Adds a variance that all wavelengths share.
    #[inline]
    pub(super) fn widened(self, variance: f64) -> Self {
        let wider = |std: f64| (std * std + variance).sqrt().min(BAND_STD_MAX);
        let [red, green, blue] = self.channels;
        Self {
            mean: wider(self.mean),
            channels: [wider(red), wider(green), wider(blue)],
        }
    }
}

/// Largest standard deviation of a band. A pixel with a wider one sees light from all around, and a turning normal is no longer a small angle.
pub const BAND_STD_MAX: f64 = 0.3;

/// The lines that stand for the part of the band which a light covers, given the extent of the light's xi_t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandLines {
    /// Number of lines: 0 (dark), 1, 3 or 5.
    pub count: usize,
    /// The band's share below the light's extent.
    pub share_below: f64,
    /// The band's share within the light's extent.
    pub share: f64,
    /// Share of each colour channel's band within the light's extent.
    pub channel_shares: [f64; 3],
    /// Standard deviations of the band.
    pub stds: BandStds,
    /// Share of the lit part of the band that lies below the single line, or below the middle one of several.
    pub node: f64,
}

/// The share below the middle line.
const MIDDLE: f64 = 0.5;

/// Whether a light of the given extent in xi_t meets the band at all.
pub(crate) fn band_reaches(lowest: f64, highest: f64, stds: BandStds) -> bool {
    let reach = BAND_REACH_STD * stds.mean;
    lowest < reach && highest > -reach && highest > lowest
}

/// Chooses the lines; `wo_t` is the component of `wo` along the tangent. Large lights cover the whole band evenly and one
/// line is enough; small ones need the band's shape, and so does a viewer who looks along the scratch, where neighbouring
/// lines are arcs of very different radius.
#[inline]
pub fn band_lines(wo_t: f64, lowest: f64, highest: f64, stds: BandStds) -> BandLines {
    if !band_reaches(lowest, highest, stds) {
        return BandLines {
            count: 0,
            share_below: 0.0,
            share: 0.0,
            channel_shares: [0.0; 3],
            stds,
            node: MIDDLE,
        };
    }
    if band_is_whole(wo_t, lowest, highest, stds.mean) {
        return BandLines {
            count: 1,
            share_below: 0.0,
            share: 1.0,
            channel_shares: [1.0; 3],
            stds,
            node: MIDDLE,
        };
    }
    let half_extent = 0.5 * (highest - lowest) / stds.mean;
    // The tests print the errors against 2-D quadrature: below 0.7 % everywhere.
    let count = if half_extent < 3.0 || is_steep(wo_t, stds.mean) {
        5
    } else if half_extent < SINGLE_LINE_STD {
        3
    } else {
        1
    };
    let table = gaussian();
    let seen = |std: f64| {
        let per_std = 1.0 / std;
        table.integral(lowest * per_std, highest * per_std)
    };
    let share_below = table.cdf(lowest / stds.mean);
    let [red, green, blue] = stds.channels;
    BandLines {
        count,
        share_below,
        share: table.cdf(highest / stds.mean) - share_below,
        channel_shares: [seen(red), seen(green), seen(blue)],
        stds,
        node: MIDDLE,
    }
}

/// Half an extent, in standard deviations, from which on one line serves.
const SINGLE_LINE_STD: f64 = 16.0;

/// Whether the viewer looks along the scratch.
#[inline]
fn is_steep(wo_t: f64, std: f64) -> bool {
    1.0 - wo_t * wo_t < 32.0 * std * wo_t.abs()
}

/// Number of standard deviations from the band's middle up to which a light must reach to cover the whole band: 6e-8 of the band lies beyond on
/// either side at the mean wavelength, 3e-6 in red.
const BAND_WHOLE_STD: f64 = 5.3;

/// Whether the line in the middle stands for all of a band that is `std` wide, every share being 1. A part of the light's extent
/// can tell.
#[inline]
pub fn band_is_whole(wo_t: f64, lowest: f64, highest: f64, std: f64) -> bool {
    lowest < -BAND_WHOLE_STD * std
        && highest > BAND_WHOLE_STD * std
        && highest - lowest >= 2.0 * SINGLE_LINE_STD * std
        && !is_steep(wo_t, std)
}

/// Gauss-Legendre nodes on [0, 1] and weights, for 1, 3 and 5 points: the constants of the twin in WGSL, not a library's.
const NODES: [[(f64, f64); 5]; 3] = [
    [(0.5, 1.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)],
    [
        (0.112_701_665_379_258, 0.277_777_777_777_778),
        (0.5, 0.444_444_444_444_444),
        (0.887_298_334_620_742, 0.277_777_777_777_778),
        (0.0, 0.0),
        (0.0, 0.0),
    ],
    [
        (0.046_910_077_030_668, 0.118_463_442_528_095),
        (0.230_765_344_947_158, 0.239_314_335_249_683),
        (0.5, 0.284_444_444_444_444),
        (0.769_234_655_052_842, 0.239_314_335_249_683),
        (0.953_089_922_969_332, 0.118_463_442_528_095),
    ],
];

impl BandLines {
    /// xi_t and the weights of line `i`: Gauss-Legendre in the band's cumulative share, which follows the band where the light
    /// is wide and the light where it is narrow. A weight is for each channel: its band over the band that placed the line.
    pub fn band_line(&self, i: usize) -> (f64, DVec3) {
        self.line_by(i, self.narrower())
    }

    /// Ratio of the width of the band that places the lines to that of each channel's band.
    fn narrower(&self) -> DVec3 {
        self.stds.mean / DVec3::from(self.stds.channels)
    }

    fn line_by(&self, i: usize, narrower: DVec3) -> (f64, DVec3) {
        let (node, weight) = NODES[self.count / 2][i];
        let x = self.quantile(node);
        let exponents = 0.5 * x * x * (DVec3::ONE - narrower * narrower);
        (self.stds.mean * x, weight * narrower * exponents.exp())
    }

    /// Quantile: the xi_t, in standard deviations, below which the share `node` of the lit part of the band lies.
    fn quantile(&self, node: f64) -> f64 {
        // It is cut where single precision loses it; the band's reach ends before.
        gaussian().quantile((self.share_below + self.share * node).clamp(1e-6, 1.0 - 1e-6))
    }

    /// A line of part `i` of the lit band, which is cut into [`Self::count`] parts of one share: where the share `u` of the part lies below.
    pub fn drawn_line(&self, wo: DVec3, i: usize, u: f64) -> BandLine {
        let node = (i as f64 + u) / self.count as f64;
        BandLine::new(wo, self.stds.mean * self.quantile(node))
    }

    /// Replaces the lines by a single one, with the share `node` of the lit part of the band below it. Its light is right in the mean over
    /// `node`, if the bands of all channels are about as wide.
    pub fn by_one_line(self, node: f64) -> Self {
        Self {
            count: self.count.min(1),
            node,
            ..self
        }
    }

    /// The line that stands for the band alone, or the middle one of several.
    pub fn middle_line(&self, wo: DVec3) -> BandLine {
        BandLine::new(wo, self.stds.mean * self.quantile(self.node))
    }

    /// The band's integral over a light, given the light integral on a line: the mean over the lines by their weights, times each
    /// channel's share, so that a light that covers the band keeps its energy however few the lines.
    pub fn integral(&self, wo: DVec3, mut on_line: impl FnMut(BandLine) -> [f64; 3]) -> DVec3 {
        let shares = DVec3::from(self.channel_shares);
        if self.count == 1 {
            // The only weight counts in full.
            return shares * DVec3::from(on_line(self.middle_line(wo)));
        }
        let narrower = self.narrower();
        let (mut sum, mut weights) = (DVec3::ZERO, DVec3::ZERO);
        for i in 0..self.count {
            let (xi_t, weight) = self.line_by(i, narrower);
            sum += weight * DVec3::from(on_line(BandLine::new(wo, xi_t)));
            weights += weight;
        }
        shares * sum / weights.max(DVec3::splat(1e-30))
    }
}
