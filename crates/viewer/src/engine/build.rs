//! A description made ready to be painted.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use hairline_index::{ScratchIndex, TriangleIndex, Watch};
use hairline_scene::description::Description;
use hairline_scene::{Loader, Scene, SceneBuilder, ScratchTables};
use web_time::Instant;

/// A scene with all that painting and picking look up.
pub struct Built {
    /// Of the description.
    pub revision: u64,
    /// When the interface asked for it.
    pub asked: Instant,
    /// What it was made from.
    pub description: Arc<Description>,
    /// The scene.
    pub scene: Scene,
    /// Triangles along a ray.
    pub triangles: Arc<TriangleIndex>,
    /// The scratches.
    pub scratches: Arc<ScratchIndex>,
    /// What the materials mean to the physics.
    pub tables: Arc<ScratchTables>,
    /// How long each stage took.
    pub stages: BuildStages,
}

/// How long a scene waited and took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildStages {
    /// From the wish to the start: what the scene before it still took.
    pub waited: Duration,
    /// Files, meshes, scratches laid.
    pub scene: Duration,
    /// Trees over triangles and scratches.
    pub index: Duration,
    /// Spectral tables.
    pub tables: Duration,
}

impl Built {
    /// How many scratches and straight pieces it has.
    pub fn scratch_counts(&self) -> (usize, usize) {
        self.scene
            .objects
            .iter()
            .fold((0, 0), |(scratches, segments), object| {
                (
                    scratches + object.scratches.len(),
                    segments + object.segments.len(),
                )
            })
    }
}

/// Builds scenes one after the other, and keeps the trees and tables of what has not changed.
#[derive(Default)]
pub(super) struct Workshop {
    scenes: SceneBuilder,
    last: Option<Kept>,
}

struct Kept {
    scene: Scene,
    triangles: Arc<TriangleIndex>,
    scratches: Arc<ScratchIndex>,
    tables: Arc<ScratchTables>,
}

impl Workshop {
    /// Gives up where `cancelled` says so, which is asked from any thread: then there is none.
    ///
    /// # Errors
    /// As [`Loader::build`]; what was kept stays.
    pub fn build(
        &mut self,
        cancelled: &(dyn Fn() -> bool + Sync),
        revision: u64,
        asked: Instant,
        description: Arc<Description>,
        base_dir: &Path,
    ) -> Result<Option<Built>, hairline_scene::Error> {
        let start = Instant::now();
        let loader = Loader {
            cancelled,
            ..Loader::default()
        };
        let scene = match self.scenes.build(&loader, &description, base_dir) {
            Err(error) if error.is_cancelled() => return Ok(None),
            scene => scene?,
        };
        let scene_done = Instant::now();
        let last = self.last.as_ref();
        let triangles = match last {
            Some(last) if has_same_meshes(&last.scene, &scene) => Arc::clone(&last.triangles),
            _ => Arc::new(TriangleIndex::build(&scene)),
        };
        let scratches = match last {
            Some(last) if has_same_scratches(&last.scene, &scene) => Arc::clone(&last.scratches),
            _ => {
                let before = last.map(|last| (&last.scene, &*last.scratches));
                let watch = Watch {
                    cancelled,
                    ..Watch::default()
                };
                match ScratchIndex::rebuild(&scene, before, &watch) {
                    Some(scratches) => Arc::new(scratches),
                    None => return Ok(None),
                }
            }
        };
        let index_done = Instant::now();
        let tables = match last {
            Some(last) if has_same_optics(&last.scene, &scene) => Arc::clone(&last.tables),
            _ => Arc::new(ScratchTables::new(&scene)),
        };
        self.last = Some(Kept {
            scene: scene.clone(),
            triangles: Arc::clone(&triangles),
            scratches: Arc::clone(&scratches),
            tables: Arc::clone(&tables),
        });
        Ok(Some(Built {
            revision,
            asked,
            description,
            scene,
            triangles,
            scratches,
            tables,
            stages: BuildStages {
                waited: start - asked,
                scene: scene_done - start,
                index: index_done - scene_done,
                tables: index_done.elapsed(),
            },
        }))
    }
}

fn has_same_meshes(a: &Scene, b: &Scene) -> bool {
    a.objects.len() == b.objects.len()
        && std::iter::zip(&a.objects, &b.objects).all(|(a, b)| Arc::ptr_eq(&a.mesh, &b.mesh))
}

/// Scratches know the coherence of the material under them.
fn has_same_scratches(a: &Scene, b: &Scene) -> bool {
    has_same_meshes(a, b)
        && std::iter::zip(&a.objects, &b.objects).all(|(a, b)| {
            Arc::ptr_eq(&a.scratches, &b.scratches) && Arc::ptr_eq(&a.segments, &b.segments)
        })
        && a.materials.len() == b.materials.len()
        && std::iter::zip(&a.materials, &b.materials).all(|(a, b)| a.coherence_um == b.coherence_um)
}

fn has_same_optics(a: &Scene, b: &Scene) -> bool {
    a.materials == b.materials
}
