//! A picture by the closed forms: one ray a sample, no randomness, all cores.
//!
//! The stages are the GPU's. Segments are projected and listed for the whole of the rows in hand; then a tile is a task, from the
//! surface under its pixels to the film.

use crate::bin::TileLists;
use crate::draft::Draft;
use crate::project::project;
use crate::published::Published;
use crate::tile::{By, Picture};
use crate::visibility::Visibility;
use hairline_image::Image;
use hairline_index::{Hit, IndexedSegment, ScratchIndex, TriangleIndex, TriangleLists, Watch};
use hairline_optics::method::Method;
use hairline_scene::{Scene, ScratchTables};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// How to render, beside what the scene says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// Jittered samples of a pixel on an edge or a crease; all other pixels, and all of them for 1, take one through the
    /// centre.
    pub samples: u32,
    /// By which method scratches are computed.
    pub method: Method,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            samples: 1,
            method: Method::default(),
        }
    }
}

/// A scene with everything that rendering looks up.
pub struct Prepared<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) triangles: Arc<TriangleIndex>,
    pub(crate) scratches: Arc<ScratchIndex>,
    pub(crate) tables: Arc<ScratchTables>,
    /// Stands for the scratches in a picture that need not be exact.
    pub(crate) draft: Option<Arc<Draft>>,
    /// For methods that look scratches up by triangle.
    lists: OnceLock<TriangleLists>,
    /// Of each object, counted over the whole scene.
    first_triangles: Vec<usize>,
}

impl<'a> Prepared<'a> {
    /// Builds the trees and the tables.
    pub fn new(scene: &'a Scene) -> Self {
        Self::watched(scene, &Watch::default()).unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// The same while another watches the tree over the scratches grow, which takes the most time. `None` if it was cancelled.
    pub fn watched(scene: &'a Scene, watch: &Watch) -> Option<Self> {
        let (triangles, (scratches, tables)) = rayon::join(
            || TriangleIndex::build(scene),
            || {
                rayon::join(
                    || ScratchIndex::rebuild(scene, None, watch),
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
            tables,
            draft: None,
            lists: OnceLock::new(),
            first_triangles: scene
                .objects
                .iter()
                .scan(0, |next, object| {
                    let first = *next;
                    *next += object.mesh.triangles.len();
                    Some(first)
                })
                .collect(),
        }
    }

    /// The same for a scene that differs in what none of this looks at: camera, lights, environment, settings.
    pub fn with_scene<'b>(&self, scene: &'b Scene) -> Prepared<'b> {
        Prepared {
            scene,
            triangles: self.triangles.clone(),
            scratches: self.scratches.clone(),
            tables: self.tables.clone(),
            draft: self.draft.clone(),
            lists: self.lists.clone(),
            first_triangles: self.first_triangles.clone(),
        }
    }

    /// The same with a few of the scratches, each of which stands for many. For Hairline's own method; that of 2018 takes all.
    pub fn with_draft(mut self, draft: Arc<Draft>) -> Self {
        self.draft = Some(draft);
        self
    }

    /// The tree over the scratches.
    pub fn scratches(&self) -> &Arc<ScratchIndex> {
        &self.scratches
    }

    /// The scratches that each triangle's points may see without a footprint; built when first asked for.
    pub fn triangle_lists(&self) -> &TriangleLists {
        self.lists
            .get_or_init(|| TriangleLists::build(self.scene, &self.scratches))
    }

    pub(crate) fn triangle_list(&self, hit: &Hit) -> &[u32] {
        let first = self.first_triangles[hit.object as usize];
        self.triangle_lists().of(first + hit.triangle as usize)
    }

    /// Whether the object has any scratches.
    pub(crate) fn is_scratched(&self, hit: &Hit) -> bool {
        let object = hit.object as usize;
        match &self.draft {
            Some(draft) => !draft.objects[object].is_empty(),
            None => !self.scratches.tree.objects[object].is_empty(),
        }
    }

    /// How alike the phase steps of an object's scratches are.
    pub(crate) fn depth_coherence(&self, object: u32) -> f64 {
        self.scratches.depth_coherence[object as usize].into()
    }

    /// The tables of the scratches' profiles.
    pub fn tables(&self) -> &ScratchTables {
        &self.tables
    }

    /// The pieces that `project` lists, and how many of each there are; 1 where it says nothing.
    pub(crate) fn segments(&self) -> (&[IndexedSegment], &[f32]) {
        match &self.draft {
            Some(draft) => (&draft.segments, &draft.weights),
            None => (&self.scratches.tree.segments, &[]),
        }
    }

    /// Renders the picture. `progress` is told the share that is done, from any thread.
    pub fn render(&self, options: &RenderOptions, progress: &(dyn Fn(f64) + Sync)) -> Image {
        self.render_rows(options, 0..self.scene.render.size_px[1], progress)
    }

    /// Renders some rows of the picture; the image is as high as they are many. `progress` is told the share that is
    /// done, from any thread.
    pub fn render_rows(
        &self,
        options: &RenderOptions,
        rows: Range<u32>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Image {
        self.render_counted(options, rows, progress).0
    }

    /// The same, and how much work its scratches were.
    pub fn render_counted(
        &self,
        options: &RenderOptions,
        rows: Range<u32>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> (Image, Counts) {
        self.render_unless(&|| false, options, rows, progress)
            .unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// The same, unless `cancelled` says so, which is asked from any thread, before each tile: then there is nothing.
    pub fn render_unless(
        &self,
        cancelled: &(dyn Fn() -> bool + Sync),
        options: &RenderOptions,
        rows: Range<u32>,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Option<(Image, Counts)> {
        let (picture, mut counts) = self.picture(options, rows, cancelled);
        if cancelled() {
            return None;
        }
        let width = self.scene.render.size_px[0];
        let mut image = Image::new([width, picture.rows.len() as u32]);
        counts = counts + picture.render(&mut image, progress, cancelled)?;
        Some((image, counts))
    }

    /// Renders anew those pixels of some rows that have an edge or a crease. `image` has these rows, of one sample a pixel, and becomes
    /// what [`Self::render_rows`] makes of more. None if it was cancelled, as by [`Self::render_unless`].
    pub fn refine_edges_unless(
        &self,
        cancelled: &(dyn Fn() -> bool + Sync),
        options: &RenderOptions,
        rows: Range<u32>,
        mut image: Image,
    ) -> Option<Image> {
        let (mut picture, _) = self.picture(options, rows, cancelled);
        if cancelled() {
            return None;
        }
        picture.only_edges = true;
        picture.render(&mut image, &|_| {}, cancelled)?;
        Some(image)
    }

    /// The stages before the tiles. Of no use if they were cancelled.
    pub(crate) fn picture(
        &self,
        options: &RenderOptions,
        rows: Range<u32>,
        cancelled: &(dyn Fn() -> bool + Sync),
    ) -> (Picture<'_>, Counts) {
        let scene = self.scene;
        let size_px = scene.render.size_px;
        let camera = scene.camera.frame(size_px);
        let mut counts = Counts::default();
        let by = match options.method.published {
            None => {
                let projection = project(self, &camera, &rows, options.samples, cancelled);
                counts.segments = projection.looked_at;
                let lists = TileLists::new(projection.segments, size_px[0], &rows);
                counts.entries = lists.len() as u64;
                By::Tiles(lists)
            }
            Some(published) => By::Published(Published::new(self, published, options.method.mask)),
        };
        let picture = Picture {
            prepared: self,
            camera,
            options: *options,
            rows: rows.start as usize..rows.end as usize,
            only_edges: false,
            visibility: Visibility::new(&self.triangles, &camera, size_px, &rows),
            by,
        };
        (picture, counts)
    }
}

/// Pixels to a side of a tile. Parts of a picture that begin and end at a multiple of it cost no more than in the whole.
pub const TILE_PX: u32 = 8;

/// How much work the scratches of a picture are, counted where it is done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Segments that were projected.
    pub segments: u64,
    /// Entries of tile lists.
    pub entries: u64,
    /// Tests of a segment at a pixel.
    pub tests: u64,
    /// Pairs of a pixel and a segment with a share.
    pub pairs: u64,
    /// Lights of a pair that were asked whether they reach it.
    pub asked: u64,
    /// Of these, the lights that do: integrals over a light.
    pub lit: u64,
}

impl std::ops::Add for Counts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            segments: self.segments + other.segments,
            entries: self.entries + other.entries,
            tests: self.tests + other.tests,
            pairs: self.pairs + other.pairs,
            asked: self.asked + other.asked,
            lit: self.lit + other.lit,
        }
    }
}

/// Renders `scene` at its own size. `progress` is told the share that is done, from any thread.
pub fn render(scene: &Scene, options: &RenderOptions, progress: &(dyn Fn(f64) + Sync)) -> Image {
    Prepared::new(scene).render(options, progress)
}

#[cfg(test)]
mod tests;
