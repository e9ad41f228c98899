//! From a description to a [`Scene`]: units, references, files.

use std::path::Path;
use std::sync::Arc;

use glam::{DMat4, DVec3};

use crate::Environment;
use crate::builder::SceneBuilder;
use crate::description::references::find;
use crate::description::{self, Description, LightKind, MaterialKind, MetalColor};
use crate::error::Error;
use crate::scene::{Base, Camera, Light, Material, RenderSettings, Scene};
use crate::surface::world_from_object;
use crate::{environment, memory, reading};

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
    /// Scenes that would take more memory, here and in what renderers make of them, are refused before they are built.
    pub memory_budget_bytes: u64,
    /// Is told how far long work has come, from the calling thread.
    pub progress: &'a dyn Fn(Progress),
    /// Is asked now and then, from the calling thread, whether to give up. Then the work ends with an error for which
    /// [`Error::is_cancelled`] holds.
    pub cancelled: &'a dyn Fn() -> bool,
}

impl Default for Loader<'_> {
    /// Silent, and with [`memory::budget_bytes`].
    fn default() -> Self {
        Self {
            memory_budget_bytes: memory::budget_bytes(),
            progress: &|_| {},
            cancelled: &|| false,
        }
    }
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
        let text = reading::scene_text(path)?;
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
        SceneBuilder::new().build(self, description, base_dir.as_ref())
    }

    /// An error if the caller gave up.
    pub(crate) fn go_on(&self) -> Result<(), Error> {
        match (self.cancelled)() {
            true => Err(Error::cancelled()),
            false => Ok(()),
        }
    }

    pub(crate) fn report(&self, stage: Stage, done: u64, total: u64) {
        (self.progress)(Progress { stage, done, total });
    }
}

/// All that takes no time: camera, settings, materials, lights.
pub(crate) fn without_surfaces(description: &Description) -> Scene {
    let lights = description.lights.iter().filter(|light| !light.hidden);
    Scene {
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
        lights: lights.map(light).collect(),
        notes: description.notes.clone(),
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
pub(crate) fn vertical_axis(up: DVec3) -> DVec3 {
    let axis = DVec3::AXES[up.abs().max_position()];
    axis * axis.dot(up).signum()
}

/// A map as it is without the scene: not turned, intensity 1.
pub(crate) fn environment_map(
    map: &description::Map,
    base_dir: &Path,
) -> Result<Environment, Error> {
    let file = match map {
        description::Map::File(file) => base_dir.join(file),
        description::Map::BuiltIn(map) => {
            let picture = map.picture(environment::BUILT_IN_SIZE_PX);
            return Ok(Environment::with_suns_parted(picture, 0.0, 1.0, true));
        }
    };
    Environment::load(&file, 0.0, 1.0, true).map_err(|error| {
        Error::new(
            "environment.file",
            error.to_string(),
            "must be an equirectangular .hdr or .exr, relative to the scene file",
        )
    })
}

/// The map as it is described, for a camera with `up`.
pub(crate) fn environment(
    described: &description::Environment,
    map: Environment,
    up: DVec3,
) -> Environment {
    map.with_up(vertical_axis(up), described.rotation_deg.to_radians())
        .with_intensity(described.intensity)
        .with_visible(described.visible)
}

impl description::Object {
    /// Where its `scale`, `rotation_deg` and `translation_m` put it.
    pub fn world_from_object(&self) -> DMat4 {
        world_from_object(self.translation_m, self.rotation_deg, self.scale)
    }
}

/// The number of the material that all of an object is of; `None` where its file brings its own.
pub(crate) fn object_material(
    object: &description::Object,
    key: &str,
    materials: &[description::Material],
) -> Result<Option<u32>, Error> {
    let Some(name) = &object.material else {
        return Ok(None);
    };
    let names = materials.iter().map(|m| m.name.as_str());
    let index = find(name, names, &format!("{key}.material"), "material")?;
    Ok(Some(index as u32))
}

/// The material with its textures numbered from `first` on instead of 0.
pub(crate) fn with_textures_from(material: Material, first: usize) -> Material {
    let shifted = |texture: Option<usize>| texture.map(|texture| texture + first);
    Material {
        base_color_texture: shifted(material.base_color_texture),
        metallic_roughness_texture: shifted(material.metallic_roughness_texture),
        normal_texture: material
            .normal_texture
            .map(|(texture, scale)| (texture + first, scale)),
        emission_texture: shifted(material.emission_texture),
        ..material
    }
}
