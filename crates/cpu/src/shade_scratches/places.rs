//! Places along a segment, at each of which the environment lights it once: at the point that sees most of it (docs/model.md, section 8).
//! Blurred by the cells of the band, an environment differs little over a pixel or two where a surface is smooth; points up to two pixels to either side see a segment.

use super::point::ScratchPoint;
use glam::{DVec2, DVec3, Vec3};
use hairline_scene::Environment;
use std::f64::consts::PI;

/// Length of a place.
const PLACE_PX: f64 = 2.0;
/// Places to either side of a point: the diagonal of a tile.
const REACH: usize = 6;
const PLACES: usize = 2 * REACH + 1;
/// Part of itself by which an environment may change between two points that it lights alike.
const ALIKE: f64 = 0.2;
/// Largest such distance on bumps: the depth of a groove depends on how the viewer looks at it, whatever the environment.
pub(crate) const ALIKE_ON_BUMPS_RAD: f64 = 0.06;

/// The largest distance between the normals of two points that an environment lights alike: by its rms change over an angle, as narrow cells see it.
pub(crate) fn alike_rad(environment: &Environment) -> f64 {
    let map = &environment.prefiltered_levels()[1];
    let [width, height] = map.size_px.map(|n| n as usize);
    let step_rad = PI / height as f64;
    let (mut light2, mut change2) = (0.0, 0.0);
    for (y, row) in map.rgb.chunks_exact(width).enumerate().skip(1) {
        let polar_sin = (step_rad * (y as f64 + 0.5)).sin();
        let above = &map.rgb[(y - 1) * width..];
        for x in 1..width {
            let [here, left, up] = [row[x], row[x - 1], above[x]].map(|c| Vec3::from(c).as_dvec3());
            light2 += polar_sin * here.length_squared();
            let across = (here - left).length_squared() / (polar_sin * polar_sin);
            change2 += polar_sin * (across + (here - up).length_squared());
        }
    }
    ALIKE * step_rad * (light2 / change2.max(f64::MIN_POSITIVE)).sqrt()
}

/// The places of a segment in a tile.
pub(super) struct Places {
    along: DVec2,
    from_px: f64,
    places: [Option<Place>; PLACES],
}

#[derive(Clone, Copy)]
struct Place {
    /// The point that sees most of the segment there, and the square of its distance.
    point: usize,
    off2: f64,
    normal: DVec3,
    /// What the environment sends it.
    sent: DVec3,
}

impl Places {
    /// `along` is the segment's direction in the picture; `points` see it, and come with the squares of their distances from it.
    pub fn new<'p>(
        along: DVec2,
        points: impl Iterator<Item = (&'p ScratchPoint<'p>, f64)> + Clone,
    ) -> Self {
        let first = points.clone().next();
        let mut all = Self {
            along,
            from_px: first.map_or(0.0, |(point, _)| along.dot(point.at_px)),
            places: [None; PLACES],
        };
        for (i, (point, off2)) in points.enumerate() {
            let place = &mut all.places[all.index(point)];
            if place.is_none_or(|place| off2 < place.off2) {
                *place = Some(Place {
                    point: i,
                    off2,
                    normal: point.point.normal,
                    sent: DVec3::ZERO,
                });
            }
        }
        all
    }

    fn index(&self, point: &ScratchPoint) -> usize {
        let off = (self.along.dot(point.at_px) - self.from_px) * (1.0 / PLACE_PX);
        (off + REACH as f64 + 0.5).clamp(0.0, PLACES as f64 - 1.0) as usize
    }

    /// Lights each place at the point that stands for it.
    #[inline(always)]
    pub fn light(&mut self, mut light: impl FnMut(usize) -> DVec3) {
        for place in self.places.iter_mut().flatten() {
            place.sent = light(place.point);
        }
    }

    /// What a point that sees the segment is sent; none if it looks elsewhere than the point that stands for its place.
    pub fn sent(&self, point: &ScratchPoint, alike_rad: f64) -> Option<DVec3> {
        let place = self.places[self.index(point)]?;
        let is_alike = place.normal.distance_squared(point.point.normal) <= alike_rad * alike_rad;
        is_alike.then_some(place.sent)
    }
}
