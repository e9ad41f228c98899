//! The reflection of an object at any of its points, with the scratches that lie there, over arrays of points and directions.

use glam::{DVec2, DVec3, Vec3};
use hairline_index::{Groove, ScratchIndex, SegmentTree, groove_index};
use hairline_optics::bsdf::{
    CoatLobe, Conductor, Overlay, PointScratch, Profile, ScratchedBsdf, SpectralMode,
};
use hairline_optics::scratch::piece_share;
use hairline_optics::section::NARROW;
use hairline_scene::{Base, GrooveShapes, Scene};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::bsdf::BELOW;
use crate::errors;

type Numbers<'py> = PyReadonlyArray1<'py, f64>;
type Made<'py> = Bound<'py, PyArray1<f64>>;

/// Distance within which scratches matter, in sigma: the window's energy falls as exp(-p^2/sigma^2).
const REACH_SIGMA: f64 = 3.5;
/// Least cosine between the normals of a scratch and of the surface that shows it.
const FACING: f64 = 0.5;
/// Points below this number are not worth a thread.
const FEWEST: usize = 64;

/// An object's reflection.
#[pyclass(frozen, module = "hairline._hairline")]
pub(crate) struct SceneBsdf {
    grooves: SegmentTree<Groove>,
    object: usize,
    bare: ScratchedBsdf,
    /// Of each shape of the scene's grooves.
    profiles: Vec<Profile>,
}

impl SceneBsdf {
    pub(crate) fn new(scene: &Scene, name: &str) -> PyResult<Self> {
        let object = crate::laid::object_named(scene, name)?;
        let of = &scene.objects[object];
        let material = &scene.materials[of
            .mesh
            .triangle_materials
            .first()
            .map_or(0, |i| *i as usize)];
        let (Base::Metal(metal) | Base::Covered { metal, .. }) = &material.base else {
            let found = format!("found \"{}\", whose material is no measured metal", of.name);
            return Err(errors::of_argument(
                "object",
                found,
                "must be an object of kind = \"metal\"",
            ));
        };
        let is_narrow = |scratch: &hairline_scene::Scratch| {
            f64::from(scratch.profile.width_um) <= NARROW * material.coherence_um
        };
        let left_out = [
            (material.anisotropy.is_some(), "anisotropy"),
            (!of.gratings.is_empty(), "gratings"),
            (
                !of.scratches.iter().all(is_narrow),
                "scratches wider than 0.4 of coherence_um",
            ),
        ];
        if let Some((_, what)) = left_out.iter().find(|it| it.0) {
            let found = format!("found \"{}\", which has {what}", of.name);
            let right = "must be metal with narrow scratches alone";
            return Err(errors::of_argument("object", found, right));
        }
        let overlay = match (material.coat, &material.base) {
            (Some(coat), _) => Overlay::Coat(CoatLobe::new(coat.weight, coat.roughness)),
            (None, Base::Covered { cover, .. }) => Overlay::Cover(*cover),
            _ => Overlay::Bare,
        };
        let bare = ScratchedBsdf {
            conductor: Conductor::new(metal.clone(), overlay, material.roughness).into(),
            roughness: material.roughness,
            coherence_um: material.coherence_um,
            layers: Vec::new(),
            points: Vec::new(),
            gratings: Vec::new(),
            depth_coherence: f64::from(ScratchIndex::depth_coherence(scene)[object]),
        };
        Ok(Self {
            grooves: groove_index::build(scene),
            object,
            bare,
            profiles: (GrooveShapes::new(scene).shapes())
                .map(|shape| Profile::new(&shape.section))
                .collect(),
        })
    }

    /// The reflection at a point, in a frame of three unit vectors.
    fn bsdf_at(&self, point: &Point) -> ScratchedBsdf {
        let mut bsdf = self.bare.clone();
        let reach_um = REACH_SIGMA * bsdf.coherence_um;
        let reach_m = Vec3::splat((1e-6 * reach_um) as f32);
        self.grooves
            .gather(self.object, point.position_m.as_vec3(), reach_m, |i| {
                let groove = &self.grooves.segments[i];
                let profile = &self.profiles[usize::from(groove.shape)];
                let seen = point.scratch(groove, profile, reach_um, bsdf.coherence_um);
                bsdf.points.extend(seen);
            });
        bsdf
    }
}

/// A point of a surface.
struct Point {
    position_m: DVec3,
    axes: [DVec3; 3],
}

impl Point {
    fn scratch(
        &self,
        groove: &Groove,
        profile: &Profile,
        reach_um: f64,
        coherence_um: f64,
    ) -> Option<PointScratch> {
        if groove.normal.as_dvec3().dot(self.axes[2]) < FACING {
            return None;
        }
        let flat = |p: Vec3| {
            let way = 1e6 * (p.as_dvec3() - self.position_m);
            DVec2::new(way.dot(self.axes[0]), way.dot(self.axes[1]))
        };
        let (start, end) = (flat(groove.start_m), flat(groove.end_m));
        let tangent = (end - start).try_normalize()?;
        let offset_um = tangent.perp_dot(start);
        let piece_um = [start.dot(tangent), end.dot(tangent)];
        let nearest_um = 0.0_f64.clamp(piece_um[0], piece_um[1]);
        if offset_um.abs() > reach_um || nearest_um.abs() > reach_um {
            return None;
        }
        let whole_um = [
            piece_um[0] - f64::from(groove.before_um),
            piece_um[1] + f64::from(groove.after_um),
        ];
        let width_um = f64::from(groove.width_um);
        Some(PointScratch {
            tangent,
            width_um,
            depth_nm: f64::from(groove.depth_nm),
            profile: profile.clone(),
            share: piece_share(width_um, offset_um, piece_um, whole_um, coherence_um),
        })
    }
}

fn rows<'a>(array: &'a Numbers<'_>) -> PyResult<&'a [[f64; 3]]> {
    Ok(array
        .as_slice()
        .map_err(|_| errors::internal())?
        .as_chunks::<3>()
        .0)
}

/// Rows of 12 numbers: a position, and the axes of its frame.
fn points<'a>(array: &'a Numbers<'_>) -> PyResult<Vec<&'a [f64]>> {
    Ok(array
        .as_slice()
        .map_err(|_| errors::internal())?
        .chunks_exact(12)
        .collect())
}

fn point(row: &[f64]) -> Point {
    let at = |i: usize| DVec3::from_slice(&row[3 * i..]);
    Point {
        position_m: at(0),
        axes: [at(1), at(2), at(3)],
    }
}

#[pymethods]
impl SceneBsdf {
    /// Reflection and density of rows of points (a position and three axes each) and directions: three numbers and one.
    fn eval_pdf<'py>(
        &self,
        py: Python<'py>,
        frames: Numbers<'py>,
        wi: Numbers<'py>,
        wo: Numbers<'py>,
    ) -> PyResult<(Made<'py>, Made<'py>)> {
        let (frames, wi, wo) = (points(&frames)?, rows(&wi)?, rows(&wo)?);
        if frames.len() != wi.len() || wi.len() != wo.len() {
            return Err(errors::internal());
        }
        let (values, pdfs) = py.detach(|| {
            let each = (0..wi.len()).into_par_iter().with_min_len(FEWEST).map(|i| {
                let (wi, wo) = (DVec3::from(wi[i]), DVec3::from(wo[i]));
                if !(wi.z > 0.0 && wo.z > 0.0) {
                    return ([0.0; 3], 0.0);
                }
                let bsdf = self.bsdf_at(&point(frames[i]));
                let value = bsdf.eval(wi, wo, SpectralMode::Rgb);
                (
                    (value.base + value.scratches).to_array(),
                    bsdf.pdf(wi, wo, SpectralMode::Rgb),
                )
            });
            let (values, pdfs): (Vec<[f64; 3]>, Vec<f64>) = each.unzip();
            (values.into_flattened(), pdfs)
        });
        Ok((values.into_pyarray(py), pdfs.into_pyarray(py)))
    }

    /// Drawn directions, their densities and reflections; downwards and zeros where none was drawn.
    fn sample<'py>(
        &self,
        py: Python<'py>,
        frames: Numbers<'py>,
        wo: Numbers<'py>,
        u: Numbers<'py>,
    ) -> PyResult<(Made<'py>, Made<'py>, Made<'py>)> {
        let (frames, wo, u) = (points(&frames)?, rows(&wo)?, rows(&u)?);
        if frames.len() != wo.len() || wo.len() != u.len() {
            return Err(errors::internal());
        }
        let drawn: Vec<_> = py.detach(|| {
            let each = (0..wo.len()).into_par_iter().with_min_len(FEWEST).map(|i| {
                let [pick, x, y] = u[i];
                let bsdf = self.bsdf_at(&point(frames[i]));
                let drawn = bsdf.sample(wo[i].into(), pick, DVec2::new(x, y), SpectralMode::Rgb);
                drawn.map_or((BELOW, 0.0, [0.0; 3]), |(wi, pdf, sent)| {
                    (wi.to_array(), pdf, (sent.base + sent.scratches).to_array())
                })
            });
            each.collect()
        });
        let wi: Vec<f64> = drawn.iter().flat_map(|it| it.0).collect();
        let pdf: Vec<f64> = drawn.iter().map(|it| it.1).collect();
        let value: Vec<f64> = drawn.iter().flat_map(|it| it.2).collect();
        Ok((
            wi.into_pyarray(py),
            pdf.into_pyarray(py),
            value.into_pyarray(py),
        ))
    }
}
