//! From a description to a [`Scene`]: units, references, files.

use std::path::Path;
use std::sync::Arc;

use glam::{DMat4, DVec3};

use crate::Environment;
use crate::description::references::find;
use crate::description::{self, Description, LightKind, MaterialKind, MetalColor, Surface};
use crate::error::Error;
use crate::scene::{Base, Camera, Light, Material, Mesh, Object, RenderSettings, Scene};
use crate::surface::world_from_object;
use crate::{mesh_file, scratches, shape};

/// How far long work has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// Units of it that are done, of `total`.
    pub done: u64,
    /// All of its units: objects for [`Stage::Meshes`], scratches for [`Stage::Scratches`].
    pub total: u64,
}

/// What takes its time in loading a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Reading and building the objects' surfaces.
    Meshes,
    /// Reading and prefiltering the environment.
    Environment,
    /// Laying scratches on the surfaces.
    Scratches,
}

/// Loads scenes within limits.
#[derive(Clone, Copy)]
pub struct Loader<'a> {
    /// Scenes whose scratches would take more memory, here and in what renderers make of them, are refused before they
    /// are laid.
    pub memory_budget_bytes: u64,
    /// Is told how far long work has come, from the calling thread.
    pub progress: &'a dyn Fn(Progress),
    /// Is asked now and then, from the calling thread, whether to give up. Then the work ends with an error for which
    /// [`Error::is_cancelled`] holds.
    pub cancelled: &'a dyn Fn() -> bool,
}

impl Default for Loader<'_> {
    /// Silent, and with 8 GiB or three quarters of the memory that is free, where that is known and less.
    fn default() -> Self {
        const LARGEST_BUDGET_BYTES: u64 = 8 << 30;
        let free = free_memory_bytes().map_or(u64::MAX, |bytes| bytes / 4 * 3);
        Self {
            memory_budget_bytes: LARGEST_BUDGET_BYTES.min(free),
            progress: &|_| {},
            cancelled: &|| false,
        }
    }
}

/// What the system can still give out; known on Linux only.
fn free_memory_bytes() -> Option<u64> {
    let table = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = table
        .lines()
        .find(|line| line.starts_with("MemAvailable:"))?;
    let kib: u64 = line.split_ascii_whitespace().nth(1)?.parse().ok()?;
    Some(kib * 1024)
}

impl Scene {
    /// Reads a scene file and all that it names, within the limits of [`Loader::default`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Error> {
        Loader::default().load(path)
    }

    /// Reads a scene from text. `name` is what errors call it; files are looked for in `base_dir`.
    pub fn from_toml(
        text: &str,
        name: impl AsRef<Path>,
        base_dir: impl AsRef<Path>,
    ) -> Result<Self, Error> {
        Loader::default().from_toml(text, name, base_dir)
    }

    /// Builds what is described. Files are looked for in `base_dir`.
    pub fn build(description: &Description, base_dir: impl AsRef<Path>) -> Result<Self, Error> {
        Loader::default().build(description, base_dir)
    }
}

impl Loader<'_> {
    /// See [`Scene::load`].
    pub fn load(&self, path: impl AsRef<Path>) -> Result<Scene, Error> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|error| {
            let found = format!("cannot be read ({error})");
            Error::new("", found, "give the path of a scene file (TOML)").at(path, None)
        })?;
        self.from_toml(&text, path, path.parent().unwrap_or(Path::new("")))
    }

    /// See [`Scene::from_toml`].
    pub fn from_toml(
        &self,
        text: &str,
        name: impl AsRef<Path>,
        base_dir: impl AsRef<Path>,
    ) -> Result<Scene, Error> {
        let name = name.as_ref();
        let description = Description::from_toml(text, name)?;
        self.build(&description, base_dir)
            .map_err(|error| error.in_scene_file(text, name))
    }

    /// See [`Scene::build`]. An error names the key; [`Error::in_scene_file`] adds the line, if there is a file.
    pub fn build(
        &self,
        description: &Description,
        base_dir: impl AsRef<Path>,
    ) -> Result<Scene, Error> {
        let base_dir = base_dir.as_ref();
        description.check()?;
        let mut scene = Scene {
            camera: camera(&description.camera),
            render: RenderSettings {
                size_px: description.render.size_px,
                filter_std_px: description.render.filter_std_px,
                tone_map: description.render.tone_map,
            },
            environment: None,
            textures: Arc::default(),
            materials: description.materials.iter().map(material).collect(),
            objects: Vec::new(),
            lights: description.lights.iter().map(light).collect(),
        };
        let objects = description.objects.len() as u64;
        for (i, object) in description.objects.iter().enumerate() {
            self.report(Stage::Meshes, i as u64, objects);
            let key = format!("object[{i}]");
            let mesh = object_mesh(object, &key, description, base_dir, &mut scene)?;
            if mesh.triangles.is_empty() {
                return Err(Error::new(
                    key,
                    format!(
                        "found no surface: every triangle of \"{}\" has zero area",
                        object.name
                    ),
                    "must have triangles that span an area",
                ));
            }
            scene.objects.push(Object {
                name: object.name.clone(),
                mesh: Arc::new(mesh),
                scratches: Arc::default(),
                segments: Arc::default(),
            });
        }
        self.report(Stage::Meshes, objects, objects);
        if let Some(environment) = &description.environment {
            self.report(Stage::Environment, 0, 1);
            let up = vertical_axis(scene.camera.up);
            scene.environment = Some(load_environment(environment, up, base_dir)?);
            self.report(Stage::Environment, 1, 1);
        }
        self.lay_scratches(description, base_dir, &mut scene)?;
        Ok(scene)
    }

    fn lay_scratches(
        &self,
        description: &Description,
        base_dir: &Path,
        scene: &mut Scene,
    ) -> Result<(), Error> {
        let mut tables = Vec::new();
        for (i, table) in description.scratches.iter().enumerate() {
            let key = format!("scratches[{i}]");
            let names = description.objects.iter().map(|o| o.name.as_str());
            tables.push(scratches::Table {
                object: find(&table.object, names, &format!("{key}.object"), "object")?,
                layer: &table.layer,
                key,
            });
        }
        let transforms = description.objects.iter().map(transform);
        let meshes: Vec<_> = scene
            .objects
            .iter()
            .map(|o| o.mesh.as_ref())
            .zip(transforms)
            .collect();
        let laid = scratches::lay(self, &tables, base_dir, &meshes)?;
        for (object, laid) in scene.objects.iter_mut().zip(laid) {
            object.scratches = Arc::new(laid.scratches);
            object.segments = Arc::new(laid.segments);
        }
        Ok(())
    }

    fn report(&self, stage: Stage, done: u64, total: u64) {
        (self.progress)(Progress { stage, done, total });
    }
}

fn camera(camera: &description::Camera) -> Camera {
    Camera {
        position_m: camera.position_m.into(),
        target_m: camera.target_m.into(),
        up: camera.up.into(),
        fov_y_rad: camera.fov_y_deg.to_radians(),
        exposure_ev: camera.exposure_ev,
    }
}

fn material(material: &description::Material) -> Material {
    Material {
        name: material.name.clone(),
        base: match material.kind {
            MaterialKind::Metal(MetalColor::Measured(metal)) => Base::Metal(metal),
            MaterialKind::Metal(MetalColor::Color(base_color)) => Base::ColoredMetal { base_color },
            MaterialKind::Dielectric { ior, base_color } => Base::Dielectric { ior, base_color },
            MaterialKind::MetallicRoughness {
                base_color,
                metallic,
            } => Base::MetallicRoughness {
                base_color,
                metallic,
            },
            MaterialKind::Mirror => Base::Mirror,
        },
        roughness: material.roughness,
        coherence_um: material.coherence_um,
        emission: [0.0; 3],
        base_color_texture: None,
        metallic_roughness_texture: None,
        normal_texture: None,
        emission_texture: None,
    }
}

fn light(light: &description::Light) -> Light {
    let radiance = light.color.map(|channel| channel * light.radiance);
    match &light.kind {
        LightKind::Sphere { center_m, radius_m } => Light::Sphere {
            center_m: (*center_m).into(),
            radius_m: *radius_m,
            radiance,
        },
        LightKind::Polygon {
            vertices_m,
            two_sided,
        } => Light::Polygon {
            vertices_m: vertices_m.iter().map(|&v| v.into()).collect(),
            radiance,
            two_sided: *two_sided,
        },
    }
}

/// The axis of the world nearest to the camera's up: the direction of the environment's top. A camera that is rolled a little
/// leaves the world upright.
fn vertical_axis(up: DVec3) -> DVec3 {
    let axis = DVec3::AXES[up.abs().max_position()];
    axis * axis.dot(up).signum()
}

fn load_environment(
    environment: &description::Environment,
    up: DVec3,
    base_dir: &Path,
) -> Result<Environment, Error> {
    let path = base_dir.join(&environment.file);
    let rotation_rad = environment.rotation_deg.to_radians();
    Environment::load(
        &path,
        rotation_rad,
        environment.intensity,
        environment.visible,
    )
    .map(|map| map.with_up(up, rotation_rad))
    .map_err(|error| {
        Error::new(
            "environment.file",
            error.to_string(),
            "must be an equirectangular .hdr or .exr, relative to the scene file",
        )
    })
}

fn transform(object: &description::Object) -> DMat4 {
    world_from_object(object.translation_m, object.rotation_deg, object.scale)
}

/// The object's triangles in world space. A mesh that keeps its own materials adds them to the scene.
fn object_mesh(
    object: &description::Object,
    key: &str,
    description: &Description,
    base_dir: &Path,
    scene: &mut Scene,
) -> Result<Mesh, Error> {
    let transform = transform(object);
    let material = match &object.material {
        Some(name) => {
            let names = description.materials.iter().map(|m| m.name.as_str());
            Some(find(name, names, &format!("{key}.material"), "material")? as u32)
        }
        None => None,
    };
    match &object.surface {
        Surface::Shape(shape) => {
            let mut mesh = Mesh::default();
            // `check` saw to it that a shape has a material.
            shape::surface(shape).bake(&transform, material.unwrap_or(0), &mut mesh);
            Ok(mesh)
        }
        Surface::Mesh(file) => {
            let stock = mesh_file::Stock {
                materials: &mut scene.materials,
                textures: Arc::make_mut(&mut scene.textures),
            };
            mesh_file::read(&base_dir.join(file), material, &transform, stock).map_err(|flaw| {
                let found = format!("\"{}\": {}", file.display(), flaw.found);
                Error::new(format!("{key}.mesh"), found, flaw.right)
            })
        }
    }
}
