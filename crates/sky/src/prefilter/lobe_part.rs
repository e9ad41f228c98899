//! The part of a level's reflection lobe that one map of a chain stands for, as weights of the map's texels.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;

use hairline_optics::ggx::ggx_g1;

use hairline_scene::environment::{LEVEL_HALVINGS, LEVEL_ROUGHNESS};

use super::levels::{COARSEST, FADE, FINEST, LEVEL_0_SIZE_PX, REACH_TEXELS};
use crate::mip::RowTaps;
use crate::resample::row_solid_angle;

/// The reflection lobe of GGX for somebody who looks along the normal, as far as one map is to be looked at for it.
pub(super) struct LobePart {
    alpha: f64,
    /// Angles from the lobe's middle over which the part begins and over which it ends.
    begin_rad: Option<[f64; 2]>,
    end_rad: Option<[f64; 2]>,
    /// Angle of a texel of the map.
    texel_rad: f64,
}

impl LobePart {
    pub(super) fn new(level: usize, mip: usize) -> Self {
        let size = LEVEL_HALVINGS[level];
        let texel_rad = |mip: usize| PI / f64::from(LEVEL_0_SIZE_PX[1] >> mip);
        let fade = |mip: usize| {
            let reach_rad = REACH_TEXELS[size] * texel_rad(mip);
            [reach_rad, FADE * reach_rad]
        };
        Self {
            alpha: LEVEL_ROUGHNESS[level].powi(2),
            begin_rad: (mip > FINEST[size]).then(|| fade(mip - 1)),
            end_rad: (mip < COARSEST).then(|| fade(mip)),
            texel_rad: texel_rad(mip),
        }
    }

    /// Largest angle of the part from the lobe's middle.
    fn reach_rad(&self) -> f64 {
        self.end_rad
            .map_or(FRAC_PI_2, |[_, end]| end.min(FRAC_PI_2))
    }

    /// Relative density of the part at an angle from the lobe's middle, given the squared sine of half the angle.
    fn density(&self, half_sine2: f64) -> f64 {
        let angle_rad = 2.0 * half_sine2.sqrt().min(1.0).asin();
        let fade = |range: Option<[f64; 2]>| {
            range.map_or(1.0, |[from, to]| {
                let t = ((angle_rad - from) / (to - from)).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            })
        };
        let begun = fade(self.begin_rad);
        let ended = self.end_rad.map_or(0.0, |range| fade(Some(range)));
        let a2 = self.alpha * self.alpha;
        let t = a2 + (1.0 - a2) * half_sine2;
        // D G1 / 4 is left of GGX; the factor keeps numbers near 1.
        a2 / (t * t) * ggx_g1(1.0 - 2.0 * half_sine2, self.alpha) * (begun - ended).max(0.0)
    }

    /// Mean density over a texel, and the texel's solid angle times that.
    fn weight(&self, at: &RowPair<'_>, turn_rad: f64) -> f64 {
        let middle = at.rows.half_sine2(turn_rad);
        let angle_rad = middle.sqrt() * 2.0;
        let steps = (6.0 * self.texel_rad / angle_rad.max(self.alpha))
            .ceil()
            .clamp(1.0, 8.0);
        if steps == 1.0 {
            return self.density(middle) * at.texel_solid_angle;
        }
        let n = steps as u32;
        let place = |i: u32| (f64::from(i) + 0.5) / steps - 0.5;
        let mut sum = 0.0;
        for y in 0..n {
            let polar_rad = at.rows.polar_rad + place(y) * at.texel_rad;
            let rows = RowAngles::new(at.middle_rad, polar_rad);
            for x in 0..n {
                sum += self.density(rows.half_sine2(turn_rad + place(x) * at.texel_rad));
            }
        }
        sum / (steps * steps) * at.texel_solid_angle
    }
}

/// A row of texels that is made and one that is looked at.
struct RowPair<'a> {
    lobe: &'a LobePart,
    /// Polar angle of the row that is made, from the map's top.
    middle_rad: f64,
    rows: RowAngles,
    /// Angle of a texel, across and down: a map is twice as wide as high.
    texel_rad: f64,
    texel_solid_angle: f64,
}

/// Positions of two rows relative to each other.
struct RowAngles {
    /// Polar angle of the row that is looked at, from the map's top.
    polar_rad: f64,
    /// The square of the sine of half the angle between them.
    apart: f64,
    /// The product of the sines of both angles from the top.
    sines: f64,
}

impl RowAngles {
    fn new(middle_rad: f64, polar_rad: f64) -> Self {
        Self {
            polar_rad,
            apart: (0.5 * (polar_rad - middle_rad)).sin().powi(2),
            sines: middle_rad.sin() * polar_rad.sin(),
        }
    }

    /// Squared sine of half the angle between two texels, one of each row, the second turned about the pole.
    fn half_sine2(&self, turn_rad: f64) -> f64 {
        self.apart + self.sines * (0.5 * turn_rad).sin().powi(2)
    }
}

impl RowPair<'_> {
    /// Returns the longitude up to which the lobe may reach into the row on either side. None if it does not reach
    /// it.
    fn turn_rad(&self) -> Option<f64> {
        // Reach of the part plus half a texel.
        let reach_rad = (self.lobe.reach_rad() + self.texel_rad).min(PI);
        if (self.rows.polar_rad - self.middle_rad).abs() > reach_rad {
            return None;
        }
        let room = (0.5 * reach_rad).sin().powi(2) - self.rows.apart;
        let turned2 = room / self.rows.sines.max(1e-12);
        Some(2.0 * turned2.sqrt().min(1.0).asin())
    }
}

/// Weights with which the texels of a row at `v` take from each row of a map that has `stride` texels for one of
/// theirs.
pub(super) fn row_taps(
    [width, height]: [usize; 2],
    lobe: &LobePart,
    v: f64,
    stride: usize,
) -> Vec<RowTaps> {
    let texel_rad = PI / height as f64;
    let rows = rows_within(height, v, lobe.reach_rad() + texel_rad);
    rows.filter_map(|row| {
        let solid_angle = row_solid_angle(row as u32, height as u32);
        let middle_rad = v * PI;
        let pair = RowPair {
            lobe,
            middle_rad,
            rows: RowAngles::new(middle_rad, (row as f64 + 0.5) * texel_rad),
            texel_rad,
            texel_solid_angle: solid_angle / width as f64,
        };
        let turn_rad = pair.turn_rad()?;
        // The first texel's middle lies between two of the map's, or on one.
        let middle = 0.5 * (stride as f64 - 1.0);
        let texels = (turn_rad / texel_rad + 0.5).min(0.5 * width as f64);
        let first = (middle - texels).ceil();
        let count = ((middle + texels).floor() - first + 1.0).min(width as f64);
        let offset = |i: f64| first + i - middle;
        // The lobe is the same to both sides.
        let mirrored = if offset(0.0) == -offset(count - 1.0) {
            (count / 2.0).floor() as usize
        } else {
            0
        };
        let mut weights: Vec<f32> = (0..count as usize - mirrored)
            .map(|i| lobe.weight(&pair, offset(i as f64) * texel_rad) as f32)
            .collect();
        weights.extend_from_within(..mirrored);
        let rest = weights.len() - mirrored;
        weights[rest..].reverse();
        Some(RowTaps {
            row,
            first: first as isize,
            weights,
        })
    })
    .collect()
}

/// Rows whose middles lie within an angle of a place.
fn rows_within(height: usize, v: f64, reach_rad: f64) -> Range<usize> {
    let reach = reach_rad / PI * height as f64;
    let at = v * height as f64 - 0.5;
    ((at - reach).ceil().max(0.0) as usize)..((at + reach).floor() as usize + 1).min(height)
}
