//! The light on a scratch: on the middle line of its band, by steps.

use super::Published;
use super::segment::SegmentView;
use crate::polygon::{clip_triangle, triangle_segments};
use crate::segments::BandSegments;
use crate::spectrum::PublishedSpectrum;
use crate::sphere::sphere_segments;
use glam::DVec3;
use hairline_cpu::method::{LightView, LightViews};
use hairline_cpu::surface::SurfacePoint;
use hairline_optics::band::BandLine;
use hairline_optics::band_environment::environment_band;

impl Published<'_> {
    /// Radiance of a scratch for a share of 1, without Fresnel's factor.
    pub(super) fn radiance(
        &self,
        view: &SegmentView,
        spectrum: &PublishedSpectrum,
        views: &LightViews,
        point: &SurfacePoint,
    ) -> DVec3 {
        let [width_um, depth_nm] = [view.profile.width_um, view.profile.depth_nm].map(f64::from);
        let over = |segments: &BandSegments| {
            DVec3::from(spectrum.radiance(segments, width_um, depth_nm, self.method.si))
        };
        let mut sum = DVec3::ZERO;
        for view_of_light in &views.views {
            match view_of_light {
                LightView::Sphere { cap, radiance } => {
                    sum += *radiance * over(&sphere_segments(view.wo, cap.turned(view.frame)));
                }
                LightView::Polygon {
                    light,
                    vertices,
                    radiance,
                    ..
                } => {
                    let vertices = &views.vertices[vertices.clone()];
                    let mean = *radiance * views.picture_mean(view_of_light);
                    for corners in &self.triangles[*light] {
                        let clipped = clip_triangle(corners.map(|i| vertices[i]));
                        for triangle in clipped.triangles() {
                            let triangle =
                                triangle.map(|corner| view.frame.band_from_surface(corner));
                            let segments = triangle_segments(view.wo, triangle);
                            if segments.count > 0 {
                                sum += mean * over(&segments);
                            }
                        }
                    }
                }
            }
        }
        if let Some(environment) = &self.prepared.scene().environment {
            sum += environment_band(
                BandLine::new(view.wo, 0.0),
                width_um,
                |q, _| {
                    let mut segments = BandSegments::default();
                    segments.push_segment(0.0, q);
                    over(&segments).to_array()
                },
                |direction, roughness| {
                    let direction = view.frame.surface_from_band(direction);
                    environment.prefiltered(point.world_from_surface(direction), roughness)
                },
            );
        }
        sum
    }
}
