//! The way that a scratch takes under a footprint: its tangent, and how an arc turns there (docs/model.md, section 6).

use glam::DVec2;
use hairline_optics::footprint::SeenPart;

/// The course of a scratch under a footprint. Twin: `scratch_turned` in scratch_light.wgsl.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course {
    /// Tangent in the surface's frame, of unit length: that of the place whose band moves by nothing.
    pub tangent: DVec2,
    /// Angles by which it turns to the left over one standard deviation of the pixel's filter to the right and down.
    pub turns_rad: [f64; 2],
}

/// An arc under a footprint.
pub(super) struct Arc {
    /// Unit tangent of its chord.
    pub chord: DVec2,
    /// Angle by which it turns to the left from its start to its end.
    pub turn_rad: f64,
    pub length_um: f64,
    /// Standard deviation of the footprint along it, and the distance by which a slanted footprint's part on it is displaced.
    pub std_um: f64,
    pub shift_um: f64,
    /// The part between its ends that the footprint sees.
    pub seen: SeenPart,
    /// Middle between the ends, in standard deviations along it.
    pub middle: f64,
    /// Components along the chord of one standard deviation of the pixel's filter to the right and down.
    pub steps_um: [f64; 2],
}

impl Course {
    /// A scratch that goes straight on.
    pub fn straight(tangent: DVec2) -> Self {
        Self {
            tangent,
            turns_rad: [0.0; 2],
        }
    }

    /// An arc as the footprint sees it: the tangent is right at the mean place of the part that is seen, and turns from there as far as that
    /// part goes.
    pub(super) fn of_arc(arc: &Arc) -> Self {
        let per_um = arc.turn_rad / arc.length_um;
        let spread = per_um * arc.seen.std;
        // What moves the band over the footprint counts from the pixel's middle.
        let at_mean = per_um * arc.std_um * (arc.seen.mean - arc.middle);
        let angle = DVec2::from_angle(at_mean - spread * arc.shift_um);
        Self {
            tangent: angle.rotate(arc.chord),
            turns_rad: arc.steps_um.map(|step| spread * step),
        }
    }
}
