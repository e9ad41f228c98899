//! A scene around a model that comes without one: a studio and a ground, wear on metal, a camera that frames it.

use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3, Vec3};
use hairline_image::FilePath;
use hairline_model::text::shown;
use hairline_model::{mesh_file, packed};
use hairline_scene::Mesh;
use hairline_sky::BuiltInMap;

use crate::description::{
    Camera, Description, Environment, Light, Map, Object, Render, Studio, Surface, Up,
};
use crate::error::Error;
use crate::framing::framing;
use crate::gltf_scene;
use crate::probe;
use crate::scratch_studio::{DARK_GROUND, Subject};
use crate::wear::Wear;
use fit::Fit;

mod fit;
mod lights;

/// The share of the picture that the model fills: the rest is for its shadow.
const FILLED: f64 = 0.8;
const FOV_Y_DEG: f64 = 28.0;
/// Around the lights of a model's file: its brightest box behind the camera, to the side.
const STUDIO_ROTATION_DEG: f64 = 220.0;
const STUDIO_INTENSITY: f64 = 0.75;
/// Direction from the model to the camera on the floor plan: a little from the left.
const VIEW: DVec2 = DVec2::new(-0.42, -1.0);
/// Elevations of the camera: for flat models, and for those as high as wide, whose walls mirror their surroundings.
const ELEVATION_DEG: [f64; 2] = [32.0, 12.0];

impl Description {
    /// Whether a file is a model by its name: .glb, .gltf, .obj or .stl.
    pub fn is_model(path: &Path) -> bool {
        packed::is_model(path)
    }

    /// The scene that a model's file holds, or one that shows the model, z up. Its files are relative to the model's folder.
    ///
    /// # Errors
    /// What is wrong with the file. A scene in it that cannot be read is told in the notes, and the model is shown plain.
    pub fn for_model(path: impl Into<FilePath>) -> Result<Self, Error> {
        let path = &path.into();
        match gltf_scene::reading::read(path) {
            Some(Ok(scene)) => Ok(scene),
            Some(Err(error)) => {
                let mut plain = Self::from_plain_model(path)?;
                plain.scratches.clear();
                plain
                    .notes
                    .push(format!("{error}; the model is shown plain"));
                Ok(plain)
            }
            None => Self::from_plain_model(path),
        }
    }

    /// A scene around a model.
    fn from_plain_model(path: &FilePath) -> Result<Self, Error> {
        let probed = probe::read_mesh(path)?;
        let name = path
            .file_name()
            .map_or_else(|| path.to_path_buf(), PathBuf::from);
        let shown_name = shown(&name.to_string_lossy());
        let summary = &probed.summary;
        let mut notes = Vec::new();
        let fit = Fit::new(summary, &shown_name, &mut notes);
        let mut lamps = own_lamps(path, &fit, &shown_name, &mut notes)?;
        let is_metal = summary.metal_share > 0.5;
        if summary.metal_share > 0.0 && !is_metal {
            notes.push(format!(
                "{shown_name}: at most half of its triangles are of metal, so no wear is laid on it; `--wear worn` lays it on all of them",
            ));
        }
        let upright = |p: &Vec3| fit.turned(p.as_dvec3());
        let [a, b] = <[Vec3; 2]>::from(summary.bounds_m).map(|corner| upright(&corner));
        let points_m: Vec<_> = summary.extreme_points_m.iter().map(upright).collect();
        let render = Render::default();
        let camera = camera(&points_m, render.size_px);
        let environment = match lamps.is_empty() {
            true => {
                let mesh = in_scene(probed.mesh, fit.factor);
                let subject = Subject {
                    meshes: &[&mesh],
                    count: 1,
                    materials: &probed.materials,
                    textures: &probed.textures,
                };
                lamps = subject.lights(&camera, render.size_px);
                Environment::dark_room()
            }
            // The model has lights of its own, but their strength is unknown, so the studio's map lights it as
            // well.
            false => studio_map(),
        };
        let object = object(path, &name, fit.fit_m);
        Ok(Self {
            camera,
            render,
            environment: Some(environment),
            // The scene gets lights in place of the studio, so that each can be changed.
            studio: Studio::NONE,
            ground: Some(DARK_GROUND),
            materials: Vec::new(),
            gratings: Vec::new(),
            scratches: match is_metal {
                true => Wear::Worn.layers(&object.name, a.distance(b)),
                false => Vec::new(),
            },
            objects: vec![object],
            lights: lamps,
            looks: Vec::new(),
            lights_of: Some(name),
            notes,
        })
    }
}

/// The lights of a model's file; a note tells why one is left out.
fn own_lamps(
    path: &FilePath,
    fit: &Fit,
    shown_name: &str,
    notes: &mut Vec<String>,
) -> Result<Vec<Light>, Error> {
    let lights = mesh_file::lights(path)
        .map_err(|flaw| Error::new("", flaw.found, flaw.right).with_position(path, None))?;
    let mut lamps = Vec::new();
    for (i, light) in lights.iter().enumerate() {
        match lights::lamp(light, fit) {
            Ok(lamp) => lamps.push(lamp),
            Err(why) => {
                let light = light.name.as_deref().map_or_else(|| i.to_string(), shown);
                notes.push(format!("{shown_name}: light {light} left out; {why}"));
            }
        }
    }
    Ok(lamps)
}

fn studio_map() -> Environment {
    Environment {
        map: Map::BuiltIn(BuiltInMap::Studio),
        rotation_deg: STUDIO_ROTATION_DEG,
        intensity: STUDIO_INTENSITY,
        visible: true,
    }
}

/// The object of a model, named after its file.
fn object(path: &FilePath, name: &Path, fit_m: Option<f64>) -> Object {
    let stem = path
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned());
    Object {
        name: stem
            .filter(|stem| !stem.is_empty())
            .unwrap_or_else(|| "model".to_owned()),
        surface: Surface::Mesh(name.to_owned()),
        up: Up::Y,
        fit_m,
        time_s: None,
        animation: None,
        overrides: Vec::new(),
        material: None,
        translation_m: [0.0; 3],
        rotation_deg: [0.0; 3],
        scale: [1.0; 3],
        hidden: false,
    }
}

/// A model as the scene has it: z up, so many times as large.
fn in_scene(mut mesh: Mesh, factor: f64) -> Mesh {
    let turned = |p: Vec3| Vec3::new(p.x, -p.z, p.y);
    for position_m in &mut mesh.positions_m {
        *position_m = factor as f32 * turned(*position_m);
    }
    for normal in &mut mesh.normals {
        *normal = turned(*normal);
    }
    mesh
}

/// Places the camera along [`VIEW`], as near as possible so that all points are in the picture.
fn camera(points_m: &[DVec3], [width, height]: [u32; 2]) -> Camera {
    let least = points_m
        .iter()
        .copied()
        .reduce(DVec3::min)
        .unwrap_or_default();
    let most = points_m
        .iter()
        .copied()
        .reduce(DVec3::max)
        .unwrap_or_default();
    let size_m = most - least;
    let [flat_deg, tall_deg] = ELEVATION_DEG;
    let tallness = (size_m.z / size_m.truncate().max_element()).clamp(0.0, 1.0);
    let elevation_rad = (flat_deg + (tall_deg - flat_deg) * tallness).to_radians();
    let view = VIEW.normalize() * elevation_rad.cos();
    let forward = -view.extend(elevation_rad.sin());
    let right = forward.cross(DVec3::Z).normalize();
    let tan_y = FILLED * (0.5 * FOV_Y_DEG.to_radians()).tan();
    let tan = DVec2::new(tan_y * f64::from(width) / f64::from(height), tan_y);
    let view = framing(points_m, [right, right.cross(forward), forward], tan);
    Camera {
        position_m: view.position_m.into(),
        target_m: view.target_m.into(),
        up: [0.0, 0.0, 1.0],
        fov_y_deg: FOV_Y_DEG,
        ..Default::default()
    }
}
