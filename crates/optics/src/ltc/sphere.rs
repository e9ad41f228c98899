//! A sphere in the cosine's space: an elliptic cone.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3Swizzles};

use super::reflected::ltc_reflected;
use super::{LobeFresnel, LtcLobe, ltc_lobe};
use crate::fresnel::FresnelRgb;
use crate::irradiance::{EllipticCone, irradiance_basis, irradiance_cone};

/// The integral of [`polygon_light`](super::polygon_light) over a sphere, cut by the horizon. `axis` is the unit direction
/// to its centre in the local frame, `sin2` the squared sine of its angular radius: radius^2 / distance^2. From inside (sin2 >= 1)
/// everything is lit.
pub fn sphere_light(
    wo: DVec3,
    roughness: f64,
    fresnel: FresnelRgb,
    axis: DVec3,
    sin2: f64,
) -> [f64; 3] {
    let of = LobeFresnel::new(fresnel, wo, roughness);
    ltc_sphere(&ltc_lobe(wo, roughness), &of, axis, sin2)
}

/// [`sphere_light`] for a lobe at hand.
pub fn ltc_sphere(lobe: &LtcLobe, of: &LobeFresnel, axis: DVec3, sin2: f64) -> [f64; 3] {
    ltc_reflected(lobe, of, ltc_sphere_vector(lobe, axis, sin2))
}

/// The vector irradiance of a sphere in the cosine's space.
pub fn ltc_sphere_vector(lobe: &LtcLobe, axis: DVec3, sin2: f64) -> DVec3 {
    if sin2 >= 1.0 {
        return PI * DVec3::Z;
    }
    // The horizon is the same here as in the cosine's space.
    if sin2 <= 0.0 || axis.z <= 0.0 && axis.z * axis.z >= sin2 {
        return DVec3::ZERO;
    }
    let cone = ltc_cone(lobe, lobe.rotate(axis), sin2);
    if axis.z * axis.z >= sin2 {
        ltc_cone_whole(&cone)
    } else {
        irradiance_cone(&ltc_cone_axes(&cone))
    }
}

/// A cone of directions in the cosine's space, within the rim c + u cos t + v sin t. In the frame of u, v (perpendicular) and n, c is `centre`.
struct LtcCone {
    /// Unit vectors of u, v and n, right-handed.
    frame: [DVec3; 3],
    centre: DVec3,
    /// Squared lengths of u and v.
    size2: DVec2,
    /// The determinant of (c, u, v).
    volume: f64,
    /// The positive root mu of x^2 / (mu + |u|^2) + y^2 / (mu + |v|^2) + z^2 / mu = 1, where (x, y, z) is `centre`.
    root: f64,
}

/// Rounds in which [`LtcCone::root`] is refined. The worst cones (mirrors, a wide light whose rim touches the peak) have 1e-4 left after
/// three and 3e-9 after four; one in a thousand has 1e-9 after three.
const CONE_ROUNDS: usize = 5;
/// Relative change that ends them: as the error is squared each time, the next would change nothing.
const CONE_CHANGE: f64 = 1e-8;

/// The cone of directions within asin sqrt(sin2) of `axis` (viewer's frame).
///
/// Its rim is on the quadric of matrix c c^T - u u^T - v v^T, whose eigenvectors are the axes of the elliptic cone: with u and v made
/// perpendicular, a diagonal matrix and a rank of one, so that the eigenvalues are the roots of a sum of poles (G. H. Golub, "Some
/// modified matrix eigenvalue problems", SIAM Review 1973). All terms of the sum are positive at the one positive root, that of the
/// cone's middle: nothing cancels, and slivers and specks keep their relative precision. Each round puts one pole for the first two,
/// of their value and slope (after J. R. Bunch, C. P. Nielsen and D. C. Sorensen, "Rank-one modification of the symmetric
/// eigenproblem", 1978).
fn ltc_cone(lobe: &LtcLobe, axis: DVec3, sin2: f64) -> LtcCone {
    let (u, v) = irradiance_basis(axis);
    let cosine = (1.0 - sin2).max(0.0).sqrt();
    let per_width = lobe.width.recip();
    let [c, u, v] = [axis, u, v].map(|w| lobe.cosine_by(per_width, w));
    let c = c * cosine;
    let (u, v) = ltc_rotate_pair(u, v);
    let (length_u, length_v) = (u.length().max(1e-30), v.length().max(1e-30));
    let (u, v) = (u / length_u, v / length_v);
    let determinant = lobe.peak.y * lobe.peak.y / (lobe.width.x * lobe.width.y);
    let n = u.cross(v);
    let centre = DVec3::new(
        c.dot(u),
        c.dot(v),
        determinant * cosine / (length_u * length_v),
    );
    let size2 = DVec2::new(length_u * length_u, length_v * length_v) * sin2;
    LtcCone {
        frame: [u, v, n],
        centre,
        size2,
        volume: determinant * cosine * sin2,
        root: ltc_cone_root(centre * centre, size2),
    }
}

/// [`LtcCone::root`], from the squares of `centre` and the squared lengths.
fn ltc_cone_root(centre2: DVec3, size2: DVec2) -> f64 {
    let level = centre2.x + centre2.y;
    // Both poles are replaced by one at their mean.
    let mean = centre2.xy().dot(size2) / level.max(1e-30);
    let mut root = ltc_one_pole(level, mean, centre2.z);
    for _ in 0..CONE_ROUNDS {
        let (x, y) = (root + size2.x, root + size2.y);
        let value = centre2.x * y + centre2.y * x;
        let per_slope = value / (centre2.x * y * y + centre2.y * x * x).max(1e-30);
        let before = root;
        root = ltc_one_pole(value * per_slope, x * y * per_slope - root, centre2.z);
        if (root - before).abs() <= CONE_CHANGE * root {
            break;
        }
    }
    root
}

/// The positive root of a / (mu + pole) + b / mu = 1.
#[inline]
fn ltc_one_pole(a: f64, pole: f64, b: f64) -> f64 {
    let half = 0.5 * (a + b - pole);
    let rest = (half * half + b * pole).max(0.0).sqrt();
    if half > 0.0 {
        half + rest
    } else {
        b * pole / (rest - half).max(1e-30)
    }
}

/// The cone's middle in its frame, of the length that `root` gives it: the eigenvector.
fn ltc_cone_middle(cone: &LtcCone) -> DVec3 {
    let root = cone.root.max(1e-30);
    cone.centre / DVec3::new(root + cone.size2.x, root + cone.size2.y, root)
}

/// The vector irradiance of a cone that the horizon does not cut: pi T1 T2 / sqrt((1 + T1^2)(1 + T2^2)) along its middle, by the
/// products of the other two eigenvalues (from the determinant) and of their differences from the root (from the sum's slope there).
fn ltc_cone_whole(cone: &LtcCone) -> DVec3 {
    let root = cone.root.max(1e-30);
    let middle = ltc_cone_middle(cone);
    let poles = ((root + cone.size2.x) * (root + cone.size2.y)).sqrt();
    let length = PI * cone.volume / (root * poles * middle.length_squared());
    let [u, v, n] = cone.frame;
    length * (u * middle.x + v * middle.y + n * middle.z)
}

/// The cone by its axes.
///
/// A Lorentz boost of (c, u, v) moves points along the rim but leaves the cone; the one that brings c into the middle leaves u and v
/// in the plane across it, where a rotation makes them perpendicular.
fn ltc_cone_axes(cone: &LtcCone) -> EllipticCone {
    let root = cone.root.max(1e-30);
    let middle = ltc_cone_middle(cone);
    let per_length = 1.0 / (root * middle.length_squared()).sqrt();
    let size = DVec2::new(cone.size2.x.sqrt(), cone.size2.y.sqrt());
    let boost = -per_length * middle.xy() * size;
    let forward = boost / (1.0 + per_length);
    // Vectors in the frame of u, v and n.
    let of_c = |k: f64| cone.centre * k;
    let u = of_c(boost.x)
        + DVec3::new(
            size.x * (1.0 + boost.x * forward.x),
            size.y * boost.x * forward.y,
            0.0,
        );
    let v = of_c(boost.y)
        + DVec3::new(
            size.x * boost.y * forward.x,
            size.y * (1.0 + boost.y * forward.y),
            0.0,
        );
    let (mut u, mut v) = ltc_rotate_pair(u, v);
    if u.length_squared() > v.length_squared() {
        (u, v) = (v, -u);
    }
    let (length_u, length_v) = (u.length().max(1e-30), v.length().max(1e-30));
    // Half-angles end at 0.006 degrees below 90.
    let length_c = root.sqrt().max(1e-4 * length_u);
    let [x, y, z] = cone.frame;
    let from_frame = |w: DVec3| x * w.x + y * w.y + z * w.z;
    let side2 = from_frame(v / length_v);
    let centre = from_frame(u.cross(v)).normalize_or(DVec3::Z);
    EllipticCone {
        axis: centre,
        side1: side2.cross(centre),
        side2,
        t1: length_u / length_c,
        t2: length_v / length_c,
    }
}

/// Rotates (u, v) into each other until they are perpendicular.
#[inline]
fn ltc_rotate_pair(u: DVec3, v: DVec3) -> (DVec3, DVec3) {
    let product = 2.0 * u.dot(v);
    let difference = v.length_squared() - u.length_squared();
    let sum = difference.abs() + (difference * difference + product * product).sqrt();
    if sum <= 0.0 {
        return (u, v);
    }
    let tangent = product.copysign(product * difference) / sum;
    let cos = 1.0 / (1.0 + tangent * tangent).sqrt();
    (cos * (u - tangent * v), cos * (v + tangent * u))
}

#[cfg(test)]
mod tests;
