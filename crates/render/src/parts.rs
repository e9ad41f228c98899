//! What renderers look up in a scene.

use std::sync::Arc;

use hairline_cpu::closed_form::Prepared;
use hairline_index::{ScratchIndex, TriangleIndex};
use hairline_scene::{Scene, ScratchTables};

/// Trees and tables of a scene, which serve it from elsewhere and in another light, too.
#[derive(Clone)]
pub struct Parts {
    /// Triangles along a ray. None: they are built when they are first needed.
    pub triangles: Option<Arc<TriangleIndex>>,
    /// The scratches.
    pub scratches: Arc<ScratchIndex>,
    /// Optical properties of the materials.
    pub tables: Arc<ScratchTables>,
}

impl Parts {
    /// The same with scratches as the camera of `scene` sees them, at the size of its picture.
    pub fn seen_from(&self, scene: &Scene) -> Self {
        Self {
            scratches: Arc::new(ScratchIndex::build(scene)),
            ..self.clone()
        }
    }

    /// Whether the pieces of scratches serve the camera of `scene`.
    pub(crate) fn serve(&self, scene: &Scene) -> bool {
        self.scratches.serves(&scene.camera, scene.render.size_px)
    }

    /// The tree over the triangles of `scene`, which is kept.
    pub(crate) fn triangles(&mut self, scene: &Scene) -> Arc<TriangleIndex> {
        let build = || Arc::new(TriangleIndex::build(scene));
        Arc::clone(self.triangles.get_or_insert_with(build))
    }

    /// A scene that has these parts, ready for the CPU renderer.
    pub fn prepared<'s>(&mut self, scene: &'s Scene) -> Prepared<'s> {
        let triangles = self.triangles(scene);
        Prepared::from_parts(
            scene,
            triangles,
            self.scratches.clone(),
            self.tables.clone(),
        )
    }
}
