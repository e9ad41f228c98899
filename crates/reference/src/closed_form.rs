//! A picture by the closed forms: one ray a sample, no randomness, all cores.
//!
//! The way of a pixel is the shader's (crates/gpu/shaders/shade.wgsl): hit, `surface`, footprint, `scratches`, mask,
//! `base`, film.

mod pixel;

pub(crate) use pixel::{Picture, Sample, Seen, SeenSurface, Way};

use crate::along;
use crate::light_view::LightViews;
use crate::scratches::{GatherCounts, Work};
use crate::silhouettes::Silhouettes;
use glam::DVec2;
use hairline_image::Image;
use hairline_index::bundles::Bundles;
use hairline_index::{BundleIndex, Hit, ScratchIndex, TriangleIndex, TriangleLists, Watch};
use hairline_optics::method::{Lookup, Method};
use hairline_scene::{Scene, ScratchTables};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
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
    /// For methods that look scratches up by triangle.
    lists: OnceLock<TriangleLists>,
    /// For methods that take many scratches together.
    bundles: OnceLock<Arc<Bundles>>,
    /// Of each object, counted over the whole scene.
    first_triangles: Vec<usize>,
}

impl<'a> Prepared<'a> {
    /// Builds the trees and the tables, for the default look-up.
    pub fn new(scene: &'a Scene) -> Self {
        Self::watched(scene, Lookup::default(), &Watch::default())
            .unwrap_or_else(|| unreachable!("nobody cancels it"))
    }

    /// The same for a look-up, while another watches the tree over the scratches grow, which takes the most time. `None` if it was
    /// cancelled.
    pub fn watched(scene: &'a Scene, lookup: Lookup, watch: &Watch) -> Option<Self> {
        let (triangles, (scratches, tables)) = rayon::join(
            || TriangleIndex::build(scene),
            || {
                rayon::join(
                    || ScratchIndex::rebuild(scene, lookup, None, watch),
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
            lists: OnceLock::new(),
            bundles: OnceLock::new(),
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

    /// Takes what many scratches add up to as it was built before, for [`hairline_optics::method::Gather::Clusters`]: of a scene as for
    /// [`Self::from_parts`].
    pub fn with_bundles(mut self, bundles: Arc<Bundles>) -> Self {
        self.bundles = bundles.into();
        self
    }

    /// The same for a scene that differs in what none of this looks at: camera, lights, environment, settings.
    pub fn with_scene<'b>(&self, scene: &'b Scene) -> Prepared<'b> {
        Prepared {
            scene,
            triangles: self.triangles.clone(),
            scratches: self.scratches.clone(),
            tables: self.tables.clone(),
            lists: self.lists.clone(),
            bundles: self.bundles.clone(),
            first_triangles: self.first_triangles.clone(),
        }
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

    /// What many scratches add up to, for [`hairline_optics::method::Gather::Clusters`]; built when first asked for.
    pub fn bundle_index(&self) -> &BundleIndex {
        &self.bundles().index
    }

    pub(crate) fn bundles(&self) -> &Bundles {
        self.bundles
            .get_or_init(|| Bundles::new(self.scene, &self.scratches, &self.tables).into())
    }

    fn triangle_list(&self, hit: &Hit) -> &[u32] {
        let first = self.first_triangles[hit.object as usize];
        self.triangle_lists().of(first + hit.triangle as usize)
    }

    /// Whether the object has any scratches.
    pub(crate) fn is_scratched(&self, hit: &Hit) -> bool {
        !self.scratches.tree.objects[hit.object as usize].is_empty()
    }

    /// The tables of the scratches' profiles.
    pub fn tables(&self) -> &ScratchTables {
        &self.tables
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
        let scene = self.scene;
        let [width, height] = [scene.render.size_px[0], rows.len() as u32];
        let camera = scene.camera.frame(scene.render.size_px);
        let samples = options.samples.max(1);
        let way = Way::new(self, options.method);
        let silhouettes = (samples > 1)
            .then(|| Silhouettes::new(&self.triangles, &camera, scene.render.size_px, &rows));
        let picture = Picture {
            way: &way,
            camera,
            samples,
            silhouettes,
        };
        if along::is_for(options.method) {
            return along::render_rows(&picture, rows, progress);
        }
        let done = AtomicUsize::new(0);
        let mut image = Image::new([width, height]);
        let width = width as usize;
        let layers = (
            image.base.par_chunks_mut(width),
            image.scratches.par_chunks_mut(width),
            image.density.par_chunks_mut(width),
            image.depth_m.par_chunks_mut(width),
            image.normal.par_chunks_mut(width),
        );
        layers.into_par_iter().enumerate().for_each_init(
            || (LightViews::new(scene), Work::default()),
            |(views, work), (row, (base, scratches, density, depth_m, normal))| {
                let y = rows.start as usize + row;
                for x in 0..width {
                    let sum = picture.pixel(x, y, picture.samples_at(x, y), views, work);
                    base[x] = sum.base.as_vec3().to_array();
                    scratches[x] = sum.scratches.as_vec3().to_array();
                    density[x] = sum.density.as_vec3().to_array();
                    normal[x] = sum.normal.normalize_or_zero().as_vec3().to_array();
                    depth_m[x] = sum.depth_m as f32;
                }
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                progress(done as f64 / f64::from(height));
            },
        );
        image
    }

    /// How much work the scratches of the picture are, one sample a pixel: the sum over every `step`-th pixel of every `step`-th
    /// row, and how many of these show scratches.
    pub fn gather_counts(&self, method: Method, step: usize) -> (GatherCounts, u64) {
        let scene = self.scene;
        let [width, height] = scene.render.size_px;
        let camera = scene.camera.frame(scene.render.size_px);
        let way = Way::new(self, method);
        let footprint_std_px = scene.render.footprint_std_px(1);
        let rows: Vec<u32> = (0..height).step_by(step.max(1)).collect();
        rows.into_par_iter()
            .map_init(
                || (LightViews::new(scene), Work::default()),
                |(views, work), y| {
                    work.counts = GatherCounts::default();
                    let mut scratched = 0;
                    for x in (0..width).step_by(step.max(1)) {
                        let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                        let before = work.counts.shares + work.counts.clusters;
                        way.shade_pixel(&camera, footprint_std_px, pixel, views, work);
                        scratched += u64::from(work.counts.shares + work.counts.clusters > before);
                    }
                    (work.counts, scratched)
                },
            )
            .reduce(
                || (GatherCounts::default(), 0),
                |(mut a, n), (b, m)| {
                    a += b;
                    (a, n + m)
                },
            )
    }
}

/// How many rows a method does together, tile by tile: parts of a picture are the whole's, and take no longer, if they begin and end
/// at a multiple of this.
pub fn rows_together(method: Method) -> u32 {
    if along::is_for(method) {
        along::TILE_PX as u32
    } else {
        1
    }
}

/// Renders `scene` at its own size. `progress` is told the share that is done, from any thread.
pub fn render(scene: &Scene, options: &RenderOptions, progress: &(dyn Fn(f64) + Sync)) -> Image {
    let prepared = Prepared::watched(scene, options.method.lookup, &Watch::default());
    prepared
        .unwrap_or_else(|| unreachable!("nobody cancels it"))
        .render(options, progress)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_the_pictures() {
        let scene = Scene::from_toml(
            "[camera]\nposition_m = [0.0, -0.3, 0.3]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\n\
             [render]\nsize_px = [60, 40]\n[[material]]\nname = \"m\"\nkind = \"mirror\"\n\
             [[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.08 } }\n\
             [[scratches]]\nobject = \"o\"\npattern = \"random\"\ncount = 500\nlength_m = 0.02\nwidth_um = 2.0\n\
             depth_nm = 200.0\n[[light]]\nkind = \"sphere\"\ncenter_m = [0.0, 0.3, 0.3]\nradius_m = 0.05\nradiance = 9.0\n",
            "test",
            ".",
        )
        .unwrap_or_else(|error| panic!("{error}"));
        let options = RenderOptions {
            samples: 3,
            ..RenderOptions::default()
        };
        let prepared = Prepared::new(&scene);
        let whole = prepared.render(&options, &|_| {});
        for rows in [0..1, 0..7, 7..24, 39..40] {
            let pixels = 60 * rows.start as usize..60 * rows.end as usize;
            let some = prepared.render_rows(&options, rows, &|_| {});
            assert_eq!(some.scratches, whole.scratches[pixels.clone()]);
            assert_eq!(some.base, whole.base[pixels.clone()]);
            assert_eq!(some.depth_m, whole.depth_m[pixels]);
        }
    }
}
