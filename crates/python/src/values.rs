//! Python's values as TOML's and back: numbers, texts, paths, sequences, arrays of numpy and tables.

use std::collections::HashMap;
use std::path::Path;

use hairline_document::Arrays;
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use toml::Value;

use crate::arrays::{MeshArray, ScratchArray};
use crate::errors;

/// Tables in tables, beyond which they are taken for endless.
const DEEPEST: usize = 32;

/// Arrays in memory of the values that were read, by name.
#[derive(Default)]
pub(crate) struct Stock {
    pub(crate) arrays: Arrays,
    handles: HashMap<String, Py<PyAny>>,
}

impl Stock {
    /// Whether a path in a folder is a name of something in memory.
    pub(crate) fn has(&self, path: &Path, folder: &Path) -> bool {
        path.strip_prefix(folder)
            .is_ok_and(|name| self.arrays.has(name))
    }

    /// A dictionary of Python's as a table of TOML's.
    pub(crate) fn table(&mut self, table: &Bound<'_, PyDict>) -> PyResult<toml::Table> {
        match self.value(table.as_any(), "", 0)? {
            Value::Table(table) => Ok(table),
            _ => Err(errors::internal()),
        }
    }

    fn value(&mut self, value: &Bound<'_, PyAny>, key: &str, depth: usize) -> PyResult<Value> {
        if depth > DEEPEST {
            let right = "must not hold itself";
            return Err(errors::of_argument(key, "found tables without end", right));
        }
        // Before numbers: Python's `True` is one of them.
        if let Ok(boolean) = value.cast::<PyBool>() {
            return Ok(Value::Boolean(boolean.is_true()));
        }
        if value.is_instance_of::<PyInt>() {
            return Ok(Value::Integer(integer(value, key)?));
        }
        if value.is_instance_of::<PyFloat>() {
            return Ok(Value::Float(value.extract()?));
        }
        if value.is_instance_of::<PyString>() {
            return Ok(Value::String(value.extract()?));
        }
        if let Ok(table) = value.cast::<PyDict>() {
            return Ok(Value::Table(self.entries(table, key, depth)?));
        }
        if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
            let elements = value.try_iter()?.enumerate();
            let read = elements.map(|(i, it)| self.value(&it?, &format!("{key}[{i}]"), depth + 1));
            return Ok(Value::Array(read.collect::<PyResult<_>>()?));
        }
        if let Ok(mesh) = value.cast::<MeshArray>() {
            let mesh = mesh.get();
            self.arrays.insert_mesh(&mesh.name, mesh.arrays.clone());
            return Ok(self.named(&mesh.name, value));
        }
        if let Ok(scratches) = value.cast::<ScratchArray>() {
            let scratches = scratches.get();
            let arrays = scratches.arrays.clone();
            self.arrays.insert_scratches(&scratches.name, arrays);
            return Ok(self.named(&scratches.name, value));
        }
        if value.hasattr("__fspath__")? {
            let path = value.call_method0("__fspath__")?;
            return self.value(&path, key, depth + 1);
        }
        // Arrays and numbers of numpy.
        let is_numpy = type_of(value).starts_with("numpy.");
        if is_numpy && value.hasattr("tolist")? {
            let list = value.call_method0("tolist")?;
            if !list.is(value) {
                return self.value(&list, key, depth + 1);
            }
        }
        let found = match value.is_none() {
            true => "found None".to_owned(),
            false => format!("found an object of type {}", type_of(value)),
        };
        let right = "must be a number, a text, a path, a list, a dict or an array of numpy";
        Err(errors::of_argument(key, found, right))
    }

    /// The entries of a table that lies at `key`.
    fn entries(
        &mut self,
        table: &Bound<'_, PyDict>,
        key: &str,
        depth: usize,
    ) -> PyResult<toml::Table> {
        let mut read = toml::Table::new();
        for (name, value) in table.iter() {
            let Ok(name) = name.extract::<String>() else {
                let found = format!("found a key of type {}", type_of(&name));
                return Err(errors::of_argument(key, found, "keys must be texts"));
            };
            let key = match key {
                "" => name.clone(),
                key => format!("{key}.{name}"),
            };
            // None counts as missing: TOML has no such value.
            if !value.is_none() {
                read.insert(name, self.value(&value, &key, depth + 1)?);
            }
        }
        Ok(read)
    }

    fn named(&mut self, name: &str, handle: &Bound<'_, PyAny>) -> Value {
        let handle = handle.clone().unbind();
        self.handles.insert(name.to_owned(), handle);
        Value::String(name.to_owned())
    }

    /// A table of TOML's as a dictionary of Python's. Names of what lies in memory become it again.
    pub(crate) fn dict<'py>(
        &self,
        py: Python<'py>,
        table: &toml::Table,
    ) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (key, value) in table {
            dict.set_item(key, self.object(py, value)?)?;
        }
        Ok(dict)
    }

    fn object<'py>(&self, py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
        Ok(match value {
            Value::String(text) => match self.handles.get(text) {
                Some(handle) => handle.bind(py).clone(),
                None => PyString::new(py, text).into_any(),
            },
            Value::Integer(integer) => integer.into_pyobject(py)?.into_any(),
            Value::Float(float) => PyFloat::new(py, *float).into_any(),
            Value::Boolean(boolean) => PyBool::new(py, *boolean).to_owned().into_any(),
            Value::Datetime(date) => PyString::new(py, &date.to_string()).into_any(),
            Value::Array(values) => {
                let elements = values.iter().map(|value| self.object(py, value));
                PyList::new(py, elements.collect::<PyResult<Vec<_>>>()?)?.into_any()
            }
            Value::Table(table) => self.dict(py, table)?.into_any(),
        })
    }
}

fn integer(value: &Bound<'_, PyAny>, key: &str) -> PyResult<i64> {
    value.extract::<i64>().map_err(|error| {
        match error.is_instance_of::<PyOverflowError>(value.py()) {
            true => {
                let found = format!("found the whole number {value}");
                errors::of_argument(key, found, "must be from -2^63 to 2^63 - 1")
            }
            false => error,
        }
    })
}

/// `torch.Tensor`, `numpy.ndarray`, `int`
fn type_of(value: &Bound<'_, PyAny>) -> String {
    value
        .get_type()
        .fully_qualified_name()
        .map_or_else(|_| "unknown".to_owned(), |name| name.to_string())
}
