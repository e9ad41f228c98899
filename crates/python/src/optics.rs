//! The physics over arrays: one number of each argument at a time. Shapes are matched in Python.

use hairline_optics::coherent::{self, GroovePiece};
use hairline_optics::footprint::ScratchShare;
use hairline_optics::mask::{self, Mask, ScratchSums};
use hairline_optics::metal::Metal;
use hairline_optics::table;
use hairline_optics::{diffraction, fresnel, scratch, spectrum};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::errors;

type Numbers<'py> = PyReadonlyArray1<'py, f64>;
type Made<'py> = PyResult<Bound<'py, PyArray1<f64>>>;

/// Numbers below this are not worth a thread.
const FEWEST: usize = 4096;

/// `OUT` numbers of each row of `IN` arrays of one length.
fn each<'py, const IN: usize, const OUT: usize>(
    py: Python<'py>,
    arrays: [&Numbers<'py>; IN],
    f: impl Fn([f64; IN]) -> [f64; OUT] + Sync,
) -> Made<'py> {
    let length = arrays[0].len();
    let mut slices = [&[][..]; IN];
    for (slice, array) in slices.iter_mut().zip(arrays) {
        *slice = array.as_slice().map_err(|_| errors::internal())?;
        if slice.len() != length {
            return Err(errors::internal());
        }
    }
    let made = py.detach(|| {
        let rows = (0..length).into_par_iter().with_min_len(FEWEST);
        let rows = rows.map(|i| f(slices.map(|slice| slice[i])));
        rows.collect::<Vec<_>>().into_flattened()
    });
    Ok(made.into_pyarray(py))
}

fn metal(name: &str) -> PyResult<Metal> {
    crate::names::named("metal", name, Metal::NAMED)
}

macro_rules! functions {
    ($($name:ident($($argument:ident),+) = $value:expr;)+) => {
        $(
            #[pyfunction]
            fn $name<'py>(py: Python<'py>, $($argument: Numbers<'py>),+) -> Made<'py> {
                each(py, [$(&$argument),+], |[$($argument),+]| $value)
            }
        )+

        fn add_functions(module: &Bound<'_, PyModule>) -> PyResult<()> {
            $(module.add_function(wrap_pyfunction!($name, module)?)?;)+
            Ok(())
        }
    };
}

functions! {
    phase_step_energy(depth_nm, wavelength_nm) = [scratch::phase_step_energy(depth_nm, wavelength_nm)];
    oblique_depth_nm(depth_nm, cos_i, cos_o) = [scratch::oblique_depth_nm(depth_nm, cos_i, cos_o)];
    window_overlap_um2(offset_um, start_um, end_um, coherence_um) =
        [scratch::window_overlap_um2(offset_um, start_um, end_um, coherence_um)];
    window_share(width_um, overlap_um2, coherence_um) =
        [scratch::window_share(width_um, overlap_um2, coherence_um)];
    band_std(coherence_um, wavelength_nm) = [scratch::band_std(coherence_um, wavelength_nm)];
    sinc_squared_integral(u_um, wavelength_nm) =
        [diffraction::sinc_squared_integral(u_um, 1e-3 * wavelength_nm)];
    fresnel_dielectric(cos_theta, eta) = [fresnel::dielectric(cos_theta, eta)];
    black_body_rgb(temperature_k) = spectrum::black_body_rgb(temperature_k);
    mask_taken(share, share_by_line, energy_r, energy_g, energy_b, depth_coherence) = {
        let mut sums = ScratchSums::default();
        let line = share_by_line / share.max(1e-30);
        let energy = [energy_r, energy_g, energy_b].map(|energy| energy / share.max(1e-30));
        sums.add(ScratchShare { segment: share, line, cover: 1.0 }, energy, [0.0; 3]);
        sums.resolve(Mask::Energy, depth_coherence).taken
    };
}

/// Reflectance of a metal.
#[pyfunction]
fn fresnel_metal<'py>(
    py: Python<'py>,
    name: &str,
    cos_theta: Numbers<'py>,
    wavelength_nm: Numbers<'py>,
) -> Made<'py> {
    let metal = metal(name)?;
    each(py, [&cos_theta, &wavelength_nm], |[cos, nm]| {
        [metal.reflectance(cos, nm)]
    })
}

/// Reflectance of a metal as a colour.
#[pyfunction]
fn metal_rgb<'py>(py: Python<'py>, name: &str, cos_theta: Numbers<'py>) -> Made<'py> {
    let metal = metal(name)?;
    each(py, [&cos_theta], |[cos]| metal.reflectance_rgb(cos))
}

/// Coherence of the phase steps of grooves of these depths.
#[pyfunction]
fn depth_coherence(depths_nm: Numbers<'_>, weights: Numbers<'_>) -> PyResult<f64> {
    let depths_nm = depths_nm.as_slice().map_err(|_| errors::internal())?;
    let weights = weights.as_slice().map_err(|_| errors::internal())?;
    let both = depths_nm.iter().copied().zip(weights.iter().copied());
    Ok(mask::depth_coherence(both))
}

/// Wavelengths, and their weights in red, green and blue.
#[pyfunction]
fn spectrum_samples(py: Python<'_>) -> (Bound<'_, PyArray1<f64>>, Bound<'_, PyArray1<f64>>) {
    let samples = spectrum::samples();
    let wavelengths_nm: Vec<_> = samples.iter().map(|sample| sample.wavelength_nm).collect();
    let weights: Vec<_> = samples.iter().flat_map(|sample| sample.weight).collect();
    (wavelengths_nm.into_pyarray(py), weights.into_pyarray(py))
}

/// Rows of a wavelength, the CIE 1931 observer's functions and D65's power, and the matrix from XYZ to Rec.709.
#[pyfunction]
fn cie(py: Python<'_>) -> (Bound<'_, PyArray1<f64>>, Bound<'_, PyArray1<f64>>) {
    let rows: Vec<f64> = spectrum::cie().as_flattened().to_vec();
    let matrix = spectrum::REC709_FROM_XYZ.as_flattened().to_vec();
    (rows.into_pyarray(py), matrix.into_pyarray(py))
}

/// The spectrum of grooves in a metal, by u and depth.
#[pyclass(frozen, module = "hairline._hairline")]
struct ScratchTable {
    table: table::ScratchTable,
}

#[pymethods]
impl ScratchTable {
    #[new]
    fn new(py: Python<'_>, name: &str) -> PyResult<Self> {
        let metal = metal(name)?;
        let table = py.detach(|| table::ScratchTable::new(|nm| metal.reflectance(1.0, nm)));
        Ok(Self { table })
    }

    fn at<'py>(&self, py: Python<'py>, u_um: Numbers<'py>, depth_nm: Numbers<'py>) -> Made<'py> {
        each(py, [&u_um, &depth_nm], |[u_um, depth_nm]| {
            self.table.scratch_table(u_um, depth_nm)
        })
    }

    fn total<'py>(&self, py: Python<'py>, depth_nm: Numbers<'py>) -> Made<'py> {
        each(py, [&depth_nm], |[depth_nm]| {
            self.table.scratch_table_total(depth_nm)
        })
    }
}

/// The whole field of straight grooves, rows of (angle of the tangent, offset, start, end, width, depth): base, cross and scratches.
#[pyfunction]
fn coherent_response<'py>(
    py: Python<'py>,
    grooves: Vec<[f64; 6]>,
    xi_x: Numbers<'py>,
    xi_y: Numbers<'py>,
    cos_sum: Numbers<'py>,
    wavelength_nm: Numbers<'py>,
    coherence_um: f64,
) -> Made<'py> {
    let pieces: Vec<_> = grooves
        .iter()
        .map(
            |&[angle_rad, offset_um, start_um, end_um, width_um, depth_nm]| GroovePiece {
                tangent: glam::DVec2::from_angle(angle_rad),
                offset_um,
                start_um,
                end_um,
                width_um,
                depth_nm,
            },
        )
        .collect();
    each(
        py,
        [&xi_x, &xi_y, &cos_sum, &wavelength_nm],
        |[x, y, cos_sum, nm]| {
            let xi = glam::DVec2::new(x, y);
            let response =
                coherent::coherent_response(&pieces, xi, cos_sum, coherence_um, nm, true);
            [response.base, response.cross, response.scratches]
        },
    )
}

/// Names of the metals in scene files.
#[pyfunction]
fn metal_names() -> Vec<&'static str> {
    Metal::NAMES.to_vec()
}

/// Adds the functions of this file to the module.
pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    add_functions(module)?;
    module.add_class::<ScratchTable>()?;
    module.add_function(wrap_pyfunction!(fresnel_metal, module)?)?;
    module.add_function(wrap_pyfunction!(metal_rgb, module)?)?;
    module.add_function(wrap_pyfunction!(metal_names, module)?)?;
    module.add_function(wrap_pyfunction!(depth_coherence, module)?)?;
    module.add_function(wrap_pyfunction!(spectrum_samples, module)?)?;
    module.add_function(wrap_pyfunction!(cie, module)?)?;
    module.add_function(wrap_pyfunction!(coherent_response, module)?)
}
