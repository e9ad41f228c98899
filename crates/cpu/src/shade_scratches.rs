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

use crate::counts::Counts;
use crate::prepared::Prepared;
use crate::project::Projected;
use glam::{DVec2, DVec3};
use hairline_index::IndexedSegment;
use hairline_optics::band::OutlineRoots;
use hairline_optics::footprint::ScratchShare;
use hairline_optics::mask::ScratchSums;
use hairline_optics::vectors::with_widest;
use lanes::{GROUPS, Group, LANES, Line, SegmentView};
use light_bounds::LightBounds;
use places::Places;
use scratch_light::scratch_energy;

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
        let (prepared, points, profile) = (self.prepared, self.points, segment.profile);
        let table = |i: usize| prepared.scratch_table(points[i].point.table, profile);
        let course = |i: usize| seen[i / LANES].course(i % LANES, &frames[i], segment.turn_rad);
        let scratch = |i: usize, course: Course| {
            ScratchLight::new(points[i].point.wo, course, table(i), profile).by_one_line(node)
        };
        bounds.find(segment, lit);
        let surrounding = prepared.scene.environment.as_ref().map(|environment| {
            let seen = pairs
                .iter()
                .map(|(i, _)| (&points[*i], seen[i / LANES].off2(i % LANES)));
            let mut places = Places::new(along, seen);
            places.light(|pair| {
                let (i, _) = pairs[pair];
                scratch(i, course(i)).environment(points[i].point, environment)
            });
            (environment, places)
        });
        for &(i, share) in pairs.iter() {
            self.counts.pairs += 1;
            let (point, stds) = (&points[i], &frames[i].stds);
            let energy = scratch_energy(profile, table(i), point.point.wo.z);
            let mut radiance = DVec3::ZERO;
            let mut picks = self.picks.as_mut().map(|picks| &mut picks[point.index]);
            if picks.is_some() || !lit.is_empty() || surrounding.is_some() {
                let (group, lane) = (&seen[i / LANES], i % LANES);
                let course = course(i);
                let place = group.place(lane, &frames[i]);
                let light = scratch(i, course);
                let pick = || group.pick(lane, &frames[i], segment, course, share.segment);
                let mut add = |source: usize, sent: DVec3| {
                    radiance += sent;
                    if let Some(picks) = &mut picks {
                        picks.add_light(source, share.segment * sent, pick);
                    }
                };
                for &index in lit.iter() {
                    if let Some(view) = point.views.view_of(index) {
                        self.counts.asked += 1;
                        if let Some(sent) = light.light(stds, place, point.views, view, roots) {
                            self.counts.lit += 1;
                            add(view, sent);
                        }
                    }
                }
                if let Some((environment, places)) = &surrounding {
                    let alone = || light.environment(point.point, environment);
                    add(
                        point.views.views.len(),
                        places.sent(point, alike_rad[i]).unwrap_or_else(alone),
                    );
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
