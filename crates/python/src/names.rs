//! Values that have names, stops, and notes.

use hairline_document::description::Camera;
use hairline_image::{Notes, ToneMap};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors;

/// The value of one of a few names.
pub(crate) fn named<T: Clone>(key: &str, name: &str, all: &[(&str, T)]) -> PyResult<T> {
    all.iter().find(|(known, _)| *known == name).map_or_else(
        || {
            let names: Vec<_> = all.iter().map(|(name, _)| format!("\"{name}\"")).collect();
            let right = format!("must be one of {}", names.join(", "));
            Err(errors::of_argument(key, format!("found \"{name}\""), right))
        },
        |(_, value)| Ok(value.clone()),
    )
}

/// A tone curve by its name.
pub(crate) fn tone_map(name: &str) -> PyResult<ToneMap> {
    named(
        "tone_map",
        name,
        &ToneMap::ALL.map(|curve| (curve.name(), curve)),
    )
}

/// Stops.
pub(crate) fn exposure(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    let number = value.extract::<f64>().ok();
    let within = number.filter(|stops| Camera::EXPOSURE_EV.bounds.ends().contains(stops));
    within.ok_or_else(|| {
        let found = value.repr().map_or_else(
            |_| "found no number".to_owned(),
            |shown| format!("found {shown}"),
        );
        let (least, most) = Camera::EXPOSURE_EV.bounds.ends().into_inner();
        let right = format!("must be a number of stops from {least} to {most}");
        errors::of_argument("exposure_ev", found, right)
    })
}

/// Notes as Python has them.
pub(crate) fn notes_dict<'py>(py: Python<'py>, notes: &Notes) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in notes {
        dict.set_item(name, value)?;
    }
    Ok(dict)
}
