//! One plain scene for all sweeps: a mirror with straight scratches under one light, of which each sweep turns one knob.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use anyhow::{Result, anyhow};
use glam::{DVec2, DVec3, Vec3};
use hairline_optics::section::Section;
use hairline_scene::{Light, Profile, Scene, Scratch, Segment};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Distances of the camera and of the light from the middle of the plate.
const CAMERA_M: f64 = 0.2;
const LIGHT_M: f64 = 1.0;

/// The light's outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lamp {
    Sphere,
    /// A square of the sphere's solid angle.
    Square,
    /// White all around instead of a lamp.
    Furnace,
}

/// The knobs.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    /// Width and height of the picture.
    pub size_px: u32,
    /// Across the view, at the middle of the plate.
    pub pixel_um: f64,
    /// Angle of the view from the plate's normal.
    pub view_rad: f64,
    /// Radius as seen from the plate.
    pub light_rad: f64,
    pub lamp: Lamp,
    /// Distance of the light's middle from the mirror direction, across the plane of incidence, in direction cosines.
    pub beside: f64,
    pub roughness: f64,
    /// Area of the grooves over area of the plate; crossings count twice.
    pub covered: f64,
    pub width_um: f64,
    pub depth_nm: f64,
    /// Cross section of the grooves.
    pub section: fn() -> Section,
    pub coherence_um: f64,
    pub length_um: f64,
    /// Largest angle of scratches to the plane of incidence; a quarter turn is every direction.
    pub spread_rad: f64,
    pub seed: u64,
}

impl Default for Stage {
    fn default() -> Self {
        Self {
            size_px: 32,
            pixel_um: 30.0,
            view_rad: 30_f64.to_radians(),
            light_rad: 0.05,
            lamp: Lamp::Sphere,
            beside: 0.12,
            roughness: 0.1,
            covered: 0.05,
            width_um: 2.0,
            depth_nm: 150.0,
            section: Section::default,
            coherence_um: 20.0,
            length_um: 1000.0,
            spread_rad: 0.35,
            seed: 1,
        }
    }
}

impl Stage {
    /// The scene.
    ///
    /// # Errors
    /// Knobs that no scene can have.
    pub fn scene(&self) -> Result<Scene> {
        let (sin, cos) = self.view_rad.sin_cos();
        let camera = DVec3::new(0.0, -sin, cos) * CAMERA_M;
        let height_m = f64::from(self.size_px) * self.pixel_um * 1e-6;
        let fov_y_deg = 2.0 * (0.5 * height_m / CAMERA_M).atan().to_degrees();
        let plate_m = (20.0 * height_m / cos).clamp(0.02, 900.0);
        let text = format!(
            "[camera]\nposition_m = [0.0, {:?}, {:?}]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 1.0, 0.0]\n\
             fov_y_deg = {fov_y_deg:?}\n[render]\nsize_px = [{size}, {size}]\n\
             [studio]\nhidden = true\n\
             [[material]]\nname = \"mirror\"\nkind = \"mirror\"\nroughness = {:?}\ncoherence_um = {:?}\n\
             [[object]]\nname = \"plate\"\nmaterial = \"mirror\"\nshape = {{ plane = {{ size_m = [{plate_m:?}, {plate_m:?}] }} }}\n",
            camera.y,
            camera.z,
            self.roughness,
            self.coherence_um,
            size = self.size_px,
        );
        let mut scene =
            hairline_document::from_toml(&text, "the stage", ".").map_err(|e| anyhow!("{e}"))?;
        match self.light() {
            Some(light) => scene.lights.push(light),
            None => scene.environment = Some(hairline_sky::uniform([1.0; 3])),
        }
        self.scratch(&mut scene);
        Ok(scene)
    }

    /// The light of the stage, of radiance one.
    fn light(&self) -> Option<Light> {
        let direction = DVec3::new(self.beside, self.view_rad.sin(), 0.0);
        let direction = direction.with_z((1.0 - direction.length_squared()).max(0.0).sqrt());
        let center_m = direction.normalize() * LIGHT_M;
        match self.lamp {
            Lamp::Sphere => Some(Light::sphere(
                center_m,
                LIGHT_M * self.light_rad.sin(),
                [1.0; 3],
            )),
            Lamp::Square => {
                let half = LIGHT_M * self.light_rad.tan() * 0.5 * PI.sqrt();
                let (x, y) = direction.normalize().any_orthonormal_pair();
                let corner = |a: f64, b: f64| center_m + half * (a * x + b * y);
                Some(Light::polygon(
                    vec![
                        corner(-1.0, -1.0),
                        corner(-1.0, 1.0),
                        corner(1.0, 1.0),
                        corner(1.0, -1.0),
                    ],
                    [1.0; 3],
                    true,
                ))
            }
            Lamp::Furnace => None,
        }
    }

    /// Lays scratches at random on the visible part of the plate and a margin around it.
    fn scratch(&self, scene: &mut Scene) {
        if self.covered <= 0.0 {
            return;
        }
        // Filter, perspective and the window reach beyond the picture's edge, and a scratch reaches half its length.
        let seen_um = f64::from(self.size_px + 8) * self.pixel_um;
        let margin_um = 150.0 + self.width_um + 0.5 * self.length_um;
        let half_um = DVec2::new(
            0.5 * seen_um + margin_um,
            0.5 * seen_um / self.view_rad.cos() * 1.1 + margin_um,
        );
        let area_um2 = 4.0 * half_um.x * half_um.y;
        let count = (self.covered * area_um2 / (self.width_um * self.length_um)).round() as usize;
        let mut random = Pcg64::seed_from_u64(self.seed);
        let object = &mut scene.objects[0];
        for _ in 0..count {
            let middle_um = DVec2::new(
                random.random_range(-half_um.x..half_um.x),
                random.random_range(-half_um.y..half_um.y),
            );
            let angle = random.random_range(-self.spread_rad..=self.spread_rad);
            let half = 0.5 * self.length_um * DVec2::new(angle.sin(), angle.cos());
            let place = |um: DVec2| Vec3::new(um.x as f32, um.y as f32, 0.0) * 1e-6;
            let first = object.segments.len() as u32;
            Arc::make_mut(&mut object.segments).push(Segment {
                start_m: place(middle_um - half),
                end_m: place(middle_um + half),
                normal: Vec3::Z,
                triangle: 0,
            });
            Arc::make_mut(&mut object.scratches).push(Scratch {
                profile: Profile {
                    width_um: self.width_um as f32,
                    depth_nm: self.depth_nm as f32,
                    section: (self.section)(),
                },
                layer: 0,
                closed: false,
                segments: first..first + 1,
            });
        }
    }
}

/// Every direction.
pub const ALL_AROUND: f64 = FRAC_PI_2;
