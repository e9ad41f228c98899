//! Fresnel reflectance: the equations, and the curves over the angle that shading looks up.
//!
//! A curve is tabulated in equal steps of the square root of the cosine, dense towards grazing, where reflectances rise; between nodes it is linear,
//! within 0.12 % of the equations (test `curves_are_the_equations`). With it comes the directional albedo of rough surfaces of
//! that reflectance.
//!
//! `cos_theta` is the cosine between a direction and the (micro)facet's normal, in [0, 1].

use std::sync::LazyLock;

use glam::DVec3;

use crate::ggx::unit_clamp;
use crate::lobe_table::{self, LobeTable};

pub use crate::lobe_table::FRESNEL_NODES;

/// Unpolarised Fresnel reflectance of a conductor of refractive index n + i k (k >= 0), seen from vacuum.
pub(crate) fn conductor(cos_theta: f64, n: f64, k: f64) -> f64 {
    let c = cos_theta.clamp(0.0, 1.0);
    let c2 = c * c;
    let s2 = 1.0 - c2;
    // (p + i q)^2 = (n + i k)^2 - sin^2: the index times the cosine inside the metal.
    let re = n * n - k * k - s2;
    let im = 2.0 * n * k;
    let modulus = re.hypot(im);
    let p = (0.5 * (modulus + re)).max(0.0).sqrt();
    let s_num = modulus - 2.0 * p * c + c2;
    let s_den = modulus + 2.0 * p * c + c2;
    if s_den <= 0.0 {
        return 1.0;
    }
    let p_num = modulus * c2 - 2.0 * p * c * s2 + s2 * s2;
    let p_den = modulus * c2 + 2.0 * p * c * s2 + s2 * s2;
    let r_s = s_num / s_den;
    // At grazing incidence on n = 1, k = 0 both vanish; the ratio's limit is 1.
    let r_p = if p_den > 0.0 {
        r_s * p_num / p_den
    } else {
        1.0
    };
    (0.5 * (r_s + r_p)).clamp(0.0, 1.0)
}

/// Cosine in a medium of the refractive index `ior` of light that comes from air.
pub(crate) fn inner_cos(cos_theta: f64, ior: f64) -> f64 {
    let c = cos_theta.clamp(0.0, 1.0);
    (1.0 - (1.0 - c * c) / (ior * ior))
        .max(0.0)
        .sqrt()
        .max(1e-9)
}

/// Unpolarised Fresnel reflectance of a dielectric; `eta` is the index behind the surface over the index before it.
/// Returns 1 under total internal reflection.
pub fn dielectric(cos_theta: f64, eta: f64) -> f64 {
    let c = cos_theta.clamp(0.0, 1.0);
    let cos2_inside = 1.0 - (1.0 - c * c) / (eta * eta);
    if cos2_inside <= 0.0 || c <= 0.0 {
        return 1.0;
    }
    let c_inside = cos2_inside.sqrt();
    let r_parallel = (eta * c - c_inside) / (eta * c + c_inside);
    let r_perpendicular = (c - eta * c_inside) / (c + eta * c_inside);
    0.5 * (r_parallel * r_parallel + r_perpendicular * r_perpendicular)
}

/// (1 - cos)^5, the weight of 1 - f0 in Schlick's approximation f0 + (1 - f0)(1 - cos)^5.
pub fn schlick_weight(cos_theta: f64) -> f64 {
    let m = (1.0 - cos_theta).clamp(0.0, 1.0);
    let m2 = m * m;
    m2 * m2 * m
}

/// The share of the way from the reflectance at normal incidence to 1 that a dielectric's reflectance has gone at an angle: the weight of 1 - f0 in
/// f0 + (1 - f0) w.
pub fn dielectric_weight(cos_theta: f64, ior: f64) -> f64 {
    let f0 = dielectric(1.0, ior);
    (dielectric(cos_theta, ior) - f0) / (1.0 - f0)
}

/// The refractive index, 1 or more, of a dielectric that reflects `f0` at normal incidence; none has it from 1 on.
pub fn dielectric_ior(f0: f64) -> Option<f64> {
    let root = f0.max(0.0).sqrt();
    (root < 1.0).then(|| 2.0 / (1.0 - root) - 1.0)
}

/// The cosine between either of two unit directions and their half vector.
pub fn half_vector_cos(wi: DVec3, wo: DVec3) -> f64 {
    0.5 * (wi + wo).length()
}

/// Fresnel reflectance over the angle, in linear Rec.709: F(c) = t(c) F90 + s(c) F0, with t in three channels and one s for all. A measured surface has
/// its whole reflectance in t, and s = 0. A dielectric has its [weight](dielectric_weight) in t, and s = 1 - t; Schlick's curve, which serves every
/// F0, has t = (1 - c)^5.
#[derive(Clone, Debug)]
pub struct FresnelCurve {
    nodes: Vec<[f32; 4]>,
    albedo: LobeTable,
}

impl FresnelCurve {
    /// The curve of a reflectance in linear Rec.709 over the cosine.
    pub fn new(reflectance: impl Fn(f64) -> [f64; 3]) -> Self {
        Self::of_parts(|cos_theta| {
            let [r, g, b] = reflectance(cos_theta);
            [r, g, b, 0.0]
        })
    }

    /// The curve of a dielectric of refractive index `ior`, seen from vacuum, for its F0 under factors and colours.
    pub fn dielectric(ior: f64) -> Self {
        Self::of_weight(|cos_theta| dielectric_weight(cos_theta, ior))
    }

    /// Schlick's, for every F0.
    pub fn schlick() -> &'static Self {
        static CURVE: LazyLock<FresnelCurve> =
            LazyLock::new(|| FresnelCurve::of_weight(schlick_weight));
        &CURVE
    }

    /// The curve that goes from F0 to F90 by a weight.
    fn of_weight(weight: impl Fn(f64) -> f64) -> Self {
        Self::of_parts(|cos_theta| {
            let weight = weight(cos_theta);
            [weight, weight, weight, 1.0 - weight]
        })
    }

    fn of_parts(parts: impl Fn(f64) -> [f64; 4]) -> Self {
        let nodes: Vec<[f32; 4]> = (0..FRESNEL_NODES)
            .map(|i| parts(fresnel_node_cos(i)).map(|part| part as f32))
            .collect();
        let albedo = lobe_table::mean_over_lobes(&nodes);
        Self { nodes, albedo }
    }

    /// t in three channels, and s.
    pub(crate) fn lookup(&self, cos_theta: f64) -> [f64; 4] {
        let at = unit_clamp(cos_theta).sqrt() * (FRESNEL_NODES - 1) as f64;
        // The place is not negative, so truncation rounds down.
        let i = (at as usize).min(FRESNEL_NODES - 2);
        let share = at - i as f64;
        let (low, high) = (self.nodes[i], self.nodes[i + 1]);
        std::array::from_fn(|k| f64::from(low[k]) + share * f64::from(high[k] - low[k]))
    }

    /// The nodes, from grazing to normal incidence.
    pub fn nodes(&self) -> &[[f32; 4]] {
        &self.nodes
    }

    /// The directional albedo of GGX, single scattering, of t and of s.
    pub fn albedo_table(&self) -> &LobeTable {
        &self.albedo
    }
}

/// The cosine at a node of a [`FresnelCurve`].
pub(crate) fn fresnel_node_cos(i: usize) -> f64 {
    let root = i as f64 / (FRESNEL_NODES - 1) as f64;
    root * root
}

/// Fresnel reflectance in linear Rec.709.
#[derive(Clone, Copy, Debug)]
pub struct FresnelRgb<'a> {
    /// Reflectance at normal incidence.
    pub f0: [f64; 3],
    /// Reflectance at grazing incidence: a factor on t. 1 but for a dielectric whose reflection has a factor.
    pub f90: f64,
    /// Curve of the reflectance over the angle.
    pub curve: &'a FresnelCurve,
}

impl FresnelRgb<'_> {
    /// Schlick's curve: metals given by a colour.
    pub fn schlick(f0: [f64; 3]) -> FresnelRgb<'static> {
        FresnelRgb {
            f0,
            f90: 1.0,
            curve: FresnelCurve::schlick(),
        }
    }

    /// Reflectance of a facet seen at `cos_theta`.
    pub fn eval(&self, cos_theta: f64) -> [f64; 3] {
        self.of_parts(self.curve.lookup(cos_theta))
    }

    /// Reflectance t F90 + s F0, from the curve's parts t and s or from their means.
    pub(crate) fn of_parts(&self, parts: [f64; 4]) -> [f64; 3] {
        std::array::from_fn(|ch| parts[ch] * self.f90 + parts[3] * self.f0[ch])
    }

    /// Directional albedo of a rough surface of this reflectance, single scattering.
    pub fn albedo(&self, roughness: f64, cos_o: f64) -> [f64; 3] {
        self.of_parts(self.curve.albedo.lookup(roughness, cos_o))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ggx::{ggx_alpha, ggx_mean};
    use crate::metal::Metal;

    #[test]
    fn conductor_without_absorption_is_the_dielectric() {
        for eta in [1.0, 1.3, 1.5, 2.4] {
            for i in 0..=90 {
                let c = f64::from(i).to_radians().cos();
                assert!((conductor(c, eta, 0.0) - dielectric(c, eta)).abs() < 1e-9 || eta == 1.0);
            }
        }
    }

    #[test]
    fn known_values() {
        // (n - 1)^2 / (n + 1)^2 and its complex form, by hand.
        assert!((dielectric(1.0, 1.5) - 0.04).abs() < 1e-15);
        assert!((conductor(1.0, 0.2, 3.0) - (0.64 + 9.0) / (1.44 + 9.0)).abs() < 1e-15);
        // Brewster's angle leaves only the perpendicular half: ((eta^2 - 1)/(eta^2 + 1))^2 / 2.
        let eta: f64 = 1.5;
        let brewster = 1.0 / (1.0 + eta * eta).sqrt();
        let expected = 0.5 * ((eta * eta - 1.0) / (eta * eta + 1.0)).powi(2);
        assert!((dielectric(brewster, eta) - expected).abs() < 1e-12);
        // Total internal reflection starts at asin(1/1.5).
        assert_eq!(dielectric((42.0_f64).to_radians().cos(), 1.0 / 1.5), 1.0);
        assert!(dielectric((41.0_f64).to_radians().cos(), 1.0 / 1.5) < 1.0);
    }

    #[test]
    fn grazing_and_odd_input_stay_in_range() {
        for c in [-1.0, 0.0, 1e-300, 1e-9, 1.0, 2.0] {
            for (n, k) in [(0.05, 4.0), (1.0, 0.0), (1.0, 1e-12), (3.0, 3.0)] {
                let r = conductor(c, n, k);
                assert!((0.0..=1.0).contains(&r), "{c} {n} {k}: {r}");
            }
        }
        assert!((conductor(0.0, 0.2, 3.0) - 1.0).abs() < 1e-12);
        assert!((dielectric(0.0, 1.5) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn curves_are_the_equations() {
        let worst = |curve: &FresnelCurve, exact: &dyn Fn(f64) -> [f64; 3]| {
            let (f0, f90) = (exact(1.0), 1.0);
            let fresnel = FresnelRgb { f0, f90, curve };
            (0..5000).fold(0.0_f64, |worst, i| {
                let c = (f64::from(i) / 4999.0).powi(2);
                let error = |ch: usize| fresnel.eval(c)[ch] / exact(c)[ch] - 1.0;
                (0..3).fold(worst, |worst, ch| worst.max(error(ch).abs()))
            })
        };
        for &metal in Metal::ALL {
            let exact = |c| metal.reflectance_rgb(c);
            let error = worst(&FresnelCurve::new(exact), &exact);
            println!("{metal:?}: {:.3} %", 100.0 * error);
            assert!(error < 0.0005, "{metal:?}: {error}");
        }
        for ior in [1.05, 1.2, 1.5, 2.4, 4.0] {
            let error = worst(&FresnelCurve::dielectric(ior), &|c| [dielectric(c, ior); 3]);
            println!("index {ior}: {:.3} %", 100.0 * error);
            assert!(error < 0.0012, "{ior}: {error}");
        }
        let grey = FresnelRgb::schlick([0.04; 3]);
        // f0 + (1 - f0)(1 - cos)^5
        let expected = 0.04 + 0.96 * schlick_weight(0.3);
        assert!((grey.eval(0.3)[0] - expected).abs() < 1e-4);
    }

    #[test]
    fn albedos_are_means_over_the_lobe() {
        for (roughness, cos_o) in [(0.1, 0.3), (0.4, 0.7), (0.6, 1.0), (0.9, 0.4)] {
            let gold = FresnelCurve::new(|c| Metal::Gold.reflectance_rgb(c));
            let glass = FresnelCurve::dielectric(1.5);
            for (curve, f0) in [(&gold, [0.0; 3]), (&glass, [0.04; 3])] {
                let f90 = 1.0;
                let fresnel = FresnelRgb { f0, f90, curve };
                let exact = ggx_mean(cos_o, ggx_alpha(roughness), 200, |c| fresnel.eval(c));
                let got = fresnel.albedo(roughness, cos_o);
                for ch in 0..3 {
                    let error = got[ch] / exact[ch] - 1.0;
                    assert!(error.abs() < 0.01, "{roughness} {cos_o} {ch}: {error}");
                }
            }
        }
    }
}
