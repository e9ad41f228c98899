//! Environment maps blurred by the reflection lobe of rough surfaces.
//!
//! Brian Karis, "Real Shading in Unreal Engine 4", 2013: maps blurred ahead by the lobe of somebody who looks along the normal. How the
//! lobes of other viewers are made of these, `hairline_optics::environment_lobe` says.
//!
//! A lobe falls with the fourth power of the angle for two orders of magnitude, and maps hold lamps a ten thousand times as bright as
//! what is around them: far tails count. So a blur is a sum over all texels, near ones of a fine map, far ones of coarse maps, none of
//! which is wider than a sixth of the angle that it lies off, or a third at the smooth levels. (Samples of the lobe, a few hundred for each
//! texel, lose half of such a lamp's tail or find twice as much.)

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;

use glam::Vec4;
use hairline_image::Picture;
use hairline_optics::ggx::ggx_g1;
use rayon::prelude::*;

use super::half_texels::round_to_half;
use super::resample::{resample, row_solid_angle};

/// The perceptual roughness of each level. A lobe between two levels is a blend of theirs, so that these are close together: one is
/// less than twice as wide as the one before.
pub const LEVEL_ROUGHNESS: [f64; LEVELS] = [
    0.0, 0.06, 0.081, 0.11, 0.148, 0.2, 0.265, 0.35, 0.458, 0.6, 0.775, 1.0,
];
const LEVELS: usize = 12;

/// How many times a level is half as wide and high as the first one: texels are about as wide as their level's lobe, or narrower.
pub const LEVEL_HALVINGS: [usize; LEVELS] = [0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6];

/// Width and height of level 0; powers of two.
pub(super) const LEVEL_0_SIZE_PX: [u32; 2] = [2048, 1024];

/// The finest map that a level is made from, and up to how many of its texels away that and each coarser map is looked at, by a level's
/// halvings: smooth levels have many texels, and tails that are dim. Texels of the finest map are a quarter of the level's, where there are any.
const FINEST: [usize; 7] = [0, 0, 0, 1, 2, 3, 4];
const REACH_TEXELS: [f64; 7] = [0.0, 5.0, 6.0, 12.0, 16.0, 16.0, 16.0];
/// From there on it fades, and the next map takes over, up to so many times as far.
const FADE: f64 = 1.5;
/// The coarsest map.
const COARSEST: usize = 5;

/// Level 0 is the map itself, scaled; the others are blurred by the lobes of [`LEVEL_ROUGHNESS`].
pub(super) fn prefilter(map: &Picture) -> Vec<Picture> {
    let sharp = resample(map, LEVEL_0_SIZE_PX);
    let uniform = sharp.rgb.iter().all(|texel| *texel == sharp.rgb[0]);
    let mips = if uniform { vec![] } else { mip_chain(&sharp) };
    let mut levels: Vec<Picture> = (1..LEVEL_ROUGHNESS.len())
        .map(|level| {
            if uniform {
                // Blurring would change no bit of it, but take as long as for any other map.
                let size_px = LEVEL_0_SIZE_PX.map(|n| n >> LEVEL_HALVINGS[level]);
                let rgb = vec![sharp.rgb[0]; (size_px[0] * size_px[1]) as usize];
                return Picture { size_px, rgb };
            }
            blur(&mips, level)
        })
        .collect();
    levels.insert(0, sharp);
    levels.iter_mut().for_each(round_to_half);
    levels
}

/// A map with a weight for each texel, which is 1 before anything is added up.
struct Mip {
    width: usize,
    height: usize,
    texels: Vec<Vec4>,
}

fn mip_chain(sharp: &Picture) -> Vec<Mip> {
    let padded = |map: &Picture| Mip {
        width: map.size_px[0] as usize,
        height: map.size_px[1] as usize,
        texels: map
            .rgb
            .iter()
            .map(|t| Vec4::new(t[0], t[1], t[2], 1.0))
            .collect(),
    };
    let mut mips = vec![padded(sharp)];
    let mut last = sharp.clone();
    for _ in 0..COARSEST {
        last = resample(&last, last.size_px.map(|n| n / 2));
        mips.push(padded(&last));
    }
    mips
}

/// A level, from what each map adds to it.
fn blur(mips: &[Mip], level: usize) -> Picture {
    let size = LEVEL_HALVINGS[level];
    let finest = FINEST[size];
    // What a coarse map adds changes slowly.
    let grid = |mip: usize| size.max(mip);
    let mut sum: Option<Mip> = None;
    for on in (size..=grid(COARSEST)).rev() {
        let mut sums = match sum {
            Some(coarser) => coarser.doubled(),
            None => Mip::empty(on),
        };
        for mip in (finest..=COARSEST).filter(|mip| grid(*mip) == on) {
            let lobe = LobePart::new(level, mip);
            sums.add(&mips[mip], &lobe);
        }
        sum = Some(sums);
    }
    let sums = sum.expect("a level is on a grid");
    Picture {
        size_px: [sums.width as u32, sums.height as u32],
        rgb: sums
            .texels
            .iter()
            .map(|t| (t.truncate() / t.w).to_array())
            .collect(),
    }
}

/// The reflection lobe of GGX for somebody who looks along the normal, as far as one map is to be looked at for it.
struct LobePart {
    alpha: f64,
    /// Where it begins, from nothing at the first angle, and where it ends, with nothing at the second.
    begin_rad: Option<[f64; 2]>,
    end_rad: Option<[f64; 2]>,
    /// Of the map.
    texel_rad: f64,
}

impl LobePart {
    fn new(level: usize, mip: usize) -> Self {
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

    /// How far from its middle it ends.
    fn reach_rad(&self) -> f64 {
        self.end_rad
            .map_or(FRAC_PI_2, |[_, end]| end.min(FRAC_PI_2))
    }

    /// Its density where the sine of half the angle from its middle has that square; but for a factor.
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

    /// The mean of its density over a texel, and the texel's solid angle times that.
    fn weight(&self, at: &Pair<'_>, turn_rad: f64) -> f64 {
        let angle_rad = at.half_sine2(at.polar_rad, turn_rad).sqrt() * 2.0;
        let steps = (6.0 * self.texel_rad / angle_rad.max(self.alpha))
            .ceil()
            .clamp(1.0, 8.0);
        let n = steps as u32;
        let place = |i: u32| (f64::from(i) + 0.5) / steps - 0.5;
        let mut sum = 0.0;
        for y in 0..n {
            let polar_rad = at.polar_rad + place(y) * at.texel_rad;
            for x in 0..n {
                sum += self.density(at.half_sine2(polar_rad, turn_rad + place(x) * at.texel_rad));
            }
        }
        sum / (steps * steps) * at.texel_solid_angle
    }
}

/// A row of texels that is made and one that is looked at.
struct Pair<'a> {
    lobe: &'a LobePart,
    /// Of the row that is made, from the map's top.
    middle_rad: f64,
    polar_rad: f64,
    /// Both ways: a map is twice as wide as high.
    texel_rad: f64,
    texel_solid_angle: f64,
}

impl Pair<'_> {
    /// The square of the sine of half the angle between both, of which one is turned about the pole.
    fn half_sine2(&self, polar_rad: f64, turn_rad: f64) -> f64 {
        let apart = (0.5 * (polar_rad - self.middle_rad)).sin();
        let turned = (0.5 * turn_rad).sin();
        apart * apart + self.middle_rad.sin() * polar_rad.sin() * turned * turned
    }

    /// How far to either side the lobe may reach into the row. None if it does not.
    fn turn_rad(&self) -> Option<f64> {
        // By half a texel more.
        let reach_rad = (self.lobe.reach_rad() + self.texel_rad).min(PI);
        let apart_rad = (self.polar_rad - self.middle_rad).abs();
        if apart_rad > reach_rad {
            return None;
        }
        let room = (0.5 * reach_rad).sin().powi(2) - (0.5 * apart_rad).sin().powi(2);
        let turned2 = room / (self.middle_rad.sin() * self.polar_rad.sin()).max(1e-12);
        Some(2.0 * turned2.sqrt().min(1.0).asin())
    }
}

/// What a row of a map adds to all texels of another row.
struct RowTaps {
    row: usize,
    /// The first texel that the first one takes from, up to a width to its left.
    first: isize,
    weights: Vec<f32>,
}

impl Mip {
    /// Of the size of a mip.
    fn empty(mip: usize) -> Self {
        let [width, height] = LEVEL_0_SIZE_PX.map(|n| (n >> mip) as usize);
        Self {
            width,
            height,
            texels: vec![Vec4::ZERO; width * height],
        }
    }

    fn row(&self, y: usize) -> &[Vec4] {
        &self.texels[y * self.width..(y + 1) * self.width]
    }

    /// Adds a map that is as fine or finer, blurred by a part of a lobe.
    fn add(&mut self, map: &Self, lobe: &LobePart) {
        let (width, height) = (self.width, self.height);
        let stride = map.width / width;
        let rows = self.texels.par_chunks_mut(width).enumerate();
        rows.for_each(|(y, sums)| {
            for taps in row_taps(map, lobe, (y as f64 + 0.5) / height as f64, stride) {
                let row = map.row(taps.row);
                for (x, sum) in sums.iter_mut().enumerate() {
                    let first = (x * stride) as isize + taps.first;
                    *sum += around(
                        row,
                        first.rem_euclid(map.width as isize) as usize,
                        &taps.weights,
                    );
                }
            }
        });
    }

    /// Twice as wide and high, linear between texels. Beyond a pole lies the row on its other side.
    fn doubled(&self) -> Self {
        let (width, height) = (self.width, self.height);
        let at = |x: isize, y: isize| {
            let is_beyond = y < 0 || y >= height as isize;
            let y = y.clamp(0, height as isize - 1) as usize;
            let x = if is_beyond { x + width as isize / 2 } else { x };
            self.texels[y * width + x.rem_euclid(width as isize) as usize]
        };
        // A quarter of a texel from the middle of one.
        let near = |i: usize| {
            let i = i as isize;
            (i / 2, if i % 2 == 0 { i / 2 - 1 } else { i / 2 + 1 })
        };
        let texels = (0..2 * height)
            .into_par_iter()
            .flat_map_iter(|y| {
                let (y0, y1) = near(y);
                (0..2 * width).map(move |x| {
                    let (x0, x1) = near(x);
                    let across = |y: isize| 0.75 * at(x0, y) + 0.25 * at(x1, y);
                    0.75 * across(y0) + 0.25 * across(y1)
                })
            })
            .collect();
        Self {
            width: 2 * width,
            height: 2 * height,
            texels,
        }
    }
}

/// What the texels of a row at `v` take from each row of a map that has `stride` texels for one of theirs.
fn row_taps(map: &Mip, lobe: &LobePart, v: f64, stride: usize) -> Vec<RowTaps> {
    let texel_rad = PI / map.height as f64;
    let rows = rows_within(map.height, v, lobe.reach_rad() + texel_rad);
    rows.filter_map(|row| {
        let solid_angle = row_solid_angle(row as u32, map.height as u32);
        let pair = Pair {
            lobe,
            middle_rad: v * PI,
            polar_rad: (row as f64 + 0.5) * texel_rad,
            texel_rad,
            texel_solid_angle: solid_angle / map.width as f64,
        };
        let turn_rad = pair.turn_rad()?;
        // The first texel's middle lies between two of the map's, or on one.
        let middle = 0.5 * (stride as f64 - 1.0);
        let width = map.width as f64;
        let texels = (turn_rad / texel_rad + 0.5).min(0.5 * width);
        let first = (middle - texels).ceil();
        let count = ((middle + texels).floor() - first + 1.0).min(width);
        let weights = (0..count as u32)
            .map(|i| lobe.weight(&pair, (first + f64::from(i) - middle) * texel_rad) as f32)
            .collect();
        Some(RowTaps {
            row,
            first: first as isize,
            weights,
        })
    })
    .collect()
}

/// Rows whose middles lie no further than so much from a place.
fn rows_within(height: usize, v: f64, reach_rad: f64) -> Range<usize> {
    let reach = reach_rad / PI * height as f64;
    let at = v * height as f64 - 0.5;
    ((at - reach).ceil().max(0.0) as usize)..((at + reach).floor() as usize + 1).min(height)
}

/// The sum over texels from `first` on, around the map, with these weights: no more than there are texels.
fn around(row: &[Vec4], first: usize, weights: &[f32]) -> Vec4 {
    let before = weights.len().min(row.len() - first);
    let (left, right) = weights.split_at(before);
    weighted(&row[first..first + before], left) + weighted(&row[..right.len()], right)
}

fn weighted(texels: &[Vec4], weights: &[f32]) -> Vec4 {
    // Four sums at once: each addition would wait for the one before it.
    let mut sums = [Vec4::ZERO; 4];
    let (fours, rest) = texels.as_chunks::<4>();
    let (weight_fours, weight_rest) = weights.as_chunks::<4>();
    for (texels, weights) in fours.iter().zip(weight_fours) {
        for i in 0..4 {
            sums[i] += texels[i] * weights[i];
        }
    }
    for (texel, weight) in rest.iter().zip(weight_rest) {
        sums[0] += *texel * *weight;
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
