//! The studio that lights a scene, and the ground under it.

use glam::DVec3;
use hairline_document::Description;
use hairline_document::description::{Ground, Studio};

use super::lights;
use crate::Selection;

/// Takes the ground away or lays it again.
pub fn toggle_ground(description: &mut Description) -> Selection {
    match &mut description.ground {
        Some(ground) => ground.hidden = !ground.hidden,
        none => *none = Some(Ground::default()),
    }
    Selection::Ground
}

/// Puts ordinary lights in the place of the studio, and its room where there is no environment: the picture stays. `bounds_m` is the box
/// around all objects.
pub fn to_lights(description: &mut Description, bounds_m: (DVec3, DVec3)) -> Selection {
    let studio = std::mem::replace(&mut description.studio, Studio::NONE);
    let first = description.lights.len();
    for light in studio.lights(&description.camera, bounds_m) {
        lights::add(description, light);
    }
    description.environment.get_or_insert_with(|| studio.room());
    Selection::Light(first)
}
