//! A scene with the trees and tables that the stages look up. It knows no stage.

use crate::draft::Draft;
use crate::sampling::environment::EnvironmentSampler;
use crate::shade_scratches::{ALIKE_ON_BUMPS_RAD, alike_rad};
use hairline_index::{
    Hit, IndexedProfile, IndexedSegment, Pieces, ScratchIndex, TriangleIndex, Watch,
};
use hairline_optics::table::ScratchTable;
use hairline_scene::{Scene, ScratchTables};
use std::sync::{Arc, OnceLock};

/// A scene with everything that rendering looks up.
pub struct Prepared<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) triangles: Arc<TriangleIndex>,
    pub(crate) scratches: Arc<ScratchIndex>,
    /// The pieces as they were laid, for methods of others.
    laid: OnceLock<Arc<ScratchIndex>>,
    pub(crate) tables: Arc<ScratchTables>,
    /// Stands for the scratches in a picture that need not be exact.
    pub(crate) draft: Option<Arc<Draft>>,
    /// Sampler of rays to the environment.
    sampler: OnceLock<EnvironmentSampler>,
    /// How far normals may differ at which the environment counts as the same.
    alike_rad: OnceLock<f64>,
}

impl<'a> Prepared<'a> {
    /// Builds the trees and the tables.
    pub fn new(scene: &'a Scene) -> Self {
        Self::watched(scene, Pieces::Seen, &Watch::default())
            .unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// Prepares the scene; a watch follows the building of the tree over the scratches, which takes the most time. `None` if it was
    /// cancelled.
    pub fn watched(scene: &'a Scene, pieces: Pieces, watch: &Watch) -> Option<Self> {
        let (triangles, (scratches, tables)) = rayon::join(
            || TriangleIndex::build(scene),
            || {
                rayon::join(
                    || ScratchIndex::rebuild(scene, pieces, None, watch),
                    || ScratchTables::new(scene),
                )
            },
        );
        let prepared = Self::from_parts(scene, triangles.into(), scratches?.into(), tables.into());
        Some(prepared)
    }

    /// Takes trees and tables that were built before, of `scene` or of one with the same surfaces, scratches and materials.
    pub fn from_parts(
        scene: &'a Scene,
        triangles: Arc<TriangleIndex>,
        scratches: Arc<ScratchIndex>,
        tables: Arc<ScratchTables>,
    ) -> Self {
        Self {
            scene,
            triangles,
            scratches,
            laid: OnceLock::new(),
            tables,
            draft: None,
            sampler: OnceLock::new(),
            alike_rad: OnceLock::new(),
        }
    }

    /// Shares the structures with a scene that differs only in camera, lights, environment or settings. A camera that comes much nearer
    /// or goes far away needs other pieces of scratches.
    pub fn with_scene<'b>(&self, scene: &'b Scene) -> Prepared<'b> {
        let serves = self.scratches.serves(&scene.camera, scene.render.size_px);
        Prepared {
            scene,
            triangles: self.triangles.clone(),
            scratches: match serves {
                true => self.scratches.clone(),
                false => Arc::new(ScratchIndex::build(scene)),
            },
            laid: self.laid.clone(),
            tables: self.tables.clone(),
            draft: self.draft.clone(),
            sampler: OnceLock::new(),
            alike_rad: OnceLock::new(),
        }
    }

    /// Replaces the scratches by a few of them, each of which stands for many. For Hairline's own method; others take all. There is no
    /// tree over them: where light comes from other objects, these have no scratches.
    pub fn with_draft(mut self, draft: Arc<Draft>) -> Self {
        self.draft = Some(draft);
        self
    }

    /// Draws the scratches as they were laid, and lights each at each pixel, as the packages for other programs do: they know no arcs and no places.
    pub fn as_laid(mut self) -> Self {
        self.scratches = Arc::clone(self.laid());
        self.alike_rad = OnceLock::from(0.0);
        self
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The tree over the triangles.
    pub fn triangles(&self) -> &Arc<TriangleIndex> {
        &self.triangles
    }

    /// The tree over the scratches.
    pub fn scratches(&self) -> &Arc<ScratchIndex> {
        &self.scratches
    }

    /// The tree over the scratches as they were laid: methods of others know no arcs. It is built at the first call.
    pub fn laid(&self) -> &Arc<ScratchIndex> {
        match self.scratches.is_laid() {
            true => &self.scratches,
            false => (self.laid).get_or_init(|| Arc::new(ScratchIndex::laid(self.scene))),
        }
    }

    /// Sampler of directions to the environment, if there is one. It is built at the first call, and not for each part of a picture.
    pub(crate) fn environment_sampler(&self) -> Option<&EnvironmentSampler> {
        let environment = self.scene.environment.as_ref()?;
        let sampler = || EnvironmentSampler::new(environment);
        Some(self.sampler.get_or_init(sampler))
    }

    /// The largest distance between the normals of two points of a material that the environment, if there is one, lights alike.
    pub(crate) fn alike_rad(&self, material: usize) -> f64 {
        let environment = self.scene.environment.as_ref();
        let by_environment = *(self.alike_rad).get_or_init(|| environment.map_or(0.0, alike_rad));
        let material = &self.scene.materials[material];
        match material.normal_texture.is_some() || material.has_coat_normals() {
            true => by_environment.min(ALIKE_ON_BUMPS_RAD),
            false => by_environment,
        }
    }

    /// Whether the object has any scratches.
    pub(crate) fn is_scratched(&self, hit: &Hit) -> bool {
        let object = hit.object as usize;
        match &self.draft {
            Some(draft) => !draft.objects[object].is_empty(),
            None => !self.scratches.tree.objects[object].is_empty(),
        }
    }

    /// Whether the object has gratings.
    pub(crate) fn has_gratings(&self, hit: &Hit) -> bool {
        !self.scene.objects[hit.object as usize].gratings.is_empty()
    }

    /// Coherence of the phase steps of an object's scratches.
    pub(crate) fn depth_coherence(&self, object: u32) -> f64 {
        self.scratches.depth_coherence[object as usize].into()
    }

    /// The tables of the scratches' profiles.
    pub fn tables(&self) -> &ScratchTables {
        &self.tables
    }

    /// Returns the table of a scratch, where those of the material begin at `first`.
    #[inline]
    pub(crate) fn scratch_table(&self, first: usize, profile: IndexedProfile) -> &ScratchTable {
        &self.tables.tables[first + usize::from(profile.shape)]
    }

    /// The pieces that `project` lists, and how many of each there are; 1 where it says nothing.
    pub(crate) fn segments(&self) -> (&[IndexedSegment], &[f32]) {
        match &self.draft {
            Some(draft) => (&draft.segments, &draft.weights),
            None => (&self.scratches.tree.segments, &[]),
        }
    }
}
