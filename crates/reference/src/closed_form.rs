//! A picture by the closed forms: one ray a sample, no randomness, all cores.
//!
//! The way of a pixel is the shader's (crates/gpu/shaders/shade.wgsl): hit, `surface`, footprint, `scratches`, mask,
//! `base`, film.

use crate::light_view::LightViews;
use crate::silhouettes::Silhouettes;
use crate::surface::SurfacePoint;
use crate::{base, scratches, surface};
use glam::{DVec2, DVec3};
use hairline_image::Image;
use hairline_index::{ScratchIndex, TriangleIndex};
use hairline_optics::mask::{Mask, ScratchSums};
use hairline_optics::method::Method;
use hairline_scene::camera::pixel_jitter;
use hairline_scene::{CameraFrame, Scene, ScratchTables};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

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
    pub(crate) triangles: TriangleIndex,
    pub(crate) scratches: ScratchIndex,
    pub(crate) tables: ScratchTables,
}

impl<'a> Prepared<'a> {
    /// Builds the trees and the tables.
    pub fn new(scene: &'a Scene) -> Self {
        let (triangles, (scratches, tables)) = rayon::join(
            || TriangleIndex::build(scene),
            || rayon::join(|| ScratchIndex::build(scene), || ScratchTables::new(scene)),
        );
        Self {
            scene,
            triangles,
            scratches,
            tables,
        }
    }

    /// The tree over the scratches.
    pub fn scratches(&self) -> &ScratchIndex {
        &self.scratches
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
            || LightViews::new(scene),
            |views, (row, (base, scratches, density, depth_m, normal))| {
                let y = rows.start as usize + row;
                for x in 0..width {
                    let smooth = silhouettes.as_ref().is_some_and(|s| s.is_smooth(x, y));
                    let samples = if smooth { 1 } else { samples };
                    let footprint_std_px = scene.render.footprint_std_px(samples);
                    let mut sum = Sample::default();
                    for i in 0..samples {
                        let pixel =
                            DVec2::new(x as f64 + 0.5, y as f64 + 0.5) + pixel_jitter(i, samples);
                        let sample = shade_pixel(
                            self,
                            options.method.mask,
                            &camera,
                            footprint_std_px,
                            pixel,
                            views,
                        );
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

/// One ray through a point of the picture.
fn shade_pixel(
    prepared: &Prepared,
    mask: Mask,
    camera: &CameraFrame,
    footprint_std_px: f64,
    pixel: DVec2,
    views: &mut LightViews,
) -> Sample {
    let scene = prepared.scene;
    let ray = camera.camera_ray(pixel);
    let direction = ray.normalize();
    let Some(hit) = prepared.triangles.intersect(camera.position_m, direction) else {
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
    let point = surface::surface_point(
        prepared.scene,
        &prepared.tables,
        camera.position_m + ray * depth_m,
        -direction,
        footprint,
        &hit,
    );
    views.look_from(&point);
    let sums = scratches::gather_scratches(prepared, &point, hit.object as usize, views);
    let object = hit.object as usize;
    shade_surface(prepared, mask, object, &point, &sums, views, depth_m)
}

fn shade_surface(
    prepared: &Prepared,
    mask: Mask,
    object: usize,
    point: &SurfacePoint,
    sums: &ScratchSums,
    views: &LightViews,
    depth_m: f64,
) -> Sample {
    let masked = sums.resolve(mask, prepared.scratches.depth_coherence[object] as f64);
    let taken = DVec3::from(masked.taken);
    let light = base::base_radiance(prepared.scene.environment.as_ref(), point, views);
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
