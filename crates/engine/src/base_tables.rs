//! Reflection of rough metal, as textures: the arguments `shapes`, `albedo` and `curves` of `shaders/engine/lit_base.wgsl`.

use std::ops::RangeInclusive;

use hairline_optics::coat::COAT_IOR;
use hairline_optics::fresnel::{FRESNEL_NODES, FresnelCurve};
use hairline_optics::lobe_table::{LOBE_TABLE_SIZE, albedo_table, shape_texels};
use hairline_optics::metal::Metal;

/// What the refractive index of each dielectric's curve is above 1, over that of the one before.
const IOR_STEP: f64 = 1.1;
/// Steps to those curves from that of 1.5, which is the index of coats.
const IOR_STEPS: RangeInclusive<i32> = -10..=18;

/// A texture of `rgba32float`.
#[derive(Clone, Debug)]
pub struct Texels {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Row by row.
    pub texels: Vec<[f32; 4]>,
}

impl Texels {
    fn new(columns: usize, texels: Vec<[f32; 4]>) -> Self {
        let size = [columns, texels.len() / columns].map(|n| n as u32);
        Self { size, texels }
    }
}

/// Shapes of lobes, by roughness and angle.
pub fn shapes() -> Texels {
    Texels::new(LOBE_TABLE_SIZE, shape_texels().to_vec())
}

/// Their albedo.
pub fn albedo() -> Texels {
    Texels::new(LOBE_TABLE_SIZE, albedo_table().texels().to_vec())
}

/// Curves of reflectance over the angle: Schlick's, those of [`Metal::ALL`], dielectrics'.
pub fn curves() -> Texels {
    let metals = Metal::ALL.iter().map(|metal| metal.fresnel_curve());
    let ior = |step| 1.0 + (COAT_IOR - 1.0) * IOR_STEP.powi(step);
    let dielectrics = IOR_STEPS.map(|step| FresnelCurve::dielectric(ior(step)));
    let texels = std::iter::once(FresnelCurve::schlick().clone())
        .chain(metals)
        .chain(dielectrics)
        .flat_map(|curve| [curve.nodes(), curve.albedo_table().texels()].concat());
    Texels::new(FRESNEL_NODES, texels.collect())
}

/// The place of a metal's curve in [`curves`]; none stands for metals given by their colour.
pub fn curve_of(metal: Option<Metal>) -> u32 {
    let place = |metal| Metal::ALL.iter().position(|other| *other == metal);
    metal.and_then(place).map_or(0, |place| 1 + place as u32)
}

/// The place in [`curves`] of the curve of a dielectric of refractive index `ior`, the nearest one. 0 is glTF's sign for a mirror under its own
/// colour, which has Schlick's.
pub fn dielectric_curve(ior: f64) -> u32 {
    if ior <= 0.0 {
        return curve_of(None);
    }
    let above = ior.max(1.0 / ior) - 1.0;
    let steps = (above / (COAT_IOR - 1.0)).log(IOR_STEP).round() as i32;
    let place = steps.clamp(*IOR_STEPS.start(), *IOR_STEPS.end()) - IOR_STEPS.start();
    1 + Metal::ALL.len() as u32 + place as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_optics::fresnel::dielectric;

    /// The nearest curve is that of the equations for any index.
    #[test]
    fn dielectrics_reflect_by_their_index() {
        const CURVE_ROWS: usize = 1 + LOBE_TABLE_SIZE * LOBE_TABLE_SIZE / FRESNEL_NODES;
        let curves = curves();
        for ior in [1.33, 1.4, 1.46, 1.5, 1.55, 1.7, 2.0, 2.4] {
            let f0 = dielectric(1.0, ior);
            let at = dielectric_curve(ior) as usize * FRESNEL_NODES * CURVE_ROWS;
            let nodes = &curves.texels[at..at + FRESNEL_NODES];
            for (i, [t, .., s]) in nodes.iter().enumerate() {
                let cos = (i as f64 / (FRESNEL_NODES - 1) as f64).powi(2);
                let found = f64::from(*t) + f64::from(*s) * f0;
                let error = found / dielectric(cos, ior) - 1.0;
                assert!(error.abs() < 0.02, "index {ior}, cosine {cos}: {error}");
            }
        }
        assert_eq!(dielectric_curve(0.0), curve_of(None));
        assert_eq!(dielectric_curve(1.0 / 1.5), dielectric_curve(1.5));
    }
}
