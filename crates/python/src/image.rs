//! Pictures: their layers as arrays of numpy that share the picture's memory.

use std::path::PathBuf;

use hairline_image::{
    BandImage, Display, Finish, Format, Layer, Layers, Notes, Output, exr_file, png,
};
use hairline_render::reference::identity;
use numpy::ndarray::{ArrayView2, ArrayView3, Axis};
use numpy::{
    Element, IntoPyArray, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray3,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyImportError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyDict};

use crate::errors;
use crate::labels::Labels;
use crate::names::{exposure, named, notes_dict, tone_map};

/// A picture with its layers: linear Rec.709, rows from the top. Its arrays share its memory and cannot be written to.
#[pyclass(frozen, module = "hairline")]
pub(crate) struct Image {
    image: hairline_image::Image,
    display: Display,
    notes: Notes,
    /// Whether each pixel has all of its samples; False after Ctrl-C.
    #[pyo3(get)]
    is_complete: bool,
    /// Beauty picture, made at the first access.
    beauty: PyOnceLock<Py<PyArray3<f32>>>,
    /// Labels that were rendered with it.
    labels: PyOnceLock<Py<Labels>>,
}

/// Writes an .exr of bands of the spectrum: arrays of height x width x bands.
#[pyfunction]
pub(crate) fn write_bands(
    py: Python<'_>,
    path: PathBuf,
    bands_nm: Vec<[f64; 2]>,
    base: PyReadonlyArray3<'_, f32>,
    scratches: PyReadonlyArray3<'_, f32>,
) -> PyResult<()> {
    let [height, width, _] = *base.shape() else {
        return Err(errors::internal());
    };
    let channels = |of: &PyReadonlyArray3<'_, f32>| {
        let layers = of.as_array();
        let bands = layers.axis_iter(Axis(2));
        bands.map(|band| band.iter().copied().collect()).collect()
    };
    let picture = BandImage {
        size_px: [width as u32, height as u32],
        bands_nm,
        base: channels(&base),
        scratches: channels(&scratches),
    };
    let write = || match Output::check(&path)?.format() {
        Format::Exr => picture.write(&path),
        Format::Png => Err(hairline_image::Error::CannotWrite {
            path: path.clone(),
            reason: "bands need an .exr".to_owned(),
        }),
    };
    py.detach(write)
        .map_err(|error| errors::of_image(py, &error))
}

/// Reads a layered EXR that `Image.save`, `hairline render` or `hairline reference` wrote.
#[pyfunction]
pub(crate) fn read_image(py: Python<'_>, path: PathBuf) -> PyResult<Image> {
    let read = py.detach(|| exr_file::read_image_with_notes(&path));
    let (image, notes) = read.map_err(|error| errors::of_image(py, &error))?;
    Ok(Image::new(image, Display::default(), notes, true))
}

impl Image {
    pub(crate) fn new(
        image: hairline_image::Image,
        display: Display,
        notes: Notes,
        is_complete: bool,
    ) -> Self {
        Self {
            image,
            display,
            notes,
            is_complete,
            beauty: PyOnceLock::new(),
            labels: PyOnceLock::new(),
        }
    }

    /// The layers.
    pub(crate) fn image(&self) -> &hairline_image::Image {
        &self.image
    }

    /// Notes on the picture's making.
    pub(crate) fn notes(&self) -> &Notes {
        &self.notes
    }

    /// Display settings of the picture.
    pub(crate) fn shown(&self) -> &Display {
        &self.display
    }

    /// Whether each pixel has all of its samples.
    pub(crate) fn is_whole(&self) -> bool {
        self.is_complete
    }

    /// Layers for a comparison.
    pub(crate) fn layers(&self) -> Layers {
        Layers::from(&self.image)
    }

    /// A copy that samples can be added to.
    pub(crate) fn to_resume(
        &self,
        size_px: [u32; 2],
        wanted: &Notes,
    ) -> PyResult<hairline_image::Image> {
        identity::check(&self.image, &self.notes, size_px, wanted).map_err(|reason| {
            errors::of_argument(
                "resume",
                format!("cannot go on from this image: {reason}"),
                "leave it out",
            )
        })?;
        Ok(self.image.clone())
    }

    fn display(
        &self,
        exposure_ev: Option<&Bound<'_, PyAny>>,
        curve: Option<&str>,
    ) -> PyResult<Display> {
        let own = self.display.exposure_ev;
        Ok(Display {
            exposure_ev: exposure_ev.map_or(Ok(own), exposure)?,
            tone_map: curve.map_or(Ok(self.display.tone_map), tone_map)?,
        })
    }

    fn shape(&self) -> [usize; 2] {
        [
            self.image.size_px[1] as usize,
            self.image.size_px[0] as usize,
        ]
    }

    fn rgb<'py>(slf: &Bound<'py, Self>, values: &[[f32; 3]]) -> PyResult<Bound<'py, PyAny>> {
        let [height, width] = slf.get().shape();
        let view = ArrayView3::from_shape((height, width, 3), values.as_flattened());
        let view = view.map_err(|_| errors::internal())?;
        #[expect(
            unsafe_code,
            reason = "the image owns the values and never changes them"
        )]
        let array = unsafe { PyArray3::borrow_from_array(&view, slf.clone().into_any()) };
        read_only(array.into_any())
    }

    fn plane<'py, T: Element>(slf: &Bound<'py, Self>, values: &[T]) -> PyResult<Bound<'py, PyAny>> {
        let [height, width] = slf.get().shape();
        let view = ArrayView2::from_shape((height, width), values);
        let view = view.map_err(|_| errors::internal())?;
        #[expect(
            unsafe_code,
            reason = "the image owns the values and never changes them"
        )]
        let array = unsafe { PyArray2::borrow_from_array(&view, slf.clone().into_any()) };
        read_only(array.into_any())
    }
}

fn read_only(array: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyAny>> {
    let writable = PyDict::new(array.py());
    writable.set_item("write", false)?;
    array.call_method("setflags", (), Some(&writable))?;
    Ok(array)
}

#[pymethods]
impl Image {
    /// Width and height, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        let [width, height] = self.image.size_px;
        (width, height)
    }

    /// Notes on the picture's making.
    #[getter(notes)]
    fn notes_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        notes_dict(py, &self.notes)
    }

    /// Exposure of the displayed picture in stops.
    #[getter]
    fn exposure_ev(&self) -> f64 {
        self.display.exposure_ev
    }

    /// Tone curve of the displayed picture.
    #[getter]
    fn tone_map(&self) -> &'static str {
        self.display.tone_map.name()
    }

    /// Base plus scratches: float32, height x width x 3, W sr^-1 m^-2. Made when first asked for, and kept.
    #[getter]
    fn beauty(slf: &Bound<'_, Self>) -> PyResult<Py<PyArray3<f32>>> {
        let py = slf.py();
        let image = slf.get();
        let beauty = image.beauty.get_or_try_init(py, || {
            let rgb = py.detach(|| image.image.beauty().rgb);
            let [height, width] = image.shape();
            let array = rgb.into_flattened().into_pyarray(py);
            let array = array.reshape([height, width, 3])?;
            read_only(array.clone().into_any())?;
            Ok::<_, PyErr>(array.unbind())
        })?;
        Ok(beauty.clone_ref(py))
    }

    /// Light off the base and of the background: float32, height x width x 3, W sr^-1 m^-2.
    #[getter]
    fn base<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Self::rgb(slf, &slf.get().image.base)
    }

    /// Light off the scratches: float32, height x width x 3, W sr^-1 m^-2.
    #[getter]
    fn scratches<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Self::rgb(slf, &slf.get().image.scratches)
    }

    /// The share of the base's energy that scratches took: float32, height x width x 3, from 0 to 1.
    #[getter]
    fn density<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Self::rgb(slf, &slf.get().image.density)
    }

    /// Unit shading normal in world space: float32, height x width x 3; 0 where there is no surface.
    #[getter]
    fn normal<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Self::rgb(slf, &slf.get().image.normal)
    }

    /// Distance along the view axis: float32, height x width, metres; 0 where there is no surface.
    #[getter]
    fn depth_m<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Self::plane(slf, &slf.get().image.depth_m)
    }

    /// The share of each pixel that surfaces cover: float32, height x width, from 0 to 1. None but for a picture before a transparent background.
    #[getter]
    fn alpha<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let alpha = slf.get().image.alpha.as_ref();
        alpha.map(|alpha| Self::plane(slf, alpha)).transpose()
    }

    /// Which scratches each pixel shows. None but for a picture that was rendered with `labels=True`.
    #[getter]
    fn labels(&self, py: Python<'_>) -> Option<Py<Labels>> {
        self.labels.get(py).map(|labels| labels.clone_ref(py))
    }

    /// Adds the labels of the same picture.
    fn _with_labels(slf: Bound<'_, Self>, labels: Py<Labels>) -> Bound<'_, Self> {
        // Those that are there already are of the same picture.
        let _ = slf.get().labels.set(slf.py(), labels);
        slf
    }

    /// Samples of each pixel of a reference: uint32, height x width. None for a picture of the closed forms.
    #[getter]
    fn samples<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let noise = slf.get().image.noise.as_ref();
        noise
            .map(|noise| Self::plane(slf, &noise.samples))
            .transpose()
    }

    /// The variance of each pixel's mean in a layer: float32, height x width x 3, squared radiance. None where it is not known.
    #[pyo3(signature = (layer="beauty"))]
    fn variance<'py>(slf: &Bound<'py, Self>, layer: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        let names = Layer::ALL.map(|layer| (layer.name(), layer));
        let layer = named("layer", layer, &names)?;
        let variance = slf.get().image.variance(layer);
        variance.map(|values| Self::rgb(slf, values)).transpose()
    }

    /// Writes an .exr (linear, all layers) or a .png (displayed): the whole file or none.
    #[pyo3(signature = (path, exposure_ev=None, tone_map=None))]
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        exposure_ev: Option<&Bound<'_, PyAny>>,
        tone_map: Option<&str>,
    ) -> PyResult<()> {
        let display = self.display(exposure_ev, tone_map)?;
        let write = || {
            let output = Output::check(&path)?;
            output.write_image_with_notes(&self.image, &display, &self.notes)
        };
        py.detach(write)
            .map_err(|error| errors::of_image(py, &error))
    }

    /// The displayed picture as the bytes of a PNG.
    #[pyo3(signature = (exposure_ev=None, tone_map=None))]
    fn png<'py>(
        &self,
        py: Python<'py>,
        exposure_ev: Option<&Bound<'_, PyAny>>,
        tone_map: Option<&str>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let display = self.display(exposure_ev, tone_map)?;
        let encoded = py.detach(|| png::encode_image(&self.image, &display, &Finish::default()));
        let bytes = encoded.map_err(|reason| errors::of_work(py, &reason))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// PNG of the picture, which notebooks show.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.png(py, None, None)
    }

    /// The displayed picture as an image of Pillow.
    #[pyo3(signature = (exposure_ev=None, tone_map=None))]
    fn to_pil<'py>(
        &self,
        py: Python<'py>,
        exposure_ev: Option<&Bound<'_, PyAny>>,
        tone_map: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let pillow = py.import("PIL.Image").map_err(|missing| {
            let needed = "to_pil needs Pillow: pip install 'hairline-render[pil]'";
            let error = PyImportError::new_err(needed);
            error.set_cause(py, Some(missing));
            error
        })?;
        pillow.call_method1("fromarray", (self.codes(py, exposure_ev, tone_map)?,))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        if slf.get().labels.get(slf.py()).is_some() {
            let told = "a picture with labels cannot be pickled: render it without, and take those of Scene.labels()";
            return Err(pyo3::exceptions::PyTypeError::new_err(told));
        }
        let module = slf.py().import("hairline._hairline")?;
        let state = module.call_method1("picture_state", (slf,))?;
        Ok((module.getattr("picture_from_state")?, state))
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.image.size_px;
        let part = if self.is_complete {
            ""
        } else {
            ", not complete"
        };
        format!("<hairline.Image: {width} x {height} pixels{part}>")
    }

    /// The displayed picture: sRGB codes, uint8, height x width x 3, or 4 with alpha.
    #[pyo3(signature = (exposure_ev=None, tone_map=None))]
    fn codes<'py>(
        &self,
        py: Python<'py>,
        exposure_ev: Option<&Bound<'_, PyAny>>,
        tone_map: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let display = self.display(exposure_ev, tone_map)?;
        let codes = py.detach(|| png::quantize_image(&self.image, &display));
        let codes = codes.map_err(|reason| errors::of_work(py, &reason))?;
        let [height, width] = self.shape();
        let channels = if self.image.alpha.is_some() { 4 } else { 3 };
        Ok(codes
            .into_pyarray(py)
            .reshape([height, width, channels])?
            .into_any())
    }
}
