//! The GGX lobe over a polygon or a sphere, by linearly transformed cosines.
//!
//! E. Heitz, J. Dupuy, S. Hill and D. Neubelt, "Real-time polygonal-light shading with linearly transformed cosines"
//! (SIGGRAPH 2016): a clamped cosine, transformed by a matrix M, stands for the lobe; a light transformed by its inverse
//! is integrated against the cosine. E. Heitz and S. Hill, "Real-time line- and disk-light shading with LTCs" (2017):
//! a cone transforms into an elliptic one.
//!
//! Four things differ from the papers.
//! * M keeps the horizon: the lobe ends exactly where the surface does, one cut at z = 0 serves both, and a light that
//!   covers the hemisphere returns the albedo by construction. That leaves three parameters, two widths and the angle
//!   by which the peak leans from the mirror direction to the normal, which stay smooth down to the mirror.
//! * What the fit misses is put back: the integral is multiplied by GGX over the fit at a few directions spread over the
//!   visible part of the light. For a light small against the lobe the result is GGX itself.
//! * Fresnel is taken at the same directions, and not from the lobe's average: a light shows what its own half vectors reflect.
//! * The cut is exact for spheres too.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3Swizzles};

use crate::fresnel::FresnelRgb;
use crate::ggx::{ggx_alpha, projected_roughness};
use crate::irradiance::{
    EllipticCone, PolygonIrradiance, irradiance_basis, irradiance_begin, irradiance_cone,
    irradiance_edge, irradiance_end,
};
use crate::lobe_table::{LOBE_MIN_COS, albedo_lookup, ltc_table};

/// The fitted parameters of one (roughness, angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LtcShape {
    /// Width in the plane of incidence over 2 alpha; 1 at the mirror.
    pub width_x: f64,
    /// Width across it over 2 alpha; 1 at the mirror.
    pub width_y: f64,
    /// Angle of the peak from the mirror direction towards the normal, over alpha sin(theta_o).
    pub lean: f64,
}

/// The lobe seen from one direction on one surface, F = 1, shared by all lights on that point.
///
/// In the frame whose x is towards the viewer a direction w maps to (u, y / (2 alpha width_y) - shear u, z) with u = cos_peak (cos_peak x + sin_peak z) / (2
/// alpha width_x).
#[derive(Clone, Copy, Debug)]
pub struct LtcLobe {
    /// Viewer in its own frame: y = 0, x >= 0.
    pub wo: DVec3,
    /// The x axis of that frame in the local one.
    pub x_axis: DVec2,
    /// GGX alpha of the surface, for masking and shadowing.
    pub alpha: f64,
    /// GGX alphas of the normals, wider where a pixel's normals differ: in the plane of view and normal, and across it for normals of one slope in that
    /// plane.
    pub alphas: DVec2,
    /// Displacement of the mean slope across the plane, over the second alpha, for a slope in the plane of one first alpha.
    pub shear: f64,
    /// Weight, 0 to 1, of the uncorrected fit for large lights, where the lobe's core is too bent for the correction. Normals that spread across the plane of
    /// view and normal reflect to an arc; the fit draws its chord, and where the two are further apart than they are wide the correction would find next to
    /// nothing.
    pub bent: f64,
    /// The share of the normals' spread that is the pixel's: its normals are weighted as the picture shows them, and not as facets are.
    pub turned: f64,
    /// Sine and cosine of the peak's angle from the normal; the peak is on the side away from the viewer.
    pub peak: DVec2,
    /// 2 alpha times the widths of [`LtcShape`].
    pub width: DVec2,
    /// Directional albedo E0.
    pub albedo: f64,
}

/// The lobe for a viewer `wo` in the local frame (z = normal; any unit vector: below the horizon it counts as grazing) and a
/// perceptual roughness in [0, 1].
pub fn ltc_lobe(wo: DVec3, roughness: f64) -> LtcLobe {
    let cos_o = wo.z.max(LOBE_MIN_COS);
    let [width_x, width_y, lean, _] = ltc_table().lookup(roughness, cos_o);
    LtcLobe::new(
        wo,
        ggx_alpha(roughness),
        LtcShape {
            width_x,
            width_y,
            lean,
        },
        albedo_lookup(roughness, cos_o),
    )
}

impl LtcLobe {
    /// Builds the lobe of [`ltc_lobe`] from parameters instead of the table; the fit varies them.
    pub fn new(wo: DVec3, alpha: f64, shape: LtcShape, albedo: f64) -> Self {
        let (x_axis, sin_cos) = viewer_frame(wo);
        let lean = alpha * shape.lean * sin_cos.x;
        let peak = DVec2::new(
            sin_cos.x * lean.cos() - sin_cos.y * lean.sin(),
            sin_cos.y * lean.cos() + sin_cos.x * lean.sin(),
        );
        Self {
            wo: DVec3::new(sin_cos.x, 0.0, sin_cos.y),
            x_axis,
            alpha,
            alphas: DVec2::splat(alpha),
            shear: 0.0,
            bent: 0.0,
            turned: 0.0,
            peak: DVec2::new(peak.x.max(0.0), peak.y),
            width: 2.0 * alpha * DVec2::new(shape.width_x, shape.width_y),
            albedo,
        }
    }

    /// Returns the lobe with other normals.
    pub(crate) fn widened(&self, alphas: DVec2, shear: f64, bent: f64, turned: f64) -> Self {
        Self {
            alphas,
            shear,
            bent,
            turned,
            width: self.width * alphas / self.alpha,
            ..*self
        }
    }

    /// Rotates a vector from the local frame into the viewer's.
    pub fn rotate(&self, w: DVec3) -> DVec3 {
        DVec3::new(
            self.x_axis.x * w.x + self.x_axis.y * w.y,
            self.x_axis.x * w.y - self.x_axis.y * w.x,
            w.z,
        )
    }

    /// Maps a vector from the viewer's frame into the cosine's space; linear, keeps z.
    pub(crate) fn to_cosine(self, w: DVec3) -> DVec3 {
        self.cosine_by(self.width.recip(), w)
    }

    /// [`Self::to_cosine`] from the reciprocal widths.
    fn cosine_by(&self, per_width: DVec2, w: DVec3) -> DVec3 {
        let x = self.peak.y * (self.peak.y * w.x + self.peak.x * w.z) * per_width.x;
        DVec3::new(x, w.y * per_width.y - self.shear * x, w.z)
    }

    /// The transpose of [`LtcLobe::to_cosine`].
    fn cosine_transposed(&self, w: DVec3) -> DVec3 {
        let x = self.peak.y * (w.x - self.shear * w.y) / self.width.x;
        DVec3::new(self.peak.y * x, w.y / self.width.y, w.z + self.peak.x * x)
    }

    /// The inverse of [`LtcLobe::to_cosine`], times cos_peak^2, which keeps it finite for a peak on the horizon.
    fn undo_cosine(&self, w: DVec3) -> DVec3 {
        let (s, c) = (self.peak.x, self.peak.y);
        DVec3::new(
            self.width.x * w.x - s * c * w.z,
            c * c * self.width.y * (w.y + self.shear * w.x),
            c * c * w.z,
        )
    }

    /// The density that stands for the lobe, at a unit direction in the local frame: integrates to E0.
    pub fn eval(&self, wi: DVec3) -> f64 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let w = self.to_cosine(self.rotate(wi));
        let l2 = w.length_squared();
        let determinant = self.peak.y * self.peak.y / (self.width.x * self.width.y);
        self.albedo * determinant * w.z / (PI * l2 * l2)
    }

    /// A direction in the viewer's frame distributed as the density, from a cosine-distributed one: for the fit.
    pub fn sample(&self, cosine_distributed: DVec3) -> DVec3 {
        self.undo_cosine(cosine_distributed).normalize_or(DVec3::Z)
    }
}

/// Fresnel reflectance of the lobe's facets.
#[derive(Clone, Copy, Debug)]
pub struct LobeFresnel<'a> {
    /// Reflectance of a facet.
    pub fresnel: FresnelRgb<'a>,
    /// Directional albedo of the whole lobe, single scattering.
    pub albedo: [f64; 3],
}

impl<'a> LobeFresnel<'a> {
    /// Reflectance for the lobe of [`ltc_lobe`].
    pub fn new(fresnel: FresnelRgb<'a>, wo: DVec3, roughness: f64) -> Self {
        Self {
            fresnel,
            albedo: fresnel.albedo(roughness, wo.z.max(LOBE_MIN_COS)),
        }
    }
}

/// Viewer's frame, for any `wo`: its x axis in the local frame, and sine and cosine of the viewer's angle to the normal.
pub fn viewer_frame(wo: DVec3) -> (DVec2, DVec2) {
    let sine = wo.truncate().length();
    let x_axis = if sine > 1e-9 {
        wo.truncate() / sine
    } else {
        DVec2::X
    };
    let sin_cos = DVec2::new(sine, wo.z.max(LOBE_MIN_COS));
    (x_axis, sin_cos / sin_cos.length())
}

/// Starts a polygon; see [`ltc_end`].
pub fn ltc_begin() -> PolygonIrradiance {
    irradiance_begin()
}

/// Adds the edge from `a` to `b`, positions relative to the point, in the local frame. Edges follow one another and close.
pub fn ltc_edge(state: &mut PolygonIrradiance, lobe: &LtcLobe, a: DVec3, b: DVec3) {
    irradiance_edge(
        state,
        lobe.to_cosine(lobe.rotate(a)),
        lobe.to_cosine(lobe.rotate(b)),
        lobe.to_cosine(lobe.rotate(b - a)),
    );
}

/// The vector irradiance of a polygon in the cosine's space.
pub fn ltc_vector(lobe: &LtcLobe, vertices: &[DVec3]) -> DVec3 {
    let mut state = ltc_begin();
    for (i, &a) in vertices.iter().enumerate() {
        ltc_edge(&mut state, lobe, a, vertices[(i + 1) % vertices.len()]);
    }
    irradiance_end(&state)
}

/// Returns the light that the lobe reflects of the polygon, in either orientation, as [`polygon_light`].
pub fn ltc_end(state: &PolygonIrradiance, lobe: &LtcLobe, of: &LobeFresnel) -> [f64; 3] {
    ltc_reflected(lobe, of, irradiance_end(state))
}

/// The integral of the GGX lobe (the cosine inside) times Fresnel's reflectance at the half vector over a simple polygon,
/// convex or not, cut by the horizon; single scattering. `wo` and the vertices (relative to the point) are in the local frame.
pub fn polygon_light(
    wo: DVec3,
    roughness: f64,
    fresnel: FresnelRgb,
    vertices: &[DVec3],
) -> [f64; 3] {
    let lobe = ltc_lobe(wo, roughness);
    let mut state = ltc_begin();
    for (i, &a) in vertices.iter().enumerate() {
        ltc_edge(&mut state, &lobe, a, vertices[(i + 1) % vertices.len()]);
    }
    ltc_end(&state, &lobe, &LobeFresnel::new(fresnel, wo, roughness))
}

/// The integral of [`polygon_light`] over a sphere, cut by the horizon. `axis` is the unit direction
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

/// Radius of the ring on which the fit is compared with GGX, besides the centre, in units of the sine of the light's radius. The rule integrates cubics over
/// a disk.
const RING_RADIUS: f64 = 0.866_025_403_784_438_6;
const RING_WEIGHT: f64 = 1.0 / 6.0;
const CENTRE_WEIGHT: f64 = 1.0 / 3.0;
/// Factor of the limit on how far the ring goes down from its centre: over the centre's height above the horizon it is 1 less this times the viewer's cosine.
/// GGX rises steeply near the horizon, the more the flatter the view.
const RING_LIFT: f64 = 0.12;
/// The longest radius of the ring.
const RING_MAX: f64 = 0.97;
/// Squared sine of a light's angular radius at which a fully bent lobe ([`LtcLobe::bent`]) is corrected by half.
const FIT_FROM: f64 = 0.0003;
/// The share of the cosine from which on the rest of the hemisphere counts, more and more up to the whole.
const REST_FROM: f64 = 0.3;

/// Computes the light that the lobe reflects from the light's vector irradiance in the cosine's space: E0 times the share of the cosine, times the mean of
/// GGX over the fit (`ltc_means`); then that, times the mean of Fresnel's reflectance over GGX.
///
/// What is missing in E0 is the same integral over the part of the hemisphere that the light leaves free. Of a light and the rest the smaller is
/// the better known, so with a growing share the result goes over from the one to the other. The means fade as the light comes to fill the
/// hemisphere, where the albedos are exact. The numbers here are chosen by the measured errors of docs/lobes.md.
pub fn ltc_reflected(lobe: &LtcLobe, of: &LobeFresnel, vector: DVec3) -> [f64; 3] {
    let share = (vector.z / PI).clamp(0.0, 1.0);
    if share <= 0.0 {
        return [0.0; 3];
    }
    let sin2 = (vector.length() / PI).min(1.0);
    let e0 = lobe.albedo;
    let (light, parts) = ltc_means(lobe, of, vector);
    let fade = sin2.powf(2.0 + 12.0 * lobe.wo.z * lobe.wo.z);
    // A part returns no more than the whole.
    let mut integral = (share * (light + fade * (e0 - light))).min(e0);
    let x = ((share - REST_FROM) / (1.0 - REST_FROM)).max(0.0);
    let by_rest = x * x * (3.0 - 2.0 * x);
    if by_rest > 0.0 {
        let (rest, _) = ltc_means(lobe, of, PI * DVec3::Z - vector);
        let missing = ((1.0 - share) * rest).min(e0);
        integral += by_rest * (e0 - missing - integral);
    }
    // A mean over some directions or other: whatever it is made of, a reflectance stays within its range.
    let mean = of.fresnel.of_parts(parts);
    let fade = (sin2 * sin2) * (sin2 * sin2);
    std::array::from_fn(|ch| integral * (mean[ch] + fade * (of.albedo[ch] / e0 - mean[ch])))
}

/// Computes the light that the lobe reflects, single scattering, from a light that is so small that all of it comes from one direction, by its vector
/// irradiance in the cosine's space.
pub fn ltc_small_light(lobe: &LtcLobe, of: &LobeFresnel, vector: DVec3) -> [f64; 3] {
    let length = vector.length().max(1e-30);
    if vector.z <= 0.0 {
        return [0.0; 3];
    }
    let ([value], [cos_h]) = ltc_exact_over_jacobian(lobe, [vector / length]);
    let facet = of.fresnel.of_parts(of.fresnel.curve.lookup(cos_h));
    facet.map(|facet| length * value * facet)
}

/// The mean of GGX over the fit, times E0; and the means of the parts of a reflectance over GGX. From the vector irradiance of what they are
/// taken over: at five directions of a cap that has the same irradiance ([`ltc_ring`]).
fn ltc_means(lobe: &LtcLobe, of: &LobeFresnel, vector: DVec3) -> (f64, [f64; 4]) {
    let length = vector.length().max(1e-30);
    let centre = vector / length;
    let sin2 = (length / PI).min(1.0);
    let [u, v] = ltc_ring(lobe, centre, RING_RADIUS * RING_RADIUS * sin2);
    let (at_u, at_v) = (
        (1.0 - u.length_squared()).sqrt() * centre,
        (1.0 - v.length_squared()).sqrt() * centre,
    );
    let points = [centre, at_u + u, at_v + v, at_u - u, at_v - v];
    let mut weights = [RING_WEIGHT; 5];
    weights[0] = CENTRE_WEIGHT;
    let (values, cosines) = ltc_exact_over_jacobian(lobe, points);
    let (mut exact, mut cosine, mut parts) = (0.0, 0.0, [0.0; 4]);
    for i in 0..points.len() {
        if points[i].z <= 0.0 {
            continue;
        }
        let value = weights[i] * values[i];
        exact += value;
        cosine += weights[i] * points[i].z;
        let at = of.fresnel.curve.lookup(cosines[i]);
        for k in 0..4 {
            parts[k] += value * at[k];
        }
    }
    let mean = PI * exact / cosine.max(1e-30);
    // Five directions find a small light on an arc and miss parts of a large one.
    let by_fit = lobe.bent * sin2 / (sin2 + FIT_FROM);
    (
        mean + by_fit * (lobe.albedo - mean),
        parts.map(|part| part / exact.max(1e-30)),
    )
}

/// Two radii of the ring about `centre`, conjugate to each other, with a product of the ellipse's half-axes of `radius2`. A light that is
/// round for the point is as long in the cosine's space as the lobe is narrow; the lobe of a surface does well with a circle. Where
/// the ring would go below the horizon it is flattened to an ellipse of the same area above it.
fn ltc_ring(lobe: &LtcLobe, centre: DVec3, radius2: f64) -> [DVec3; 2] {
    let (u, v) = irradiance_basis(centre);
    let (to_u, to_v) = (lobe.cosine_transposed(u), lobe.cosine_transposed(v));
    let (uu, uv, vv) = (to_u.length_squared(), to_u.dot(to_v), to_v.length_squared());
    let stretched = lobe.turned / (uu * vv - uv * uv).max(1e-30).sqrt();
    let round = 1.0 - lobe.turned;
    let (uu, uv, vv) = (
        round + stretched * uu,
        stretched * uv,
        round + stretched * vv,
    );
    let per_area = 1.0 / (uu * vv - uv * uv).max(1e-30).sqrt();
    let depth = (1.0 - RING_LIFT * lobe.wo.z) * centre.z;
    let down = (radius2 * uu * per_area).sqrt().min(depth).max(1e-15);
    let along = radius2 / down;
    let ends_early = |radius: DVec3| radius * (RING_MAX / radius.length().max(RING_MAX));
    [ends_early(down * (u + uv / uu * v)), ends_early(along * v)]
}

/// GGX of the lobe's normals at the directions that each `w` stands for, times the solid angle there per solid angle at w; and the cosine at the half vector.
///
/// [`ggx_eval`](crate::ggx::ggx_eval) written out, the viewer's part taken once and with as few divisions as there can be, step by step for all of
/// them: compilers then do several at a time.
fn ltc_exact_over_jacobian<const N: usize>(lobe: &LtcLobe, w: [DVec3; N]) -> ([f64; N], [f64; N]) {
    let (wo, alpha2) = (lobe.wo, lobe.alpha * lobe.alpha);
    let rough_o = projected_roughness(wo.z, lobe.alpha);
    let c2 = lobe.peak.y * lobe.peak.y;
    let per_alpha = lobe.alphas.recip();
    let scale = lobe.width.x * lobe.width.y * c2 * c2 * 0.5 / (PI * lobe.alphas.x * lobe.alphas.y);
    let direction = w.map(|w| lobe.undo_cosine(w));
    let [x, y, z]: [[f64; N]; 3] =
        std::array::from_fn(|axis| std::array::from_fn(|i| direction[i][axis]));
    let (mut values, mut cosines) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        let l2 = (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).max(1e-30);
        let per_l = 1.0 / l2.sqrt();
        let cos_i = z[i] * per_l;
        // The half vector, of any length.
        let (hx, hy, hz) = (x[i] * per_l + wo.x, y[i] * per_l + wo.y, cos_i + wo.z);
        let (u, normal) = (hx * per_alpha.x, hz * hz);
        let v = hy * per_alpha.y - lobe.shear * u;
        let length2 = hx * hx + hy * hy + normal;
        let q = (u * u + v * v + normal).max(1e-30);
        let cos_h = (0.5 * length2.sqrt()).min(1.0);
        let shown = 1.0 + lobe.turned * (wo.z / cos_h.max(1e-15) - 1.0);
        let rough_i = (alpha2 + (1.0 - alpha2) * cos_i * cos_i).sqrt();
        let sum = (wo.z * rough_i + cos_i * rough_o).max(1e-30);
        let value =
            scale * per_l * per_l * per_l * cos_i * (length2 * length2) * shown / (q * q * sum);
        values[i] = if cos_i > 0.0 { value } else { 0.0 };
        cosines[i] = cos_h;
    }
    (values, cosines)
}

#[cfg(test)]
mod tests;
