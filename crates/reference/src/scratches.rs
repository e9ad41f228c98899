//! The scratches under a footprint and the light that they send to the viewer (docs/model.md, sections 4 to 6).

use crate::closed_form::Prepared;
use crate::light_view::{LightView, LightViews};
use crate::surface::SurfacePoint;
use glam::{DVec2, DVec3};
use hairline_index::IndexedSegment;
use hairline_index::scratch_index::{FACING_MIN_COS, REACH_STD};
use hairline_optics::band::{
    BandFrame, BandLine, MovedBand, band_lines, band_move, band_reaches, band_stds, chord_cos,
    moved_band, sphere_band_extent, sphere_chord,
};
use hairline_optics::band_environment::environment_band;
use hairline_optics::footprint::{Footprint, ScratchShare, scratch_share};
use hairline_optics::mask::ScratchSums;
use hairline_optics::scratch::oblique_depth_nm;
use hairline_optics::table::ScratchTable;
use hairline_scene::Environment;

/// Adds up all scratches of an object under the point's footprint.
pub(crate) fn gather_scratches(
    prepared: &Prepared,
    point: &SurfacePoint,
    object: usize,
    list: Option<&[u32]>,
    views: &LightViews,
) -> ScratchSums {
    let mut sums = ScratchSums::default();
    let table = &prepared.tables.tables[point.table];
    each_segment(prepared, point, object, list, |segment| {
        let Some(view) = SegmentView::new(point, segment) else {
            return;
        };
        let radiance = scratch_radiance(
            &view,
            table,
            views,
            prepared.scene.environment.as_ref(),
            point,
        );
        sums.add(
            view.share,
            // In the mirror's direction both cosines are the viewer's.
            table.scratch_table_total(oblique_depth_nm(view.depth_nm, point.wo.z, point.wo.z)),
            radiance.to_array(),
        );
    });
    sums
}

/// Calls `visit` for every segment of an object that the point's footprint may touch: by the tree, or by the `list` of the
/// point's triangle.
pub(crate) fn each_segment(
    prepared: &Prepared,
    point: &SurfacePoint,
    object: usize,
    list: Option<&[u32]>,
    mut visit: impl FnMut(&IndexedSegment),
) {
    let tree = &prepared.scratches.tree;
    if let Some(list) = list {
        list.iter().for_each(|i| visit(&tree.segments[*i as usize]));
        return;
    }
    let sigma_m = point.coherence_um * 1e-6;
    // Variances of position along the world's axes; 0.7 sigma^2 covers the window across and the ends' blur along.
    let [ax, ay] = point.footprint_axes_m;
    let variance = ax * ax + ay * ay + DVec3::splat(0.7 * sigma_m * sigma_m);
    let reach = (variance.map(f64::sqrt) * REACH_STD as f64).as_vec3();
    tree.gather(object, point.position_m.as_vec3(), reach, visit);
}

/// A segment as seen from the point.
struct SegmentView {
    frame: BandFrame,
    /// `wo` in the frame of the scratch.
    wo: DVec3,
    share: ScratchShare,
    width_um: f64,
    depth_nm: f64,
    /// Distance of the scratch across its tangent.
    offset_um: f64,
    /// One standard deviation of the pixel's filter to the right and down.
    axes_um: [DVec3; 2],
    /// The footprint's variance across the scratch, and the coherence window's with it.
    variance_um2: f64,
}

impl SegmentView {
    /// None where the segment lies on another side of the surface or out of the footprint's reach.
    fn new(point: &SurfacePoint, segment: &IndexedSegment) -> Option<Self> {
        if segment.normal.as_dvec3().dot(point.normal) < FACING_MIN_COS as f64 {
            return None;
        }
        let start = point.surface_from_world(segment.start_m.as_dvec3() - point.position_m) * 1e6;
        let end = point.surface_from_world(segment.end_m.as_dvec3() - point.position_m) * 1e6;
        let along = DVec2::new(end.x - start.x, end.y - start.y);
        let length = along.length();
        if !(length > 0.0) {
            return None;
        }
        let frame = BandFrame {
            tangent: along / length,
        };
        let (start, end) = (frame.band_from_surface(start), frame.band_from_surface(end));
        let offset_um = 0.5 * (start.y + end.y);
        let axes_um = point
            .footprint_axes_m
            .map(|a| frame.band_from_surface(point.surface_from_world(a)) * 1e6);
        let [ax, ay] = axes_um;
        let footprint = Footprint {
            across_um2: ax.y * ax.y + ay.y * ay.y,
            along_um2: ax.x * ax.x + ay.x * ay.x,
            cross_um2: ax.x * ax.y + ay.x * ay.y,
        };
        let sigma = point.coherence_um;
        let variance_um2 = footprint.across_um2 + 0.5 * sigma * sigma;
        if offset_um * offset_um > (REACH_STD * REACH_STD) as f64 * variance_um2 {
            return None;
        }
        let (width_um, blur_um) = (segment.width_um as f64, segment.blur_um as f64);
        let share = scratch_share(
            width_um, offset_um, start.x, end.x, blur_um, footprint, sigma,
        );
        (share.segment > 0.0).then(|| Self {
            frame,
            wo: frame.band_from_surface(point.wo),
            share,
            width_um,
            depth_nm: segment.depth_nm as f64,
            offset_um,
            axes_um,
            variance_um2,
        })
    }

    /// The band as the pixel sees it towards a light in a direction of the scratch's frame.
    fn band(&self, point: &SurfacePoint, wi: DVec3, distance_m: f64) -> MovedBand {
        let (per_o, per_i) = (1e-6 / point.distance_m, 1e-6 / distance_m);
        let moves = std::array::from_fn(|j| {
            let turn_t = point.normal_turns[j].truncate().dot(self.frame.tangent);
            band_move(turn_t, self.axes_um[j], self.wo, per_o, wi, per_i)
        });
        let across_um = self.axes_um.map(|axis| axis.y);
        let stds = band_stds(point.coherence_um);
        moved_band(stds, moves, across_um, self.offset_um, self.variance_um2)
    }
}

/// Radiance of a scratch per unit of its share, Fresnel left out.
fn scratch_radiance(
    view: &SegmentView,
    table: &ScratchTable,
    views: &LightViews,
    environment: Option<&Environment>,
    point: &SurfacePoint,
) -> DVec3 {
    let frame = view.frame;
    let antiderivative = |cos_i: f64| {
        let depth_nm = oblique_depth_nm(view.depth_nm, cos_i, view.wo.z);
        move |q: f64| table.scratch_table(view.width_um * q, depth_nm)
    };
    let cos_over = |line, (low, high)| chord_cos(line, low, high, view.width_um);
    let mut sum = DVec3::ZERO;
    for (light, &distance_m) in views.views.iter().zip(&views.distances_m) {
        match light {
            LightView::Sphere { cap, radiance } => {
                let cap = cap.turned(frame);
                let band = view.band(point, cap.axis, distance_m);
                let (wo, stds) = (view.wo + band.shift * DVec3::X, band.stds);
                let (lowest, highest) = sphere_band_extent(wo, cap);
                let lines = band_lines(wo.x, lowest, highest, stds);
                sum += *radiance
                    * lines.integral(wo, |line| {
                        let chord = sphere_chord(line, cap);
                        let cos_i = cos_over(line, chord.range(line));
                        chord.integral(line, antiderivative(cos_i))
                    });
            }
            LightView::Polygon {
                vertices,
                away,
                facing,
                bound,
                radiance,
                ..
            } => {
                // Most scratches are dark to most lights; the bound tells it without a look at the edges.
                let bound = bound.turned(frame);
                let band = view.band(point, bound.axis, distance_m);
                let (wo, stds) = (view.wo + band.shift * DVec3::X, band.stds);
                let (lowest, highest) = sphere_band_extent(wo, bound);
                if !band_reaches(lowest, highest, stds) {
                    continue;
                }
                let polygon = views.polygon(vertices, *away, *facing);
                let (lowest, highest) = polygon.band_extent(frame, wo);
                let lines = band_lines(wo.x, lowest, highest, stds);
                if lines.count == 0 {
                    continue;
                }
                // One cosine for all lines: else the outline would be walked twice for each.
                let middle = BandLine::new(wo, lines.band_line(lines.count / 2).0);
                let cos_i = cos_over(middle, polygon.range(frame, middle));
                sum += *radiance
                    * lines.integral(wo, |line| {
                        polygon.integral(frame, line, antiderivative(cos_i))
                    });
            }
        }
    }
    if let Some(environment) = environment {
        sum += environment_radiance(view, environment, point, |q, cos_i| {
            antiderivative(cos_i)(q)
        });
    }
    sum
}

/// The 1-D integral of the environment along the band's middle line, cell by cell.
fn environment_radiance(
    view: &SegmentView,
    environment: &Environment,
    point: &SurfacePoint,
    antiderivative: impl Fn(f64, f64) -> [f64; 3],
) -> DVec3 {
    environment_band(
        BandLine::new(view.wo, 0.0),
        view.width_um,
        antiderivative,
        |direction, roughness| {
            let direction = view.frame.surface_from_band(direction);
            environment.prefiltered(point.world_from_surface(direction), roughness)
        },
    )
}
