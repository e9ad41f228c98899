//! Comparison of two pictures.

use std::path::PathBuf;

use hairline_image::metrics::{self, Metric, Problem};
use hairline_image::{Display, Layers};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors;
use crate::image::Image;
use crate::names::{exposure, tone_map};
use crate::watched::refuse_forks;

/// A picture in memory or in a file.
fn layers(picture: &Bound<'_, PyAny>) -> PyResult<Layers> {
    let py = picture.py();
    if let Ok(image) = picture.cast::<Image>() {
        return Ok(image.get().layers());
    }
    let path: PathBuf = picture.extract()?;
    let read = py.detach(|| Layers::read(&path));
    read.map_err(|error| errors::of_image(py, &error))
}

/// The figures of each layer, and the problems that keep the comparison from being complete.
#[pyfunction]
pub(crate) fn compare<'py>(
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    exposure_ev: &Bound<'py, PyAny>,
    curve: &str,
) -> PyResult<(Bound<'py, PyDict>, Vec<String>)> {
    let py = a.py();
    refuse_forks(py)?;
    let display = Display {
        exposure_ev: exposure(exposure_ev)?,
        tone_map: tone_map(curve)?,
    };
    let (a, b) = (layers(a)?, layers(b)?);
    let comparison = py.detach(|| metrics::compare(&a, &b, &display, None));
    for problem in &comparison.problems {
        if matches!(
            problem,
            Problem::SizesDiffer { .. } | Problem::NothingInCommon
        ) {
            return Err(errors::of_argument(
                "a, b",
                problem.to_string(),
                "must be two pictures of one size",
            ));
        }
    }
    let layers = PyDict::new(py);
    for layer in &comparison.layers {
        let figures = PyDict::new(py);
        for metric in Metric::ALL {
            if let Some(value) = metric.value(layer) {
                figures.set_item(metric.name().replace('-', "_"), value)?;
            }
        }
        figures.set_item("mean", layer.difference.mean)?;
        figures.set_item("reference_mean", layer.difference.reference_mean)?;
        figures.set_item("not_finite", layer.difference.not_finite)?;
        if let Some(test) = &layer.z_test {
            figures.set_item("verdict", test.verdict.name())?;
        }
        layers.set_item(layer.layer.name(), figures)?;
    }
    let problems = comparison.problems.iter().map(ToString::to_string);
    Ok((layers, problems.collect()))
}
