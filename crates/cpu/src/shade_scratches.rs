//! Stage 5, shade scratches: the scratches under the points of a tile and the light that they send to the viewer (docs/model.md,
//! sections 4 to 6). Twin: shade_scratches.wgsl.
//!
//! Segment by segment of the tile's list: eight points at once are tested whether they see it, then each that does asks those lights
//! which can reach the segment from any point of the tile.

mod chord_depths;
mod course;
mod drawn_light;
mod lanes;
mod light_bounds;
mod one_pair;
mod picks;
mod picture_chords;
mod point;
mod row_spread;
mod scratch_light;

use crate::counts::Counts;
use crate::prepared::Prepared;
use crate::project::Projected;
use glam::DVec3;
use hairline_index::IndexedSegment;
use hairline_optics::band::OutlineRoots;
use hairline_optics::mask::ScratchSums;
use hairline_optics::vectors::with_widest;
use lanes::{GROUPS, Group, LANES, Line, SegmentView};
use light_bounds::LightBounds;
use scratch_light::scratch_energy;

pub(crate) use course::Course;
pub(crate) use drawn_light::{Choice, DrawnLight};
pub(crate) use one_pair::pick_one_pair;
pub(crate) use picks::{Pick, Picks};
pub(crate) use point::{Frame, ScratchPoint};
pub(crate) use row_spread::{ROW_PROFILE, RowSpread};
pub(crate) use scratch_light::ScratchLight;

/// Points that are shaded together.
pub(crate) const BATCH: usize = GROUPS * LANES;

/// Number of segments in a tile's list from which on one line stands for the band of each. Footprints are wide there, and wide bands take five
/// lines.
const LONG_LIST: usize = 1 << 14;

/// Place of the one line of a segment in its band: even over the segments, and the same in each pixel. Twin: `one_line_node`.
fn one_line_node(segment: u32) -> f64 {
    f64::from(segment.wrapping_mul(0x9E37_79B9)) / 2f64.powi(32)
}

/// Shades batches of points. One for each thread: what it holds is filled anew for each batch.
pub(crate) struct ScratchShader {
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
            frames: Vec::with_capacity(BATCH),
            groups: Vec::with_capacity(GROUPS),
            bounds: LightBounds::default(),
            lit: Vec::new(),
            roots: Default::default(),
        }
    }

    /// Adds up the light of the segments of a list at the points, in the list's order. `picks` are those of all points that may be shaded, or
    /// none.
    pub fn shade<'l>(
        &mut self,
        prepared: &Prepared,
        points: &[ScratchPoint],
        list: impl ExactSizeIterator<Item = &'l Projected>,
        sums: &mut [ScratchSums],
        picks: Option<&mut [Picks]>,
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
        let (segments, weights) = prepared.segments();
        let is_long = list.len() >= LONG_LIST;
        let mut shading = Shading {
            prepared,
            points,
            shader: self,
            sums,
            picks,
            counts,
        };
        with_widest(
            #[inline(always)]
            || {
                for projected in list {
                    let at = projected.segment as usize;
                    let weight = weights.get(at).map_or(1.0, |&weight| f64::from(weight));
                    let node = is_long.then(|| one_line_node(projected.segment));
                    shading.add(&segments[at], projected, weight, node);
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
    picks: Option<&'s mut [Picks]>,
    counts: &'s mut Counts,
}

impl Shading<'_, '_> {
    #[inline(always)]
    fn add(
        &mut self,
        segment: &IndexedSegment,
        projected: &Projected,
        weight: f64,
        node: Option<f64>,
    ) {
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
            self.light(segment, i * LANES, &seen, weight, node);
        }
    }

    /// Adds the light of a segment, times `weight`, to the points of a group that the segment lies under.
    #[inline(always)]
    fn light(
        &mut self,
        segment: &IndexedSegment,
        first: usize,
        seen: &SegmentView,
        weight: f64,
        node: Option<f64>,
    ) {
        let environment = self.prepared.scene.environment.as_ref();
        let profile = segment.profile;
        for lane in 0..LANES {
            let Some(mut share) = seen.share(lane, profile) else {
                continue;
            };
            // A weight counts as that many scratches, each with the line's full length.
            share.segment *= weight;
            self.counts.pairs += 1;
            let point = &self.points[first + lane];
            let frame = &self.shader.frames[first + lane];
            let table = self
                .prepared
                .scratch_table(point.point.table, segment.profile);
            let mut radiance = DVec3::ZERO;
            let energy = scratch_energy(segment.profile, table, point.point.wo.z);
            let mut picks = self.picks.as_mut().map(|picks| &mut picks[point.index]);
            if picks.is_some() || !self.shader.lit.is_empty() || environment.is_some() {
                let course = seen.course(lane, frame, segment.turn_rad);
                let place = seen.place(lane, frame);
                let light = ScratchLight::new(point.point.wo, course, table, segment.profile)
                    .by_one_line(node);
                let pick = || seen.pick(lane, frame, segment, course, share.segment);
                let mut add = |source: usize, sent: DVec3| {
                    radiance += sent;
                    if let Some(picks) = &mut picks {
                        picks.add_light(source, share.segment * sent, pick);
                    }
                };
                for &index in &self.shader.lit {
                    if let Some(view) = point.views.view_of(index) {
                        self.counts.asked += 1;
                        let roots = &mut self.shader.roots;
                        if let Some(sent) =
                            light.light(&frame.stds, place, point.views, view, roots)
                        {
                            self.counts.lit += 1;
                            add(view, sent);
                        }
                    }
                }
                if let Some(environment) = environment {
                    let sent = light.environment(point.point, environment);
                    add(point.views.views.len(), sent);
                }
                if let Some(picks) = picks {
                    picks.add_energy(share.segment * DVec3::from(energy), pick);
                }
            }
            self.sums[point.index].add(share, energy, radiance.to_array());
        }
    }
}

#[cfg(test)]
mod tests;
