//! A segment under the footprints of the points of a group.

use super::course::{Arc, Course};
use super::picks::Pick;
use super::point::{Frame, share};
use glam::{DVec2, DVec3};
use hairline_index::{IndexedProfile, IndexedSegment};
use hairline_optics::band::{Along, BandPlace};
use hairline_optics::footprint::{ScratchShare, SeenPart};
use hairline_optics::section::cover_of_part;

/// Points of a group.
pub(super) const LANES: usize = 8;

/// A number for each point of a group.
pub(super) type Lanes = [f64; LANES];

/// A segment under the footprints of a group.
#[derive(Default)]
pub(super) struct SegmentView {
    /// 1 for lanes that see the segment; the other values of the rest may be no numbers.
    pub(super) sees: [u64; LANES],
    /// Tangent of the segment, in the surface's frame.
    pub(super) tangent: [Lanes; 2],
    /// Distance of the segment's line from the point, and the variance of footprint and window across it.
    pub offset_um: Lanes,
    pub variance_um2: Lanes,
    /// Square of the one over the other.
    pub(super) far2: Lanes,
    /// Ends of the segment, in standard deviations along it.
    pub(super) low: Lanes,
    pub(super) high: Lanes,
    /// The standard deviation along it, and the distance by which a slanted footprint's part on the segment is displaced.
    pub(super) std_um: Lanes,
    pub(super) shift_um: Lanes,
}

impl SegmentView {
    pub fn tangent(&self, lane: usize) -> DVec2 {
        DVec2::new(self.tangent[0][lane], self.tangent[1][lane])
    }

    /// Ends of the segment, in standard deviations along it.
    pub fn ends(&self, lane: usize) -> [f64; 2] {
        [self.low[lane], self.high[lane]]
    }

    /// Square of the distance from the segment to the point, in standard deviations of the footprint.
    pub fn off2(&self, lane: usize) -> f64 {
        let [low, high] = self.ends(lane);
        let beyond = low.max(-high).max(0.0);
        self.far2[lane] + beyond * beyond
    }

    /// Place of the segment under the footprint of a point.
    pub fn place(&self, lane: usize, frame: &Frame) -> BandPlace {
        let tangent = self.tangent(lane);
        BandPlace::new(
            frame.steps_um.map(|step| tangent.perp_dot(step)),
            self.offset_um[lane],
            self.variance_um2[lane],
        )
    }

    /// Course of the segment under the footprint of a point that has a share of it.
    #[inline(always)]
    pub fn course(&self, lane: usize, frame: &Frame, turn_rad: f32) -> Course {
        let chord = self.tangent(lane);
        if turn_rad == 0.0 {
            return Course::straight(chord);
        }
        let [low, high] = self.ends(lane);
        let std_um = self.std_um[lane];
        Course::of_arc(&Arc {
            chord,
            turn_rad: turn_rad.into(),
            length_um: (high - low) * std_um,
            std_um,
            shift_um: self.shift_um[lane],
            seen: SeenPart::new([low, high]),
            middle: 0.5 * (low + high),
            steps_um: frame.steps_um.map(|step| chord.dot(step)),
        })
    }

    /// Pick of the segment with its share, for rays that start from it.
    pub fn pick(
        &self,
        lane: usize,
        frame: &Frame,
        segment: &IndexedSegment,
        course: Course,
        share: f64,
    ) -> Pick {
        let chord = self.tangent(lane);
        Pick {
            course,
            place: self.place(lane, frame),
            along: Along {
                steps_um: frame.steps_um.map(|step| chord.dot(step)),
                blur_um: segment.blur_um.into(),
                ends: self.ends(lane),
            },
            profile: segment.profile,
            row: None,
            share,
            source: 0,
            radiance: DVec3::ZERO,
        }
    }

    /// The share that a point sees; none if it doesn't.
    #[inline(always)]
    pub fn share(&self, lane: usize, profile: IndexedProfile) -> Option<ScratchShare> {
        if self.sees[lane] == 0 {
            return None;
        }
        let mut share = share(
            profile.width_um.into(),
            self.far2[lane],
            self.variance_um2[lane],
            self.ends(lane),
        );
        share.line *= profile.lines();
        share.cover = cover_of_part(profile.width_class);
        (share.segment > 0.0).then_some(share)
    }
}
