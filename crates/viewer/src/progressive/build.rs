//! A description made ready to be painted.

use std::sync::Arc;
use std::time::Duration;

use hairline_document::description::Description;
use hairline_document::{Loader, SceneBuilder};
use hairline_image::FilePath;
use hairline_index::{Pieces, ScratchIndex, TriangleIndex, Watch};
use hairline_render::Parts;
use hairline_scene::{Scene, ScratchTables};
use web_time::Instant;

use super::View;
use super::sketch::Sketch;

/// A scene with all that painting and picking look up.
#[derive(Clone)]
pub struct Built {
    /// Revision of the description.
    pub revision: u64,
    /// Time of the interface's order.
    pub asked: Instant,
    /// Description that it was made from.
    pub description: Arc<Description>,
    /// The scene.
    pub scene: Scene,
    /// Triangles along a ray.
    pub triangles: Arc<TriangleIndex>,
    /// The scratches; a sketch has no trees of them.
    pub scratches: Arc<ScratchIndex>,
    /// Optical properties of the materials.
    pub tables: Arc<ScratchTables>,
    /// Number of pieces of scratches that are looked at for a picture.
    pub segments: usize,
    /// Weights of its scratches, if the scene has only some of them.
    pub(crate) sketch: Option<Sketch>,
    /// Time of each stage.
    pub stages: BuildStages,
}

/// Time for which a scene waited, and that of each stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildStages {
    /// Time from the request to the start, while the scene before it was built.
    pub waited: Duration,
    /// Files, meshes, scratches laid.
    pub scene: Duration,
    /// Trees over triangles and scratches.
    pub index: Duration,
    /// Spectral tables.
    pub tables: Duration,
}

impl Built {
    /// Whether the scene has only some of the scratches, which stand for all of them.
    pub fn is_sketch(&self) -> bool {
        self.sketch.is_some()
    }

    /// What renderers look up in it.
    pub(crate) fn parts(&self) -> Parts {
        Parts {
            triangles: Some(Arc::clone(&self.triangles)),
            scratches: Arc::clone(&self.scratches),
            tables: Arc::clone(&self.tables),
        }
    }

    /// Numbers of scratches and of straight pieces in the scene.
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

/// Builds scenes one after the other, and keeps the trees and tables of unchanged parts.
#[derive(Default)]
pub(crate) struct ViewBuilder {
    scenes: SceneBuilder,
    last: Option<LastBuild>,
    /// Builder of sketches, until a whole scene is built.
    sketches: Option<SceneBuilder>,
}

struct LastBuild {
    description: Arc<Description>,
    scene: Scene,
    triangles: Arc<TriangleIndex>,
    scratches: Arc<ScratchIndex>,
    tables: Arc<ScratchTables>,
}

impl ViewBuilder {
    /// Whether a whole scene was ever built.
    pub fn has_built(&self) -> bool {
        self.last.is_some()
    }

    /// Builds a sketch of a scene whose scratches are to be laid anew, in a small part of the time; none where all of it is soon
    /// built, or cannot be.
    pub fn sketch(
        &mut self,
        revision: u64,
        asked: Instant,
        description: &Arc<Description>,
        base_dir: &FilePath,
    ) -> Option<Built> {
        let start = Instant::now();
        let last = self.last.as_ref();
        if last.is_some_and(|last| {
            last.description.scratches == description.scratches
                && last.description.objects == description.objects
        }) {
            return None;
        }
        let (few, sketch) = Sketch::from_description(description)?;
        let scenes = self.sketches.get_or_insert_with(|| self.scenes.clone());
        // Errors are reported for the whole scene.
        let scene = scenes.build(&Loader::default(), &few, base_dir).ok()?;
        if self.last.is_none() {
            // Surfaces and maps are read once.
            self.scenes = scenes.clone();
        }
        let scene_done = Instant::now();
        let triangles = triangles(&scene, last);
        let scratches = Arc::new(ScratchIndex::without_trees(&scene));
        let segments: usize = scene.objects.iter().map(|o| o.segments.len()).sum();
        let index_done = Instant::now();
        let tables = match last {
            Some(last) if last.tables.are_of(&scene) => Arc::clone(&last.tables),
            _ => Arc::new(ScratchTables::new(&scene)),
        };
        Some(Built {
            revision,
            asked,
            description: Arc::clone(description),
            segments: (segments as f64 * sketch.thin()) as usize,
            sketch: Some(sketch),
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
        })
    }

    /// Builds a scene for a view of it; none where `cancelled` says so, which is asked from any thread.
    ///
    /// # Errors
    /// As [`Loader::build`]; what was kept stays.
    pub fn build(
        &mut self,
        cancelled: &(dyn Fn() -> bool + Sync),
        revision: u64,
        asked: Instant,
        description: Arc<Description>,
        base_dir: &FilePath,
        view: Option<View>,
    ) -> Result<Option<Built>, hairline_document::Error> {
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
        let triangles = triangles(&scene, last);
        let Some(scratches) = scratches(&scene, view, last, cancelled) else {
            return Ok(None);
        };
        let index_done = Instant::now();
        let tables = match last {
            Some(last) if last.tables.are_of(&scene) => Arc::clone(&last.tables),
            _ => match ScratchTables::unless(&scene, cancelled) {
                Some(tables) => Arc::new(tables),
                None => return Ok(None),
            },
        };
        self.sketches = None;
        self.last = Some(LastBuild {
            description: Arc::clone(&description),
            scene: scene.clone(),
            triangles: Arc::clone(&triangles),
            scratches: Arc::clone(&scratches),
            tables: Arc::clone(&tables),
        });
        Ok(Some(Built {
            revision,
            asked,
            description,
            segments: scratches.tree.segments.len(),
            sketch: None,
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

fn triangles(scene: &Scene, last: Option<&LastBuild>) -> Arc<TriangleIndex> {
    match last {
        Some(last) if has_same_meshes(&last.scene, scene) => Arc::clone(&last.triangles),
        _ => Arc::new(TriangleIndex::build(scene)),
    }
}

/// Scratches of a scene for a view of it; none where `cancelled` says so.
fn scratches(
    scene: &Scene,
    view: Option<View>,
    last: Option<&LastBuild>,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Arc<ScratchIndex>> {
    let mut viewed = scene.clone();
    if let Some(View {
        camera, size_px, ..
    }) = view
    {
        (viewed.camera, viewed.render.size_px) = (camera, size_px);
    }
    if let Some(last) = last
        && has_same_scratches(&last.scene, scene)
        && (last.scratches).serves(&viewed.camera, viewed.render.size_px)
    {
        return Some(Arc::clone(&last.scratches));
    }
    let before = last.map(|last| (&last.scene, &*last.scratches));
    let watch = Watch {
        cancelled,
        ..Watch::default()
    };
    ScratchIndex::rebuild(&viewed, Pieces::Near, before, &watch).map(Arc::new)
}

fn has_same_meshes(a: &Scene, b: &Scene) -> bool {
    a.objects.len() == b.objects.len()
        && std::iter::zip(&a.objects, &b.objects).all(|(a, b)| Arc::ptr_eq(&a.mesh, &b.mesh))
}

/// Whether two scenes have equal scratches. These depend on the coherence of the material under them.
fn has_same_scratches(a: &Scene, b: &Scene) -> bool {
    has_same_meshes(a, b)
        && std::iter::zip(&a.objects, &b.objects).all(|(a, b)| {
            Arc::ptr_eq(&a.scratches, &b.scratches) && Arc::ptr_eq(&a.segments, &b.segments)
        })
        && a.materials.len() == b.materials.len()
        && std::iter::zip(&a.materials, &b.materials).all(|(a, b)| a.coherence_um == b.coherence_um)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_fixtures::{DISK, SceneFile};

    /// A wide scratch has a table of its own: pictures would look for it where the tables were of narrow ones.
    #[test]
    fn tables_are_those_of_the_scratches() {
        let mut builder = ViewBuilder::default();
        for (width_um, shapes) in [(2.0, 1), (30.0, 2), (2.0, 1)] {
            let description = SceneFile::seen_from([0.0, -0.3, 0.3])
                .metal("steel", "steel")
                .object("plate", "steel", DISK)
                .random("plate", 20)
                .with_lines(&format!("width_um = {width_um:?}"))
                .description();
            let now = Instant::now();
            let built = builder.build(
                &|| false,
                1,
                now,
                Arc::new(description),
                &FilePath::default(),
                None,
            );
            let built = built.unwrap().unwrap();
            assert_eq!(built.tables.shapes.count(), shapes, "{width_um} um");
            assert!(built.tables.are_of(&built.scene));
        }
    }
}
