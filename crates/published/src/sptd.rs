//! The GGX lobe over a sphere by a spherical-cap-preserving (pivot) transform.
//!
//! J. Dupuy, E. Heitz and L. Belcour, "A spherical cap preserving parameterization for spherical distributions"
//! (SIGGRAPH 2017): chords through a pivot inside the unit sphere map the sphere to itself and caps to caps. The uniform
//! distribution so transformed stands for the lobe; light and horizon become two caps, whose intersection has a
//! closed form. The pivot's lobe is symmetric about its axis, which GGX at grazing views is not: the default for spheres is
//! [`hairline_optics::ltc::sphere_light`], whose fit is closer.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::{DVec2, DVec3};

use hairline_optics::ggx::ggx_alpha;
use hairline_optics::irradiance::irradiance_angle;
use hairline_optics::lobe_table::{LOBE_MIN_COS, LobeTable, albedo_lookup};
use hairline_optics::ltc::viewer_frame;

/// Pivot over (roughness, viewer's cosine): the width and the lean of [`SptdShape`]. Committed under `data/`, and made again by
/// `cargo lab fit-lobes`.
pub fn sptd_table() -> &'static LobeTable {
    static TABLE: LazyLock<LobeTable> =
        LazyLock::new(|| LobeTable::from_bytes(include_bytes!("../data/lobe_sptd.bin")));
    &TABLE
}

/// The fitted parameters of one (roughness, angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SptdShape {
    /// (1 - r) / (1 + r) over alpha, for a pivot at the distance r from the centre; 1 at the mirror, seen from the normal.
    pub width: f64,
    /// Angle of the pivot from the mirror direction towards the normal, over alpha sin(theta_o).
    pub lean: f64,
}

/// The lobe seen from one direction on one surface, F = 1.
#[derive(Clone, Copy, Debug)]
pub struct SptdLobe {
    /// The x axis of the viewer's frame in the local one.
    pub x_axis: DVec2,
    /// Unit direction of the lobe's peak, in the viewer's frame.
    pub axis: DVec3,
    /// 1 - r, for a pivot at r along the axis: precise where r is near 1.
    pub rest: f64,
    /// Pivot, in the viewer's frame.
    pub pivot: DVec3,
    /// 1 - |pivot|^2.
    pub gap: f64,
    /// Directional albedo E0.
    pub albedo: f64,
}

/// A cap {w : w . axis >= cosine} of the unit sphere.
#[derive(Clone, Copy, Debug)]
pub struct SphericalCap {
    /// Unit axis.
    pub axis: DVec3,
    /// Cosine of the angular radius, in [-1, 1].
    pub cosine: f64,
    /// Sine of the cap's angular radius, kept beside the cosine because it is precise for small caps.
    pub sine: f64,
}

/// The lobe for a viewer `wo` in the local frame (below the horizon it counts as grazing) and a perceptual roughness.
pub fn sptd_lobe(wo: DVec3, roughness: f64) -> SptdLobe {
    let cos_o = wo.z.max(LOBE_MIN_COS);
    let [width, lean, _, _] = sptd_table().lookup(roughness, cos_o);
    SptdLobe::new(
        wo,
        ggx_alpha(roughness),
        SptdShape { width, lean },
        albedo_lookup(roughness, cos_o),
    )
}

impl SptdLobe {
    /// Builds the lobe of [`sptd_lobe`] from parameters instead of the table; the fit varies them.
    pub fn new(wo: DVec3, alpha: f64, shape: SptdShape, albedo: f64) -> Self {
        let (x_axis, sin_cos) = viewer_frame(wo);
        let lean = alpha * shape.lean * sin_cos.x;
        let width = alpha * shape.width;
        let rest = 2.0 * width / (1.0 + width);
        let x = sin_cos.x * lean.cos() - sin_cos.y * lean.sin();
        let z = sin_cos.y * lean.cos() + sin_cos.x * lean.sin();
        let axis = DVec3::new(-x, 0.0, z);
        Self {
            x_axis,
            axis,
            rest,
            pivot: (1.0 - rest) * axis,
            gap: rest * (2.0 - rest),
            albedo,
        }
    }

    /// The density that stands for the lobe, at a direction in the viewer's frame: integrates to E0.
    pub fn eval(&self, wi: DVec3) -> f64 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let ratio = self.gap / (wi - self.pivot).length_squared();
        self.albedo / sptd_horizon_share(self) * ratio * ratio / (4.0 * PI)
    }

    /// A direction in the viewer's frame distributed as the density, horizon aside, from a uniform one.
    pub fn sample(&self, uniform: DVec3) -> DVec3 {
        let d = -uniform - self.pivot;
        self.pivot - d * (self.gap / d.length_squared())
    }
}

/// The cap that a cap (in the viewer's frame) maps to.
///
/// A chord map is a Lorentz reflection of (direction, 1) in (pivot, 1), and a cap's plane (axis, cosine) goes with it: with
/// push = 2 (axis . pivot - cosine) / gap it becomes (axis + push pivot, -cosine - push). Near a mirror that is a difference
/// of numbers near 1; here both are written in what is small, the cap's versine and its distance from the peak.
pub fn sptd_transform_cap(lobe: &SptdLobe, cap: SphericalCap) -> SphericalCap {
    let versine = if cap.cosine > 0.0 {
        cap.sine * cap.sine / (1.0 + cap.cosine)
    } else {
        1.0 - cap.cosine
    };
    let r = 1.0 - lobe.rest;
    let off_peak = cap.axis - lobe.axis;
    let shift = r * off_peak.length_squared();
    let along = lobe.rest * lobe.rest + r * (2.0 * versine - shift);
    let height = lobe.rest * lobe.rest - versine * (2.0 - lobe.gap) + shift;
    let axis = off_peak * lobe.gap + lobe.axis * along;
    let scale = 1.0 / axis.length().max(1e-30);
    SphericalCap {
        axis: axis * scale,
        cosine: (height * scale).clamp(-1.0, 1.0),
        // The reflection keeps |axis|^2 - cosine^2.
        sine: (cap.sine * lobe.gap * scale).min(1.0),
    }
}

/// The hemisphere below the horizon. Its image is the smaller one: less cancels than with the upper.
const NADIR: SphericalCap = SphericalCap {
    axis: DVec3::NEG_Z,
    cosine: 0.0,
    sine: 1.0,
};

/// The share of the untrimmed lobe above the horizon.
fn sptd_horizon_share(lobe: &SptdLobe) -> f64 {
    (0.5 * (1.0 + sptd_transform_cap(lobe, NADIR).cosine)).max(1e-6)
}

/// The solid angle of a cap.
fn sptd_cap_area(cap: SphericalCap) -> f64 {
    if cap.cosine > 0.0 {
        2.0 * PI * cap.sine * cap.sine / (1.0 + cap.cosine)
    } else {
        2.0 * PI * (1.0 - cap.cosine)
    }
}

/// Complement of a cap on the sphere.
fn sptd_complement(cap: SphericalCap) -> SphericalCap {
    SphericalCap {
        axis: -cap.axis,
        cosine: -cap.cosine,
        sine: cap.sine,
    }
}

/// The solid angle of the intersection of two caps.
pub fn sptd_cap_intersection(a: SphericalCap, b: SphericalCap) -> f64 {
    // Replaces each cap by its complement if it is larger than a hemisphere.
    let (flip_a, flip_b) = (a.cosine < 0.0, b.cosine < 0.0);
    let small_a = if flip_a { sptd_complement(a) } else { a };
    let small_b = if flip_b { sptd_complement(b) } else { b };
    let lens = sptd_lens(small_a, small_b);
    let without = |whole: f64, part: f64| (whole - part).max(0.0);
    match (flip_a, flip_b) {
        (false, false) => lens,
        (false, true) => without(sptd_cap_area(a), lens),
        (true, false) => without(sptd_cap_area(b), lens),
        (true, true) => without(sptd_cap_area(a), without(sptd_cap_area(small_b), lens)),
    }
}

/// Intersects caps that are at most hemispheres, as [`sptd_cap_intersection`].
///
/// Two sectors less the kite between the centres and the corners. With the kite's area by L'Huilier's formula all three are
/// small when the caps are; the textbook sum of angles would cancel.
fn sptd_lens(a: SphericalCap, b: SphericalCap) -> f64 {
    let (area_a, area_b) = (sptd_cap_area(a), sptd_cap_area(b));
    let radius_a = irradiance_angle(a.sine, a.cosine);
    let radius_b = irradiance_angle(b.sine, b.cosine);
    let distance = irradiance_angle(a.axis.cross(b.axis).length(), a.axis.dot(b.axis));
    if distance >= radius_a + radius_b {
        return 0.0;
    }
    if distance <= (radius_a - radius_b).abs() {
        return area_a.min(area_b);
    }
    // The triangle of the centres and one corner, by its half perimeter.
    let s = 0.5 * (radius_a + radius_b + distance);
    let (rest_a, rest_b, rest_d) = (s - radius_a, s - radius_b, s - distance);
    let angle = |near: f64, opposite: f64| {
        2.0 * irradiance_angle(
            (near.sin() * rest_d.sin()).max(0.0).sqrt(),
            (s.sin() * opposite.sin()).max(0.0).sqrt(),
        )
    };
    let (angle_a, angle_b) = (angle(rest_a, rest_b), angle(rest_b, rest_a));
    let quarter = |x: f64| (0.5 * x).tan();
    let product = quarter(s) * quarter(rest_a) * quarter(rest_b) * quarter(rest_d);
    let triangle = 4.0 * irradiance_angle(product.max(0.0).sqrt(), 1.0);
    let sectors = (angle_a * area_a + angle_b * area_b) / PI;
    (sectors - 2.0 * triangle).clamp(0.0, area_a.min(area_b))
}

/// The fitted lobe's own integral over a sphere, cut by the horizon: F = 1, cosine inside; as [`hairline_optics::ltc::ltc_sphere`].
pub fn sptd_sphere_published(lobe: &SptdLobe, axis: DVec3, sin2: f64) -> f64 {
    if sin2 >= 1.0 {
        return lobe.albedo;
    }
    let lit = sptd_visible(lobe, axis, sin2);
    lobe.albedo * (lit / (4.0 * PI * sptd_horizon_share(lobe))).min(1.0)
}

/// The solid angle of the image of the part of a sphere above the horizon; `axis` in the local frame, sin2 < 1.
fn sptd_visible(lobe: &SptdLobe, axis: DVec3, sin2: f64) -> f64 {
    let sin2 = sin2.max(0.0);
    let x = lobe.x_axis;
    let light = SphericalCap {
        axis: DVec3::new(
            x.x * axis.x + x.y * axis.y,
            x.x * axis.y - x.y * axis.x,
            axis.z,
        ),
        cosine: (1.0 - sin2).sqrt(),
        sine: sin2.sqrt(),
    };
    let image = sptd_transform_cap(lobe, light);
    let hidden = sptd_cap_intersection(image, sptd_transform_cap(lobe, NADIR));
    (sptd_cap_area(image) - hidden).max(0.0)
}
