//! The scene that the benchmark measures: a worn disk of steel under one lamp, or as many as are asked for.
//!
//! What the talk measured is not published, so this stands for it: scratches in every direction, so many that two to four
//! lie within the coherence window of each point, on a mesh as fine as a model's; the lamp seen from the disk under a tenth of a
//! radian, its reflection in the middle of the picture.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::anyhow;
use glam::DVec2;
use hairline_scene::Scene;

use hairline_work::failure::Failure;

/// Lights of the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lamps {
    /// No light: scratches are found and weighed, and none is lit.
    None,
    /// A sphere.
    Sphere,
    /// A triangle as large as the sphere's outline.
    Triangle,
    /// Spheres and triangles by turns, with the same light in all.
    Many(u32),
}

/// A variant of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    pub lamps: Lamps,
    /// 2: the camera at half the distance.
    pub zoom: f64,
    pub scratches: u32,
    /// Their mean length.
    pub length_m: f64,
    /// Width and height.
    pub size_px: [u32; 2],
}

/// Picture size of the talk's table.
pub const TALK_SIZE_PX: [u32; 2] = [1280, 720];
pub const TALK_SCRATCHES: u32 = 10_000;

/// Length of a scratch: with 10,000 of them on the disk 30 m of scratch lie on each square centimetre's hundredth, three within
/// the window's reach.
const LENGTH_M: f64 = 0.0236;
const DISK_RADIUS_M: f64 = 0.05;
/// Rings of the mesh: 4,032 triangles of about 2 mm, as a model of a few thousand has.
const RINGS: u32 = 32;
const FACETS: u32 = 64;
/// Angle of the view and of the lamp's mirror direction from the normal.
const TILT_RAD: f64 = std::f64::consts::FRAC_PI_6;
const FOV_Y_DEG: f64 = 20.0;
/// Distance of the camera at 1x: the disk fills nine tenths of the picture's height.
const CAMERA_M: f64 = 0.273;
const LAMP_M: f64 = 0.4;
const LAMP_RAD: f64 = 0.1;
/// The Gaussian with the variance of a square pixel.
const FILTER_STD_PX: f64 = 0.2887;

impl Default for Stage {
    /// The talk's, under a sphere.
    fn default() -> Self {
        Self {
            lamps: Lamps::Sphere,
            zoom: 1.0,
            scratches: TALK_SCRATCHES,
            length_m: LENGTH_M,
            size_px: TALK_SIZE_PX,
        }
    }
}

impl Stage {
    /// The scene file.
    pub fn to_toml(self) -> String {
        let (sin, cos) = TILT_RAD.sin_cos();
        let camera_m = CAMERA_M / self.zoom;
        let [width, height] = self.size_px;
        let Self {
            scratches,
            length_m,
            ..
        } = self;
        let ring_m = DISK_RADIUS_M / f64::from(RINGS);
        let profile: Vec<String> = (0..=RINGS)
            .map(|ring| format!("[{:.7}, 0.0]", f64::from(ring) * ring_m))
            .collect();
        let profile = profile.join(", ");
        let mut text = format!(
            r#"# What `hairline bench` measures: a worn disk of steel.

[camera]
position_m = [0.0, {:.6}, {:.6}]
target_m = [0.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
fov_y_deg = {FOV_Y_DEG:?}

[render]
size_px = [{width}, {height}]
filter_std_px = {FILTER_STD_PX}

[[material]]
name = "steel"
kind = "metal"
metal = "iron"
roughness = 0.1

[[object]]
name = "disk"
shape = {{ lathe = {{ segments = {FACETS}, profile_m = [{profile}] }} }}
material = "steel"

[[scratches]]
object = "disk"
pattern = "random"
count = {scratches}
seed = 1
length_m = {{ mean = {length_m}, spread = 0.4 }}
width_um = {{ mean = 3.0, spread = 0.15 }}
depth_nm = {{ mean = 220.0, spread = 0.3 }}
"#,
            -camera_m * sin,
            camera_m * cos,
        );
        let lamps = self.lamps();
        if lamps.is_empty() {
            text += "\n[studio]\nhidden = true\n";
        }
        text + &lamps.concat()
    }

    /// Builds it.
    pub fn build(self) -> Result<Scene, Failure> {
        hairline_document::from_toml(&self.to_toml(), Path::new("bench scene"), ".")
            .map_err(|error| Failure::Work(anyhow!("{error}")))
    }

    /// Combines the camera and the lamps of this scene with the disk of another.
    pub fn with_disk_of(self, worn: &Scene) -> Result<Scene, Failure> {
        let bare = Self {
            scratches: 0,
            ..self
        }
        .build()?;
        Ok(Scene {
            camera: bare.camera,
            lights: bare.lights,
            render: bare.render,
            ..worn.clone()
        })
    }

    fn lamps(self) -> Vec<String> {
        match self.lamps {
            Lamps::None => Vec::new(),
            Lamps::Sphere => vec![lamp(false, DVec2::ZERO, 40.0)],
            Lamps::Triangle => vec![lamp(true, DVec2::ZERO, 40.0)],
            Lamps::Many(count) => {
                // On a sunflower's spiral about the mirror direction, out to a radian.
                (0..count)
                    .map(|i| {
                        let turn = 2.399_963_229_728_653 * f64::from(i);
                        let out_rad = (f64::from(i) / f64::from(count.max(1))).sqrt();
                        let place = LAMP_M * out_rad * DVec2::from_angle(turn);
                        lamp(i % 2 == 1, place, 40.0 / f64::from(count))
                    })
                    .collect()
            }
        }
    }
}

/// A lamp, moved by `place_m` to the right and up from the mirror direction, and facing the disk.
fn lamp(triangle: bool, place_m: DVec2, radiance: f64) -> String {
    let (sin, cos) = TILT_RAD.sin_cos();
    let radius_m = LAMP_M * LAMP_RAD;
    // Across the mirror direction (0, sin, cos): x to the right, y up and towards the viewer.
    let at = |p: DVec2| {
        let up = p.y;
        [p.x, LAMP_M * sin - up * cos, LAMP_M * cos + up * sin]
    };
    let mut text = String::from("\n[[light]]\n");
    let vector = |[x, y, z]: [f64; 3]| format!("[{x:.6}, {y:.6}, {z:.6}]");
    // A string takes everything.
    let _ = if triangle {
        // Triangle with the area of the disk that the sphere shows.
        let corner_m = radius_m * (4.0 * std::f64::consts::PI / 27.0_f64.sqrt()).sqrt();
        let corners: Vec<String> = (0..3)
            .map(|i| {
                let turn = std::f64::consts::TAU / 3.0 * f64::from(i);
                vector(at(place_m + corner_m * DVec2::from_angle(turn)))
            })
            .collect();
        writeln!(
            text,
            "kind = \"polygon\"\nvertices_m = [{}]\nradiance = {radiance}",
            corners.join(", ")
        )
    } else {
        writeln!(
            text,
            "kind = \"sphere\"\ncenter_m = {}\nradius_m = {radius_m:?}\nradiance = {radiance}",
            vector(at(place_m))
        )
    };
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use hairline_scene::LightShape;

    fn small(lamps: Lamps) -> Scene {
        Stage {
            lamps,
            scratches: 300,
            ..Stage::default()
        }
        .build()
        .unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn the_lamps_reflection_is_in_the_middle_and_as_large_as_it_says() {
        let scene = small(Lamps::Sphere);
        let to_camera = scene.camera.position_m.normalize();
        let mirrored = DVec3::new(-to_camera.x, -to_camera.y, to_camera.z);
        let LightShape::Sphere { center_m, radius_m } = scene.lights[0].shape else {
            panic!("a sphere")
        };
        assert!(center_m.normalize().angle_between(mirrored) < 1e-5);
        assert!((radius_m / center_m.length() - LAMP_RAD).abs() < 1e-6);
    }

    #[test]
    fn the_triangle_faces_the_disk_and_is_as_large_as_the_sphere() {
        let scene = small(Lamps::Triangle);
        let LightShape::Polygon { vertices_m, .. } = &scene.lights[0].shape else {
            panic!("a polygon")
        };
        let twice = (vertices_m[1] - vertices_m[0]).cross(vertices_m[2] - vertices_m[0]);
        assert!(twice.dot(vertices_m[0]) < 0.0, "it shines away");
        let disk = std::f64::consts::PI * (LAMP_M * LAMP_RAD).powi(2);
        assert!((0.5 * twice.length() / disk - 1.0).abs() < 1e-3);
    }

    #[test]
    fn lamps_are_as_many_as_asked_and_half_of_each_kind() {
        let scene = small(Lamps::Many(64));
        let spheres = scene.lights.iter();
        let spheres = spheres
            .filter(|l| matches!(l.shape, LightShape::Sphere { .. }))
            .count();
        assert_eq!((scene.lights.len(), spheres), (64, 32));
        assert!(small(Lamps::None).lights.is_empty());
    }

    /// 30,000 m of scratch on a square metre: a strip of 3.5 standard deviations of the window to both sides of a point
    /// (99 um for 20 um) holds 3 of them.
    #[test]
    fn two_to_four_scratches_lie_within_the_window() {
        let scene = small(Lamps::None);
        let length_m: f32 = scene.objects[0]
            .segments
            .iter()
            .map(|s| s.start_m.distance(s.end_m))
            .sum();
        let whole_m = f64::from(length_m) * f64::from(TALK_SCRATCHES) / 300.0;
        let area_m2 = std::f64::consts::PI * DISK_RADIUS_M * DISK_RADIUS_M;
        let within = whole_m / area_m2 * 2.0 * 3.5 * 20e-6 / 2.0_f64.sqrt();
        assert!((2.0..4.0).contains(&within), "{within}");
    }

    #[test]
    fn half_the_distance_is_twice_as_near() {
        let at = |zoom| {
            let stage = Stage {
                zoom,
                scratches: 1,
                ..Stage::default()
            };
            let scene = stage.build().unwrap_or_else(|error| panic!("{error}"));
            scene.camera.position_m.length()
        };
        assert!((at(1.0) / at(2.0) - 2.0).abs() < 1e-4);
        assert!((at(0.5) / at(1.0) - 2.0).abs() < 1e-4);
    }
}
