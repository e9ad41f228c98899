//! A sphere on the lobe of [`BrushedLobe`].

use glam::DVec3;

use super::BrushedLobe;
use super::slice::FAR;
use crate::fresnel::FresnelRgb;

/// The rim of a sphere in slopes. A direction with slopes x and y is inside where a2 y^2 + 2 a1 y + a0 is above zero.
struct SlopeConic {
    a2: f64,
    /// a1 = b0 + b1 x.
    b: [f64; 2],
    /// a0 = e0 + e1 x + e2 x^2.
    e: [f64; 3],
    /// a1^2 - a2 a0 = d0 + 2 d1 x + d2 x^2, in an order that keeps the digits of small spheres. Slices reach the rim where that is above zero.
    d: [f64; 3],
}

impl SlopeConic {
    /// Whether a slice is inside beyond its two crossings, and not between them.
    fn is_outside(&self) -> bool {
        self.a2 > 0.0
    }

    /// Slopes at which a slice enters and leaves the sphere, with signs.
    fn crossings(&self, x: f64, add: &mut dyn FnMut(f64, f64)) {
        let Self { a2, b, e, d } = *self;
        let (a1, a0) = (b[0] + b[1] * x, e[0] + x * (e[1] + x * e[2]));
        let inside = d[0] + x * (2.0 * d[1] + x * d[2]);
        let sign = if self.is_outside() { -1.0 } else { 1.0 };
        if self.is_outside() {
            add(FAR, 1.0);
            add(-FAR, -1.0);
        }
        if inside > 0.0 {
            let reach = inside.sqrt().copysign(a1);
            let q = -(a1 + reach);
            // The nearer end has two forms; the one that cancels less is used.
            let near = if 2.0 * reach.abs() < a1.abs() {
                (reach - a1) / a2
            } else {
                a0 / q
            };
            let ends = [q / a2, near];
            add(ends[0].max(ends[1]).min(FAR), sign);
            add(ends[0].min(ends[1]).max(-FAR), -sign);
        }
    }
}

impl BrushedLobe {
    /// Computes the light that the lobe reflects of a sphere, single scattering, over the sphere's radiance. `axis` is the unit direction to its centre
    /// in the local frame, `sin2` the squared sine of its angular radius; from inside (sin2 >= 1) everything is lit.
    pub fn sphere(&self, axis: DVec3, sin2: f64, of: &FresnelRgb) -> [f64; 3] {
        let c = self.turned(axis);
        let wo = self.wo;
        // Cosine of the radius, squared sine and 1 less the cosine; from inside those of a cap that holds more than all.
        let (least, sin2, versine) = if sin2 >= 1.0 {
            (-2.0, -3.0, 3.0)
        } else {
            let cos = (1.0 - sin2).sqrt();
            (cos, sin2, sin2 / (1.0 + cos))
        };
        let m = wo.dot(c) + least;
        let a2 = 2.0 * wo.y * c.y - m;
        let b = [-(wo.z * c.y + wo.y * c.z), wo.x * c.y + wo.y * c.x];
        let e = [
            2.0 * wo.z * c.z - m,
            -2.0 * (wo.x * c.z + wo.z * c.x),
            2.0 * wo.x * c.x - m,
        ];
        let (p, r) = (wo.x + c.x, wo.z + c.z);
        let crossed = versine * (wo.x * c.z + wo.z * c.x);
        let (of_x, of_z) = (
            sin2 + 2.0 * versine * wo.x * c.x,
            sin2 + 2.0 * versine * wo.z * c.z,
        );
        let (d2, d1, d0) = (of_z - r * r, crossed - p * r, of_x - p * p);
        let conic = SlopeConic {
            a2,
            b,
            e,
            d: [d0, d1, d2],
        };
        let mut range = [-1.0, 1.0];
        if d2 < 0.0 && !conic.is_outside() {
            let inside = r * r * of_x + p * p * of_z - 2.0 * p * r * crossed + crossed * crossed
                - of_x * of_z;
            if inside <= 0.0 {
                return [0.0; 3];
            }
            let ends = [1.0, -1.0].map(|sign| (-d1 + sign * inside.sqrt()) / d2);
            range = ends.map(|end| self.place_of_slope(end));
        }
        self.sum_of_slices(range, of, |x, add| conic.crossings(x, add))
    }
}
