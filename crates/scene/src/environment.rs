//! Light from all around: an equirectangular radiance map, prefiltered for rough reflection.
//!
//! Shading follows the split sum: a reflection off a rough surface is the map blurred by the surface's lobe, put together from round ones
//! ([`Environment::prefiltered`], `hairline_optics::environment_lobe`), times the lobe's directional albedo; diffuse light is the map blurred by the cosine
//! ([`Environment::irradiance`]). Suns ([`Environment::load`]) are lights of their own.
//!
//! The map's top is at +Y, as in glTF, and its centre column at -Z, where a glTF camera looks by default; +X is to the
//! right of it. [`Environment::with_up`] turns all of that to another axis.

use std::path::Path;
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};
use hairline_image::Picture;

use crate::light::Light;
use half_texels::{HALF_MAX, fit_half, round_to_half};
use suns::Sun;

mod built_in;
mod file;
mod half_texels;
mod irradiance;
pub mod lookup;
mod mip;
mod prefilter;
mod radiance_header;
mod resample;
mod suns;

pub use built_in::BuiltInMap;
pub(crate) use built_in::SIZE_PX as BUILT_IN_SIZE_PX;
pub use file::Error;
pub(crate) use file::{read, read_picture, size_px};
pub use prefilter::{LEVEL_HALVINGS, LEVEL_ROUGHNESS, level_place};

use lookup::{
    environment_irradiance, environment_lod, environment_prefiltered_all,
    environment_prefiltered_lod, environment_radiance,
};

/// An environment map and the maps that are made from it. Clones share the texels.
///
/// Texels are bounded and rounded so that half floats (`rgba16float`) hold them exactly: a renderer that uploads them
/// shows what one that reads them here shows. A map with radiances above 65504 is stored divided by a power of two, which
/// multiplies what is looked up ([`Environment::texel_radiance`]). Radiances above 6.9e10 (forty times those of the sun's disk in cd/m2) are cut there.
#[derive(Clone, Debug)]
pub struct Environment {
    maps: Arc<Maps>,
    intensity: f64,
    map_from_world: DMat3,
    visible: bool,
    /// The suns as they shine on the scene.
    suns: Vec<Light>,
}

#[derive(Debug)]
struct Maps {
    /// Suns taken out of the levels and of the irradiance, in the map's frame and in texel units.
    suns: Vec<Sun>,
    background: Picture,
    levels: Vec<Picture>,
    irradiance: Picture,
    texel_scale: f64,
    repaired_texels: usize,
    /// Notes on the file for the scene's author.
    notes: Vec<String>,
}

impl Environment {
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
        path: &Path,
        rotation_rad: f64,
        intensity: f64,
        visible: bool,
    ) -> Result<Self, Error> {
        let mut maps = Maps::new(file::read(path)?, true);
        maps.notes = file::notes(path);
        Ok(Self::of_maps(maps, rotation_rad, intensity, visible))
    }

    /// Makes an environment of an equirectangular map in memory, rows from the top; see [`Environment::load`] for the rest. The map stays whole: no sun
    /// becomes a light of its own.
    ///
    /// # Panics
    /// If the map is empty.
    pub fn from_map(map: Picture, rotation_rad: f64, intensity: f64, visible: bool) -> Self {
        let maps = Maps::new(map, false);
        Self::of_maps(maps, rotation_rad, intensity, visible)
    }

    /// Makes the environment as [`Environment::from_map`] does, with suns parted from the map as [`Environment::load`] does.
    ///
    /// # Panics
    /// If the map is empty.
    pub fn with_lamps_parted(
        map: Picture,
        rotation_rad: f64,
        intensity: f64,
        visible: bool,
    ) -> Self {
        let maps = Maps::new(map, true);
        Self::of_maps(maps, rotation_rad, intensity, visible)
    }

    fn of_maps(maps: Maps, rotation_rad: f64, intensity: f64, visible: bool) -> Self {
        Self {
            maps: Arc::new(maps),
            intensity,
            map_from_world: map_from_world(DVec3::Y, rotation_rad),
            visible,
            suns: Vec::new(),
        }
        .with_lamps()
    }

    /// Brings suns up to date with the map's turn and intensity.
    fn with_lamps(mut self) -> Self {
        let per_texel = self.texel_radiance();
        let world_from_map = self.map_from_world.transpose();
        let sun = |sun: &Sun| {
            Light::sun(
                world_from_map * sun.direction,
                sun.radius_rad,
                sun.radiance.map(|c| c * per_texel),
            )
        };
        self.suns = self.maps.suns.iter().map(sun).collect();
        self
    }

    /// An environment of the same radiance from everywhere, visible. Exact if half floats hold the radiance, else within 0.05 %.
    pub fn uniform(radiance: [f32; 3]) -> Self {
        let map = Picture {
            size_px: [2, 1],
            rgb: vec![radiance; 2],
        };
        Self::from_map(map, 0.0, 1.0, true)
    }

    /// Puts the map's top at the direction `up` (need not be a unit vector) instead of +Y, by the shortest turn from
    /// one to the other, and then turns it by `rotation_rad` about `up`.
    #[must_use]
    pub fn with_up(mut self, up: DVec3, rotation_rad: f64) -> Self {
        self.map_from_world = map_from_world(up, rotation_rad);
        self.with_lamps()
    }

    /// Sets the factor on the map's radiance.
    #[must_use]
    pub fn with_intensity(mut self, intensity: f64) -> Self {
        self.intensity = intensity;
        self.with_lamps()
    }

    /// Sets whether the camera sees it.
    #[must_use]
    pub fn with_visible(mut self, visible: bool) -> Self {
        self.visible = visible;
        self
    }

    /// Whether two environments share their texels: they then differ by rotation, intensity and visibility at most.
    pub fn same_map(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.maps, &other.maps)
    }

    /// The radiance that arrives from a direction, as the camera sees the map. `dir` is a unit vector in world space, away from the viewer.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        environment_radiance(&self.maps.background, self.map_from_world * dir)
            * self.texel_radiance()
    }

    /// Radiance averaged over the lobe of a GGX surface of perceptual `roughness` and normal `dir` (unit vector, world space) that is seen along the
    /// normal.
    pub fn prefiltered(&self, dir: DVec3, roughness: f64) -> DVec3 {
        self.prefiltered_lod(dir, environment_lod(roughness))
    }

    /// [`Environment::prefiltered`] for several directions at once.
    #[inline(always)]
    pub fn prefiltered_all<const N: usize>(
        &self,
        dirs: [DVec3; N],
        roughness: [f64; N],
    ) -> [DVec3; N] {
        let dirs = dirs.map(|dir| self.map_from_world * dir);
        let radiance = environment_prefiltered_all(&self.maps.levels, dirs, roughness);
        radiance.map(|radiance| radiance * self.texel_radiance())
    }

    /// [`Environment::prefiltered`] by level: `lod` 0 is the sharp map, each further level belongs to
    /// [`LEVEL_ROUGHNESS`]; between levels, a blend.
    pub fn prefiltered_lod(&self, dir: DVec3, lod: f64) -> DVec3 {
        environment_prefiltered_lod(&self.maps.levels, self.map_from_world * dir, lod)
            * self.texel_radiance()
    }

    /// The irradiance on a surface with unit `normal` in world space: the integral of radiance times cosine.
    pub fn irradiance(&self, normal: DVec3) -> DVec3 {
        environment_irradiance(&self.maps.irradiance, self.map_from_world * normal)
            * self.texel_radiance()
    }

    /// Whether the camera sees the map.
    pub fn visible(&self) -> bool {
        self.visible
    }

    /// The radiance of a texel of value 1: the intensity, times the power of two that brought a very
    /// bright map into half floats.
    #[inline]
    pub fn texel_radiance(&self) -> f64 {
        self.intensity * self.maps.texel_scale
    }

    /// Rotation from the world to the map's frame, in which +Y is the top and -Z the centre.
    pub fn map_from_world(&self) -> DMat3 {
        self.map_from_world
    }

    /// The map in full resolution, in texel units.
    pub fn background(&self) -> &Picture {
        &self.maps.background
    }

    /// The prefiltered maps in texel units, one for each of [`LEVEL_ROUGHNESS`], as large as [`LEVEL_HALVINGS`] says.
    pub fn prefiltered_levels(&self) -> &[Picture] {
        &self.maps.levels
    }

    /// The map blurred by the cosine, in texel units: [`Environment::irradiance`] over pi.
    pub fn irradiance_map(&self) -> &Picture {
        &self.maps.irradiance
    }

    /// Suns as spheres, so far away that their direction is the same over the whole scene. They shine beside what is
    /// [prefiltered](Environment::prefiltered) and the [irradiance](Environment::irradiance), which lack them; the
    /// [radiance](Environment::radiance) has them.
    pub fn suns(&self) -> &[Light] {
        &self.suns
    }

    /// Number of texels of the file with a negative, infinite or NaN component, or one beyond [what a map can hold](Environment).
    pub fn repaired_texels(&self) -> usize {
        self.maps.repaired_texels
    }

    /// Notes on the file for the scene's author, a line each.
    pub fn notes(&self) -> &[String] {
        &self.maps.notes
    }
}

impl Maps {
    /// Makes the maps; `parts` tells whether suns are taken out.
    fn new(mut map: Picture, parts: bool) -> Self {
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
            suns::Parted::default()
        };
        let levels = prefilter::prefilter(&map);
        let irradiance = irradiance::blur(&levels[0]);
        parted.put_back(&mut map);
        round_to_half(&mut map);
        Self {
            suns: parted.suns,
            background: map,
            levels,
            irradiance,
            texel_scale,
            repaired_texels,
            notes: Vec::new(),
        }
    }
}

/// Largest width: every WebGPU device holds it in one texture.
const MAP_WIDTH_MAX: u32 = 8192;

fn map_from_world(up: DVec3, rotation_rad: f64) -> DMat3 {
    let up = up.normalize();
    let world_from_map =
        DQuat::from_axis_angle(up, rotation_rad) * DQuat::from_rotation_arc(DVec3::Y, up);
    DMat3::from_quat(world_from_map).transpose()
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
