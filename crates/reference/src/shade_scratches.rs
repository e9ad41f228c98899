//! Stage 5, shade scratches: the scratches under the points of a tile and the light that they send to the viewer (docs/model.md,
//! sections 4 to 6). Twin: shade_scratches.wgsl.
//!
//! Segment by segment of the tile's list: eight points at once are tested whether they see it, then each that does asks those lights
//! which can reach the segment from any point of the tile.

mod lanes;
mod light_bounds;
mod scratch_light;

use crate::closed_form::{Counts, Prepared};
use crate::light_view::LightViews;
use crate::project::Projected;
use crate::surface::SurfacePoint;
use glam::DVec2;
use hairline_index::IndexedSegment;
use hairline_optics::band::{BandPlace, BandStds, OutlineRoots, band_stds};
use hairline_optics::footprint::ScratchShare;
use hairline_optics::mask::ScratchSums;
use hairline_optics::scratch::oblique_depth_nm;
use lanes::{GROUPS, Group, LANES, Line, Seen};
use light_bounds::LightBounds;
use pulp::Arch;
use scratch_light::ScratchLight;

/// Points that are shaded together.
pub(crate) const BATCH: usize = GROUPS * LANES;

/// A point of a surface with scratches, in the picture.
pub(crate) struct ScratchPoint<'a> {
    pub point: &'a SurfacePoint<'a>,
    pub object: u32,
    pub at_px: DVec2,
    /// The lights from there, ready for scratches.
    pub views: &'a LightViews<'a>,
    /// Index into the sums.
    pub index: usize,
}

/// What of a point is the same for all scratches.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// How the point moves by one standard deviation of the pixel's filter to the right and down, in the surface's frame.
    steps_um: [DVec2; 2],
    /// The coherence window's variance.
    window_um2: f64,
    /// Of the band that a pixel without perspective sees.
    stds: BandStds,
}

impl Frame {
    fn new(point: &SurfacePoint) -> Self {
        Self {
            steps_um: point
                .footprint_axes_m
                .map(|step| (point.surface_from_world(step) * 1e6).truncate()),
            window_um2: 0.5 * point.coherence_um * point.coherence_um,
            stds: band_stds(point.coherence_um),
        }
    }
}

/// Shades batches of points. One for each thread: what it holds is filled anew for each batch.
pub(crate) struct ScratchShader {
    arch: Arch,
    frames: Vec<Frame>,
    groups: Vec<Group>,
    bounds: LightBounds,
    /// Lights that can reach the segment in hand.
    lit: Vec<u32>,
    roots: [OutlineRoots; 2],
}

impl ScratchShader {
    pub fn new() -> Self {
        Self {
            arch: Arch::new(),
            frames: Vec::with_capacity(BATCH),
            groups: Vec::with_capacity(GROUPS),
            bounds: LightBounds::default(),
            lit: Vec::new(),
            roots: Default::default(),
        }
    }

    /// Adds up what the points see of the segments of a list, in its order.
    pub fn shade<'l>(
        &mut self,
        prepared: &Prepared,
        points: &[ScratchPoint],
        list: impl Iterator<Item = &'l Projected>,
        sums: &mut [ScratchSums],
        counts: &mut Counts,
    ) {
        self.frames.clear();
        self.frames
            .extend(points.iter().map(|p| Frame::new(p.point)));
        self.groups.clear();
        for (points, frames) in points.chunks(LANES).zip(self.frames.chunks(LANES)) {
            self.groups.push(Group::new(points, frames));
        }
        self.bounds.gather(points, &self.frames);
        let arch = self.arch;
        let (segments, weights) = prepared.segments();
        let mut shading = Shading {
            prepared,
            points,
            shader: self,
            sums,
            counts,
        };
        // Compiled for the vectors of this processor, with all that is inlined.
        arch.dispatch(
            #[inline(always)]
            || {
                for projected in list {
                    let at = projected.segment as usize;
                    let weight = weights.get(at).map_or(1.0, |&weight| f64::from(weight));
                    shading.add(&segments[at], projected, weight);
                }
            },
        );
    }
}

/// A batch that is being shaded.
struct Shading<'a, 's> {
    prepared: &'a Prepared<'a>,
    points: &'a [ScratchPoint<'a>],
    shader: &'s mut ScratchShader,
    sums: &'s mut [ScratchSums],
    counts: &'s mut Counts,
}

impl Shading<'_, '_> {
    #[inline(always)]
    fn add(&mut self, segment: &IndexedSegment, projected: &Projected, weight: f64) {
        let line = Line::new(projected);
        let mut is_new = true;
        for i in 0..self.shader.groups.len() {
            let group = &self.shader.groups[i];
            if !group.is_near(&line) {
                continue;
            }
            self.counts.tests += LANES as u64;
            let Some(seen) = group.see(segment, projected.object) else {
                continue;
            };
            if is_new {
                self.shader.bounds.find(segment, &mut self.shader.lit);
                is_new = false;
            }
            self.light(segment, i * LANES, &seen, weight);
        }
    }

    /// Adds the light of a segment, times `weight`, to those points of a group that see it.
    #[inline(always)]
    fn light(&mut self, segment: &IndexedSegment, first: usize, seen: &Seen, weight: f64) {
        let environment = self.prepared.scene.environment.as_ref();
        let (width_um, depth_nm) = (f64::from(segment.width_um), f64::from(segment.depth_nm));
        for lane in 0..LANES {
            let Some(mut share) = seen.share(lane, width_um) else {
                continue;
            };
            // As many scratches, each of which is as long a line.
            share.segment *= weight;
            self.counts.pairs += 1;
            let point = &self.points[first + lane];
            let frame = &self.shader.frames[first + lane];
            let table = &self.prepared.tables.tables[point.point.table];
            let mut radiance = glam::DVec3::ZERO;
            if !self.shader.lit.is_empty() || environment.is_some() {
                let tangent = seen.tangent(lane);
                let place = BandPlace::new(
                    frame.steps_um.map(|step| tangent.perp_dot(step)),
                    seen.offset_um[lane],
                    seen.variance_um2[lane],
                );
                let light = ScratchLight::new(point.point.wo, tangent, table, width_um, depth_nm);
                for &index in &self.shader.lit {
                    if let Some(view) = point.views.view_of(index) {
                        self.counts.asked += 1;
                        let roots = &mut self.shader.roots;
                        if let Some(sent) =
                            light.light(&frame.stds, place, point.views, view, roots)
                        {
                            self.counts.lit += 1;
                            radiance += sent;
                        }
                    }
                }
                if let Some(environment) = environment {
                    radiance += light.environment(point.point, environment);
                }
            }
            // In the mirror's direction both cosines are the viewer's.
            let cos_o = point.point.wo.z;
            let energy = table.scratch_table_total(oblique_depth_nm(depth_nm, cos_o, cos_o));
            self.sums[point.index].add(share, energy, radiance.to_array());
        }
    }
}

/// The share of a segment from what its place under a footprint amounts to: [`hairline_optics::footprint::scratch_share`].
#[inline]
fn share(width_um: f64, far2: f64, variance_um2: f64, [low, high]: [f64; 2]) -> ScratchShare {
    use hairline_optics::gaussian::gaussian;
    let line = width_um
        * (-0.5 * far2).exp()
        * (1.0 / (variance_um2 * (2.0 * std::f64::consts::PI))).sqrt();
    ScratchShare {
        segment: line * gaussian().between(low, high),
        line,
    }
}

#[cfg(test)]
mod tests;
