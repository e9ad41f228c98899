//! Maps of environments from files and pictures: an equirectangular map is freed of suns, and prefiltered for rough reflection.
//!
//! ```
//! use hairline_image::Picture;
//!
//! let sky = Picture { size_px: [2, 1], rgb: vec![[1.0, 1.0, 2.0]; 2] };
//! let environment = hairline_sky::from_map(sky, 0.0, 1.0, true);
//! assert!(environment.suns().is_empty());
//! ```

#![warn(unreachable_pub)]

use hairline_image::{FilePath, Picture};
use hairline_scene::Environment;
use hairline_scene::environment::EnvironmentMaps;

use half_texels::{HALF_MAX, fit_half, round_to_half};

mod built_in;
mod file;
mod half_texels;
mod irradiance;
mod mip;
mod prefilter;
mod radiance_header;
mod resample;
mod suns;

pub use built_in::{BuiltInMap, SIZE_PX as BUILT_IN_SIZE_PX};
pub use file::{Error, read, read_picture, size_px};

/// Reads a Radiance (.hdr) or OpenEXR (.exr) file that holds an equirectangular map, twice as wide as high.
///
/// `rotation_rad` turns the map about the up axis, counter-clockwise seen from above; `intensity` multiplies its
/// radiance; `visible` says whether the camera sees it.
///
/// What is small and bright in it, the disc of the sun above all, becomes a light: [`Environment::suns`]. The camera sees it
/// where it was.
///
/// Negative and NaN components count as 0, infinite ones as 65504, the largest half float: what files of half floats had no number for;
/// [`Environment::repaired_texels`] counts them. Maps wider than 8192 pixels are halved until they are not.
///
/// # Errors
/// [`Error`] names the file and what is wrong with it.
pub fn load(
    path: impl Into<FilePath>,
    rotation_rad: f64,
    intensity: f64,
    visible: bool,
) -> Result<Environment, Error> {
    let path = path.into();
    let mut maps = maps_of(file::read(&path)?, true);
    maps.notes = file::notes(&path);
    Ok(Environment::new(maps, rotation_rad, intensity, visible))
}

/// Makes an environment of an equirectangular map in memory, rows from the top; see [`load`] for the rest. The map stays whole: no sun
/// becomes a light of its own.
///
/// # Panics
/// If the map is empty.
pub fn from_map(map: Picture, rotation_rad: f64, intensity: f64, visible: bool) -> Environment {
    let maps = maps_of(map, false);
    Environment::new(maps, rotation_rad, intensity, visible)
}

/// Makes the environment as [`from_map`] does, with suns parted from the map as [`load`] does.
///
/// # Panics
/// If the map is empty.
pub fn with_suns_parted(
    map: Picture,
    rotation_rad: f64,
    intensity: f64,
    visible: bool,
) -> Environment {
    let maps = maps_of(map, true);
    Environment::new(maps, rotation_rad, intensity, visible)
}

/// An environment of the same radiance from everywhere, visible. Exact if half floats hold the radiance, else within 0.05 %.
pub fn uniform(radiance: [f32; 3]) -> Environment {
    let map = Picture {
        size_px: [2, 1],
        rgb: vec![radiance; 2],
    };
    from_map(map, 0.0, 1.0, true)
}

/// Largest width: every WebGPU device holds it in one texture.
const MAP_WIDTH_MAX: u32 = 8192;

/// Makes the maps; `parts` tells whether suns are taken out.
fn maps_of(mut map: Picture, parts: bool) -> EnvironmentMaps {
    assert!(!map.rgb.is_empty(), "an empty environment map");
    let mut repaired_texels = repair(&mut map);
    while map.size_px[0] > MAP_WIDTH_MAX {
        map = resample::resample(&map, map.size_px.map(|n| n / 2));
    }
    let (texel_scale, cut_texels) = fit_half(&mut map);
    repaired_texels += cut_texels;
    let parted = if parts {
        suns::part(&mut map)
    } else {
        suns::ExtractedSuns::default()
    };
    let levels = prefilter::prefilter(&map);
    let irradiance = irradiance::blur(&levels[0]);
    parted.put_back(&mut map);
    round_to_half(&mut map);
    EnvironmentMaps {
        suns: parted.suns,
        background: map,
        levels,
        irradiance,
        texel_scale,
        repaired_texels,
        notes: Vec::new(),
    }
}

/// Replaces components that are no radiance; returns how many texels had one.
fn repair(map: &mut Picture) -> usize {
    let mut repaired = 0;
    for texel in &mut map.rgb {
        let whole = texel.map(|c| match c {
            _ if c.is_nan() => 0.0,
            f32::INFINITY => HALF_MAX,
            _ => c.max(0.0),
        });
        repaired += usize::from(whole != *texel);
        *texel = whole;
    }
    repaired
}
