//! The reflection of a scratched metal by itself, over arrays of directions.

use glam::{DMat2, DVec2, DVec3};
use hairline_document::description;
use hairline_document::description::Scratches;
use hairline_optics::bsdf::{
    CoatLobe, Conductor, FineGrating, GratingLobe, Groove, GrooveDirections, LayerLobe, Overlay,
    PointScratch, Profile, Reflected, ScratchedBsdf, SpectralMode,
};
use hairline_optics::cover::Cover;
use hairline_optics::footprint::{Footprint, ScratchShare, ends, scratch_share};
use hairline_optics::grating::Grating;
use hairline_optics::mask::depth_coherence;
use hairline_optics::metal::{Metal, MetalIndex};
use hairline_optics::rigorous::Medium;
use hairline_optics::section::Section;
use hairline_scene::{efficiencies, fine_row};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::{errors, names};

type Numbers<'py> = PyReadonlyArray1<'py, f64>;
type Made<'py> = Bound<'py, PyArray1<f64>>;

/// Directions below this number are not worth a thread.
const FEWEST: usize = 1024;
/// Largest error of the squared length of a direction.
const UNIT: f64 = 1e-4;
/// Smallest length of what stands for an endless scratch.
const ENDLESS_UM: f64 = 1e9;

/// Direction of a sample that none was drawn for: it has neither light nor density.
pub(crate) const BELOW: [f64; 3] = [0.0, 0.0, -1.0];

/// A layer: its share, direction and spread in radians, its grooves as (part, width, depth), and their cross section.
type Layer = (f64, f64, f64, Vec<(f64, f64, f64)>, ProfileKey);
/// A grating: share, direction and spread in radians, those of [`Grating`], and whether it is rigorous where it is fine.
type Row = (f64, f64, f64, [f64; 5], bool);
/// A plate: index, thickness in mm, colour.
type Plate = (f64, f64, [f64; 3]);
/// A scratch: angle in radians, offset, start and end, width, depth.
type Scratch = [f64; 6];

/// A cross section as scene files have it.
#[derive(FromPyObject)]
enum ProfileKey {
    Name(String),
    Depths(Vec<f64>),
}

/// Strips of one depth that stand for a section in the coherence of depths.
const STRIPS: usize = 16;

impl ProfileKey {
    fn section(&self) -> PyResult<Section> {
        let depths = match self {
            Self::Name(name) => {
                return names::named("profile", name, &description::profile_names());
            }
            Self::Depths(depths) => depths,
        };
        let is_within = depths
            .iter()
            .all(|depth| Scratches::PROFILE.bounds.ends().contains(depth));
        let is_flat = depths.iter().all(|depth| *depth == 0.0);
        if !(2..=64).contains(&depths.len()) || !is_within || is_flat {
            let right = "must be a name, or 2 to 64 numbers from -1 to 1, not all 0";
            return Err(errors::of_argument(
                "profile",
                format!("found {depths:?}"),
                right,
            ));
        }
        Ok(Section::Listed(depths.as_slice().into()))
    }
}

/// A scratched metal.
#[pyclass(frozen, module = "hairline._hairline")]
pub(crate) struct Bsdf {
    bsdf: ScratchedBsdf,
    /// Whether it has a spectrum: colours of plates have none.
    is_spectral: bool,
    /// What is seen through a footprint.
    scratches: Vec<Scratch>,
}

/// Parts of the reflection that are asked for.
#[derive(Clone, Copy)]
enum Part {
    All,
    Base,
    Scratches,
}

impl Part {
    fn eval(self, bsdf: &ScratchedBsdf, wi: DVec3, wo: DVec3, mode: SpectralMode) -> DVec3 {
        match self {
            Self::All => all(bsdf.eval(wi, wo, mode)),
            Self::Base => bsdf.eval(wi, wo, mode).base,
            Self::Scratches => bsdf.eval_scratches(wi, wo, mode),
        }
    }
}

fn all(reflected: Reflected) -> DVec3 {
    reflected.base + reflected.scratches
}

fn slice<'a>(array: &'a Numbers<'_>) -> PyResult<&'a [f64]> {
    array.as_slice().map_err(|_| errors::internal())
}

/// Unit vectors of an array of their components.
fn directions<'a>(key: &str, array: &'a Numbers<'_>) -> PyResult<&'a [[f64; 3]]> {
    let (rows, _) = slice(array)?.as_chunks::<3>();
    let is_unit = |row: &[f64; 3]| (DVec3::from(*row).length_squared() - 1.0).abs() < UNIT;
    match rows.par_iter().position_first(|row| !is_unit(row)) {
        None => Ok(rows),
        Some(i) => {
            let [x, y, z] = rows[i];
            let found = format!("found ({x}, {y}, {z}) at {i}");
            Err(errors::of_argument(key, found, "must be unit vectors"))
        }
    }
}

/// Spectral mode of each row.
fn modes<'a>(wavelengths_nm: Option<&'a [f64]>) -> impl Fn(usize) -> SpectralMode + Sync + 'a {
    move |i| wavelengths_nm.map_or(SpectralMode::Rgb, |nm| SpectralMode::Wavelength(nm[i]))
}

/// How coherent the depths of scratches and of strips of grooves are.
fn coherence_of_depths(scratches: &[Scratch], layers: &[Layer], sections: &[Section]) -> f64 {
    let mut depths: Vec<(f64, f64)> = scratches.iter().map(|it| (it[5], it[4])).collect();
    for ((share, .., grooves, _), section) in layers.iter().zip(sections) {
        let strips = section.strips(STRIPS);
        for ((part, _, depth_nm), (_, of_depth)) in grooves
            .iter()
            .flat_map(|it| strips.iter().map(move |strip| (it, strip)))
        {
            depths.push((depth_nm * of_depth, share * part / strips.len() as f64));
        }
    }
    depth_coherence(depths.iter().copied())
}

fn layer_lobe(
    conductor: &Conductor,
    &(share, mean_rad, std_rad, ref grooves, _): &Layer,
    section: &Section,
    coherence_um: f64,
) -> LayerLobe {
    let groove = |&(part, width_um, depth_nm): &(f64, f64, f64)| Groove {
        part,
        width_um,
        depth_nm,
    };
    LayerLobe::new(
        conductor,
        share,
        grooves.iter().map(groove).collect(),
        Profile::new(section),
        GrooveDirections { mean_rad, std_rad },
        coherence_um,
    )
}

fn grating_lobe(
    (conductor, metal): (&Conductor, &MetalIndex),
    cover: Option<Cover>,
    is_coated: bool,
    &(share, mean_rad, std_rad, row, is_rigorous): &Row,
    coherence_um: f64,
) -> GratingLobe {
    let [pitch_um, width_um, depth_nm, depth_spread, jitter_um] = row;
    let row = Grating {
        pitch_um,
        width_um,
        depth_nm,
        depth_spread,
        jitter_um,
    };
    let medium = Medium::Metal(metal.clone());
    // What lies in a coat is scalar.
    let is_rigorous = is_rigorous && !is_coated;
    let fine = is_rigorous.then(|| fine_row(&row, medium.clone(), cover.as_ref()));
    let fine = fine.flatten().and_then(|fine| {
        Some(FineGrating {
            efficiencies: efficiencies(&fine, &|| false)?.into(),
            medium,
            cover,
        })
    });
    let row = match (&fine, cover) {
        (None, Some(cover)) => row.in_cover(&cover),
        _ => row,
    };
    let directions = GrooveDirections { mean_rad, std_rad };
    GratingLobe::new(conductor, row, fine, share, directions, coherence_um)
}

#[pymethods]
impl Bsdf {
    /// `n_k`, rows of a wavelength in nm, n and k, takes the place of a metal's name. `coat` is a share of the surface and a roughness.
    #[new]
    #[expect(
        clippy::too_many_arguments,
        reason = "the wrapper in Python names them"
    )]
    fn new(
        py: Python<'_>,
        metal: &str,
        n_k: Option<Vec<[f64; 3]>>,
        roughness: f64,
        coherence_um: f64,
        coat: Option<(f64, f64)>,
        cover: Option<Plate>,
        layers: Vec<Layer>,
        gratings: Vec<Row>,
        scratches: Vec<Scratch>,
    ) -> PyResult<Self> {
        let sections = layers.iter().map(|layer| layer.4.section());
        let sections: Vec<Section> = sections.collect::<PyResult<_>>()?;
        let metal = match n_k {
            Some(rows) if rows.is_empty() => return Err(errors::internal()),
            Some(rows) => MetalIndex::own(&rows),
            None => names::named("metal", metal, Metal::NAMED)?.into(),
        };
        let cover = cover.map(|(ior, thickness_mm, color)| Cover {
            ior,
            thickness_mm,
            color,
        });
        let made = py.detach(|| {
            let overlay = match (coat, cover) {
                (Some((weight, roughness)), _) => Overlay::Coat(CoatLobe::new(weight, roughness)),
                (None, Some(cover)) => Overlay::Cover(cover),
                (None, None) => Overlay::Bare,
            };
            let conductor = Conductor::new(metal.clone(), overlay, roughness);
            let depth_coherence = coherence_of_depths(&scratches, &layers, &sections);
            let layers = layers.iter().zip(&sections);
            let layers =
                layers.map(|(layer, section)| layer_lobe(&conductor, layer, section, coherence_um));
            let gratings = gratings.iter().map(|row| {
                grating_lobe(
                    (&conductor, &metal),
                    cover,
                    coat.is_some(),
                    row,
                    coherence_um,
                )
            });
            ScratchedBsdf {
                layers: layers.collect(),
                gratings: gratings.collect(),
                points: Vec::new(),
                conductor: conductor.into(),
                roughness,
                coherence_um,
                depth_coherence,
            }
        });
        Ok(Self {
            bsdf: made,
            is_spectral: cover.is_none_or(|cover| cover.is_grey()),
            scratches,
        })
    }

    /// The same with its single scratches as they are seen through a footprint of the variances xx, xy and yy.
    fn seen_through(&self, footprint_um2: [f64; 3]) -> Self {
        let seen = |it| point_scratch(it, footprint_um2, self.bsdf.coherence_um);
        Self {
            bsdf: ScratchedBsdf {
                points: self.scratches.iter().map(seen).collect(),
                ..self.bsdf.clone()
            },
            scratches: self.scratches.clone(),
            is_spectral: self.is_spectral,
        }
    }

    /// Reflection of rows of directions: three numbers a row, or one where wavelengths are given.
    fn eval<'py>(
        &self,
        py: Python<'py>,
        wi: Numbers<'py>,
        wo: Numbers<'py>,
        wavelength_nm: Option<Numbers<'py>>,
        part: &str,
    ) -> PyResult<Made<'py>> {
        let parts = [
            ("all", Part::All),
            ("base", Part::Base),
            ("scratches", Part::Scratches),
        ];
        let part = names::named("part", part, &parts)?;
        let (wi, wo) = (directions("wi", &wi)?, directions("wo", &wo)?);
        let nm = self.wavelengths(wavelength_nm.as_ref())?;
        let values: Vec<f64> = py.detach(|| {
            let mode = modes(nm);
            let rows = (0..wi.len()).into_par_iter().with_min_len(FEWEST);
            let value = |i: usize| part.eval(&self.bsdf, wi[i].into(), wo[i].into(), mode(i));
            match nm {
                Some(_) => rows.map(|i| value(i).x).collect(),
                None => {
                    let rgb = rows.map(|i| value(i).to_array());
                    rgb.collect::<Vec<_>>().into_flattened()
                }
            }
        });
        Ok(values.into_pyarray(py))
    }

    /// Density of `sample`, per steradian.
    fn pdf<'py>(
        &self,
        py: Python<'py>,
        wi: Numbers<'py>,
        wo: Numbers<'py>,
        wavelength_nm: Option<Numbers<'py>>,
    ) -> PyResult<Made<'py>> {
        let (wi, wo) = (directions("wi", &wi)?, directions("wo", &wo)?);
        let nm = self.wavelengths(wavelength_nm.as_ref())?;
        let values: Vec<f64> = py.detach(|| {
            let mode = modes(nm);
            let rows = (0..wi.len()).into_par_iter().with_min_len(FEWEST);
            rows.map(|i| self.bsdf.pdf(wi[i].into(), wo[i].into(), mode(i)))
                .collect()
        });
        Ok(values.into_pyarray(py))
    }

    /// Drawn directions, their densities and reflections; downwards and zeros where none was drawn.
    fn sample<'py>(
        &self,
        py: Python<'py>,
        wo: Numbers<'py>,
        u: Numbers<'py>,
        wavelength_nm: Option<Numbers<'py>>,
    ) -> PyResult<(Made<'py>, Made<'py>, Made<'py>)> {
        let wo = directions("wo", &wo)?;
        let (u, _) = slice(&u)?.as_chunks::<3>();
        let nm = self.wavelengths(wavelength_nm.as_ref())?;
        let (wi, (pdf, value)): (Vec<_>, (Vec<_>, Vec<_>)) = py.detach(|| {
            let mode = modes(nm);
            let rows = (0..wo.len()).into_par_iter().with_min_len(FEWEST);
            let drawn = rows.map(|i| {
                let [pick, x, y] = u[i];
                let at = DVec2::new(x, y);
                match self.bsdf.sample(wo[i].into(), pick, at, mode(i)) {
                    Some((wi, pdf, value)) => (wi.to_array(), (pdf, all(value).to_array())),
                    None => (BELOW, (0.0, [0.0; 3])),
                }
            });
            drawn.unzip()
        });
        let wi = wi.into_flattened();
        let value = match nm {
            Some(_) => value.iter().map(|rgb| rgb[0]).collect(),
            None => value.into_flattened(),
        };
        Ok((
            wi.into_pyarray(py),
            pdf.into_pyarray(py),
            value.into_pyarray(py),
        ))
    }
}

impl Bsdf {
    fn wavelengths<'a>(&self, nm: Option<&'a Numbers<'_>>) -> PyResult<Option<&'a [f64]>> {
        if nm.is_some() && !self.is_spectral {
            let found = "found wavelengths for a cover of a colour, which has no spectrum";
            let right = "leave them out, or give the cover a grey color";
            return Err(errors::of_argument("wavelength_nm", found, right));
        }
        nm.map(slice).transpose()
    }
}

/// A scratch with its share of a footprint of the variances xx, xy and yy.
fn point_scratch(
    &[angle_rad, offset_um, start_um, end_um, width_um, depth_nm]: &Scratch,
    [xx, xy, yy]: [f64; 3],
    coherence_um: f64,
) -> PointScratch {
    let tangent = DVec2::from_angle(angle_rad);
    let normal = tangent.perp();
    let spread = DMat2::from_cols_array(&[xx, xy, xy, yy]);
    let footprint = Footprint {
        across_um2: normal.dot(spread * normal),
        along_um2: tangent.dot(spread * tangent),
        cross_um2: normal.dot(spread * tangent),
    };
    let (start_um, end_um) = (start_um.max(-ENDLESS_UM), end_um.min(ENDLESS_UM));
    let ends = ends(end_um - start_um, coherence_um);
    let (start_um, end_um) = (start_um + ends.shrink_um, end_um - ends.shrink_um);
    let share: ScratchShare = scratch_share(
        width_um,
        offset_um,
        start_um,
        end_um,
        ends.blur_um,
        footprint,
        coherence_um,
    );
    PointScratch {
        tangent,
        width_um,
        depth_nm,
        profile: Profile::default(),
        share,
    }
}
