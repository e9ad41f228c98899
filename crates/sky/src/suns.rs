//! Suns: small and bright spots in a map, each of which lights a surface as a disc of its own.
//!
//! A map blurred for rough surfaces, a map blurred by the cosine and the cells of a scratch's band know nothing as narrow as the sun: it
//! would be a stain of a tenth of a radian, without colours on scratches. As a light it is exact (docs/model.md, section 8).

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use hairline_image::Picture;
use hairline_scene::environment::Sun;
use hairline_scene::environment::lookup::environment_dir;
use rayon::prelude::*;

use super::resample::row_solid_angle;

/// Largest number of suns of a map: each costs as much as a light.
const SUNS_MOST: usize = 4;
/// Bright spots that are looked at before the search is given up: large lights are among them.
const SPOTS_MOST: usize = 32;
/// A sun's brightest texel over the mean of the map, at least.
const BRIGHT: f64 = 20.0;
/// Thresholds, as shares of a sun's brightest texel, above which a texel belongs to it; they are tried in this order. The first one
/// includes its glare in the camera; if it is no sun with that, then perhaps without: the surroundings of a lamp are a hundredth as
/// bright, or a tenth.
const RIMS: [f64; 2] = [0.01, 0.1];
/// The largest sun: a scratch's band shows larger lamps well enough (docs/model.md, section 8), and a polished surface their outlines.
const RADIUS_MOST_RAD: f64 = 0.06;
/// Least share of a sun's light that lies in a disc of its size: 0.91 for a square, 0.7 for a rectangle of two.
const ROUND: f64 = 0.85;
/// The least share of the whole map's light.
const SHARE: f64 = 0.01;

/// Suns taken out of a map.
#[derive(Default)]
pub(super) struct ExtractedSuns {
    /// Suns in the map's frame and units.
    pub suns: Vec<Sun>,
    /// Texels that were changed, and their former values.
    texels: Vec<(usize, [f32; 3])>,
}

impl ExtractedSuns {
    /// Puts it back. (A copy of the map would be half a gigabyte.)
    pub(crate) fn put_back(&self, map: &mut Picture) {
        for &(i, texel) in &self.texels {
            map.rgb[i] = texel;
        }
    }
}

/// Takes the suns out of a map: where they were it is as dark as around them.
pub(super) fn part(map: &mut Picture) -> ExtractedSuns {
    let brightness = Brightness::measure(map);
    let mut seen = vec![false; map.rgb.len()];
    let mut parted = ExtractedSuns::default();
    for _ in 0..SPOTS_MOST {
        let Some(peak) = brightness.brightest(map, &seen) else {
            break;
        };
        let mut looked_at = Vec::new();
        let found = RIMS.into_iter().find_map(|rim| {
            let threshold = brightness.threshold(rim, value(map.rgb[peak]));
            let spot = BrightSpot::grow(map, peak, threshold, &mut seen);
            let around = spot.around_it(map);
            let sun = spot.sun(map, around, brightness.total);
            if sun.is_some() || looked_at.is_empty() {
                looked_at.clone_from(&spot.texels);
            }
            Some((spot, around, sun?))
        });
        // Each texel belongs to one spot at most.
        for i in looked_at {
            seen[i] = true;
        }
        let Some((spot, around, sun)) = found else {
            continue;
        };
        parted.suns.push(sun);
        for &i in &spot.texels {
            parted.texels.push((i, map.rgb[i]));
            map.rgb[i] = around.as_vec3().to_array();
        }
        if parted.suns.len() == SUNS_MOST {
            break;
        }
    }
    parted
}

/// Brightness of a texel.
fn value(texel: [f32; 3]) -> f64 {
    texel.iter().map(|c| f64::from(*c)).sum()
}

/// A map's light as a whole.
struct Brightness {
    /// Integrated over all directions.
    total: f64,
    mean: f64,
}

impl Brightness {
    fn measure(map: &Picture) -> Self {
        let [width, height] = map.size_px;
        let rows = map.rgb.par_chunks(width as usize).zip(0..height);
        let total: f64 = rows
            .map(|(row, y)| {
                let sum: f64 = row.iter().map(|texel| value(*texel)).sum();
                sum * row_solid_angle(y, height) / f64::from(width)
            })
            .sum();
        Self {
            total,
            mean: total / (2.0 * TAU),
        }
    }

    /// The brightest texel that was not seen, if it might be a sun's.
    fn brightest(&self, map: &Picture, seen: &[bool]) -> Option<usize> {
        let texels = map.rgb.par_iter().zip(seen).enumerate();
        let (value, i) = texels
            .filter(|(_, (_, seen))| !**seen)
            .map(|(i, (texel, _))| (value(*texel), i))
            // The first of equal texels wins, however threads share the work.
            .reduce_with(|a, b| if (b.0, a.1) > (a.0, b.1) { b } else { a })?;
        (value > BRIGHT * self.mean).then_some(i)
    }

    /// Brightness above which a texel belongs to the spot with this peak.
    fn threshold(&self, rim: f64, peak: f64) -> f64 {
        (rim * peak).max(0.5 * BRIGHT * self.mean)
    }
}

/// Texels that hang together and are bright.
struct BrightSpot {
    texels: Vec<usize>,
    /// Texels about the spot, if it is no larger than a sun may be.
    ring: Vec<usize>,
    is_small: bool,
}

impl BrightSpot {
    /// Connected texels about `peak` that are brighter than `threshold`, except those that are `seen` already.
    fn grow(map: &Picture, peak: usize, threshold: f64, seen: &mut [bool]) -> Self {
        let middle = direction(map, peak);
        let mut spot = Self {
            texels: vec![peak],
            ring: vec![],
            is_small: true,
        };
        seen[peak] = true;
        let mut next = 0;
        while let Some(&i) = spot.texels.get(next) {
            next += 1;
            // The peak may lie at the rim.
            spot.is_small &= direction(map, i).angle_between(middle) < 2.0 * RADIUS_MOST_RAD;
            for neighbour in neighbours(map, i) {
                if seen[neighbour] {
                    continue;
                }
                if value(map.rgb[neighbour]) > threshold {
                    seen[neighbour] = true;
                    spot.texels.push(neighbour);
                } else if spot.is_small {
                    spot.ring.push(neighbour);
                }
            }
        }
        for &i in &spot.texels {
            seen[i] = false;
        }
        spot.ring.sort_unstable();
        spot.ring.dedup();
        spot
    }

    /// The mean radiance around it.
    fn around_it(&self, map: &Picture) -> DVec3 {
        let sum: DVec3 = self.ring.iter().map(|&i| radiance(map, i)).sum();
        sum / self.ring.len().max(1) as f64
    }

    /// The disc with the light of the spot beyond its surroundings. None if it is no sun.
    fn sun(&self, map: &Picture, around: DVec3, total: f64) -> Option<Sun> {
        if !self.is_small {
            return None;
        }
        let [width, height] = map.size_px;
        let solid_angle_of =
            |i: usize| row_solid_angle(i as u32 / width, height) / f64::from(width);
        let beyond = |i: usize| (radiance(map, i) - around).max(DVec3::ZERO);
        let light_of = |i: usize| beyond(i).element_sum() * solid_angle_of(i);
        let (mut light, mut toward) = (DVec3::ZERO, DVec3::ZERO);
        let (mut sum, mut sum_of_squares) = (0.0, 0.0);
        for &i in &self.texels {
            light += beyond(i) * solid_angle_of(i);
            toward += direction(map, i) * light_of(i);
            sum += light_of(i);
            sum_of_squares += beyond(i).element_sum() * light_of(i);
        }
        if !(sum > SHARE * total) {
            return None;
        }
        // Solid angle of an even disc of this light; dim glare around it hardly counts.
        let solid_angle = sum * sum / sum_of_squares;
        let radius_rad = (1.0 - solid_angle / TAU).acos();
        if !(radius_rad < RADIUS_MOST_RAD) {
            return None;
        }
        // Another shape than a disc would be visible in a polished surface.
        let direction_of_sun = toward.normalize();
        let within = |i: &&usize| direction(map, **i).angle_between(direction_of_sun) < radius_rad;
        let inside: f64 = self
            .texels
            .iter()
            .filter(within)
            .map(|&i| light_of(i))
            .sum();
        if !(inside > ROUND * sum) {
            return None;
        }
        Some(Sun {
            direction: direction_of_sun,
            radius_rad,
            radiance: (light / solid_angle).to_array(),
        })
    }
}

fn radiance(map: &Picture, i: usize) -> DVec3 {
    DVec3::from(map.rgb[i].map(f64::from))
}

fn direction(map: &Picture, i: usize) -> DVec3 {
    let [width, height] = map.size_px;
    let at = DVec2::new(
        f64::from(i as u32 % width) + 0.5,
        f64::from(i as u32 / width) + 0.5,
    );
    environment_dir(at / DVec2::new(f64::from(width), f64::from(height)))
}

/// The texels beside, above and below one, and at its corners. In the rows at the poles all lie beside one another.
fn neighbours(map: &Picture, i: usize) -> impl Iterator<Item = usize> {
    let [width, height] = map.size_px.map(|n| n as usize);
    let (x, y) = (i % width, i / width);
    let is_pole = y == 0 || y + 1 == height;
    let beside = [x + width - 1, x, x + 1].map(|x| x % width);
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    let near = rows.flat_map(move |row| beside.map(|column| row * width + column));
    let across = (0..if is_pole { width } else { 0 }).map(move |column| y * width + column);
    near.chain(across).filter(move |&j| j != i)
}

#[cfg(test)]
mod tests;
