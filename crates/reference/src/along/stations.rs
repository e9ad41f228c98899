//! What a scratch sends at places along it.

use super::course::{Course, Knot, Numbers, SLOPES, WEIGHTS};
use super::line::Reach;
use crate::segment_view::Sides;
use glam::DVec3;

/// What a scratch sends at one place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Station {
    pub place_px: f64,
    /// Fresnel left out, for a share of one.
    pub radiance: DVec3,
    /// What the base pays for a share of one.
    pub energy: DVec3,
    /// How pixels about it see the scratch.
    pub weights: FlatWeights,
    /// By how much the phase between both edges of the groove changes for a pixel along it, by way of any light that reaches it. None
    /// if that is not known.
    pub phase_per_px: Option<f64>,
    /// Where lights are that don't reach it.
    pub sides: Sides,
    /// How far pixels see the scratch here.
    pub reach: Reach,
    /// Unit normal of the plane that it lies in.
    pub facet: DVec3,
    /// By how much a pixel that sees it may be off its plane, in reciprocal depth.
    pub depth_room: f64,
    /// Whether it is short against the pixel's footprint.
    pub is_short: bool,
}

/// The shares (20) of pixels about a place of a line on a surface that is flat there: in terms of their distances from it in the
/// picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatWeights {
    /// Pixels' standard deviations across the line, for a pixel.
    pub stds_per_px: f64,
    /// The share in the middle of an endless line.
    pub middle: f64,
    /// By how much the place that a pixel sees is farther along for a pixel's distance across.
    pub skew: f64,
    /// What ends are divided by, for a pixel along the line, before their error functions.
    pub ends_per_px: f64,
}

impl FlatWeights {
    fn lerp(&self, to: &Self, part: f64) -> Self {
        let lerp = |from: f64, to: f64| from + part * (to - from);
        Self {
            stds_per_px: lerp(self.stds_per_px, to.stds_per_px),
            middle: lerp(self.middle, to.middle),
            skew: lerp(self.skew, to.skew),
            ends_per_px: lerp(self.ends_per_px, to.ends_per_px),
        }
    }
}

/// Stations along a line, in order.
#[derive(Default)]
pub(super) struct Stations {
    knots: Vec<Knot>,
    course: Box<Course>,
    are_short: bool,
    facet: DVec3,
    depth_room: f64,
    reach: Reach,
}

/// Up to this length in pixels one station is enough.
const ONE_PX: f64 = 1.5;
/// The same for a dark scratch on a plane, where perspective alone changes how it is seen.
const PLANE_PX: f64 = 6.0;
/// Between stations farther apart there is always another: spectra turn with the phase, and ends of chords with more than that.
const FAR_RAD: f64 = 0.1;
/// At least, and where the phase is not known; and at most.
const FAR_PX: [f64; 2] = [4.0, 16.0];
/// Up to here nothing can shine between two that are dark, all lights being on the same side for both.
const DARK_PX: f64 = 16.0;
/// Closer ones are not looked for: pixels are no finer.
const NEAR_PX: f64 = 1.5;
/// What neighbours may differ by, as a share of the larger, without another between them.
const ALIKE: f64 = 0.1;
/// By what share of the largest of three the middle one may be off the mean of its neighbours: what is then left of the error after a
/// parabola through the three is of the next order.
const STRAIGHT: f64 = 0.02;

/// Where a station is looked for: what is nearest to an edge may be hidden there.
const FROM_START: [f64; 7] = [0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5];
const FROM_END: [f64; 7] = [1.0, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5];

impl Stations {
    /// Puts stations along a part of a line, as many as it needs. `station` is asked for them at places of the line; it takes the
    /// pixel nearest to it, or has none.
    pub fn place(
        &mut self,
        [begin, end]: [f64; 2],
        mut station: impl FnMut(f64) -> Option<Station>,
    ) {
        self.clear();
        if end - begin <= ONE_PX {
            if let Some(only) = station(0.5 * (begin + end)) {
                self.push(&only);
            }
            return;
        }
        let from = |parts: [f64; 7], station: &mut dyn FnMut(f64) -> Option<Station>| {
            parts
                .iter()
                .find_map(|part| station(begin + part * (end - begin)))
        };
        let Some(first) = from(FROM_START, &mut station) else {
            return;
        };
        self.push(&first);
        if let Some(last) = from(FROM_END, &mut station) {
            self.between(&first, &last, &mut station);
            self.push(&last);
        }
    }

    /// The same for a scratch that is dark all along: how it is seen changes slowly, or not at all on a plane.
    pub fn place_dark(
        &mut self,
        [begin, end]: [f64; 2],
        is_plane: bool,
        mut station: impl FnMut(f64) -> Option<Station>,
    ) {
        self.clear();
        let one_px = if is_plane { PLANE_PX } else { ONE_PX };
        let parts: &[&[f64]] = if end - begin <= one_px {
            &[&[0.5, 0.3, 0.7, 0.1, 0.9, 0.0, 1.0]]
        } else {
            &[&FROM_START, &FROM_END]
        };
        for parts in parts {
            let first = parts
                .iter()
                .find_map(|part| station(begin + part * (end - begin)));
            if let Some(first) = first {
                self.push(&first);
            }
        }
    }

    fn clear(&mut self) {
        self.knots.clear();
        self.are_short = false;
        self.facet = DVec3::ZERO;
        self.depth_room = 0.0;
        self.reach = Reach::default();
    }

    fn push(&mut self, station: &Station) {
        let place_px = station.place_px as f32;
        // Two may be of one pixel.
        let at = numbers(station);
        if let Some(last) = self.knots.last_mut() {
            if last.place_px >= place_px {
                return;
            }
            let per_px = 1.0 / (place_px - last.place_px);
            last.slopes = std::array::from_fn(|i| (at[i] - last.at[i]) * per_px);
            last.at[SLOPES..].copy_from_slice(&last.slopes[WEIGHTS..SLOPES]);
            last.slopes[SLOPES..].fill(0.0);
        }
        self.are_short |= station.is_short;
        self.facet = station.facet;
        self.depth_room = self.depth_room.max(station.depth_room);
        self.reach = self.reach.max(station.reach);
        self.knots.push(Knot {
            place_px,
            at,
            slopes: Numbers::default(),
        });
    }

    /// Those that are needed between two.
    fn between(
        &mut self,
        a: &Station,
        b: &Station,
        station: &mut impl FnMut(f64) -> Option<Station>,
    ) {
        let span = b.place_px - a.place_px;
        let are_dark = a.radiance == DVec3::ZERO && b.radiance == DVec3::ZERO;
        if are_dark && span < DARK_PX && !may_hide_light(a, b) {
            return;
        }
        let far_px = far_px(a, b);
        let far = span > far_px;
        if !(far || span > NEAR_PX && (differ(a, b, ALIKE) || may_hide_light(a, b))) {
            return;
        }
        let Some(middle) = station(0.5 * (a.place_px + b.place_px)) else {
            return;
        };
        let f = (middle.place_px - a.place_px) / span;
        if !(0.1..=0.9).contains(&f) {
            return;
        }
        let mean = a.radiance.lerp(b.radiance, f);
        let largest = largest(a).max(largest(b)).max(largest(&middle));
        let off = (middle.radiance - mean).abs().max_element();
        let is_long = span > 2.0 * far_px;
        if is_long
            || off > STRAIGHT * largest
            || may_hide_light(a, &middle)
            || may_hide_light(&middle, b)
        {
            self.between(a, &middle, station);
            self.push(&middle);
            self.between(&middle, b, station);
            return;
        }
        let curve = (middle.radiance - mean) / (f * (1.0 - f));
        for part in [0.5 * f, f, 0.5 + 0.5 * f] {
            let on_parabola = Station {
                place_px: a.place_px + part * span,
                radiance: a.radiance.lerp(b.radiance, part) + curve * (part * (1.0 - part)),
                energy: a.energy.lerp(b.energy, part),
                weights: if part < f {
                    a.weights.lerp(&middle.weights, part / f)
                } else {
                    middle.weights.lerp(&b.weights, (part - f) / (1.0 - f))
                },
                ..middle
            };
            self.push(&on_parabola);
        }
    }

    /// What they say at all places, once all are there: linear between them, and beyond the last ones as there.
    #[inline(always)]
    pub fn course(&mut self) -> &Course {
        let Self { knots, course, .. } = self;
        course.follow(knots);
        course
    }

    /// Whether the scratch is short against a pixel's footprint.
    pub fn are_short(&self) -> bool {
        self.are_short
    }

    /// By how much the place that a pixel sees is farther along for a pixel's distance across, in the middle.
    pub fn skew(&self) -> f32 {
        let middle = self.knots.get(self.knots.len() / 2);
        middle.map_or(0.0, |knot| knot.at[WEIGHTS + 2])
    }

    /// Unit normal of the plane that the scratch lies in.
    pub fn facet(&self) -> DVec3 {
        self.facet
    }

    /// By how much pixels may be off the scratch's plane, in reciprocal depth.
    pub fn depth_room(&self) -> f64 {
        self.depth_room
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.knots.is_empty()
    }

    /// The farthest reach of all.
    pub fn reach(&self) -> Reach {
        self.reach
    }
}

fn numbers(station: &Station) -> Numbers {
    let (r, e, w) = (station.radiance, station.energy, &station.weights);
    let numbers = [
        1.0,
        0.0,
        r.x,
        r.y,
        r.z,
        e.x,
        e.y,
        e.z,
        w.stds_per_px,
        w.middle,
        w.skew,
        w.ends_per_px,
        0.0,
        0.0,
        0.0,
        0.0,
    ];
    numbers.map(|number| number as f32)
}

/// Beyond which distance there is always another station between two.
fn far_px(a: &Station, b: &Station) -> f64 {
    match (a.phase_per_px, b.phase_per_px) {
        (Some(a), Some(b)) => (FAR_RAD / a.max(b).max(1e-9)).clamp(FAR_PX[0], FAR_PX[1]),
        _ => FAR_PX[0],
    }
}

fn largest(station: &Station) -> f64 {
    station.radiance.abs().max_element()
}

fn differ(a: &Station, b: &Station, share: f64) -> bool {
    (a.radiance - b.radiance).abs().max_element() > share * largest(a).max(largest(b))
}

/// Whether a light that is seen from neither passes from one side of the scratch to the other between them.
fn may_hide_light(a: &Station, b: &Station) -> bool {
    (a.sides.positive ^ b.sides.positive) & a.sides.dark & b.sides.dark != 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(range: [f64; 2], light: impl Fn(f64) -> f64) -> (Stations, usize) {
        let (mut stations, mut count) = (Stations::default(), 0);
        stations.place(range, |place_px| {
            count += 1;
            let radiance = DVec3::splat(light(place_px));
            let dark = u64::from(radiance == DVec3::ZERO);
            Some(Station {
                place_px,
                radiance,
                energy: DVec3::ONE,
                weights: FlatWeights {
                    stds_per_px: 1.0,
                    middle: 1.0,
                    skew: 0.0,
                    ends_per_px: 1.0,
                },
                phase_per_px: None,
                sides: Sides {
                    turn: 0.0,
                    dark,
                    positive: u64::from(place_px > 13.0),
                },
                reach: Reach::default(),
                facet: DVec3::Z,
                depth_room: 1.0,
                is_short: false,
            })
        });
        (stations, count)
    }

    fn radiance(course: &Course, place_px: f32) -> f32 {
        course.at(course.index(place_px))[2]
    }

    fn largest_error(range: [f64; 2], light: impl Fn(f64) -> f64) -> (f64, usize) {
        let (mut stations, count) = placed(range, &light);
        let course = stations.course();
        let places = (0..=500).map(|i| range[0] + (range[1] - range[0]) * f64::from(i) / 500.0);
        let errors = places.map(|p| (f64::from(radiance(course, p as f32)) - light(p)).abs());
        (errors.fold(0.0, f64::max), count)
    }

    /// A smooth light takes a station every four pixels or so, a narrow one more, and both are found.
    #[test]
    fn stations_are_as_dense_as_the_light_changes() {
        let (error, count) = largest_error([0.0, 32.0], |p| 1.0 + (p * 0.05).sin());
        // Half of the way to the next place, at 0.05 for a pixel, and what the parabolas leave.
        assert!(error < 0.0125 + 2e-3 && count <= 10, "{error} {count}");
        let band = |width: f64| move |p: f64| (-0.5 * ((p - 13.0) / width).powi(2)).exp();
        let (error, count) = largest_error([0.0, 32.0], band(4.0));
        assert!(error < 0.04 && count <= 40, "{error} {count}");
        let (error, _) = largest_error([0.0, 32.0], band(1.5));
        // As narrow as stations are close.
        assert!(error < 0.25, "{error}");
    }

    /// A light that is dark from all of the first places, and passes from one side to the other between them.
    #[test]
    fn a_light_between_dark_places_is_found() {
        let light = |p: f64| f64::from((p - 13.0).abs() < 1.2);
        let (mut stations, _) = placed([0.0, 32.0], light);
        assert!(radiance(stations.course(), 13.0) > 0.5);
        // One that stays on its side is not looked for.
        let (_, count) = placed([14.5, 28.0], light);
        assert_eq!(count, 2);
    }

    #[test]
    fn beyond_its_ends_it_is_as_there() {
        let (mut stations, _) = placed([2.0, 6.0], |p| p);
        let course = stations.course();
        for (place_px, expected) in [(-5.0, 2.0), (50.0, 6.0), (f32::NAN, 2.0)] {
            assert_eq!(radiance(course, place_px), expected);
        }
        let (mut one, count) = placed([2.0, 3.0], |p| p);
        assert_eq!((radiance(one.course(), 7.0), count), (2.5, 1));
    }
}
