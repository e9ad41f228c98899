//! Meshes and scratches from numpy arrays. Each is copied once, into what scenes are built from.

use std::sync::Arc;

use hairline_document::{Error, MeshArrays, ScratchArrays};
use numpy::{
    IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
    PyUntypedArrayMethods, ToPyArray,
};
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple, PyType};

use crate::errors;

/// Digits of a name: 128 bits, beyond any accident.
const DIGITS: usize = 32;

/// A name that stands for these numbers.
fn name(parts: &[&[u8]]) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in parts {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    }
    format!("array:{}", &hasher.finalize().to_hex()[..DIGITS])
}

fn contiguous<'a, T: numpy::Element>(
    key: &str,
    slice: Result<&'a [T], impl std::fmt::Debug>,
) -> PyResult<&'a [T]> {
    slice.map_err(|_| errors::of_argument(key, "found an array with gaps", "must be contiguous"))
}

/// Function that pickles call with the parts of either.
fn restore(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    py.import("hairline._arrays")?.getattr("restored")
}

/// The class, and the arguments of [`MeshArray::new`].
type Parts<'py> = (
    Bound<'py, PyType>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<u32>>,
    Option<Bound<'py, PyArray2<f64>>>,
    Option<Bound<'py, PyArray2<f64>>>,
);

fn rows<'py, T: numpy::Element + Copy>(
    py: Python<'py>,
    values: &[T],
    columns: usize,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    values
        .to_pyarray(py)
        .reshape([values.len() / columns, columns])
}

/// Triangles in memory, by the name that a scene has for them.
#[pyclass(frozen, module = "hairline._hairline")]
pub(crate) struct MeshArray {
    pub(crate) arrays: Arc<MeshArrays>,
    #[pyo3(get)]
    pub(crate) name: String,
    #[pyo3(get)]
    vertices: usize,
    #[pyo3(get)]
    triangles: usize,
}

#[pymethods]
impl MeshArray {
    #[new]
    #[pyo3(signature = (vertices_m, triangles, normals=None, uvs=None))]
    fn new(
        py: Python<'_>,
        vertices_m: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        normals: Option<PyReadonlyArray2<'_, f64>>,
        uvs: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<Self> {
        let vertices_m = contiguous("vertices_m", vertices_m.as_slice())?;
        let triangles = contiguous("triangles", triangles.as_slice())?;
        let normals = normals
            .as_ref()
            .map(|it| contiguous("normals", it.as_slice()));
        let normals = normals.transpose()?;
        let uvs = uvs
            .as_ref()
            .map(|it| contiguous("uvs", it.as_slice()))
            .transpose()?;
        let made: Result<_, Error> = py.detach(|| {
            let name = name(&[
                bytemuck::cast_slice(vertices_m),
                bytemuck::cast_slice(triangles),
                bytemuck::cast_slice(normals.unwrap_or_default()),
                bytemuck::cast_slice(uvs.unwrap_or_default()),
            ]);
            let arrays = MeshArrays::new(
                bytemuck::cast_slice(vertices_m).to_vec(),
                bytemuck::cast_slice(triangles).to_vec(),
                normals.map(|it| bytemuck::cast_slice(it).to_vec()),
                uvs.map(|it| bytemuck::cast_slice(it).to_vec()),
            )?;
            Ok((name, arrays))
        });
        let (name, arrays) = made.map_err(|error| errors::of_scene(py, &error))?;
        Ok(Self {
            arrays: arrays.into(),
            name,
            vertices: vertices_m.len() / 3,
            triangles: triangles.len() / 3,
        })
    }

    fn __repr__(&self) -> String {
        format!("<{} vertices, {} triangles>", self.vertices, self.triangles)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let other = other.cast::<Self>();
        other.is_ok_and(|other| other.get().name == self.name)
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        PyString::new(py, &self.name).hash()
    }

    fn __deepcopy__<'py>(slf: Bound<'py, Self>, _memo: &Bound<'py, PyAny>) -> Bound<'py, Self> {
        slf
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Parts<'py>)> {
        let py = slf.py();
        let arrays = &slf.get().arrays;
        let parts = (
            slf.get_type(),
            rows(py, arrays.vertices_m().as_flattened(), 3)?,
            rows(py, arrays.triangles().as_flattened(), 3)?,
            arrays
                .normals()
                .map(|it| rows(py, it.as_flattened(), 3))
                .transpose()?,
            arrays
                .uvs()
                .map(|it| rows(py, it.as_flattened(), 2))
                .transpose()?,
        );
        Ok((restore(py)?, parts))
    }
}

/// Straight scratches in memory, by the name that a scene has for them.
#[pyclass(frozen, module = "hairline._hairline")]
pub(crate) struct ScratchArray {
    pub(crate) arrays: Arc<ScratchArrays>,
    #[pyo3(get)]
    pub(crate) name: String,
    #[pyo3(get)]
    count: usize,
}

#[pymethods]
impl ScratchArray {
    /// `sizes` in the order of [`ScratchArrays::SIZES`].
    #[new]
    #[pyo3(signature = (ends_m, *sizes))]
    fn new(
        py: Python<'_>,
        ends_m: PyReadonlyArray3<'_, f64>,
        sizes: Vec<PyReadonlyArray1<'_, f64>>,
    ) -> PyResult<Self> {
        let count = ends_m.shape()[0];
        let ends_m = contiguous("ends_m", ends_m.as_slice())?;
        let keys = ScratchArrays::SIZES;
        let mut slices = [&[][..]; ScratchArrays::SIZES.len()];
        for ((slice, array), key) in slices.iter_mut().zip(&sizes).zip(keys) {
            *slice = contiguous(key, array.as_slice())?;
        }
        let made: Result<_, Error> = py.detach(|| {
            let arrays = ScratchArrays::new(bytemuck::cast_slice(ends_m).to_vec(), slices)?;
            // Sizes in the precision of the stored layer, so that a copy has the same name.
            let sizes = (0..keys.len()).flat_map(|place| arrays.size(place));
            let sizes: Vec<f32> = sizes.collect();
            let name = name(&[bytemuck::cast_slice(ends_m), bytemuck::cast_slice(&sizes)]);
            Ok((name, arrays))
        });
        let (name, arrays) = made.map_err(|error| errors::of_scene(py, &error))?;
        Ok(Self {
            arrays: arrays.into(),
            name,
            count,
        })
    }

    fn __repr__(&self) -> String {
        format!("<{} scratches>", self.count)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let other = other.cast::<Self>();
        other.is_ok_and(|other| other.get().name == self.name)
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        PyString::new(py, &self.name).hash()
    }

    fn __deepcopy__<'py>(slf: Bound<'py, Self>, _memo: &Bound<'py, PyAny>) -> Bound<'py, Self> {
        slf
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let py = slf.py();
        let arrays = &slf.get().arrays;
        let ends_m = arrays.ends_m().as_flattened().as_flattened().to_pyarray(py);
        let ends_m = ends_m.reshape([arrays.ends_m().len(), 2, 3])?;
        let mut parts = vec![slf.get_type().into_any(), ends_m.into_any()];
        for place in 0..ScratchArrays::SIZES.len() {
            let size: Vec<f64> = arrays.size(place).map(f64::from).collect();
            parts.push(size.into_pyarray(py).into_any());
        }
        Ok((restore(py)?, PyTuple::new(py, parts)?))
    }
}
