//! `hairline._hairline`: the functions that the Python package of hairline calls. The package's Python part gives it
//! names, defaults and documentation; this part converts values and arrays to the libraries' types, and calls them.

mod arrays;
mod bsdf;
mod built;
mod compare;
mod editing;
mod errors;
mod image;
mod labels;
mod laid;
mod names;
mod optics;
mod scene;
mod scene_bsdf;
mod strips;
mod values;
mod watched;

use hairline_document::description::Laid;
use hairline_optics::scratch::DEPTH_MAX_NM;
use hairline_optics::section::NARROW;
use hairline_optics::spectrum::{WAVELENGTH_MAX_NM, WAVELENGTH_MIN_NM};
use pyo3::prelude::*;

/// Has all that follows run on so many threads. It must come before any work.
#[pyfunction]
fn set_threads(count: usize) -> PyResult<()> {
    let made = rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .build_global();
    made.map_err(|_| {
        let right = "must be set before any other work, or by RAYON_NUM_THREADS";
        let running = rayon::current_num_threads();
        errors::of_argument("threads", format!("found {running} at work already"), right)
    })
}

/// Number of threads that work runs on.
#[pyfunction]
fn threads() -> usize {
    rayon::current_num_threads()
}

#[pymodule]
fn _hairline(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("DEFAULT_SAMPLES", hairline_document::DEFAULT_SAMPLES)?;
    module.add("WIDEST_UM", Laid::WIDTH_UM.bounds.ends().end())?;
    module.add("DEEPEST_NM", DEPTH_MAX_NM)?;
    module.add("NARROW", NARROW)?;
    module.add("WAVELENGTHS_NM", (WAVELENGTH_MIN_NM, WAVELENGTH_MAX_NM))?;
    module.add_class::<arrays::MeshArray>()?;
    module.add_class::<bsdf::Bsdf>()?;
    module.add_class::<arrays::ScratchArray>()?;
    module.add_class::<image::Image>()?;
    module.add_class::<labels::Labels>()?;
    module.add_class::<scene::Builder>()?;
    module.add_class::<scene_bsdf::SceneBsdf>()?;
    module.add_class::<built::Built>()?;
    module.add_function(wrap_pyfunction!(set_threads, module)?)?;
    module.add_function(wrap_pyfunction!(threads, module)?)?;
    module.add_function(wrap_pyfunction!(scene::read, module)?)?;
    module.add_function(wrap_pyfunction!(scene::check, module)?)?;
    module.add_function(wrap_pyfunction!(scene::to_toml, module)?)?;
    module.add_function(wrap_pyfunction!(scene::export, module)?)?;
    module.add_function(wrap_pyfunction!(image::read_image, module)?)?;
    module.add_function(wrap_pyfunction!(image::write_bands, module)?)?;
    module.add_function(wrap_pyfunction!(strips::assemble, module)?)?;
    module.add_function(wrap_pyfunction!(strips::picture_from_state, module)?)?;
    module.add_function(wrap_pyfunction!(strips::picture_state, module)?)?;
    module.add_function(wrap_pyfunction!(scene::inputs, module)?)?;
    module.add_function(wrap_pyfunction!(scene::digest, module)?)?;
    module.add_function(wrap_pyfunction!(compare::compare, module)?)?;
    module.add_function(wrap_pyfunction!(editing::controls, module)?)?;
    module.add_function(wrap_pyfunction!(editing::presets, module)?)?;
    module.add_function(wrap_pyfunction!(editing::from_preset, module)?)?;
    optics::add_to(module)
}
