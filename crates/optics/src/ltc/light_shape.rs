//! Which way a light is how long in the cosine's space of a lobe.

use std::ops::AddAssign;

use glam::{DVec3, Vec3Swizzles};

use super::RING_RADIUS;
use crate::irradiance::irradiance_basis;

/// Factor of the limit on how far the ring goes down from its centre: over the centre's height above the horizon it is 1 less this times the viewer's cosine.
/// GGX rises steeply near the horizon, the more the flatter the view.
const RING_LIFT: f64 = 0.12;
/// The longest radius of the ring.
const RING_MAX: f64 = 0.97;
/// The root of the determinant of a disk's tensor, as of its corners, over the squared radius of its ring.
const LEAST_AREA: f64 = 0.5 / (RING_RADIUS * RING_RADIUS);
/// The least determinant of the ring's shape: that of a light without an area is 0.
const LEAST_DETERMINANT: f64 = 1e-2;
/// The least square of a light's width each way over that of its length.
const LEAST_WIDTH: f64 = 1e-7;

/// Squares of a light's length each way: a symmetric tensor.
#[derive(Clone, Copy, Debug, Default)]
pub struct LightShape {
    /// Of x x, y y and z z.
    diagonal: DVec3,
    /// Of y z, z x and x y.
    mixed: DVec3,
}

impl LightShape {
    /// The same each way.
    pub const ROUND: Self = Self {
        diagonal: DVec3::ONE,
        mixed: DVec3::ZERO,
    };

    /// The product of a vector with itself.
    pub(super) fn square(w: DVec3) -> Self {
        Self {
            diagonal: w * w,
            mixed: w.yzx() * w.zxy(),
        }
    }

    fn of(&self, u: DVec3, v: DVec3) -> f64 {
        self.diagonal.dot(u * v) + self.mixed.dot(u.yzx() * v.zxy() + u.zxy() * v.yzx())
    }
}

impl AddAssign for LightShape {
    fn add_assign(&mut self, other: Self) {
        self.diagonal += other.diagonal;
        self.mixed += other.mixed;
    }
}

/// Unit vectors to the corners of a polygon, those below the horizon raised to it, from the first one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Corners {
    count: f64,
    first: DVec3,
    sum: DVec3,
    squares: LightShape,
}

impl Corners {
    pub(super) fn add(&mut self, w: DVec3) {
        let w = w.with_z(w.z.max(0.0));
        let w = w / w.length().max(1e-30);
        if self.count == 0.0 {
            self.first = w;
        }
        self.count += 1.0;
        self.sum += w - self.first;
        self.squares += LightShape::square(w - self.first);
    }

    /// Their covariances.
    pub(super) fn shape(&self) -> LightShape {
        let per_corner = 1.0 / self.count.max(1.0);
        let mean = LightShape::square(per_corner * self.sum);
        LightShape {
            diagonal: per_corner * self.squares.diagonal - mean.diagonal,
            mixed: per_corner * self.squares.mixed - mean.mixed,
        }
    }
}

/// Two radii of the ring about `centre`, conjugate to each other, with a product of the ellipse's half-axes of `radius2`. The ring is as much longer one
/// way than another as the light: directions on a circle would all lie near the middle of a long one. Where the ring would go below the horizon it is
/// flattened to an ellipse of the same area above it. The more the lobe's core is `bent`, the rounder is the ring: the ends of a long light miss the core.
pub(super) fn ltc_ring(
    cos_o: f64,
    bent: f64,
    centre: DVec3,
    radius2: f64,
    shape: &LightShape,
) -> [DVec3; 2] {
    let (u, v) = irradiance_basis(centre);
    let (uu, uv, vv) = (shape.of(u, u), shape.of(u, v), shape.of(v, v));
    // The determinant of a long and narrow light is a difference of large numbers; it is no less than that of a disk of the light's area.
    let area = (uu * vv - uv * uv).max(0.0).sqrt();
    let per_area = (1.0 - bent) / area.max(LEAST_AREA * radius2).max(1e-30);
    let (uu, uv, vv) = (bent + per_area * uu, per_area * uv, bent + per_area * vv);
    let per_area = 1.0 / (uu * vv - uv * uv).max(LEAST_DETERMINANT).sqrt();
    let (uu, vv) = (uu.max(LEAST_WIDTH * vv), vv.max(LEAST_WIDTH * uu));
    let most = (uu * vv).sqrt();
    let along_v = uv.clamp(-most, most) / uu.max(1e-30);
    let depth = (1.0 - RING_LIFT * cos_o) * centre.z;
    let down = (radius2 * uu * per_area).sqrt().min(depth).max(1e-15);
    let along = radius2 / down;
    let ends_early = |radius: DVec3| radius * (RING_MAX / radius.length().max(RING_MAX));
    [ends_early(down * (u + along_v * v)), ends_early(along * v)]
}
