//! A surface that is a metal in part, and a dielectric over a body in the other: glTF's mix of two materials, as numbers of one lobe.
//!
//! Single scattering of both is one lobe of the mixed F0 and F90, as a reflectance is linear in them. Multiple scattering is not, and the body lies
//! under the dielectric alone. Twin: metal_mix.wgsl.

use crate::fresnel::FresnelRgb;
use crate::ggx::ggx_multiple_scattering;

/// Numbers of a mix, for a viewer ((26b) of docs/model.md).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetalMix {
    /// Reflectance at normal incidence by which multiple scattering adds to the lobe of the mix.
    pub scattered_f0: [f64; 3],
    /// Share of the light that the dielectric lets through to the body.
    pub body_share: [f64; 3],
}

impl MetalMix {
    /// `metallic` is the metal's share, `mixed` the reflectance of the mix, `diffuse` the body's albedo times the dielectric's share, and so
    /// tells the metal's colour. `albedo` is that of the lobe by single scattering, and `e0` the one with F = 1.
    pub fn new(
        metallic: f64,
        mixed: &FresnelRgb,
        diffuse: [f64; 3],
        albedo: [f64; 3],
        e0: f64,
    ) -> Self {
        let FresnelRgb { f0, f90, .. } = *mixed;
        let plastic = 1.0 - metallic;
        if metallic <= 0.0 || plastic <= 0.0 {
            let passes = |ch: usize| {
                let reflected = albedo[ch] * ggx_multiple_scattering(f0[ch], e0);
                (1.0 - reflected).max(0.0)
            };
            return Self {
                scattered_f0: f0,
                body_share: std::array::from_fn(passes),
            };
        }
        // An albedo is t F90 + (E0 - t) F0. The lowest of three tells t best.
        let lowest = |of: [f64; 3]| of[0].min(of[1]).min(of[2]);
        let low = lowest(f0);
        let t = ((lowest(albedo) - e0 * low) / (f90 - low).max(1e-3)).clamp(0.0, e0);
        let part = |f0: f64, f90: f64| t * f90 + (e0 - t) * f0;
        let plastic_f90 = ((f90 - metallic) / plastic).clamp(0.0, 1.0);
        let channel = |ch: usize| {
            let metal_f0 = (diffuse[ch] / plastic).min(1.0);
            let plastic_f0 = ((f0[ch] - metallic * metal_f0) / plastic).clamp(0.0, 1.0);
            let of_metal = metallic * part(metal_f0, 1.0);
            let of_plastic = part(plastic_f0, plastic_f90);
            let all = of_metal + plastic * of_plastic;
            let scattered = of_metal * metal_f0 + plastic * of_plastic * plastic_f0;
            let reflected = of_plastic * ggx_multiple_scattering(plastic_f0, e0);
            [scattered / all.max(1e-9), (1.0 - reflected).max(0.0)]
        };
        let channels = [0, 1, 2].map(channel);
        Self {
            scattered_f0: channels.map(|it| it[0]),
            body_share: channels.map(|it| it[1]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Light of radiance 1 from all around comes back as from two materials, in their shares.
    #[test]
    fn a_mix_reflects_what_its_materials_do() {
        let colors = [[1.0; 3], [0.9, 0.4, 0.05], [0.02; 3]];
        for (metal, metallic) in colors
            .iter()
            .flat_map(|c| [0.1, 0.5, 0.97].map(|m| (*c, m)))
        {
            for (roughness, cos_o) in [(0.05, 0.9), (0.3, 0.2), (0.7, 0.6), (1.0, 1.0), (1.0, 0.1)]
            {
                let of = |f0| FresnelRgb::schlick(f0).albedo(roughness, cos_o);
                let e0 = of([1.0; 3])[0];
                let plastic_f0 = [0.04; 3];
                let mixed = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] {
                    std::array::from_fn(|ch| metallic * a[ch] + (1.0 - metallic) * b[ch])
                };
                let f0 = mixed(metal, plastic_f0);
                let diffuse = metal.map(|c| (1.0 - metallic) * c);
                let mix = MetalMix::new(metallic, &FresnelRgb::schlick(f0), diffuse, of(f0), e0);
                for ch in 0..3 {
                    let lobe = |f0: [f64; 3]| of(f0)[ch] * ggx_multiple_scattering(f0[ch], e0);
                    let plastic = lobe(plastic_f0);
                    let right = metallic * lobe(metal)
                        + (1.0 - metallic) * (plastic + (1.0 - plastic) * metal[ch]);
                    let found = of(f0)[ch] * ggx_multiple_scattering(mix.scattered_f0[ch], e0)
                        + diffuse[ch] * mix.body_share[ch];
                    assert!(
                        (found - right).abs() < 1e-3,
                        "{metal:?} {metallic} {roughness} {cos_o}: {found}, not {right}"
                    );
                    // One lobe of the mixed F0 over a body would be told apart.
                    let one = lobe(f0);
                    let wrong = one + diffuse[ch] * (1.0 - one);
                    if metallic == 0.5 && metal[ch] == 1.0 {
                        assert!(right - wrong > 0.15, "{wrong}");
                    }
                }
            }
        }
    }

    #[test]
    fn materials_that_are_not_mixed_stay_what_they_are() {
        let metal = MetalMix::new(
            1.0,
            &FresnelRgb::schlick([0.9, 0.5, 0.2]),
            [0.0; 3],
            [0.7, 0.4, 0.2],
            0.8,
        );
        assert_eq!(metal.scattered_f0, [0.9, 0.5, 0.2]);
        let plastic = MetalMix::new(
            0.0,
            &FresnelRgb::schlick([0.04; 3]),
            [0.5; 3],
            [0.05; 3],
            0.8,
        );
        assert_eq!(plastic.scattered_f0, [0.04; 3]);
        assert!((plastic.body_share[0] - (1.0 - 0.05 * 1.01)).abs() < 1e-12);
    }
}
