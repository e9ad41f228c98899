//! Scenes: conversion of Python's tables to descriptions, checked as scene files are, and their building.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};

use hairline_document::estimate::Estimate;
use hairline_document::export::{Export, Format};
use hairline_document::inputs::is_same_file;
use hairline_document::{Description, Error, Loader, SceneBuilder, Stage, reading};
use hairline_image::output::write_atomically;
use hairline_memory::budget_bytes;
use hairline_reference::SceneIndex;
use hairline_render::Listener;
use hairline_scene::{Scene, ScratchTables};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::built::Built;
use crate::errors;
use crate::values::Stock;
use crate::watched;

/// File name in errors for text that was made of a table, and nobody has seen.
const NO_FILE: &str = "\u{0}";

/// Reads a scene file or a model: its table, its text and the notes about it.
#[pyfunction]
pub(crate) fn read<'py>(
    py: Python<'py>,
    path: PathBuf,
) -> PyResult<(Bound<'py, PyDict>, String, Vec<String>)> {
    let read = || -> Result<_, Error> {
        if Description::is_model(&path) {
            return Ok((Description::for_model(&path)?, String::new()));
        }
        let text = reading::scene_text(&path)?;
        let description = Description::from_toml(&text, &path)?;
        let checked = description
            .check()
            .and_then(|()| description.check_references());
        checked.map_err(|error| error.in_scene_file(&text, &path))?;
        Ok((description, text))
    };
    let (description, text) = read().map_err(|error| errors::of_scene(py, &error))?;
    let table = table(py, &description)?;
    let dict = Stock::default().dict(py, &table)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let models = description.model_notes(folder);
    Ok((dict, text, [description.notes, models].concat()))
}

/// Returns the table of a whole scene with its defaults filled in, or its error. `alone` where a part of it is asked for, and the things that it
/// names are elsewhere.
#[pyfunction]
#[pyo3(signature = (table, alone=false))]
pub(crate) fn check<'py>(table: &Bound<'py, PyDict>, alone: bool) -> PyResult<Bound<'py, PyDict>> {
    let py = table.py();
    let mut stock = Stock::default();
    let description = described(py, stock.table(table)?)?;
    let references = |()| match alone {
        true => Ok(()),
        false => description.check_references(),
    };
    let checked = description.check().and_then(references);
    checked.map_err(|error| errors::of_scene(py, &error))?;
    stock.dict(py, &self::table(py, &description)?)
}

/// The scene file of a table.
#[pyfunction]
pub(crate) fn to_toml(table: &Bound<'_, PyDict>) -> PyResult<String> {
    let py = table.py();
    let description = described(py, Stock::default().table(table)?)?;
    let text = description.to_toml();
    text.map_err(|error| errors::of_work(py, &error.to_string()))
}

/// Writes a scene as one file for other programs, and returns notes on what other programs do not show.
#[pyfunction]
pub(crate) fn export(
    table: &Bound<'_, PyDict>,
    folder: PathBuf,
    path: PathBuf,
    laid: bool,
    bake_px: Option<u32>,
) -> PyResult<Vec<String>> {
    let py = table.py();
    let mut stock = Stock::default();
    let description = described(py, stock.table(table)?)?;
    let format = Format::from_path(&path).ok_or_else(|| {
        let found = format!("found {:?}", path.display().to_string());
        errors::of_argument("path", found, Format::RIGHT)
    })?;
    let inputs = description.inputs(&folder);
    if let Some(input) = inputs.iter().find(|it| is_same_file(&it.path, &path)) {
        let found = format!("found {}", input.what);
        let right = "must be another file: it would be overwritten";
        return Err(errors::of_argument("path", found, right));
    }
    let arrays = &stock.arrays;
    let exported = py.detach(|| {
        let loader = Loader {
            arrays,
            ..Loader::default()
        };
        let export = Export {
            format,
            laid,
            bake_px,
        };
        loader.export(&description, &folder, export)
    });
    let exported = exported.map_err(|error| errors::of_scene(py, &error))?;
    let written = write_atomically(&path, &exported.bytes);
    written.map_err(|error| errors::of_work(py, &error.to_string()))?;
    Ok(exported.notes)
}

/// The files that a scene is made from, in `folder`.
#[pyfunction]
pub(crate) fn inputs(table: &Bound<'_, PyDict>, folder: PathBuf) -> PyResult<Vec<PathBuf>> {
    let mut stock = Stock::default();
    let description = described(table.py(), stock.table(table)?)?;
    let inputs = description
        .inputs(&folder)
        .into_iter()
        .map(|input| input.path);
    let is_file = |path: &PathBuf| !stock.has(path, &folder);
    Ok(inputs.filter(is_file).collect())
}

/// A name for all that a scene says, in whatever types and order: arrays by their numbers, arrays in memory by their contents, and files by their
/// names.
#[pyfunction]
pub(crate) fn digest(table: &Bound<'_, PyDict>) -> PyResult<String> {
    let py = table.py();
    let description = described(py, Stock::default().table(table)?)?;
    let text = self::table(py, &description)?.to_string();
    Ok(blake3::hash(text.as_bytes()).to_hex().to_string())
}

fn described(py: Python<'_>, table: toml::Table) -> PyResult<Description> {
    let text = table.to_string();
    let read = Description::from_toml(&text, Path::new(NO_FILE));
    read.map_err(|error| errors::of_scene(py, &error.nowhere_in(Path::new(NO_FILE))))
}

pub(crate) fn table(py: Python<'_>, part: &impl serde::Serialize) -> PyResult<toml::Table> {
    let table = toml::Table::try_from(part);
    table.map_err(|error| errors::of_work(py, &error.to_string()))
}

/// Builds scenes one after the other, and keeps unchanged parts.
#[pyclass(frozen, module = "hairline._hairline")]
#[derive(Default)]
pub(crate) struct Builder {
    builder: Mutex<SceneBuilder>,
    /// Look-up structures of the last scene's references.
    last: Mutex<Option<(Scene, Arc<OnceLock<SceneIndex>>)>>,
    /// Tables of the last scene whose light was asked for with all digits.
    smooth: Arc<Mutex<Option<Arc<ScratchTables>>>>,
}

#[pymethods]
impl Builder {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Builds the scene of a table. `text` is the file that it was read from and still equals, for the lines of errors.
    fn build(
        &self,
        table: &Bound<'_, PyDict>,
        folder: PathBuf,
        text: Option<String>,
        file: PathBuf,
        host: &Bound<'_, PyAny>,
    ) -> PyResult<Built> {
        let py = table.py();
        let mut stock = Stock::default();
        let description = described(py, stock.table(table)?)?;
        let ended = watched::run(host, |told| {
            let mut picture = Estimate::default();
            picture.add_picture(description.render.size_px);
            picture.check(budget_bytes() as f64)?;
            let loader = Loader {
                arrays: &stock.arrays,
                progress: &|at| {
                    if at.done == 0 {
                        told.begin(match at.stage {
                            Stage::Meshes => "reading meshes",
                            Stage::Environment => "reading the map",
                            Stage::Scratches => "laying scratches",
                        });
                    }
                    told.set(at.done as f64 / at.total.max(1) as f64);
                },
                cancelled: &|| told.is_cancelled(),
                ..Loader::default()
            };
            // A builder that panicked may be broken.
            let mut builder = self.builder.lock().unwrap_or_else(|left| {
                let mut builder = left.into_inner();
                *builder = SceneBuilder::new();
                builder
            });
            builder.build(&loader, &description, &folder)
        })?;
        match (ended.made, ended.interrupt) {
            (Err(error), Some(interrupt)) if error.is_cancelled() => Err(interrupt),
            (Err(error), _) => {
                let placed = match &text {
                    Some(text) => error.in_scene_file(text, &file),
                    None => error,
                };
                Err(errors::of_scene(py, &placed))
            }
            (Ok(_), Some(interrupt)) => Err(interrupt),
            (Ok(scene), None) => Ok(Built {
                parts: self.parts(&scene),
                smooth: self.smooth.clone(),
                scene,
                description,
                folder,
                stock: stock.into(),
            }),
        }
    }
}

impl Builder {
    /// Those of the last scene, if this one has its surfaces, scratches and materials.
    fn parts(&self, scene: &Scene) -> Arc<OnceLock<SceneIndex>> {
        let mut last = self.last.lock().unwrap_or_else(|left| left.into_inner());
        let kept = last
            .as_ref()
            .filter(|(old, _)| SceneIndex::are_alike(old, scene));
        let parts = kept.map(|(_, parts)| parts.clone()).unwrap_or_default();
        *last = Some((scene.clone(), parts.clone()));
        parts
    }
}
