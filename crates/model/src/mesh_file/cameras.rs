//! The cameras of a file, each at one of its nodes (glTF 2.0, section 3.10).

use glam::{DMat4, DVec3};
use gltf::camera::Projection;

use super::nodes::PlacedNode;
use crate::flaw::Flaw;
use crate::text::shown;

/// Position and directions of a file's camera, in a frame of its own or in the world's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileCamera {
    /// The pinhole, metres.
    pub position: DVec3,
    /// Unit vector, along the view.
    pub forward: DVec3,
    /// Unit vector, up in the picture.
    pub up: DVec3,
    /// Vertical field of view.
    pub fov_y_rad: f64,
}

impl FileCamera {
    pub(super) fn moved(self, to: &DMat4) -> Self {
        let axis = |axis: DVec3| to.transform_vector3(axis).normalize_or(axis);
        Self {
            position: to.transform_point3(self.position),
            forward: axis(self.forward),
            up: axis(self.up),
            ..self
        }
    }
}

/// The camera of a name, its own or its node's, or of a number.
pub(super) fn find_camera<'p>(
    placed: &'p [PlacedNode<'p>],
    wanted: &str,
) -> Result<FileCamera, Flaw> {
    let cameras = || {
        let of_node = |it: &'p PlacedNode<'p>| Some((it, it.node.camera()?));
        placed.iter().filter_map(of_node)
    };
    let is_wanted = |(placed, camera): &(&PlacedNode, gltf::Camera)| {
        let names = [camera.name(), placed.node.name()];
        names.contains(&Some(wanted)) || wanted.parse() == Ok(camera.index())
    };
    let Some((it, camera)) = cameras().find(is_wanted) else {
        let known: Vec<_> = cameras()
            .map(|(placed, camera)| {
                let name = camera.name().or(placed.node.name());
                name.map_or_else(|| camera.index().to_string(), shown)
            })
            .collect();
        let right = match known.is_empty() {
            true => "its scene has no camera at all".to_owned(),
            false => format!("its cameras are {}", known.join(", ")),
        };
        return Err(Flaw::new(
            format!("it has no camera \"{}\"", shown(wanted)),
            right,
        ));
    };
    let Projection::Perspective(lens) = camera.projection() else {
        return Err(Flaw::new(
            format!("its camera \"{}\" is orthographic", shown(wanted)),
            "must be a perspective one",
        ));
    };
    let in_node = FileCamera {
        position: DVec3::ZERO,
        forward: DVec3::NEG_Z,
        up: DVec3::Y,
        fov_y_rad: f64::from(lens.yfov()),
    };
    Ok(in_node.moved(&it.file_from_node))
}
