//! The light on a scratch: on one line of its band or several, by steps or by roots.

use super::Published;
use super::response::Response;
use super::segment::SegmentView;
use crate::light_view::{LightView, LightViews};
use crate::surface::SurfacePoint;
use glam::DVec3;
use hairline_optics::band::{
    BandLine, Cap, MovedBand, band_lines, chord_cos, sphere_band_extent, sphere_chord,
};
use hairline_optics::band_environment::environment_band;
use hairline_optics::method::{Band, Chords};
use hairline_optics::published::polygon::{clip_triangle, triangle_segments};
use hairline_optics::published::sphere::sphere_segments;
use hairline_optics::scratch::oblique_depth_nm;

/// A polygon for the steps: vertices relative to the point, in its surface's frame, and its triangles as corners into them.
#[derive(Clone, Copy)]
struct Triangles<'a> {
    vertices: &'a [DVec3],
    corners: &'a [[usize; 3]],
}

impl Published<'_> {
    /// Radiance of a scratch per unit of its share, Fresnel left out.
    pub(super) fn radiance(
        &self,
        view: &SegmentView,
        response: Response,
        views: &LightViews,
        point: &SurfacePoint,
    ) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for (light, &distance_m) in views.views.iter().zip(&views.distances_m) {
            match light {
                LightView::Sphere { cap, radiance } => {
                    let cap = cap.turned(view.frame);
                    let band = || view.band(point, cap.axis, distance_m);
                    sum += *radiance * self.sphere(view, response, cap, band);
                }
                LightView::Polygon {
                    light,
                    vertices,
                    away,
                    facing,
                    bound,
                    radiance,
                    ..
                } => {
                    let triangles = Triangles {
                        vertices: &views.vertices[vertices.clone()],
                        corners: &self.triangles[*light],
                    };
                    let on_line = |line: BandLine, depth_nm: f64| match self.method.chords {
                        Chords::Steps => by_steps(view, response, triangles, line, depth_nm),
                        Chords::Roots => {
                            let at = |q| response.up_to(q, view.width_um, depth_nm);
                            views
                                .polygon(vertices, *away, *facing)
                                .integral(view.frame, line, at)
                        }
                    };
                    sum += *radiance
                        * match self.method.band {
                            Band::MiddleLine => {
                                DVec3::from(on_line(BandLine::new(view.wo, 0.0), view.depth_nm))
                            }
                            Band::Lines => {
                                let towards = bound.turned(view.frame).axis;
                                let band = view.band(point, towards, distance_m);
                                let wo = view.wo + band.shift * DVec3::X;
                                let polygon = views.polygon(vertices, *away, *facing);
                                let (lowest, highest) = polygon.band_extent(view.frame, wo);
                                let lines = band_lines(wo.x, lowest, highest, band.stds);
                                if lines.count == 0 {
                                    continue;
                                }
                                let middle = BandLine::new(wo, lines.band_line(lines.count / 2).0);
                                let range = polygon.range(view.frame, middle);
                                let depth_nm = chord_depth_nm(view, middle, range);
                                lines.integral(wo, |line| on_line(line, depth_nm))
                            }
                        };
                }
            }
        }
        if let Some(environment) = &self.prepared.scene.environment {
            sum += environment_band(
                BandLine::new(view.wo, 0.0),
                view.width_um,
                |q, cos_i| {
                    let depth_nm = match self.method.band {
                        Band::Lines => oblique_depth_nm(view.depth_nm, cos_i, view.wo.z),
                        Band::MiddleLine => view.depth_nm,
                    };
                    response.up_to(q, view.width_um, depth_nm)
                },
                |direction, roughness| {
                    let direction = view.frame.surface_from_band(direction);
                    environment.prefiltered(point.world_from_surface(direction), roughness)
                },
            );
        }
        sum
    }

    /// By a sphere of radiance 1.
    fn sphere(
        &self,
        view: &SegmentView,
        response: Response,
        cap: Cap,
        band: impl Fn() -> MovedBand,
    ) -> DVec3 {
        let on_line = |line: BandLine, depth_nm: f64| match self.method.chords {
            Chords::Steps => {
                let segments = sphere_segments(line_wo(view.wo, line), cap);
                response.over(&segments, view.width_um, depth_nm)
            }
            Chords::Roots => {
                let at = |q| response.up_to(q, view.width_um, depth_nm);
                sphere_chord(line, cap).integral(line, at)
            }
        };
        match self.method.band {
            Band::MiddleLine => on_line(BandLine::new(view.wo, 0.0), view.depth_nm).into(),
            Band::Lines => {
                let band = band();
                let wo = view.wo + band.shift * DVec3::X;
                let (lowest, highest) = sphere_band_extent(wo, cap);
                let lines = band_lines(wo.x, lowest, highest, band.stds);
                lines.integral(wo, |line| {
                    let range = sphere_chord(line, cap).range(line);
                    on_line(line, chord_depth_nm(view, line, range))
                })
            }
        }
    }
}

/// A polygon of radiance 1 on a line, triangle by triangle.
fn by_steps(
    view: &SegmentView,
    response: Response,
    polygon: Triangles,
    line: BandLine,
    depth_nm: f64,
) -> [f64; 3] {
    let wo = line_wo(view.wo, line);
    let mut sum = [0.0; 3];
    for corners in polygon.corners {
        let clipped = clip_triangle(corners.map(|i| polygon.vertices[i]));
        for triangle in clipped.triangles() {
            let triangle = triangle.map(|corner| view.frame.band_from_surface(corner));
            let segments = triangle_segments(wo, triangle);
            if segments.count > 0 {
                let part = response.over(&segments, view.width_um, depth_nm);
                (0..3).for_each(|c| sum[c] += part[c]);
            }
        }
    }
    sum
}

/// The viewer for whom a line is the middle one: what the steps take.
fn line_wo(wo: DVec3, line: BandLine) -> DVec3 {
    wo.with_x(-line.along)
}

/// The groove's depth for light from a part of a line.
fn chord_depth_nm(view: &SegmentView, line: BandLine, (low, high): (f64, f64)) -> f64 {
    let cos_i = chord_cos(line, low, high, view.width_um);
    oblique_depth_nm(view.depth_nm, cos_i, view.wo.z)
}
