//! Light from all around: an equirectangular radiance map, prefiltered for rough reflection.
//!
//! Shading follows the split sum: a reflection off a rough surface is the map blurred by the surface's lobe, put together from round ones
//! ([`Environment::prefiltered`], `hairline_optics::environment_lobe`), times the lobe's directional albedo; diffuse light is the map blurred by the cosine
//! ([`Environment::irradiance`]). [Suns](Environment::suns) are lights of their own.
//!
//! The map's top is at +Y, as in glTF, and its centre column at -Z, where a glTF camera looks by default; +X is to the
//! right of it. [`Environment::with_up`] turns all of that to another axis.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};
use hairline_image::Picture;

use crate::light::Light;

mod levels;
pub mod lookup;

pub use levels::{LEVEL_HALVINGS, LEVEL_ROUGHNESS, level_place};

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
    maps: Arc<EnvironmentMaps>,
    intensity: f64,
    map_from_world: DMat3,
    visible: bool,
    /// The suns as they shine on the scene.
    suns: Vec<Light>,
}

/// A disc of even radiance, infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit vector to its middle.
    pub direction: DVec3,
    /// Angular radius of the disc.
    pub radius_rad: f64,
    /// Radiance of the disc, the same at all its points.
    pub radiance: [f64; 3],
}

/// An equirectangular map and what is made from it, in the map's frame and in texel units.
#[derive(Debug)]
pub struct EnvironmentMaps {
    /// Suns, which the levels and the irradiance lack.
    pub suns: Vec<Sun>,
    /// The map in full resolution.
    pub background: Picture,
    /// The prefiltered maps, one for each of [`LEVEL_ROUGHNESS`].
    pub levels: Vec<Picture>,
    /// The map blurred by the cosine.
    pub irradiance: Picture,
    /// Radiance of a texel of value 1.
    pub texel_scale: f64,
    /// Number of texels whose radiance was none and was replaced.
    pub repaired_texels: usize,
    /// Notes on the file for the scene's author.
    pub notes: Vec<String>,
}

impl Environment {
    /// Puts the map's top at +Y and turns it by `rotation_rad` about that axis, counter-clockwise seen from above. `intensity` multiplies its radiance;
    /// `visible` says whether the camera sees it.
    pub fn new(maps: EnvironmentMaps, rotation_rad: f64, intensity: f64, visible: bool) -> Self {
        Self {
            maps: Arc::new(maps),
            intensity,
            map_from_world: map_from_world(DVec3::Y, rotation_rad),
            visible,
            suns: Vec::new(),
        }
        .with_suns()
    }

    /// Brings suns up to date with the map's turn and intensity.
    fn with_suns(mut self) -> Self {
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

    /// Puts the map's top at the direction `up` (need not be a unit vector) instead of +Y, by the shortest turn from
    /// one to the other, and then turns it by `rotation_rad` about `up`.
    #[must_use]
    pub fn with_up(mut self, up: DVec3, rotation_rad: f64) -> Self {
        self.map_from_world = map_from_world(up, rotation_rad);
        self.with_suns()
    }

    /// Sets the factor on the map's radiance.
    #[must_use]
    pub fn with_intensity(mut self, intensity: f64) -> Self {
        self.intensity = intensity;
        self.with_suns()
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

fn map_from_world(up: DVec3, rotation_rad: f64) -> DMat3 {
    let up = up.normalize();
    let world_from_map =
        DQuat::from_axis_angle(up, rotation_rad) * DQuat::from_rotation_arc(DVec3::Y, up);
    DMat3::from_quat(world_from_map).transpose()
}
