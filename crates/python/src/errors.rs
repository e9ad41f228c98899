//! Exceptions. Their classes are written in Python, where they have their documentation.

use hairline_render::failure::Failure;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

fn class<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    static MODULE: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let module = MODULE.get_or_try_init(py, || py.import("hairline._errors").map(Bound::unbind))?;
    module.bind(py).getattr(name)
}

fn made(py: Python<'_>, made: PyResult<Bound<'_, PyAny>>) -> PyErr {
    match made {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => {
            let _ = py;
            error
        }
    }
}

/// Converts an error of a scene to `SceneError`.
pub(crate) fn of_scene(py: Python<'_>, error: &hairline_document::Error) -> PyErr {
    let file = error.file().map(|file| file.display().to_string());
    let arguments = (
        error.to_string(),
        file,
        error.line(),
        error.key(),
        error.found(),
        error.right(),
    );
    made(
        py,
        class(py, "SceneError").and_then(|class| class.call1(arguments)),
    )
}

/// Makes a `SceneError` without a file for an argument.
pub(crate) fn of_argument(key: &str, found: impl Into<String>, right: impl Into<String>) -> PyErr {
    let error = hairline_document::Error::new(key, found, right);
    Python::attach(|py| of_scene(py, &error))
}

/// Why work was not done: `SceneError` where a scene is wrong, else `WorkError`.
pub(crate) fn of_failure(py: Python<'_>, failure: &Failure) -> PyErr {
    let (Failure::Input(error) | Failure::Work(error)) = failure;
    match error.downcast_ref::<hairline_document::Error>() {
        Some(error) => of_scene(py, error),
        None => of_work(py, &format!("{error:#}")),
    }
}

/// Why a picture was not read or written.
pub(crate) fn of_image(py: Python<'_>, error: &hairline_image::Error) -> PyErr {
    of_work(py, &error.to_string())
}

/// `WorkError`
pub(crate) fn of_work(py: Python<'_>, message: &str) -> PyErr {
    made(
        py,
        class(py, "WorkError").and_then(|class| class.call1((message,))),
    )
}

/// A mistake of Hairline.
pub(crate) fn internal() -> PyErr {
    PyRuntimeError::new_err(
        "internal error of hairline; please report it with the script and its files",
    )
}
