//! Meshes of shapes, for tests.

use hairline_fixtures::SceneFile;
use hairline_scene::Mesh;

/// The mesh of a shape as scene files have it.
pub(crate) fn mesh(shape: &str) -> Mesh {
    let scene = SceneFile::seen_from([0.0, -1.0, 1.0])
        .mirror("m")
        .object("it", "m", shape)
        .scene();
    Mesh::clone(&scene.objects[0].mesh)
}
