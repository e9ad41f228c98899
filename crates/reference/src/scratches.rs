//! The scratches under a footprint and the light that they send to the viewer (docs/model.md, sections 4 to 6).

use crate::closed_form::Prepared;
use crate::light_view::LightViews;
use crate::segment_view::{Groove, SegmentView};
use crate::surface::SurfacePoint;
use glam::{DVec2, DVec3};
use hairline_index::IndexedSegment;
use hairline_index::scratch_index::{FACING_MIN_COS, REACH_STD};
use hairline_optics::band::{BandPlace, BandStds, OutlineRoots, band_stds};
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
    work: &mut Work,
) -> ScratchSums {
    let mut sums = ScratchSums::default();
    let table = &prepared.tables.tables[point.table];
    let environment = prepared.scene.environment.as_ref();
    let pixel = Pixel::new(point);
    each_segment(prepared, point, object, list, |segment| {
        work.counts.segments += 1;
        if let Some(seen) = pixel.see(segment) {
            work.counts.shares += 1;
            let radiance = seen.radiance(&pixel, table, views, environment, work);
            seen.add(&pixel, table, radiance, &mut sums);
        }
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
    let reach_m = gather_reach_m(point).as_vec3();
    tree.gather(object, point.position_m.as_vec3(), reach_m, visit);
}

/// How far a surface may be off the plane of a footprint for each length along it.
const BENDS: f64 = 0.125;

/// Half the sides of the box around a point that holds every segment with a share there, world space.
pub(crate) fn gather_reach_m(point: &SurfacePoint) -> DVec3 {
    let sigma_m = point.coherence_um * 1e-6;
    // Variances of position along the world's axes; 0.7 sigma^2 covers the window across and the ends' blur along.
    let [ax, ay] = point.footprint_axes_m;
    let variance = ax * ax + ay * ay + DVec3::splat(0.7 * sigma_m * sigma_m);
    let on_plane = variance.map(f64::sqrt);
    // The footprint lies in the plane that shading sees. Scratches lie on triangles: this one leaves it by as much as its normal is
    // another one, its neighbours by about as much again; and where a surface bends elsewhere under a footprint, by a share of its size.
    let leaves = BENDS + 2.0 * point.normal.distance(point.facet);
    let aside = leaves * variance.element_sum().sqrt();
    (on_plane + point.normal.abs() * aside) * REACH_STD as f64
}

/// A segment with less than this share of its line is left out: that is the Gaussian's tail beyond 5.5 standard deviations.
const SHARE_MIN: f64 = 2e-8;

/// A pixel as the scratches under it see it: what is the same for all of them.
#[derive(Clone, Copy)]
pub(crate) struct Pixel<'a> {
    pub point: &'a SurfacePoint,
    pub frame: PixelFrame,
}

/// What a [`Pixel`] works out of its point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PixelFrame {
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

impl PixelFrame {
    fn new(point: &SurfacePoint) -> Self {
        let steps_um = point
            .footprint_axes_m
            .map(|step| (point.surface_from_world(step) * 1e6).truncate());
        let [x, y] = steps_um;
        Self {
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
}

impl<'a> Pixel<'a> {
    pub fn new(point: &'a SurfacePoint) -> Self {
        Self {
            point,
            frame: PixelFrame::new(point),
        }
    }

    /// None where the segment lies on another side of the surface or out of the footprint's reach.
    pub fn see(&self, segment: &IndexedSegment) -> Option<SeenSegment> {
        let line = self.line(segment, f64::from(REACH_STD))?;
        let share = scratch_share(
            line.width_um,
            line.offset_um,
            line.start_um,
            line.end_um,
            line.blur_um,
            line.footprint,
            self.point.coherence_um,
        );
        (share.segment > SHARE_MIN * share.line).then_some(SeenSegment { line, share })
    }

    /// The segment's line. None where it lies on another side of the surface or more than `reach` standard deviations of the footprint
    /// away.
    pub fn line(&self, segment: &IndexedSegment, reach: f64) -> Option<SeenLine> {
        if segment.normal.as_dvec3().dot(self.point.normal) < FACING_MIN_COS as f64 {
            return None;
        }
        let local_um = |v: glam::Vec3| {
            let v = v.as_dvec3() - self.point.position_m;
            DVec2::new(v.dot(self.frame.axis_x_um), v.dot(self.frame.axis_y_um))
        };
        let (start, end) = (local_um(segment.start_m), local_um(segment.end_m));
        let along = end - start;
        let length2 = along.length_squared();
        // Distance from the line and variance across it, times the length and its square: most segments of a leaf lie out of
        // reach, which takes no root to tell.
        let area = end.perp_dot(start);
        let c = self.frame.covariance_um2;
        let across =
            c.x * along.y * along.y - 2.0 * c.y * along.x * along.y + c.z * along.x * along.x;
        let variance = across.max(0.0) + self.frame.window_um2 * length2;
        if !(length2 > 0.0) || area * area > reach * reach * variance {
            return None;
        }
        let t = along / length2.sqrt();
        Some(SeenLine {
            tangent: t,
            offset_um: area / length2.sqrt(),
            start_um: start.dot(t),
            end_um: end.dot(t),
            footprint: Footprint {
                across_um2: (c.x * t.y * t.y - 2.0 * c.y * t.x * t.y + c.z * t.x * t.x).max(0.0),
                along_um2: (c.x * t.x * t.x + 2.0 * c.y * t.x * t.y + c.z * t.y * t.y).max(0.0),
                cross_um2: (c.z - c.x) * t.x * t.y + c.y * (t.x * t.x - t.y * t.y),
            },
            width_um: segment.width_um as f64,
            depth_nm: segment.depth_nm as f64,
            blur_um: segment.blur_um as f64,
        })
    }

    /// Variance of footprint and window across a tangent.
    pub fn variance_across_um2(&self, tangent: DVec2) -> f64 {
        let [x, y] = self.frame.steps_um.map(|step| tangent.perp_dot(step));
        x * x + y * y + self.frame.window_um2
    }
}

/// The line of a segment, from a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenLine {
    /// In the surface's frame.
    pub tangent: DVec2,
    /// Of the line from the pixel's middle.
    offset_um: f64,
    /// The segment's ends, along it.
    pub start_um: f64,
    pub end_um: f64,
    pub footprint: Footprint,
    pub width_um: f64,
    pub depth_nm: f64,
    /// Standard deviation that smooths the ends.
    pub blur_um: f64,
}

impl SeenLine {
    /// The scratch as light sees it, from the pixel.
    pub fn view<'a>(&self, pixel: &Pixel, table: &'a ScratchTable) -> SegmentView<'a, 1> {
        let groove = Groove {
            table,
            width_um: self.width_um,
            depth_nm: self.depth_nm,
            moved: [0.0; 2],
            share: 1.0,
        };
        let place = BandPlace::new(
            pixel.frame.steps_um.map(|step| self.tangent.perp_dot(step)),
            self.offset_um,
            self.footprint.across_um2 + pixel.frame.window_um2,
        );
        SegmentView::new(pixel, self.tangent, [groove], place)
    }

    /// What it takes from the base, per unit of its share.
    pub fn energy(&self, pixel: &Pixel, table: &ScratchTable) -> [f64; 3] {
        // In the mirror's direction both cosines are the viewer's.
        let cos_o = pixel.point.wo.z;
        table.scratch_table_total(oblique_depth_nm(self.depth_nm, cos_o, cos_o))
    }
}

/// A segment under the footprint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenSegment {
    pub line: SeenLine,
    pub share: ScratchShare,
}

impl SeenSegment {
    /// Radiance to the viewer, per unit of the share, Fresnel left out.
    pub fn radiance(
        &self,
        pixel: &Pixel,
        table: &ScratchTable,
        views: &LightViews,
        environment: Option<&Environment>,
        work: &mut Work,
    ) -> DVec3 {
        let view = self.line.view(pixel, table);
        let mut radiance = view.lights(pixel, views, work);
        if let Some(environment) = environment {
            radiance += view.environment(pixel, environment);
        }
        radiance
    }

    /// Adds it to a footprint's sums.
    pub fn add(
        &self,
        pixel: &Pixel,
        table: &ScratchTable,
        radiance: DVec3,
        sums: &mut ScratchSums,
    ) {
        let energy = self.line.energy(pixel, table);
        sums.add(self.share, energy, radiance.to_array());
    }
}

/// What the work on one scratch leaves for the next to fill again.
#[derive(Default)]
pub(crate) struct Work {
    pub roots: OutlineRoots,
    pub middle_roots: OutlineRoots,
    /// Scratches under a footprint.
    pub seen: Vec<SeenSegment>,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{Seen, Way};
    use hairline_optics::method::Method;
    use hairline_scene::Scene;

    /// A dish of three cones, whose shading normals are those of its triangles only at its flat bottom: a walk of the tree finds what
    /// a look at all scratches finds.
    #[test]
    fn the_box_holds_what_has_a_share() {
        let text = "[camera]\nposition_m = [0.0, -0.20, 0.17]\ntarget_m = [0.045, 0.0, 0.003]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 9.0\n\
             [render]\nsize_px = [48, 32]\n\
             [[material]]\nname = \"m\"\nkind = \"metal\"\nmetal = \"steel\"\nroughness = 0.1\n\
             [[object]]\nname = \"o\"\nmaterial = \"m\"\n\
             shape = { lathe = { profile_m = [[0.0, 0.0], [0.04, 0.0], [0.05, 0.004], [0.066, 0.006]] } }\n\
             [[scratches]]\nobject = \"o\"\npattern = \"random\"\ncount = 4000\nseed = 3\nlength_m = 0.01\nwidth_um = 3.0\ndepth_nm = 200.0\n\
             [[light]]\nkind = \"sphere\"\ncenter_m = [0.1, 0.2, 0.3]\nradius_m = 0.01\nradiance = 100.0\n";
        let scene = Scene::from_toml(text, "test", ".").unwrap_or_else(|error| panic!("{error}"));
        let prepared = Prepared::new(&scene);
        let way = Way::new(&prepared, Method::default());
        let mut views = LightViews::new(&scene);
        let camera = scene.camera.frame(scene.render.size_px);
        let std_px = scene.render.footprint_std_px(1);
        let all: Vec<u32> = (0..prepared.scratches.tree.segments.len() as u32).collect();
        let (mut lost, mut sum, mut bent) = (0.0, 0.0, 0);
        for (x, y) in (0..32).flat_map(|y| (0..48).map(move |x| (x, y))) {
            let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let Seen::Surface(seen) = way.look(&camera, std_px, middle, &mut views.rays) else {
                continue;
            };
            let (point, object) = (&seen.point, seen.hit.object as usize);
            bent += usize::from(point.normal.distance(point.facet) > 0.02);
            let pixel = Pixel::new(point);
            let [found, expected] = [None, Some(all.as_slice())].map(|list| {
                let mut shares = 0.0;
                each_segment(&prepared, point, object, list, |segment| {
                    shares += pixel.see(segment).map_or(0.0, |seen| seen.share.segment);
                });
                shares
            });
            lost += (expected - found) * (expected - found);
            sum += expected * expected;
        }
        assert!(bent > 500, "{bent}");
        // 5e-4 of a Gaussian lies beyond the reach.
        let lost = f64::sqrt(lost / sum);
        assert!(lost < 1e-3, "{lost}");
    }
}
