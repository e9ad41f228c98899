//! The way of a pixel: what its ray meets, its surface, its scratches and its base.

use super::Prepared;
use crate::camera_beam::CameraBeam;
use crate::light_view::LightViews;
use crate::published::Published;
use crate::scratches::Work;
use crate::silhouettes::Silhouettes;
use crate::surface::SurfacePoint;
use crate::{base, bundles, scratches, surface};
use glam::{DVec2, DVec3};
use hairline_index::Hit;
use hairline_optics::ltc::ltc_sphere;
use hairline_optics::mask::Masked;
use hairline_optics::method::{Gather, Lookup, Method, PixelFilter};
use hairline_scene::CameraFrame;
use hairline_scene::camera::pixel_jitter;

/// A scene and the method to compute it by.
pub(crate) struct Way<'a> {
    pub prepared: &'a Prepared<'a>,
    pub method: Method,
    /// None on the default path.
    published: Option<Published<'a>>,
}

impl<'a> Way<'a> {
    /// Builds what the method looks up beside the trees. Now, on one thread: a thread that builds it in parallel while others
    /// wait for it may take up one of their pixels meanwhile, and wait for itself.
    pub fn new(prepared: &'a Prepared<'a>, method: Method) -> Self {
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
    pub fn shade_pixel(
        &self,
        camera: &CameraFrame,
        footprint_std_px: f64,
        pixel: DVec2,
        views: &mut LightViews,
        work: &mut Work,
    ) -> Sample {
        let SeenSurface {
            hit,
            point,
            depth_m,
        } = match self.look(camera, footprint_std_px, pixel, &mut views.rays) {
            Seen::Background(radiance) => return Sample::background(radiance),
            Seen::Surface(surface) => surface,
        };
        let alone = self.alone(&point);
        let scratched = alone.as_ref().unwrap_or(&point);
        views.look_from(scratched);
        if self.published.is_none() && self.prepared.is_scratched(&hit) {
            views.ready_for_scratches(scratched);
        }
        let masked = self.scratches(&hit, scratched, views, work);
        self.shade_surface(&masked, &point, views, depth_m)
    }

    /// What a ray through a point of the picture meets. `rays` is what is kept from one pixel to the next, row by row.
    pub fn look(
        &self,
        camera: &CameraFrame,
        footprint_std_px: f64,
        pixel: DVec2,
        rays: &mut CameraBeam,
    ) -> Seen {
        let Prepared {
            scene,
            triangles,
            tables,
            ..
        } = self.prepared;
        let ray = camera.camera_ray(pixel);
        let direction = ray.normalize();
        let Some(hit) = rays.intersect(triangles, camera, pixel, direction) else {
            return Seen::Background(match &scene.environment {
                Some(environment) if environment.visible() => environment.radiance(direction),
                _ => DVec3::ZERO,
            });
        };
        let depth_m = hit.distance_m / ray.length();
        let footprint = |normal| {
            camera
                .footprint_axes(ray, depth_m, normal)
                .map(|axis| axis * footprint_std_px)
        };
        let position_m = camera.position_m + ray * depth_m;
        let point = surface::surface_point(scene, tables, position_m, -direction, footprint, &hit);
        Seen::Surface(SeenSurface {
            hit,
            point,
            depth_m,
        })
    }

    /// The point as its scratches see it, where that is not the point itself: for a pixel that is the point in its middle nothing
    /// moves.
    pub fn alone(&self, point: &SurfacePoint) -> Option<SurfacePoint> {
        (self.method.footprint == PixelFilter::Off).then(|| point.without_footprint())
    }

    /// Base and scratches of a point.
    pub fn shade_surface(
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

/// A scene, how to compute it, and from where.
pub(crate) struct Picture<'a> {
    pub way: &'a Way<'a>,
    pub camera: CameraFrame,
    /// Of pixels that are not smooth.
    pub samples: u32,
    pub silhouettes: Option<Silhouettes>,
}

impl Picture<'_> {
    /// How many samples a pixel needs.
    pub fn samples_at(&self, x: usize, y: usize) -> u32 {
        let smooth = self.silhouettes.as_ref().is_some_and(|s| s.is_smooth(x, y));
        if smooth { 1 } else { self.samples }
    }

    /// The mean of so many samples of a pixel.
    pub fn pixel(
        &self,
        x: usize,
        y: usize,
        samples: u32,
        views: &mut LightViews,
        work: &mut Work,
    ) -> Sample {
        let footprint_std_px = self.way.prepared.scene.render.footprint_std_px(samples);
        let mut sum = Sample::default();
        let mut coverage = 0.0;
        for i in 0..samples {
            let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) + pixel_jitter(i, samples);
            let sample = self
                .way
                .shade_pixel(&self.camera, footprint_std_px, pixel, views, work);
            sum.base += sample.base;
            sum.scratches += sample.scratches;
            sum.density += sample.density;
            sum.normal += sample.normal;
            sum.depth_m += sample.depth_m;
            coverage += f64::from(sample.depth_m > 0.0);
        }
        let per_sample = 1.0 / f64::from(samples);
        Sample {
            base: sum.base * per_sample,
            scratches: sum.scratches * per_sample,
            density: sum.density * per_sample,
            normal: sum.normal,
            depth_m: sum.depth_m / f64::max(coverage, 1.0),
        }
    }
}

/// What one sample adds to the film, or the mean of several. Depths are the mean of those samples that see a surface.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sample {
    pub base: DVec3,
    pub scratches: DVec3,
    pub density: DVec3,
    /// Not of unit length.
    pub normal: DVec3,
    /// 0 for the background.
    pub depth_m: f64,
}

impl Sample {
    pub fn background(radiance: DVec3) -> Self {
        Self {
            base: radiance,
            ..Self::default()
        }
    }
}

/// What a ray through a point of the picture meets.
#[expect(
    clippy::large_enum_variant,
    reason = "there is one at a time, and most are surfaces"
)]
pub(crate) enum Seen {
    /// Nothing: radiance of the environment.
    Background(DVec3),
    Surface(SeenSurface),
}

/// A point of a surface under a pixel.
pub(crate) struct SeenSurface {
    pub hit: Hit,
    pub point: SurfacePoint,
    /// Along the view axis.
    pub depth_m: f64,
}
