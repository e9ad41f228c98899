//! Environment maps blurred by the reflection lobe of rough surfaces.
//!
//! Brian Karis, "Real Shading in Unreal Engine 4", 2013: the lobe at normal incidence stands for all directions, so that
//! the blur depends on the mirror direction alone. Jaroslav Křivánek and Mark Colbert, "Real-time Shading with Filtered
//! Importance Sampling", 2008: each sample reads a mip level that covers its share of the lobe.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, Vec4};
use hairline_image::Picture;
use rayon::prelude::*;

use super::lookup::{environment_dir, environment_uv};
use super::resample::resample;
use super::round_to_half;

/// The perceptual roughness of each level. Sizes halve from level to level, so roughness rises as fast as they allow:
/// texels are about as wide as their level's lobe, or narrower. Dense at the smooth end, where a blend of a sharp and a
/// blurred picture would look like a veil over a mirror.
pub const LEVEL_ROUGHNESS: [f64; 7] = [0.0, 0.06, 0.11, 0.2, 0.35, 0.6, 1.0];

/// Width and height of level 0; powers of two.
const LEVEL_0_SIZE_PX: [u32; 2] = [2048, 1024];

/// Samples of the lobe for each texel of a level: the rough ones have few texels and wide lobes.
const SAMPLE_COUNTS: [usize; 7] = [1, 32, 128, 512, 1024, 2048, 4096];

/// Level 0 is the map itself, scaled; the others are blurred by the lobes of [`LEVEL_ROUGHNESS`].
pub(super) fn prefilter(map: &Picture) -> Vec<Picture> {
    let sharp = resample(map, LEVEL_0_SIZE_PX);
    let size_px = |level: usize| LEVEL_0_SIZE_PX.map(|n| n >> level);
    let uniform = sharp.rgb.iter().all(|texel| *texel == sharp.rgb[0]);
    let mips = if uniform { vec![] } else { mip_chain(&sharp) };
    let mut levels: Vec<Picture> = (1..LEVEL_ROUGHNESS.len())
        .map(|level| {
            if uniform {
                // Blurring would change no bit of it, but take as long as for any other map.
                let size_px = size_px(level);
                let rgb = vec![sharp.rgb[0]; (size_px[0] * size_px[1]) as usize];
                return Picture { size_px, rgb };
            }
            let lobe = lobe(LEVEL_ROUGHNESS[level], SAMPLE_COUNTS[level]);
            blur(&mips, size_px(level), &lobe)
        })
        .collect();
    levels.insert(0, sharp);
    levels.iter_mut().for_each(round_to_half);
    levels
}

/// A map padded to four components, which load and blend at once.
struct Mip {
    size_px: [u32; 2],
    texels: Vec<Vec4>,
}

fn mip_chain(sharp: &Picture) -> Vec<Mip> {
    let padded = |map: &Picture| Mip {
        size_px: map.size_px,
        texels: map
            .rgb
            .iter()
            .map(|t| Vec4::new(t[0], t[1], t[2], 0.0))
            .collect(),
    };
    let mut mips = vec![padded(sharp)];
    let mut last = resample(sharp, sharp.size_px.map(|n| n / 2));
    while last.size_px[1] > 1 {
        mips.push(padded(&last));
        last = resample(&last, last.size_px.map(|n| n / 2));
    }
    mips
}

/// A direction of the lobe, relative to its mirror direction (0, 0, 1).
struct LobeSample {
    direction: DVec3,
    /// The cosine with the normal, which is the mirror direction here.
    weight: f64,
    /// Its share of the solid angle.
    solid_angle: f64,
}

/// The reflection lobe of GGX at normal incidence, sampled by its distribution of normals.
fn lobe(roughness: f64, count: usize) -> Vec<LobeSample> {
    let alpha_squared = roughness.powi(4);
    (0..count)
        .filter_map(|i| {
            let [u, v] = hammersley(i, count);
            // The normal distribution's inverse cumulative function (Walter et al. 2007, equation 35).
            let cos_squared = (1.0 - u) / (1.0 + (alpha_squared - 1.0) * u);
            let cos_half = cos_squared.sqrt();
            let sin_half = (1.0 - cos_squared).max(0.0).sqrt();
            let cos = 2.0 * cos_squared - 1.0;
            let sin = 2.0 * cos_half * sin_half;
            let (sin_phi, cos_phi) = (TAU * v).sin_cos();
            // D cos(h) is the density of h; reflection's Jacobian is 4 (h.v), and here v is n: the cosines cancel.
            let t = 1.0 + (alpha_squared - 1.0) * cos_squared;
            let pdf = alpha_squared / (PI * t * t) / 4.0;
            (cos > 0.0).then(|| LobeSample {
                direction: DVec3::new(sin * cos_phi, sin * sin_phi, cos),
                weight: cos,
                solid_angle: 1.0 / (count as f64 * pdf),
            })
        })
        .collect()
}

/// The Hammersley point set, its first coordinate at cell centres.
fn hammersley(i: usize, count: usize) -> [f64; 2] {
    let radical_inverse = f64::from((i as u32).reverse_bits()) / 4_294_967_296.0;
    [(i as f64 + 0.5) / count as f64, radical_inverse]
}

fn blur(mips: &[Mip], size_px: [u32; 2], lobe: &[LobeSample]) -> Picture {
    let [width, height] = size_px;
    let rgb = (0..height)
        .into_par_iter()
        .flat_map_iter(|y| {
            let v = (f64::from(y) + 0.5) / f64::from(height);
            let taps = row_taps(mips, lobe, v);
            (0..width).map(move |x| {
                let u = (x as f32 + 0.5) / width as f32;
                let mut mean = Vec4::ZERO;
                for tap in &taps {
                    let near = tap.near.read(mips, u + tap.du);
                    let far = tap.far.read(mips, u + tap.du);
                    let sample = near + (far - near) * tap.toward_far;
                    mean += (sample - mean) * tap.share;
                }
                mean.truncate().to_array()
            })
        })
        .collect();
    Picture { size_px, rgb }
}

/// What a sample of the lobe reads: the same for all texels of a row but for their own u.
struct Tap {
    /// From the texel, in (0, 2): positive, so that rounding towards zero is rounding down.
    du: f32,
    near: RowPair,
    far: RowPair,
    toward_far: f32,
    /// Its weight over the sum of the weights up to it: a running mean is exact where all values are equal.
    share: f32,
}

/// Two rows of a mip and where between them.
struct RowPair {
    mip: usize,
    top: usize,
    bottom: usize,
    toward_bottom: f32,
}

impl RowPair {
    fn at(mips: &[Mip], mip: usize, v: f64) -> Self {
        let [width, height] = mips[mip].size_px.map(|n| n as usize);
        let y = (v * height as f64 - 0.5).max(0.0);
        let top = (y as usize).min(height - 1);
        Self {
            mip,
            top: top * width,
            bottom: (top + 1).min(height - 1) * width,
            toward_bottom: (y - top as f64) as f32,
        }
    }

    /// Bilinear. `u` is in (1/2, 3) and repeats.
    fn read(&self, mips: &[Mip], u: f32) -> Vec4 {
        let mip = &mips[self.mip];
        let width = mip.size_px[0] as usize;
        let x = u * width as f32 - 0.5;
        let x0 = x as usize;
        let t = x - x0 as f32;
        let (x0, x1) = (x0 & (width - 1), (x0 + 1) & (width - 1));
        let across = |row: usize| {
            let (left, right) = (mip.texels[row + x0], mip.texels[row + x1]);
            left + (right - left) * t
        };
        let (top, bottom) = (across(self.top), across(self.bottom));
        top + (bottom - top) * self.toward_bottom
    }
}

fn row_taps(mips: &[Mip], lobe: &[LobeSample], v: f64) -> Vec<Tap> {
    let [width, height] = mips[0].size_px.map(f64::from);
    // The frame at u = 1/2.
    let forward = environment_dir(DVec2::new(0.5, v));
    let east = DVec3::X;
    let north = east.cross(forward);
    let mut weights = 0.0;
    lobe.iter()
        .map(|sample| {
            let d = sample.direction;
            let uv = environment_uv(east * d.x + north * d.y + forward * d.z);
            // A texel's solid angle. Near the poles texels are narrow but no lower, and a level blurs both ways alike:
            // the bound limits the blur along v.
            let texel = (TAU / width) * (PI / height) * (uv.y * PI).sin().max(POLE_SINE_MIN);
            let lod = 0.5 * (sample.solid_angle / texel).log2() + LOD_BIAS;
            let lod = lod.clamp(0.0, (mips.len() - 1) as f64);
            let level = (lod as usize).min(mips.len() - 2);
            weights += sample.weight;
            Tap {
                du: (uv.x + 0.5) as f32,
                near: RowPair::at(mips, level, uv.y),
                far: RowPair::at(mips, level + 1, uv.y),
                toward_far: (lod - level as f64) as f32,
                share: (sample.weight / weights) as f32,
            }
        })
        .collect()
}

const POLE_SINE_MIN: f64 = 0.25;

/// Samples overlap a little, which hides their pattern behind bright lights: found by comparing with quadrature.
const LOD_BIAS: f64 = 0.5;
