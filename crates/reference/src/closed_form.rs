//! A picture by the closed forms: one ray a sample, no randomness, all cores.
//!
//! The way of a pixel is the shader's (crates/gpu/shaders/shade.wgsl): hit, `surface`, footprint, `scratches`, mask,
//! `base`, film.

use crate::light_view::LightViews;
use crate::published::Published;
use crate::scratches::{GatherCounts, Work};
use crate::silhouettes::Silhouettes;
use crate::surface::SurfacePoint;
use crate::{base, bundles, scratches, surface};
use glam::{DVec2, DVec3};
use hairline_image::Image;
use hairline_index::bundles::Bundles;
use hairline_index::{BundleIndex, Hit, ScratchIndex, TriangleIndex, TriangleLists, Watch};
use hairline_optics::ltc::ltc_sphere;
use hairline_optics::mask::Masked;
use hairline_optics::method::{Gather, Lookup, Method, PixelFilter};
use hairline_scene::camera::pixel_jitter;
use hairline_scene::{CameraFrame, Scene, ScratchTables};
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

    /// Takes what many scratches add up to as it was built before, for [`Gather::Clusters`]: of a scene as for
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

    /// What many scratches add up to, for [`Gather::Clusters`]; built when first asked for.
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

    fn is_scratched(&self, hit: &Hit) -> bool {
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
                    let smooth = silhouettes.as_ref().is_some_and(|s| s.is_smooth(x, y));
                    let samples = if smooth { 1 } else { samples };
                    let footprint_std_px = scene.render.footprint_std_px(samples);
                    let mut sum = Sample::default();
                    for i in 0..samples {
                        let pixel =
                            DVec2::new(x as f64 + 0.5, y as f64 + 0.5) + pixel_jitter(i, samples);
                        let sample = way.shade_pixel(&camera, footprint_std_px, pixel, views, work);
                        sum.base += sample.base;
                        sum.scratches += sample.scratches;
                        sum.density += sample.density;
                        sum.normal += sample.normal;
                        sum.depth_m += sample.depth_m;
                        sum.coverage += sample.coverage;
                    }
                    let mean = |v: DVec3| (v / samples as f64).as_vec3().to_array();
                    base[x] = mean(sum.base);
                    scratches[x] = mean(sum.scratches);
                    density[x] = mean(sum.density);
                    normal[x] = sum.normal.normalize_or_zero().as_vec3().to_array();
                    depth_m[x] = if sum.coverage > 0.0 {
                        (sum.depth_m / sum.coverage) as f32
                    } else {
                        0.0
                    };
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

/// What one sample adds to the film.
#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    base: DVec3,
    scratches: DVec3,
    density: DVec3,
    normal: DVec3,
    depth_m: f64,
    coverage: f64,
}

/// Renders `scene` at its own size. `progress` is told the share that is done, from any thread.
pub fn render(scene: &Scene, options: &RenderOptions, progress: &(dyn Fn(f64) + Sync)) -> Image {
    Prepared::new(scene).render(options, progress)
}

/// A scene and the method to compute it by.
struct Way<'a> {
    prepared: &'a Prepared<'a>,
    method: Method,
    /// None on the default path.
    published: Option<Published<'a>>,
}

impl<'a> Way<'a> {
    /// Builds what the method looks up beside the trees. Now, on one thread: a thread that builds it in parallel while others
    /// wait for it may take up one of their pixels meanwhile, and wait for itself.
    fn new(prepared: &'a Prepared<'a>, method: Method) -> Self {
        if method.gather.has_grids() {
            prepared.bundles();
        }
        if method.lookup == Lookup::Triangles {
            prepared.triangle_lists();
        }
        Self {
            prepared,
            method,
            published: Published::new(prepared, method),
        }
    }

    /// One ray through a point of the picture.
    fn shade_pixel(
        &self,
        camera: &CameraFrame,
        footprint_std_px: f64,
        pixel: DVec2,
        views: &mut LightViews,
        work: &mut Work,
    ) -> Sample {
        let Prepared {
            scene,
            triangles,
            tables,
            ..
        } = self.prepared;
        let ray = camera.camera_ray(pixel);
        let direction = ray.normalize();
        let Some(hit) = views.rays.intersect(triangles, camera, pixel, direction) else {
            let background = match &scene.environment {
                Some(environment) if environment.visible() => environment.radiance(direction),
                _ => DVec3::ZERO,
            };
            return Sample {
                base: background,
                ..Sample::default()
            };
        };
        let depth_m = hit.distance_m / ray.length();
        let footprint = |normal| {
            camera
                .footprint_axes(ray, depth_m, normal)
                .map(|axis| axis * footprint_std_px)
        };
        let position_m = camera.position_m + ray * depth_m;
        let point = surface::surface_point(scene, tables, position_m, -direction, footprint, &hit);
        // For a pixel that is the point in its middle nothing moves.
        let alone = (self.method.footprint == PixelFilter::Off).then(|| point.without_footprint());
        let scratched = alone.as_ref().unwrap_or(&point);
        views.look_from(scratched);
        if self.published.is_none() && self.prepared.is_scratched(&hit) {
            views.ready_for_scratches(scratched);
        }
        let masked = self.scratches(&hit, scratched, views, work);
        self.shade_surface(&masked, &point, views, depth_m)
    }

    fn shade_surface(
        &self,
        masked: &Masked,
        point: &SurfacePoint,
        views: &LightViews,
        depth_m: f64,
    ) -> Sample {
        let environment = self.prepared.scene.environment.as_ref();
        let light = match &self.published {
            None => base::base_radiance(environment, point, views, ltc_sphere),
            Some(published) => {
                base::base_radiance(environment, point, views, published.base_sphere(point))
            }
        };
        let taken = DVec3::from(masked.taken);
        // A groove interrupts the reflecting surface; what shines from under it passes.
        let fresnel = DVec3::from(point.fresnel.eval(point.wo.z));
        Sample {
            base: point.emission + light.diffuse + light.specular * (DVec3::ONE - taken),
            scratches: DVec3::from(masked.scratches) * fresnel,
            density: taken,
            normal: point.normal,
            depth_m,
            coverage: 1.0,
        }
    }

    /// Radiance of the scratches under the point's footprint and what they take from the base.
    fn scratches(
        &self,
        hit: &Hit,
        point: &SurfacePoint,
        views: &LightViews,
        work: &mut Work,
    ) -> Masked {
        let object = hit.object as usize;
        let list =
            (self.method.lookup == Lookup::Triangles).then(|| self.prepared.triangle_list(hit));
        match &self.published {
            None => {
                let sums = match self.method.gather {
                    Gather::Exact => {
                        scratches::gather_scratches(self.prepared, point, object, list, views, work)
                    }
                    Gather::Clusters | Gather::Tally => bundles::gather_bundles(
                        self.prepared,
                        point,
                        object,
                        list,
                        views,
                        self.method.gather,
                        work,
                    ),
                };
                sums.resolve(
                    self.method.mask,
                    self.prepared.scratches.depth_coherence[object] as f64,
                )
            }
            Some(published) => published.scratches(point, object, list, views),
        }
    }
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
