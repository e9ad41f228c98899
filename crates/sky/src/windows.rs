//! Windows: bright parts of a map with a sharp outline, from lamps larger than a sun to soft boxes and windows.
//!
//! A scratch looks a map up in ten cells of its band, each blurred by a lobe (docs/model.md, section 8): that smears an outline which the
//! scratch itself shows sharply. So for scratches windows are lights of their own, and the cells hold the rest of the map. The base knows
//! nothing of them: its lobes are wider, and a mirror shows what is behind a window's panes.

use std::collections::HashSet;

use glam::DVec3;
use hairline_image::Picture;
use hairline_scene::environment::Window;
use rayon::prelude::*;

use super::prefilter::LEVEL_0_SIZE_PX;
use super::resample::{resample, row_solid_angle};
use super::suns::{direction, neighbours, radiance, value};
use patch::{Patch, best_fit};

mod patch;

/// Largest number of windows of a map: each costs as much as a light, and a device lights scratches from seven lights at once.
const WINDOWS_MOST: usize = 7;
/// The map that is searched is no wider: texels of 0.7 degrees.
const SEARCH_WIDTH_PX: u32 = 512;
/// Values beyond which texels are a region, over the map's mean.
const THRESHOLDS: [f64; 8] = [2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0];
/// The largest region.
const SOLID_ANGLE_MOST_SR: f64 = 0.6;
/// The least share of the whole map's light that a window holds.
const SHARE: f64 = 0.005;
/// Least evenness of a region under its outline, see `Patch::evenness`: the gaps of a window behind bars would have as many edges.
const EVEN: f64 = 0.85;
/// Least radiance of a window, over the map's mean.
const BRIGHT: f64 = 2.0;

/// Parts the windows of a map from the rest: the light of both together is the map's. None where there is no window.
pub(super) fn part(map: &Picture) -> Option<(Vec<Window>, Picture)> {
    let windows = Search::new(map).windows();
    if windows.is_empty() {
        return None;
    }
    // Resampled to the resolution of look-ups: between the texels of a coarse map its edges are soft, and those of the windows are not.
    let mut rest = resample(map, LEVEL_0_SIZE_PX);
    let windows = windows
        .into_iter()
        .map(|window| taken_out(window, &mut rest))
        .collect();
    Some((windows, rest))
}

/// Resamples a map to the width that is searched, if it is wider.
fn narrowed(map: &Picture) -> Picture {
    let mut narrow = map.clone();
    while narrow.size_px[0] > SEARCH_WIDTH_PX {
        narrow = resample(&narrow, narrow.size_px.map(|n| n.div_ceil(2)));
    }
    narrow
}

/// Takes a window out of a map, but nowhere more than the map exceeds the surroundings: rays are drawn by the rest. Beyond the outline it
/// takes the light of an edge that is no step there. Returns the window as bright as the light that was taken.
fn taken_out(window: Window, rest: &mut Picture) -> Window {
    let [width, height] = rest.size_px;
    let texel_rad = std::f64::consts::PI / f64::from(height);
    let reach_rad = 0.5 * (window.edge_rad + texel_rad);
    let (most, around) = (DVec3::from(window.radiance), DVec3::from(window.around));
    let inside_rad = window.outline.inside_rad();
    let taken: Vec<DVec3> = (0..rest.rgb.len())
        .into_par_iter()
        .map(|i| {
            let inside_rad = inside_rad(direction(rest, i));
            if inside_rad < -reach_rad {
                return DVec3::ZERO;
            }
            // An edge has fallen by half where the outline is.
            let most = if inside_rad < 0.0 { 0.5 * most } else { most };
            (radiance(rest, i) - around).max(DVec3::ZERO).min(most)
        })
        .collect();
    let mut sum = DVec3::ZERO;
    for (i, taken) in taken.into_iter().enumerate() {
        sum += taken * (row_solid_angle(i as u32 / width, height) / f64::from(width));
        rest.rgb[i] = (radiance(rest, i) - taken).as_vec3().to_array();
    }
    Window {
        radiance: (sum / window.outline.solid_angle_sr()).to_array(),
        ..window
    }
}

/// A map that windows are looked for in.
struct Search {
    map: Picture,
    directions: Vec<DVec3>,
    solid_angles: Vec<f64>,
    /// Light of the whole map.
    light: f64,
    mean: f64,
}

/// A window that might be taken.
struct Candidate {
    window: Window,
    patch: Patch,
}

impl Candidate {
    /// Reduction of the error that scratches make without the window: its squared radiance above the surroundings times its solid angle to the
    /// power 1.5, as bands meet wide ones more often.
    fn gain(&self) -> f64 {
        let radiance: f64 = self.window.radiance.iter().sum();
        radiance.powi(2) * self.window.outline.solid_angle_sr().powf(1.5)
    }
}

impl Search {
    fn new(map: &Picture) -> Self {
        let map = narrowed(map);
        let [width, height] = map.size_px;
        let texels = 0..map.rgb.len();
        let directions = texels.clone().map(|i| direction(&map, i)).collect();
        let solid_angles: Vec<f64> = texels
            .map(|i| row_solid_angle(i as u32 / width, height) / f64::from(width))
            .collect();
        let lights = map.rgb.iter().zip(&solid_angles);
        let light: f64 = lights.map(|(texel, sr)| value(*texel) * sr).sum();
        Self {
            mean: light / (4.0 * std::f64::consts::PI),
            map,
            directions,
            solid_angles,
            light,
        }
    }

    /// Finds the windows with the largest gain, one after the other, each in the map without those before.
    fn windows(self) -> Vec<Window> {
        let regions = self.regions();
        let fits = regions.par_iter().filter_map(|region| {
            let patch = self.patch(region);
            let outline = best_fit(&patch)?;
            let is_even = patch.evenness(&outline) > EVEN;
            is_even.then(|| {
                let edge_rad = patch.edge_rad(&outline);
                let radiance = patch.step(&outline, edge_rad).to_array();
                let window = Window {
                    outline,
                    radiance,
                    around: patch.surroundings.to_array(),
                    edge_rad,
                };
                Candidate { window, patch }
            })
        });
        let mut candidates: Vec<Candidate> = fits.collect();
        candidates.sort_by(|a, b| b.gain().total_cmp(&a.gain()));
        let mut windows: Vec<Window> = Vec::new();
        for mut candidate in candidates {
            let before = candidate.gain();
            for taken in &windows {
                candidate.patch.take_out(taken);
            }
            let Window {
                outline, edge_rad, ..
            } = &candidate.window;
            let step = candidate.patch.step(outline, *edge_rad);
            candidate.window.radiance = step.to_array();
            let sum = step.element_sum();
            let is_window = sum * candidate.window.outline.solid_angle_sr() > SHARE * self.light
                && sum > BRIGHT * self.mean
                && sum > candidate.patch.surroundings.element_sum()
                && candidate.gain() > 0.5 * before;
            if is_window {
                windows.push(candidate.window);
            }
            if windows.len() == WINDOWS_MOST {
                break;
            }
        }
        windows
    }

    /// Texels that hang together and are brighter than a threshold, for each threshold; each region once.
    fn regions(&self) -> Vec<Vec<usize>> {
        let values: Vec<f64> = self.map.rgb.iter().map(|texel| value(*texel)).collect();
        let mut known = HashSet::new();
        let mut regions = Vec::new();
        for threshold in THRESHOLDS.map(|times| times * self.mean) {
            let mut seen: Vec<bool> = values.iter().map(|value| *value <= threshold).collect();
            for first in 0..seen.len() {
                if seen[first] {
                    continue;
                }
                seen[first] = true;
                let mut region = vec![first];
                let mut next = 0;
                while let Some(&i) = region.get(next) {
                    next += 1;
                    for neighbour in neighbours(&self.map, i) {
                        if !seen[neighbour] {
                            seen[neighbour] = true;
                            region.push(neighbour);
                        }
                    }
                }
                let solid_angle: f64 = region.iter().map(|&i| self.solid_angles[i]).sum();
                let lights = region.iter().map(|&i| values[i] * self.solid_angles[i]);
                let is_candidate =
                    solid_angle < SOLID_ANGLE_MOST_SR && lights.sum::<f64>() > SHARE * self.light;
                if is_candidate && known.insert((first, region.len())) {
                    regions.push(region);
                }
            }
        }
        regions
    }

    /// A region with its surroundings.
    fn patch(&self, region: &[usize]) -> Patch {
        let mut texels: Vec<usize> = region.to_vec();
        let mut is_in: HashSet<usize> = region.iter().copied().collect();
        // Rings, the nearest of which the camera has blurred.
        let mut ends = vec![texels.len()];
        let mut from = 0;
        for _ in 0..3 {
            let to = texels.len();
            for at in from..to {
                for neighbour in neighbours(&self.map, texels[at]) {
                    if is_in.insert(neighbour) {
                        texels.push(neighbour);
                    }
                }
            }
            from = to;
            ends.push(texels.len());
        }
        let each = texels.iter();
        Patch::new(
            each.clone().map(|&i| self.directions[i]).collect(),
            each.clone().map(|&i| self.solid_angles[i]).collect(),
            each.map(|&i| radiance(&self.map, i)).collect(),
            region.len(),
            ends[1]..ends[3],
            std::f64::consts::PI / f64::from(self.map.size_px[1]),
        )
    }
}

#[cfg(test)]
mod tests;
