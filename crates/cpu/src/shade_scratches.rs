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
mod places;
mod point;
mod row_spread;
mod scratch_light;
mod segment_view;

use crate::counts::Counts;
use crate::prepared::Prepared;
use crate::project::Projected;
use glam::{DVec2, DVec3};
use hairline_index::IndexedSegment;
use hairline_optics::band::OutlineRoots;
use hairline_optics::footprint::ScratchShare;
use hairline_optics::mask::ScratchSums;
use hairline_optics::table::ScratchTable;
use hairline_optics::vectors::with_widest;
use hairline_scene::Environment;
use lanes::{GROUPS, Group, Line};
use light_bounds::LightBounds;
use places::Places;
use scratch_light::scratch_energy;
use segment_view::{LANES, SegmentView};

pub(crate) use course::Course;
pub(crate) use drawn_light::{Choice, DrawnLight};
pub(crate) use one_pair::pick_one_pair;
pub(crate) use picks::{Pick, Picks};
pub(crate) use places::{ALIKE_ON_BUMPS_RAD, alike_rad};
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
    /// For each point, how far the normals of others may be off its own at which the environment lights them alike.
    alike_rad: Vec<f64>,
    groups: Vec<Group>,
    bounds: LightBounds,
    /// The segment in hand under each group.
    seen: [SegmentView; GROUPS],
    /// The points that see it, with their shares.
    pairs: Vec<(usize, ScratchShare)>,
    /// Lights that can reach the segment in hand.
    lit: Vec<u32>,
    roots: [OutlineRoots; 2],
}

impl ScratchShader {
    pub fn new() -> Self {
        Self {
            frames: Vec::with_capacity(BATCH),
            alike_rad: Vec::with_capacity(BATCH),
            groups: Vec::with_capacity(GROUPS),
            bounds: LightBounds::default(),
            seen: Default::default(),
            pairs: Vec::with_capacity(BATCH),
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
        self.alike_rad.clear();
        let materials = points.iter().map(|p| p.point.material);
        self.alike_rad
            .extend(materials.map(|material| prepared.alike_rad(material)));
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
        let ScratchShader {
            groups,
            seen,
            pairs,
            ..
        } = &mut *self.shader;
        pairs.clear();
        for (i, group) in groups.iter().enumerate() {
            if !group.is_near(&line) {
                continue;
            }
            self.counts.tests += LANES as u64;
            if !group.see(segment, projected.object, &mut seen[i]) {
                continue;
            }
            for lane in 0..LANES {
                if let Some(mut share) = seen[i].share(lane, segment.profile) {
                    // A weight counts as that many scratches, each with the line's full length.
                    share.segment *= weight;
                    pairs.push((i * LANES + lane, share));
                }
            }
        }
        if !self.shader.pairs.is_empty() {
            self.light(segment, line.direction(), node);
        }
    }

    /// Adds the light of a segment to the points that see it. `along` is its direction in the picture.
    #[inline(always)]
    fn light(&mut self, segment: &IndexedSegment, along: DVec2, node: Option<f64>) {
        let ScratchShader {
            frames,
            alike_rad,
            seen,
            pairs,
            bounds,
            lit,
            roots,
            ..
        } = &mut *self.shader;
        bounds.find(segment, lit);
        let mut on = LitSegment {
            prepared: self.prepared,
            points: self.points,
            frames,
            alike_rad,
            seen,
            segment,
            node,
            lit,
            surrounding: None,
        };
        on.surrounding = on.surrounding(pairs, along);
        for &(i, share) in pairs.iter() {
            self.counts.pairs += 1;
            let point = &self.points[i];
            let energy = scratch_energy(segment.profile, on.table(i), point.point.wo.z);
            let picks = self.picks.as_mut().map(|picks| &mut picks[point.index]);
            let mut radiance = DVec3::ZERO;
            if picks.is_some() || !on.lit.is_empty() || on.surrounding.is_some() {
                radiance = on.light((i, share), energy, picks, roots, self.counts);
            }
            self.sums[point.index].add(share, energy, radiance.to_array());
        }
    }
}

/// A segment under a batch, with what lights it.
struct LitSegment<'a, 's> {
    prepared: &'a Prepared<'a>,
    points: &'a [ScratchPoint<'a>],
    frames: &'s [Frame],
    alike_rad: &'s [f64],
    seen: &'s [SegmentView; GROUPS],
    segment: &'s IndexedSegment,
    /// Place of its one line in its band, if it has one.
    node: Option<f64>,
    lit: &'s [u32],
    surrounding: Option<(&'a Environment, Places)>,
}

impl<'a> LitSegment<'a, '_> {
    #[inline(always)]
    fn table(&self, i: usize) -> &'a ScratchTable {
        let table = self.points[i].point.table;
        self.prepared.scratch_table(table, self.segment.profile)
    }

    #[inline(always)]
    fn course(&self, i: usize) -> Course {
        self.seen[i / LANES].course(i % LANES, &self.frames[i], self.segment.turn_rad)
    }

    #[inline(always)]
    fn scratch(&self, i: usize, course: Course) -> ScratchLight<'a> {
        let wo = self.points[i].point.wo;
        ScratchLight::new(wo, course, self.table(i), self.segment.profile).by_one_line(self.node)
    }

    /// The environment, with its light at a few places of the points.
    #[inline(always)]
    fn surrounding(
        &self,
        pairs: &[(usize, ScratchShare)],
        along: DVec2,
    ) -> Option<(&'a Environment, Places)> {
        let environment = self.prepared.scene.environment.as_ref()?;
        let off2 = |i: usize| self.seen[i / LANES].off2(i % LANES);
        let seen = pairs.iter().map(|(i, _)| (&self.points[*i], off2(*i)));
        let mut places = Places::new(along, seen);
        places.light(|pair| {
            let (i, _) = pairs[pair];
            let scratch = self.scratch(i, self.course(i));
            scratch.environment(self.points[i].point, environment)
        });
        Some((environment, places))
    }

    /// The light that the segment sends from one of the points, which picks it.
    #[inline(always)]
    fn light(
        &self,
        (i, share): (usize, ScratchShare),
        energy: [f64; 3],
        mut picks: Option<&mut Picks>,
        roots: &mut [OutlineRoots; 2],
        counts: &mut Counts,
    ) -> DVec3 {
        let (point, frame) = (&self.points[i], &self.frames[i]);
        let (group, lane) = (&self.seen[i / LANES], i % LANES);
        let course = self.course(i);
        let place = group.place(lane, frame);
        let light = self.scratch(i, course);
        let pick = || group.pick(lane, frame, self.segment, course, share.segment);
        let mut radiance = DVec3::ZERO;
        let mut add = |source: usize, sent: DVec3| {
            radiance += sent;
            if let Some(picks) = &mut picks {
                picks.add_light(source, share.segment * sent, pick);
            }
        };
        for &index in self.lit {
            if let Some(view) = point.views.view_of(index) {
                counts.asked += 1;
                if let Some(sent) = light.light(&frame.stds, place, point.views, view, roots) {
                    counts.lit += 1;
                    add(view, sent);
                }
            }
        }
        if let Some((environment, places)) = &self.surrounding {
            let alone = || light.environment(point.point, environment);
            let sent = places.sent(point, self.alike_rad[i]);
            add(point.views.views.len(), sent.unwrap_or_else(alone));
        }
        if let Some(picks) = picks {
            picks.add_energy(share.segment * DVec3::from(energy), pick);
        }
        radiance
    }
}

#[cfg(test)]
mod tests;
