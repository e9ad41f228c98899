//! A tube with round ends as seen from a point: its surface, sampled evenly.

#[cfg(test)]
use super::bound::Cone;
use super::sphere::SphereLight;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

#[derive(Clone, Copy, Debug)]
pub(super) struct TubeLight {
    /// Middle of the first end, and the unit axis towards the other one.
    start_m: DVec3,
    axis: DVec3,
    length_m: f64,
    radius_m: f64,
}

/// A line's way through a tube: where it goes in and out, and how squarely.
#[derive(Clone, Copy)]
struct Crossing {
    distance_m: f64,
    cos: f64,
}

impl TubeLight {
    pub fn new([start_m, end_m]: [DVec3; 2], radius_m: f64) -> Self {
        Self {
            start_m,
            axis: (end_m - start_m).normalize_or(DVec3::Z),
            length_m: end_m.distance(start_m),
            radius_m,
        }
    }

    fn area_m2(&self) -> f64 {
        2.0 * PI * self.radius_m * (self.length_m + 2.0 * self.radius_m)
    }

    /// The nearest point of the axis between the ends.
    fn middle_m(&self, point_m: DVec3) -> DVec3 {
        let along_m = (point_m - self.start_m).dot(self.axis);
        self.start_m + self.axis * along_m.clamp(0.0, self.length_m)
    }

    fn holds(&self, from: DVec3) -> bool {
        self.middle_m(from).distance(from) <= self.radius_m
    }

    /// Both crossings of a line with the surface; none where it misses.
    fn crossings(&self, from: DVec3, direction: DVec3) -> Option<[Crossing; 2]> {
        // The line within the round wall, then within either end: the tube is convex, and these are all of it.
        let to_start = from - self.start_m;
        let (along, speed) = (to_start.dot(self.axis), direction.dot(self.axis));
        let beside = to_start - along * self.axis;
        let across = direction - speed * self.axis;
        let (mut enter, mut leave) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut add = |at: f64| (enter, leave) = (enter.min(at), leave.max(at));
        let a = across.length_squared();
        if a > 1e-24 {
            let b = beside.dot(across);
            let nearest2 = (beside - across * (b / a)).length_squared();
            let reach2 = self.radius_m * self.radius_m - nearest2;
            if reach2 < 0.0 {
                return None;
            }
            let half = (reach2 / a).sqrt();
            for at in [-b / a - half, -b / a + half] {
                if (0.0..=self.length_m).contains(&(along + at * speed)) {
                    add(at);
                }
            }
        }
        for offset_m in [0.0, self.length_m] {
            let to_middle = to_start - offset_m * self.axis;
            let b = to_middle.dot(direction);
            let half2 = self.radius_m.powi(2) - (to_middle - direction * b).length_squared();
            if half2 >= 0.0 {
                for at in [-b - half2.sqrt(), -b + half2.sqrt()] {
                    let past_m = along + at * speed - offset_m;
                    let is_out = if offset_m == 0.0 {
                        past_m <= 0.0
                    } else {
                        past_m >= 0.0
                    };
                    if is_out {
                        add(at);
                    }
                }
            }
        }
        (enter < leave).then(|| {
            [enter, leave].map(|distance_m| {
                let at = from + direction * distance_m;
                let normal = (at - self.middle_m(at)) / self.radius_m;
                Crossing {
                    distance_m,
                    cos: normal.dot(direction).abs(),
                }
            })
        })
    }

    /// (direction, distance, density)
    pub fn sample(&self, from: DVec3, u: DVec2) -> Option<(DVec3, f64, f64)> {
        let (x, y) = self.axis.any_orthonormal_pair();
        // Height is evenly distributed over a sphere cut in two and over the wall between the halves.
        let height_m = u.x * (self.length_m + 2.0 * self.radius_m) - self.radius_m;
        let (sin, cos) = (2.0 * PI * u.y).sin_cos();
        let past_m = height_m - height_m.clamp(0.0, self.length_m);
        let rim_m = (self.radius_m.powi(2) - past_m * past_m).max(0.0).sqrt();
        let at = self.start_m + self.axis * height_m + (x * cos + y * sin) * rim_m;
        let direction = (at - from).try_normalize()?;
        let distance_m = self.hit(from, direction)?;
        Some((direction, distance_m, self.pdf(from, direction)))
    }

    pub fn hit(&self, from: DVec3, direction: DVec3) -> Option<f64> {
        let [enter, _] = self.crossings(from, direction)?;
        (enter.distance_m > 0.0 && !self.holds(from)).then_some(enter.distance_m)
    }

    /// Density of a direction over solid angle, in 1/sr. A line crosses the tube twice, and points
    /// of both sides are drawn.
    pub fn pdf(&self, from: DVec3, direction: DVec3) -> f64 {
        let Some(crossings) = self.crossings(from, direction) else {
            return 0.0;
        };
        let shown = crossings.map(|at| at.distance_m.powi(2) / at.cos.max(1e-12));
        shown.iter().sum::<f64>() / self.area_m2()
    }

    /// Distance at which a ray meets the tube first, or passes nearest to its middle.
    pub fn reach_m(&self, from: DVec3, direction: DVec3) -> f64 {
        self.hit(from, direction).unwrap_or_else(|| {
            let middle = self.start_m + 0.5 * self.length_m * self.axis;
            (middle - from).dot(direction).max(0.0)
        })
    }

    /// Spheres in a row that hold the tube.
    fn beads(&self) -> impl Iterator<Item = SphereLight> {
        const MOST: f64 = 64.0;
        let count = (self.length_m / self.radius_m).ceil().clamp(1.0, MOST);
        let step_m = self.length_m / count;
        let radius_m = self.radius_m.hypot(0.5 * step_m);
        let tube = *self;
        (0..=count as u32).map(move |i| {
            SphereLight::new(tube.start_m + f64::from(i) * step_m * tube.axis, radius_m)
        })
    }

    /// Least and greatest component along `axis` of the unit directions to the tube.
    pub fn extent(&self, from: DVec3, axis: DVec3) -> (f64, f64) {
        let extents = self.beads().map(|bead| bead.bound(from).extent(axis));
        extents.fold((1.0, -1.0), |(low, high), (a, b)| (low.min(a), high.max(b)))
    }

    /// Cone that contains all directions to the tube.
    #[cfg(test)]
    pub fn bound(&self, from: DVec3) -> Cone {
        let middle_m = self.start_m + 0.5 * self.length_m * self.axis;
        SphereLight::new(middle_m, 0.5 * self.length_m + self.radius_m).bound(from)
    }
}
