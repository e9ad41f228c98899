//! Reflection of rough metal, as textures: the arguments `shapes`, `albedo` and `curves` of `shaders/engine/lit_base.wgsl`.

use hairline_optics::fresnel::{FRESNEL_NODES, FresnelCurve};
use hairline_optics::lobe_table::{LOBE_TABLE_SIZE, albedo_table, shape_texels};
use hairline_optics::metal::Metal;

/// Refractive index of the last curve, which is a dielectric's.
const IOR: f64 = 1.5;

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

/// Curves of reflectance over the angle: Schlick's, those of [`Metal::ALL`], a dielectric's.
pub fn curves() -> Texels {
    let metals = Metal::ALL.iter().map(|metal| metal.fresnel_curve());
    let texels = std::iter::once(FresnelCurve::schlick().clone())
        .chain(metals)
        .chain([FresnelCurve::dielectric(IOR)])
        .flat_map(|curve| [curve.nodes(), curve.albedo_table().texels()].concat());
    Texels::new(FRESNEL_NODES, texels.collect())
}

/// The place of a metal's curve in [`curves`]; none stands for metals given by their colour.
pub fn curve_of(metal: Option<Metal>) -> u32 {
    let place = |metal| Metal::ALL.iter().position(|other| *other == metal);
    metal.and_then(place).map_or(0, |place| 1 + place as u32)
}
