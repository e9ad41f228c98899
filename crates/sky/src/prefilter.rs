//! Environment maps blurred by the reflection lobe of rough surfaces.
//!
//! Brian Karis, "Real Shading in Unreal Engine 4", 2013: maps blurred ahead by the lobe of somebody who looks along the normal. How the
//! lobes of other viewers are made of these, `hairline_optics::environment_lobe` says.
//!
//! A lobe falls with the fourth power of the angle for two orders of magnitude, and maps hold lamps a ten thousand times as bright as
//! what is around them: far tails count. So a blur is a sum over all texels, near ones of a fine map, far ones of coarse maps, none of
//! which is wider than a sixth of the angle that it lies off, or a third at the smooth levels. (Samples of the lobe, a few hundred for each
//! texel, lose half of such a lamp's tail or find twice as much.)

use hairline_image::Picture;
use hairline_scene::environment::{LEVEL_HALVINGS, LEVEL_ROUGHNESS};

use super::half_texels::round_to_half;
use super::mip::Mip;
use super::resample::resample;
use lobe_part::{LobePart, row_taps};

mod levels;
mod lobe_part;

pub(super) use levels::LEVEL_0_SIZE_PX;
use levels::{COARSEST, FINEST};

/// The levels of a map. Level 0 is the map itself, scaled; the others are blurred by the lobes of [`LEVEL_ROUGHNESS`].
pub(super) fn prefilter(map: &Picture) -> Vec<Picture> {
    let sharp = resample(map, LEVEL_0_SIZE_PX);
    let mut levels = if sharp.rgb.iter().all(|texel| *texel == sharp.rgb[0]) {
        // Blurring would change no bit of it, but take as long as for any other map.
        uniform_levels(&sharp)
    } else {
        let mips = mip_chain(&sharp);
        (1..LEVEL_ROUGHNESS.len())
            .map(|level| blur(&mips, level))
            .collect()
    };
    levels.insert(0, sharp);
    levels.iter_mut().for_each(round_to_half);
    levels
}

/// Levels of a uniform map, from level 1 on.
fn uniform_levels(sharp: &Picture) -> Vec<Picture> {
    let level = |halvings: &usize| {
        let size_px = LEVEL_0_SIZE_PX.map(|n| n >> halvings);
        let rgb = vec![sharp.rgb[0]; (size_px[0] * size_px[1]) as usize];
        Picture { size_px, rgb }
    };
    LEVEL_HALVINGS[1..].iter().map(level).collect()
}

fn mip_chain(sharp: &Picture) -> Vec<Mip> {
    let mut last = sharp.clone();
    let mut mips = vec![Mip::from_picture(&last)];
    for _ in 0..COARSEST {
        last = resample(&last, last.size_px.map(|n| n / 2));
        mips.push(Mip::from_picture(&last));
    }
    mips
}

/// Blurs a level from the contributions of each mip.
fn blur(mips: &[Mip], level: usize) -> Picture {
    let size = LEVEL_HALVINGS[level];
    let finest = FINEST[size];
    // The light of a coarse map changes slowly and needs no fine grid.
    let grid = |mip: usize| size.max(mip);
    let mut sum: Option<Mip> = None;
    for on in (size..=grid(COARSEST)).rev() {
        let mut sums = match sum {
            Some(coarser) => coarser.doubled(),
            None => Mip::empty(LEVEL_0_SIZE_PX.map(|n| n >> on)),
        };
        for mip in (finest..=COARSEST).filter(|mip| grid(*mip) == on) {
            let lobe = LobePart::new(level, mip);
            sums.add(&mips[mip], |size, v, stride| {
                row_taps(size, &lobe, v, stride)
            });
        }
        sum = Some(sums);
    }
    sum.expect("a level is on a grid").picture()
}
