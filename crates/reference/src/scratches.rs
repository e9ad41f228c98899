//! The scratches under a footprint and the light that they send to the viewer (docs/model.md, sections 4 to 6).

use crate::closed_form::Prepared;
use crate::light_view::{LightView, LightViews};
use crate::surface::SurfacePoint;
use glam::{DVec2, DVec3};
use hairline_index::IndexedSegment;
use hairline_index::scratch_index::{FACING_MIN_COS, REACH_STD};
use hairline_optics::band::{
    BandFrame, BandLine, BandMotion, BandPlace, BandStds, Cap, Outline, OutlineRoots,
    band_is_whole, band_lines, band_stds, chord_cos, sphere_band_extent, sphere_chord,
};
use hairline_optics::band_environment::environment_band;
use hairline_optics::footprint::{Footprint, ScratchShare, scratch_share};
use hairline_optics::mask::ScratchSums;
use hairline_optics::scratch::oblique_depth_nm;
use hairline_optics::table::{ScratchTable, TableRow};
use hairline_scene::Environment;

/// Adds up all scratches of an object under the point's footprint.
pub(crate) fn gather_scratches(
    prepared: &Prepared,
    point: &SurfacePoint,
    object: usize,
    list: Option<&[u32]>,
    views: &LightViews,
    work: &mut Work,
) -> ScratchSums {
    let mut sums = ScratchSums::default();
    let table = &prepared.tables.tables[point.table];
    let environment = prepared.scene.environment.as_ref();
    let pixel = Pixel::new(point);
    each_segment(prepared, point, object, list, |segment| {
        work.counts.segments += 1;
        let Some(view) = pixel.see(segment) else {
            return;
        };
        work.counts.shares += 1;
        let mut radiance = view.lights(&pixel, table, views, work);
        if let Some(environment) = environment {
            radiance += view.environment(&pixel, table, environment);
        }
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

/// A segment with less than this share of its line is left out: that is the Gaussian's tail beyond 5.5 standard deviations.
const SHARE_MIN: f64 = 2e-8;

/// A pixel as the scratches under it see it: what is the same for all of them.
pub(crate) struct Pixel<'a> {
    pub point: &'a SurfacePoint,
    /// The surface's axes in world space, to micrometres.
    axis_x_um: DVec3,
    axis_y_um: DVec3,
    /// How the point moves by one standard deviation of the pixel's filter to the right and down, in the surface's frame.
    steps_um: [DVec2; 2],
    /// Of both steps: xx, xy, yy.
    pub covariance_um2: DVec3,
    /// The coherence window's variance.
    pub window_um2: f64,
    /// Of the band that a pixel without perspective sees.
    pub stds: BandStds,
}

impl<'a> Pixel<'a> {
    pub fn new(point: &'a SurfacePoint) -> Self {
        let steps_um = point
            .footprint_axes_m
            .map(|step| (point.surface_from_world(step) * 1e6).truncate());
        let [x, y] = steps_um;
        Self {
            point,
            axis_x_um: point.axis_x * 1e6,
            axis_y_um: point.axis_y * 1e6,
            steps_um,
            covariance_um2: DVec3::new(
                x.x * x.x + y.x * y.x,
                x.x * x.y + y.x * y.y,
                x.y * x.y + y.y * y.y,
            ),
            window_um2: 0.5 * point.coherence_um * point.coherence_um,
            stds: band_stds(point.coherence_um),
        }
    }

    /// None where the segment lies on another side of the surface or out of the footprint's reach.
    fn see(&self, segment: &IndexedSegment) -> Option<SegmentView> {
        if segment.normal.as_dvec3().dot(self.point.normal) < FACING_MIN_COS as f64 {
            return None;
        }
        let local_um = |v: glam::Vec3| {
            let v = v.as_dvec3() - self.point.position_m;
            DVec2::new(v.dot(self.axis_x_um), v.dot(self.axis_y_um))
        };
        let (start, end) = (local_um(segment.start_m), local_um(segment.end_m));
        let along = end - start;
        let length2 = along.length_squared();
        // Distance from the line and variance across it, times the length and its square: most segments of a leaf lie out of
        // reach, which takes no root to tell.
        let area = end.perp_dot(start);
        let c = self.covariance_um2;
        let across =
            c.x * along.y * along.y - 2.0 * c.y * along.x * along.y + c.z * along.x * along.x;
        let variance = across.max(0.0) + self.window_um2 * length2;
        if !(length2 > 0.0) || area * area > (REACH_STD * REACH_STD) as f64 * variance {
            return None;
        }
        let t = along / length2.sqrt();
        let offset_um = area / length2.sqrt();
        let footprint = Footprint {
            across_um2: (c.x * t.y * t.y - 2.0 * c.y * t.x * t.y + c.z * t.x * t.x).max(0.0),
            along_um2: (c.x * t.x * t.x + 2.0 * c.y * t.x * t.y + c.z * t.y * t.y).max(0.0),
            cross_um2: (c.z - c.x) * t.x * t.y + c.y * (t.x * t.x - t.y * t.y),
        };
        let (width_um, blur_um) = (segment.width_um as f64, segment.blur_um as f64);
        let share = scratch_share(
            width_um,
            offset_um,
            start.dot(t),
            end.dot(t),
            blur_um,
            footprint,
            self.point.coherence_um,
        );
        (share.segment > SHARE_MIN * share.line).then(|| {
            let frame = BandFrame { tangent: t };
            let variance_um2 = footprint.across_um2 + self.window_um2;
            SegmentView {
                frame,
                wo: frame.band_from_surface(self.point.wo),
                share,
                width_um,
                depth_nm: segment.depth_nm as f64,
                turn_rad2: 0.0,
                place: BandPlace::new(
                    self.steps_um.map(|step| t.perp_dot(step)),
                    offset_um,
                    variance_um2,
                ),
                variance_um2,
            }
        })
    }
}

/// What the work on one scratch leaves for the next to fill again.
#[derive(Default)]
pub(crate) struct Work {
    roots: OutlineRoots,
    middle_roots: OutlineRoots,
    pub counts: GatherCounts,
}

/// How much work finding and lighting scratches was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GatherCounts {
    /// Vertices of grids that were looked for.
    pub nodes: u64,
    /// Segments of leaves that were looked at.
    pub segments: u64,
    /// Of these, those under the footprint.
    pub shares: u64,
    /// Vertices that were found.
    pub clusters: u64,
    /// Pairs of a scratch and a light of which the one was asked whether it reaches the other.
    pub pairs: u64,
    /// Of these, lit ones: integrals over a light.
    pub lit: u64,
}

impl std::ops::AddAssign for GatherCounts {
    fn add_assign(&mut self, other: Self) {
        self.nodes += other.nodes;
        self.segments += other.segments;
        self.shares += other.shares;
        self.clusters += other.clusters;
        self.pairs += other.pairs;
        self.lit += other.lit;
    }
}

/// A segment as seen from the point.
pub(crate) struct SegmentView {
    frame: BandFrame,
    /// `wo` in the frame of the scratch.
    wo: DVec3,
    share: ScratchShare,
    width_um: f64,
    depth_nm: f64,
    /// Variance of the tangent's angle about it; 0 for a single scratch.
    turn_rad2: f64,
    place: BandPlace,
    variance_um2: f64,
}

impl SegmentView {
    /// What stands for many scratches of one direction, which lie all over the footprint: with them the band is as wide as it moves
    /// over the whole pixel.
    pub fn of_many(
        pixel: &Pixel,
        tangent: DVec2,
        width_um: f64,
        depth_nm: f64,
        turn_rad2: f64,
    ) -> Self {
        let frame = BandFrame { tangent };
        let across_um = pixel.steps_um.map(|step| tangent.perp_dot(step));
        let variance_um2 =
            across_um[0] * across_um[0] + across_um[1] * across_um[1] + pixel.window_um2;
        Self {
            frame,
            wo: frame.band_from_surface(pixel.point.wo),
            share: ScratchShare {
                segment: 1.0,
                line: 1.0,
            },
            width_um,
            depth_nm,
            turn_rad2,
            // They lie on both sides, as far as the footprint goes: to none of them does the place across tell how ξt moves.
            place: BandPlace::new([0.0; 2], 0.0, pixel.window_um2),
            variance_um2,
        }
    }

    /// Variance across of footprint and window.
    pub fn variance_um2(&self) -> f64 {
        self.variance_um2
    }

    /// Radiance by way of the lights, per unit of the share, Fresnel left out.
    fn lights(
        &self,
        pixel: &Pixel,
        table: &ScratchTable,
        views: &LightViews,
        work: &mut Work,
    ) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for light in 0..views.views.len() {
            sum += self.light(pixel, table, views, light, work);
        }
        sum
    }

    /// Radiance by way of one light.
    pub fn light(
        &self,
        pixel: &Pixel,
        table: &ScratchTable,
        views: &LightViews,
        light: usize,
        work: &mut Work,
    ) -> DVec3 {
        let (light, moves) = (&views.views[light], views.moves[light]);
        let tangent = self.frame.tangent;
        let mut motion = self.place.moved(moves.map(|m| m.dot(tangent)));
        let (LightView::Sphere { cap: bound, .. } | LightView::Polygon { bound, .. }) = light;
        work.counts.pairs += 1;
        if self.turn_rad2 > 0.0 {
            let sum = pixel.point.wo.truncate() + bound.cos_radius * bound.axis.truncate();
            let aside = tangent.perp_dot(sum);
            motion.variance += self.turn_rad2 * aside * aside;
        }
        // Most scratches are dark to most lights.
        let along = tangent.dot(bound.axis.truncate());
        if !self.may_meet(pixel, along, bound, motion) {
            return DVec3::ZERO;
        }
        match light {
            LightView::Sphere { cap, radiance } => {
                *radiance * self.sphere(pixel, table, *cap, motion, work)
            }
            LightView::Polygon {
                vertices,
                away,
                facing,
                sets,
                radiance,
                ..
            } => {
                let outline = views.outline(vertices, *away, *facing, *sets);
                *radiance * self.polygon(pixel, table, outline, motion, work)
            }
        }
    }

    /// Whether the band can meet a cap whose axis has the component `along` on the tangent.
    fn may_meet(&self, pixel: &Pixel, along: f64, cap: &Cap, motion: BandMotion) -> bool {
        let middle = self.wo.x + motion.shift + along * cap.cos_radius;
        // Around the pole of the tangent a cap reaches further.
        along.abs() >= cap.cos_radius
            || motion.reaches(
                middle - cap.sin_radius,
                middle + cap.sin_radius,
                pixel.stds.mean,
            )
    }

    /// T over u at the depth for light with a cosine to the normal.
    fn row<'t>(&self, table: &'t ScratchTable, cos_i: f64) -> TableRow<'t> {
        table.at_depth(oblique_depth_nm(self.depth_nm, cos_i, self.wo.z))
    }

    /// By a sphere of radiance 1.
    fn sphere(
        &self,
        pixel: &Pixel,
        table: &ScratchTable,
        cap: Cap,
        motion: BandMotion,
        work: &mut Work,
    ) -> DVec3 {
        let cap = cap.turned(self.frame);
        let wo = self.wo + motion.shift * DVec3::X;
        let (lowest, highest) = sphere_band_extent(wo, cap);
        if !motion.reaches(lowest, highest, pixel.stds.mean) {
            return DVec3::ZERO;
        }
        work.counts.lit += 1;
        let lines = band_lines(wo.x, lowest, highest, motion.band(pixel.stds).stds);
        lines.integral(wo, |line| {
            let chord = sphere_chord(line, cap);
            let (low, high) = chord.range(line);
            let row = self.row(table, chord_cos(line, low, high, self.width_um));
            chord.integral(line, |q| row.at(self.width_um * q))
        })
    }

    /// By a polygon of radiance 1.
    fn polygon(
        &self,
        pixel: &Pixel,
        table: &ScratchTable,
        outline: Outline,
        motion: BandMotion,
        work: &mut Work,
    ) -> DVec3 {
        let wo = self.wo + motion.shift * DVec3::X;
        // Large lights cover the whole band, and their corners tell so.
        let (low, high) = outline.corner_extent(self.frame);
        let std = motion.widened(pixel.stds.mean);
        if band_is_whole(wo.x, wo.x + low, wo.x + high, std) {
            work.counts.lit += 1;
            let line = BandLine::new(wo, 0.0);
            let row = self.outline_row(table, outline, line, &mut work.roots);
            return work.roots.integral(|q| row.at(self.width_um * q)).into();
        }
        let (lowest, highest) = outline.band_extent(self.frame, wo.x);
        if !motion.reaches(lowest, highest, pixel.stds.mean) {
            return DVec3::ZERO;
        }
        work.counts.lit += 1;
        let lines = band_lines(wo.x, lowest, highest, motion.band(pixel.stds).stds);
        // One cosine for all lines, that of the middle one.
        let middle = lines.middle_line(wo);
        let row = self.outline_row(table, outline, middle, &mut work.middle_roots);
        lines.integral(wo, |line| {
            let roots = if line == middle {
                &work.middle_roots
            } else {
                outline.roots(self.frame, line, &mut work.roots);
                &work.roots
            };
            roots.integral(|q| row.at(self.width_um * q))
        })
    }

    /// The roots of a polygon on a line, and T at the depth for light from there.
    fn outline_row<'t>(
        &self,
        table: &'t ScratchTable,
        outline: Outline,
        line: BandLine,
        roots: &mut OutlineRoots,
    ) -> TableRow<'t> {
        outline.roots(self.frame, line, roots);
        let (low, high) = roots.range;
        self.row(table, chord_cos(line, low, high, self.width_um))
    }

    /// By the environment, along the band's middle line, cell by cell.
    pub fn environment(
        &self,
        pixel: &Pixel,
        table: &ScratchTable,
        environment: &Environment,
    ) -> DVec3 {
        environment_band(
            BandLine::new(self.wo, 0.0),
            self.width_um,
            |q, cos_i| self.row(table, cos_i).at(self.width_um * q),
            |direction, roughness| {
                let direction = self.frame.surface_from_band(direction);
                environment.prefiltered(pixel.point.world_from_surface(direction), roughness)
            },
        )
    }
}
