//! Labels of a picture as arrays of numpy.

use std::path::PathBuf;

use hairline_render::labels::{self, RANKS};
use hairline_scene::{Object, Scene};
use numpy::{IntoPyArray, PyArray1, PyArrayMethods, ToPyArray};
use pyo3::prelude::*;

use crate::errors;

/// Labels of a picture: which scratches each pixel shows. What shows nothing is -1.
#[pyclass(frozen, module = "hairline")]
pub(crate) struct Labels {
    labels: labels::Labels,
    scene: Scene,
}

impl Labels {
    pub(crate) fn new(labels: labels::Labels, scene: Scene) -> Self {
        Self { labels, scene }
    }

    fn pixels<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        values: Vec<T>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let [width, height] = self.labels.size_px.map(|n| n as usize);
        let ranks = values.len() / (width * height).max(1);
        let array = values.into_pyarray(py);
        Ok(match ranks {
            1 => array.reshape([height, width])?.into_any(),
            _ => array.reshape([height, width, ranks])?.into_any(),
        })
    }

    fn each<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(usize, &Object, &hairline_scene::Scratch) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        let objects = self.scene.objects.iter().enumerate();
        let all =
            objects.flat_map(|(i, object)| object.scratches.iter().map(move |it| (i, object, it)));
        let values: Vec<T> = all.map(|(i, object, it)| of(i, object, it)).collect();
        values.into_pyarray(py)
    }
}

/// Numbers of things, -1 for nothing.
fn numbers(things: &[u32]) -> Vec<i32> {
    // Nothing is the largest number.
    things.iter().map(|thing| *thing as i32).collect()
}

#[pymethods]
impl Labels {
    /// Number of scratches that each pixel names.
    #[classattr]
    const RANKS: usize = RANKS;

    /// Width and height, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        let [width, height] = self.labels.size_px;
        (width, height)
    }

    /// Names of the objects.
    #[getter]
    fn objects(&self) -> Vec<String> {
        self.scene
            .objects
            .iter()
            .map(|object| object.name.clone())
            .collect()
    }

    /// Index of the object in `objects` that the middle of each pixel sees: int32, height x width.
    #[getter]
    fn object<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.pixels(py, numbers(&self.labels.object))
    }

    /// Scratches that cover most of each pixel, the strongest first, counted over all objects: int32, height x width x 6.
    #[getter]
    fn scratch<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.pixels(py, numbers(&self.labels.scratch))
    }

    /// Share of the pixel, through its filter, that each of these covers: float32, height x width x 6.
    #[getter]
    fn coverage<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.pixels(py, self.labels.coverage.clone())
    }

    /// Direction of each of these in the picture, radians counter-clockwise from the right: float32, height x width x 6.
    #[getter]
    fn direction_rad<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.pixels(py, self.labels.direction_rad.clone())
    }

    /// Pixels that scratches go through: uint32, n x 2, the index of the pixel row by row and that of the scratch.
    #[getter]
    fn touched<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let flat = self.labels.touched.as_flattened().to_pyarray(py);
        Ok(flat.reshape([self.labels.touched.len(), 2])?.into_any())
    }

    /// Object of each scratch: uint32.
    #[getter]
    fn scratch_object<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.each(py, |object, _, _| object as u32)
    }

    /// Table of `scratches` that each scratch was laid by: uint32.
    #[getter]
    fn scratch_layer<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.each(py, |_, _, it| it.layer)
    }

    /// Width of each scratch: float32, micrometres.
    #[getter]
    fn scratch_width_um<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        self.each(py, |_, _, it| it.profile.width_um)
    }

    /// Depth of each scratch: float32, nanometres.
    #[getter]
    fn scratch_depth_nm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        self.each(py, |_, _, it| it.profile.depth_nm)
    }

    /// Length of each scratch: float32, metres.
    #[getter]
    fn scratch_length_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        self.each(py, |_, object, scratch| {
            let own = scratch.segments.start as usize..scratch.segments.end as usize;
            object.segments[own]
                .iter()
                .map(|piece| piece.start_m.distance(piece.end_m))
                .sum()
        })
    }

    /// Writes an .exr by the convention of Cryptomatte: the whole file or none.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let written = py.detach(|| self.labels.write(&path, &self.scene));
        written.map_err(|error| errors::of_image(py, &error))
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.labels.size_px;
        let all: usize = self
            .scene
            .objects
            .iter()
            .map(|object| object.scratches.len())
            .sum();
        format!("<hairline.Labels: {width} x {height} pixels, {all} scratches>")
    }
}
