//! The model of a scene: the objects that it is about.

use glam::{DMat3, DVec3, Vec3};
use hairline_image::FilePath;
use hairline_model::mesh_file::quarter_turn;
use hairline_scene::{Object, Scene};

use crate::description::Description;
use crate::error::Error;
use crate::loader::Loader;
use crate::subject;

/// The model of a scene.
pub(crate) struct PlainModel {
    /// The scene.
    pub(super) scene: Scene,
    /// Numbers of the objects that the scene is about.
    pub(super) objects: Vec<usize>,
    /// From the world to a frame whose y is up.
    file_from_world: DMat3,
    /// Whether its materials have the scratches in their maps.
    pub(super) is_baked: bool,
}

impl PlainModel {
    /// Builds the scene. Files are looked for in `base_dir`.
    pub(crate) fn new(
        loader: &Loader,
        description: &Description,
        base_dir: impl Into<FilePath>,
    ) -> Result<Self, Error> {
        let base_dir = &base_dir.into();
        let described = description.with_its_camera(base_dir)?;
        let scene = loader.build(&described, base_dir)?;
        // The ground and the shapes of lights lie behind them.
        let own = scene.objects.iter().take(described.objects.len());
        let boxes_m: Vec<_> = own
            .map(|object| object.mesh.bounds_m())
            .map(|(low, high)| (low.as_dvec3(), high.as_dvec3()))
            .collect();
        Ok(Self {
            objects: subject::objects(&described, &boxes_m),
            file_from_world: quarter_turn(described.camera.world_up(), DVec3::Y),
            scene,
            is_baked: false,
        })
    }

    /// The objects that the scene is about.
    pub(super) fn objects(&self) -> impl Iterator<Item = &Object> {
        self.objects.iter().map(|i| &self.scene.objects[*i])
    }

    /// A direction or a place in the file's frame.
    pub(super) fn turned(&self, v: Vec3) -> Vec3 {
        // Not -0.
        (self.file_from_world * v.as_dvec3()).as_vec3() + Vec3::ZERO
    }

    /// Notes on what is not in the file.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let mut note = |what: &str| notes.push(format!("{what} are not in the file"));
        note("lights and the camera");
        if !self.is_baked && self.objects().any(|it| !it.scratches.is_empty()) {
            note("scratches");
        }
        if self.objects().any(|it| !it.gratings.is_empty()) {
            note("gratings");
        }
        if self.is_baked && self.objects().all(|it| it.scratches.is_empty()) {
            notes.push("there are no scratches to be drawn into maps; --wear lays some".to_owned());
        }
        notes
    }
}
