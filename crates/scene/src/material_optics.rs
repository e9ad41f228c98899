//! What the materials of a scene mean to the physics: coefficients and tables that every renderer reads alike.

use crate::grating::Grating;
use crate::scene::{Base, Material, Scene};
use hairline_optics::fresnel::FresnelCurve;
use hairline_optics::grating::Grating as Row;
use hairline_optics::metal::Metal;
use hairline_optics::published::spectrum::PublishedSpectrum;
use hairline_optics::table::ScratchTable;

/// A material's reflection before textures: a metallic part with the base colour as its reflectance at normal incidence, and
/// a dielectric one over a diffuse body of the base colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialOptics {
    /// Linear Rec.709.
    pub base_color: [f64; 3],
    /// 1 for a metal, 0 for a dielectric.
    pub metallic: f64,
    /// Reflectance of the dielectric part at normal incidence.
    pub dielectric_f0: f64,
    /// Which of [`ScratchTables::curves`] its reflectance follows.
    pub curve: u32,
    /// Which of [`ScratchTables::tables`] its scratches use.
    pub table: u32,
}

/// What a curve of reflectance over the angle is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reflector {
    /// Schlick's approximation, which serves every colour.
    Schlick,
    /// The same, rising to another reflectance at grazing incidence than 1.
    Grazing(f64),
    /// A metal's measured refractive index.
    Metal(Metal),
    /// A dielectric's refractive index.
    Dielectric(f64),
}

impl Reflector {
    /// Of a material.
    pub fn new(material: &Material) -> Self {
        let [_, grazing] = material.dielectric;
        match material.base {
            Base::Metal(metal) => Self::Metal(metal),
            Base::Dielectric { ior, .. } => Self::Dielectric(ior),
            Base::MetallicRoughness { .. } if grazing != 1.0 => Self::Grazing(grazing),
            _ => Self::Schlick,
        }
    }

    fn curve(self) -> FresnelCurve {
        match self {
            Self::Schlick => FresnelCurve::schlick().clone(),
            Self::Grazing(reflectance) => FresnelCurve::grazing(reflectance),
            Self::Metal(metal) => metal.fresnel_curve(),
            Self::Dielectric(ior) => FresnelCurve::dielectric(ior),
        }
    }
}

/// The scratch tables that a scene needs, one for each reflectance spectrum.
pub struct ScratchTables {
    /// Distinct tables.
    pub tables: Vec<ScratchTable>,
    /// The metal of each table; none for white's.
    pub metals: Vec<Option<Metal>>,
    /// Distinct curves of reflectance over the angle.
    pub curves: Vec<FresnelCurve>,
    /// What each curve is of.
    pub reflectors: Vec<Reflector>,
    /// One for each material of the scene.
    pub materials: Vec<MaterialOptics>,
    /// Tables of gratings, for each material that they lie on; those of materials come before them.
    gratings: Vec<GratingTable>,
}

/// Which table a grating has on a material.
struct GratingTable {
    row: Row,
    material: usize,
    table: usize,
}

impl ScratchTables {
    /// Tables and coefficients for all materials of a scene.
    pub fn new(scene: &Scene) -> Self {
        // Colours given in RGB have no spectrum: their scratches use white's table and take the colour at the end.
        let mut metals: Vec<Option<Metal>> = Vec::new();
        let mut reflectors: Vec<Reflector> = Vec::new();
        let materials = scene
            .materials
            .iter()
            .map(|material| {
                let metal = match material.base {
                    Base::Metal(metal) => Some(metal),
                    _ => None,
                };
                let table = metals.iter().position(|m| *m == metal).unwrap_or_else(|| {
                    metals.push(metal);
                    metals.len() - 1
                });
                let reflector = Reflector::new(material);
                let curve = reflectors.iter().position(|r| *r == reflector);
                let curve = curve.unwrap_or_else(|| {
                    reflectors.push(reflector);
                    reflectors.len() - 1
                });
                material_optics(material, table as u32, curve as u32)
            })
            .collect();
        let mut tables: Vec<ScratchTable> = metals
            .iter()
            .map(|metal| ScratchTable::new(|nm| reflectance(*metal, nm)))
            .collect();
        let materials: Vec<MaterialOptics> = materials;
        let gratings = grating_tables(scene, &materials, &metals, &mut tables);
        Self {
            tables,
            gratings,
            metals,
            curves: reflectors.iter().map(|r| r.curve()).collect(),
            reflectors,
            materials,
        }
    }

    /// Which of [`Self::tables`] a grating of the scene has on a material that it lies on.
    pub fn grating_table(&self, grating: &Grating, material: usize) -> Option<usize> {
        let is_it = |known: &&GratingTable| known.material == material && known.row == grating.row;
        self.gratings.iter().find(is_it).map(|known| known.table)
    }

    /// What the method of 2018 has in the place of each table: `count` wavelengths.
    pub fn published_spectra(&self, count: usize) -> Vec<PublishedSpectrum> {
        self.metals
            .iter()
            .map(|metal| PublishedSpectrum::new(count, |nm| reflectance(*metal, nm)))
            .collect()
    }
}

/// Adds a table for each row of grooves on each material that differs in what the table depends on.
fn grating_tables(
    scene: &Scene,
    materials: &[MaterialOptics],
    metals: &[Option<Metal>],
    tables: &mut Vec<ScratchTable>,
) -> Vec<GratingTable> {
    let mut known: Vec<GratingTable> = Vec::new();
    for object in scene.objects.iter().filter(|o| !o.gratings.is_empty()) {
        let mut own: Vec<usize> = object
            .mesh
            .triangle_materials
            .iter()
            .map(|material| *material as usize)
            .collect();
        own.sort_unstable();
        own.dedup();
        for (grating, material) in object
            .gratings
            .iter()
            .flat_map(|g| own.iter().map(move |m| (g, *m)))
        {
            let of = |material: usize| {
                let coherence_um = scene.materials[material].coherence_um;
                (metals[materials[material].table as usize], coherence_um)
            };
            let same_row = |k: &&GratingTable| k.row == grating.row;
            let alike = known.iter().filter(same_row);
            if alike.clone().any(|k| k.material == material) {
                continue;
            }
            let (metal, coherence_um) = of(material);
            let shared = alike
                .clone()
                .find(|k| of(k.material) == (metal, coherence_um));
            let table = shared.map_or(tables.len(), |k| k.table);
            if table == tables.len() {
                tables.push(grating.row.table(coherence_um, |nm| reflectance(metal, nm)));
            }
            known.push(GratingTable {
                row: grating.row,
                material,
                table,
            });
        }
    }
    known
}

/// At normal incidence.
fn reflectance(metal: Option<Metal>, wavelength_nm: f64) -> f64 {
    metal.map_or(1.0, |m| m.reflectance(1.0, wavelength_nm))
}

fn material_optics(material: &Material, table: u32, curve: u32) -> MaterialOptics {
    let metal = |base_color| MaterialOptics {
        base_color,
        metallic: 1.0,
        dielectric_f0: 0.04,
        curve,
        table,
    };
    match material.base {
        Base::Mirror => metal([1.0; 3]),
        Base::Metal(m) => metal(m.reflectance_rgb(1.0)),
        Base::ColoredMetal { base_color } => metal(base_color),
        Base::Dielectric { ior, base_color } => MaterialOptics {
            metallic: 0.0,
            dielectric_f0: ((ior - 1.0) / (ior + 1.0)).powi(2),
            ..metal(base_color)
        },
        Base::MetallicRoughness {
            base_color,
            metallic,
        } => MaterialOptics {
            metallic,
            dielectric_f0: material.dielectric[0],
            ..metal(base_color)
        },
    }
}
