//! Optical properties of a scene's materials: coefficients that every renderer reads alike.

use crate::scene::{Base, Material, Scene};
use hairline_optics::coat::COAT_IOR;
use hairline_optics::cover::Cover;
use hairline_optics::fresnel::{FresnelCurve, dielectric_ior};
use hairline_optics::metal::MetalIndex;
use hairline_optics::spectrum::Observer;

/// A material's reflection before textures: a metallic part with the base colour as its reflectance at normal incidence, and
/// a dielectric one over a diffuse body of the base colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialOptics {
    /// Linear Rec.709.
    pub base_color: [f64; 3],
    /// 1 for a metal, 0 for a dielectric.
    pub metallic: f64,
    /// Reflectance of the dielectric part at normal incidence, by its refractive index.
    pub dielectric_f0: f64,
    /// Index of the material's reflectance in [`crate::ScratchTables::curves`].
    pub curve: u32,
    /// Index of the table of its narrow rectangular scratches in [`crate::ScratchTables::tables`], which those of the scene's further shapes follow; the
    /// table of white if they lie in a coat.
    pub table: u32,
    /// Index of the coat's reflectance in [`crate::ScratchTables::curves`].
    pub coat_curve: Option<u32>,
}

/// The surface whose reflectance a curve tabulates.
#[derive(Clone, Debug, PartialEq)]
pub enum Reflector {
    /// Schlick's approximation, for metals that are given by a colour.
    Schlick,
    /// A metal's measured refractive index.
    Metal(MetalIndex),
    /// A metal's measured refractive index, under a clear plate.
    Covered(MetalIndex, Cover),
    /// A dielectric's refractive index. The metal of a mix has the weight of its dielectric.
    Dielectric(f64),
}

impl Reflector {
    /// Reflector of a material.
    pub fn new(material: &Material) -> Self {
        match &material.base {
            Base::Metal(metal) => Self::Metal(metal.clone()),
            Base::Covered { metal, cover } => Self::Covered(metal.clone(), *cover),
            Base::Dielectric { ior, .. } => Self::Dielectric(*ior),
            Base::MetallicRoughness { metallic, .. }
                if *metallic < 1.0 || material.metallic_roughness_texture.is_some() =>
            {
                dielectric_ior(material.dielectric_f0).map_or(Self::Schlick, Self::Dielectric)
            }
            _ => Self::Schlick,
        }
    }

    /// Reflector of every coat.
    pub const COAT: Self = Self::Dielectric(COAT_IOR);

    pub(crate) fn curve(&self, observer: &Observer) -> FresnelCurve {
        match self {
            Self::Schlick => FresnelCurve::schlick().clone(),
            Self::Metal(metal) => FresnelCurve::new(|cos_theta| {
                observer.channels(|nm| metal.reflectance(cos_theta, nm))
            }),
            Self::Covered(metal, cover) => {
                FresnelCurve::new(|cos_theta| cover.reflectance_seen_by(observer, metal, cos_theta))
            }
            Self::Dielectric(ior) => FresnelCurve::dielectric(*ior),
        }
    }
}

/// The materials of a scene by the numbers of what several of them share.
pub(crate) struct Numbered {
    pub materials: Vec<MaterialOptics>,
    /// Metals of tables; none is white.
    pub metals: Vec<Option<MetalIndex>>,
    pub reflectors: Vec<Reflector>,
}

impl Numbered {
    /// `shapes` is the number of tables of each metal.
    pub(crate) fn new(scene: &Scene, shapes: usize) -> Self {
        let mut all = Self {
            materials: Vec::new(),
            metals: Vec::new(),
            reflectors: Vec::new(),
        };
        for material in &scene.materials {
            // Colours given in RGB have no spectrum: their scratches use white's table and take the colour at the end.
            let metal = match &material.base {
                Base::Metal(metal) | Base::Covered { metal, .. } if material.coat.is_none() => {
                    Some(metal.clone())
                }
                _ => None,
            };
            let table = shapes * number(&mut all.metals, metal);
            let curve = number(&mut all.reflectors, Reflector::new(material)) as u32;
            let coat_curve =
                (material.coat).map(|_| number(&mut all.reflectors, Reflector::COAT) as u32);
            all.materials.push(MaterialOptics {
                coat_curve,
                ..material_optics(material, &scene.observer, table as u32, curve)
            });
        }
        all
    }
}

/// Index of a value among those that are there already, or behind them.
fn number<T: PartialEq>(all: &mut Vec<T>, value: T) -> usize {
    let known = all.iter().position(|other| *other == value);
    known.unwrap_or_else(|| {
        all.push(value);
        all.len() - 1
    })
}

fn material_optics(
    material: &Material,
    observer: &Observer,
    table: u32,
    curve: u32,
) -> MaterialOptics {
    let metal = |base_color| MaterialOptics {
        base_color,
        metallic: 1.0,
        dielectric_f0: 0.04,
        curve,
        table,
        coat_curve: None,
    };
    match &material.base {
        Base::Mirror => metal([1.0; 3]),
        Base::Metal(m) => metal(observer.channels(|nm| m.reflectance(1.0, nm))),
        Base::Covered { metal: m, cover } => metal(cover.reflectance_seen_by(observer, m, 1.0)),
        Base::ColoredMetal { base_color } => metal(*base_color),
        Base::Dielectric { ior, base_color } => MaterialOptics {
            metallic: 0.0,
            dielectric_f0: ((ior - 1.0) / (ior + 1.0)).powi(2),
            ..metal(*base_color)
        },
        Base::MetallicRoughness {
            base_color,
            metallic,
        } => MaterialOptics {
            metallic: *metallic,
            dielectric_f0: material.dielectric_f0,
            ..metal(*base_color)
        },
    }
}
