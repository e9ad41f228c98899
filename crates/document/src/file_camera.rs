//! A scene seen by a camera of one of its models' files.

use std::borrow::Cow;
use std::path::Path;

use glam::DVec3;
use hairline_image::FilePath;
use hairline_model::mesh_file::{self, FileCamera};

use crate::description::{Camera, Description, Surface};
use crate::error::Error;
use crate::schema::SMALLEST_M;
use crate::upright::vertical_axis;

impl Description {
    /// Returns the description with the camera of a file in place of its own, if `of_file` names one.
    ///
    /// # Errors
    /// As of [`Description::see_by`].
    pub fn with_its_camera(&self, base_dir: impl Into<FilePath>) -> Result<Cow<'_, Self>, Error> {
        let Some(wanted) = &self.camera.of_file else {
            return Ok(Cow::Borrowed(self));
        };
        let mut seen = self.clone();
        seen.see_by(wanted, base_dir)?;
        Ok(Cow::Owned(seen))
    }

    /// Files of the scene's models, with the paths as written.
    pub fn mesh_files(&self) -> impl Iterator<Item = &Path> {
        self.objects
            .iter()
            .filter_map(|object| match &object.surface {
                Surface::Mesh(file) => Some(file.as_path()),
                Surface::Shape(_) => None,
            })
    }

    /// Cameras of the models' files: their names, their nodes' names, or their numbers. What cannot be read has none.
    pub fn file_cameras(&self, base_dir: impl Into<FilePath>) -> Vec<String> {
        let base_dir = base_dir.into();
        let mut names = Vec::new();
        let files = self.mesh_files();
        for name in files.flat_map(|file| mesh_file::camera_names(&base_dir.join(file))) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }

    /// Takes over a camera of the first model that has it: by its name or its node's, or by its number from 0. The exposure stays.
    ///
    /// # Errors
    /// No model has it, or it is none that Hairline can see by; what is wrong with a file.
    pub fn see_by(&mut self, wanted: &str, base_dir: impl Into<FilePath>) -> Result<(), Error> {
        let base_dir = base_dir.into();
        let world_up = self.camera.world_up();
        let mut first_flaw = None;
        for (i, object) in self.objects.iter().enumerate() {
            let Surface::Mesh(file) = &object.surface else {
                continue;
            };
            let placing = object.placing(world_up);
            let path = base_dir.join(file);
            let found = mesh_file::camera(&path, &object.world_from_object(), &placing, wanted);
            let flaw = match found.and_then(|seen| camera(&seen, &self.camera, world_up)) {
                Ok(camera) => {
                    self.camera = camera;
                    return Ok(());
                }
                Err(flaw) => flaw,
            };
            let found = format!("\"{}\": {}", path.display(), flaw.found);
            let error = Error::new(format!("object[{i}].mesh"), found, flaw.right);
            first_flaw.get_or_insert(error);
        }
        Err(first_flaw.unwrap_or_else(|| {
            Error::new(
                "camera",
                "found no model",
                "only a model's file has cameras",
            )
        }))
    }
}

/// The least cosine between the up of a picture and the axis that its `up` is nearest to.
const LEAST_RISE: f64 = 0.05;

/// Converts a file's camera to that of a description. Models stand by the axis nearest to its `up`, which therefore has to stay.
fn camera(seen: &FileCamera, before: &Camera, world_up: DVec3) -> Result<Camera, mesh_file::Flaw> {
    let right = seen.forward.cross(seen.up);
    // Up vector nearest to the axis among those that are up in this picture; for a camera that looks straight down, one that leans a little.
    let rise = world_up.dot(seen.up);
    let up = world_up - right * world_up.dot(right) + seen.up * (LEAST_RISE - rise).max(0.0);
    if vertical_axis(up, seen.forward) != world_up {
        let found = "its camera is rolled by more than 45 degrees";
        return Err(mesh_file::Flaw::new(found, "must stand upright"));
    }
    let middle = DVec3::from(before.target_m) - seen.position;
    let distance_m = middle.dot(seen.forward).max(10.0 * SMALLEST_M);
    Ok(Camera {
        of_file: None,
        position_m: seen.position.into(),
        target_m: (seen.position + seen.forward * distance_m).into(),
        up: up.into(),
        fov_y_deg: seen.fov_y_rad.to_degrees(),
        ..before.clone()
    })
}
