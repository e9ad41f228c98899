//! A layer whose scratches lie along the strokes of a brush.
//!
//! Scratches are scattered evenly: each has its own share of the stroke, in which its middle lies anywhere. So a stroke that is
//! still being drawn keeps the scratches it has.

use std::f64::consts::TAU;

use glam::DVec3;
use hairline_laying::{
    Course, ErasingStroke, Facet, Groove, Ground, Guide, Laying, MeshPoint, Stream, Walker,
};
use hairline_scene::Segment;

use super::off_object::refuse_far;
use super::sizes::scratch_profile;
use crate::description::{Brush, Brushed, Stroke};
use crate::error::Error;

/// Largest distance of the surface from the brush, in the brush's radii.
const REACH: f64 = 2.0;

/// A layer's description with the ground that it goes on.
pub(super) struct Painted<'a> {
    layer: &'a Brushed,
    /// Number that distinguishes layers of one seed.
    number: u64,
    ground: &'a Ground,
    paths: Vec<Path>,
}

/// A stroke that lays scratches.
struct Path {
    /// Index of the stroke among all strokes.
    stroke: usize,
    /// World space; one is a dab.
    points_m: Vec<DVec3>,
    /// The length of the stroke until each point.
    lengths_m: Vec<f64>,
    radius_m: f64,
    density_per_m: f64,
    width: f64,
    depth: f64,
    /// Number of scratches of the strokes before it.
    first: u64,
    count: u64,
}

/// Position of the brush when it makes a scratch.
struct Touch {
    /// Anywhere under the brush, not yet on the surface.
    point_m: DVec3,
    /// The surface under the middle of the brush.
    normal: DVec3,
    /// Direction of the brush's movement; `None` for a dab.
    along: Option<DVec3>,
}

impl<'a> Painted<'a> {
    pub(super) fn new(
        layer: &'a Brushed,
        number: u64,
        strokes: &[Stroke],
        ground: &'a Ground,
    ) -> Self {
        let mut paths: Vec<Path> = Vec::new();
        for (i, stroke) in strokes.iter().enumerate() {
            let first = paths.last().map_or(0, |last| last.first + last.count);
            paths.extend(Path::new(i, stroke, ground, first));
        }
        Self {
            layer,
            number,
            ground,
            paths,
        }
    }

    pub(super) fn count(&self) -> u64 {
        self.paths.last().map_or(0, |last| last.first + last.count)
    }

    /// Index of the stroke of a scratch among those that lay scratches.
    fn path(&self, index: u64) -> usize {
        self.paths.partition_point(|path| path.first <= index) - 1
    }

    fn stream(&self, index: u64) -> Stream {
        // Erasing strokes are not counted, so that they may come and go. Far more scratches than 2^32 fit into no memory.
        let number = self.path(index);
        let nth = index - self.paths[number].first;
        Stream::new(self.layer.seed, self.number, (number as u64) << 32 | nth)
    }

    /// Draws the middle of a scratch, and the place of the brush for it, from the first two numbers of its stream.
    fn seed(&self, index: u64, stream: &mut Stream) -> Option<(MeshPoint, Touch)> {
        let path = &self.paths[self.path(index)];
        let [along, across] = std::array::from_fn(|_| stream.uniform());
        let touch = path.touch(self.ground, index - path.first, along, across)?;
        Some((self.land(&touch, path.radius_m)?, touch))
    }

    /// The nearest place on the side of the surface that the brush is on; `None` where it hangs over the rim.
    fn land(&self, touch: &Touch, radius_m: f64) -> Option<MeshPoint> {
        let most_m = REACH * radius_m;
        let (spot, distance_m) = self.ground.closest().find_within(touch.point_m, most_m)?;
        let facet = Facet::new(&self.ground.mesh, spot.triangle);
        let is_near = distance_m <= most_m && facet.normal.dot(touch.normal) >= 0.0;
        (is_near && self.ground.is_under(&spot, touch.point_m)).then_some(spot)
    }
}

impl Laying for Painted<'_> {
    fn lay(&self, walker: &Walker, index: u64, segments: &mut Vec<Segment>) -> Groove {
        let path = &self.paths[self.path(index)];
        let mut stream = self.stream(index);
        let seed = self.seed(index, &mut stream);
        let angle = stream.uniform();
        let [length, width, depth, jitter] = std::array::from_fn(|_| stream.normal());

        if let Some((seed, touch)) = seed {
            let facet = Facet::new(&self.ground.mesh, seed.triangle);
            let direction = touch
                .along
                .and_then(|along| facet.in_plane(along).try_normalize())
                .unwrap_or_else(|| facet.direction(TAU * angle));
            let (sin, cos) = libm::sincos(self.layer.jitter_deg.to_radians() * jitter);
            let guide = Guide::Free {
                seed_direction: direction * cos + facet.normal.cross(direction) * sin,
                curvature_per_m: 0.0,
            };
            let length_m = self.layer.length_m.log_normal_at(length);
            let length_m = self.ground.fitting_length_m(length_m);
            walker.lay(seed, &guide, length_m, segments);
        }
        Groove {
            profile: scratch_profile(
                [self.layer.width_um, self.layer.depth_nm],
                [width, depth],
                [path.width, path.depth],
            ),
            course: Course::Open,
        }
    }

    fn middle(&self, index: u64) -> Option<MeshPoint> {
        let (seed, _) = self.seed(index, &mut self.stream(index))?;
        Some(seed)
    }

    fn strokes_before(&self, index: u64) -> usize {
        self.paths[self.path(index)].stroke + 1
    }
}

impl Path {
    /// `None` for a stroke that erases.
    fn new(stroke: usize, description: &Stroke, ground: &Ground, first: u64) -> Option<Self> {
        let Brush::Paint {
            density_per_m,
            width,
            depth,
        } = description.brush
        else {
            return None;
        };
        let points_m = ground.points_in_world_m(&description.points_m);
        let mut lengths_m = vec![0.0];
        for pair in points_m.windows(2) {
            lengths_m.push(lengths_m[lengths_m.len() - 1] + pair[0].distance(pair[1]));
        }
        let radius_m = description.radius_m;
        let mut length_m = lengths_m[lengths_m.len() - 1];
        if points_m.len() == 1 {
            length_m = 2.0 * radius_m;
        }
        Some(Self {
            stroke,
            points_m,
            lengths_m,
            radius_m,
            density_per_m,
            width,
            depth,
            first,
            count: (density_per_m * length_m).round().max(1.0) as u64,
        })
    }

    /// Position of the brush for scratch `nth` of the stroke; the last two arguments are uniform draws. `None` where the brush
    /// is out of reach.
    fn touch(&self, ground: &Ground, nth: u64, along: f64, across: f64) -> Option<Touch> {
        // The brush touches points within its radius of its middle.
        let most_m = (REACH + 1.0) * self.radius_m;
        let normal_at = |point_m| {
            let (spot, _) = ground.closest().find_within(point_m, most_m)?;
            Some(Facet::new(&ground.mesh, spot.triangle).normal)
        };
        if self.points_m.len() == 1 {
            return Some(self.dab(normal_at(self.points_m[0])?, along, across));
        }
        // The last share may reach beyond the end, since the count is rounded.
        let length_m = self.lengths_m[self.lengths_m.len() - 1];
        let share_m = (nth as f64 + along) / self.density_per_m;
        let along_m = match share_m < length_m {
            true => share_m,
            false => along * length_m,
        };
        let next = self.lengths_m.partition_point(|length| *length <= along_m);
        let next = next.clamp(1, self.points_m.len() - 1);
        let (from, to) = (self.points_m[next - 1], self.points_m[next]);
        let step_m = self.lengths_m[next] - self.lengths_m[next - 1];
        let middle_m = from.lerp(to, (along_m - self.lengths_m[next - 1]) / step_m);
        let tangent = (to - from) / step_m;
        let normal = normal_at(middle_m)?;
        let sideways = normal
            .cross(tangent)
            .try_normalize()
            .unwrap_or_else(|| tangent.any_orthonormal_vector());
        Some(Touch {
            point_m: middle_m + sideways * (self.radius_m * (2.0 * across - 1.0)),
            normal,
            along: Some(tangent),
        })
    }

    /// Anywhere in a circle, each area alike.
    fn dab(&self, normal: DVec3, share: f64, turn: f64) -> Touch {
        let (x, y) = normal.any_orthonormal_pair();
        let (sin, cos) = libm::sincos(TAU * turn);
        Touch {
            point_m: self.points_m[0] + (x * cos + y * sin) * (self.radius_m * libm::sqrt(share)),
            normal,
            along: None,
        }
    }
}

/// Refuses strokes with points far from the surface, which belong to another object or to another unit. A stroke may go over the
/// rim, and an object may shrink under it: as far as the object is large.
pub(super) fn check(strokes: &[Stroke], key: &str, ground: &Ground) -> Result<(), Error> {
    for (i, stroke) in strokes.iter().enumerate() {
        let most_m = ground.diagonal_m.max(REACH * stroke.radius_m);
        for (j, point) in stroke.points_m.iter().enumerate() {
            let key = || format!("{key}.strokes[{i}].points_m[{j}]");
            refuse_far(ground, *point, most_m, key)?;
        }
    }
    Ok(())
}

/// The strokes that erase.
pub(super) fn erasing<'a>(
    strokes: &'a [Stroke],
    ground: &'a Ground,
) -> impl Iterator<Item = ErasingStroke> + 'a {
    let numbered = strokes.iter().enumerate();
    let erasing = numbered.filter(|(_, stroke)| stroke.brush == Brush::Erase);
    erasing.map(|(number, stroke)| ErasingStroke {
        points_m: ground.points_in_world_m(&stroke.points_m),
        radius_m: stroke.radius_m,
        number,
    })
}
