//! Scenes: conversion of Python's tables to descriptions, checked as scene files are, and their building.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use hairline_cpu::unrounded_light;
use hairline_document::estimate::{Estimate, scratches_bytes, textures_bytes};
use hairline_document::export::{Export, Format};
use hairline_document::inputs::is_same_file;
use hairline_document::{Description, Error, Loader, SceneBuilder, Stage, reading};
use hairline_image::Display;
use hairline_image::output::write_atomically;
use hairline_memory::{available_bytes, budget_bytes};
use hairline_optics::mask::Mask;
use hairline_reference::{Integrator, Model, SceneIndex, Settings};
use hairline_scene::{Scene, ScratchTables};
use hairline_work::Listener;
use hairline_work::backend::{self, Backend, BouncesWithoutShadows, Painter, Rendered, Task};
use hairline_work::failure::Failure;
use hairline_work::reference::{self, Limits, identity};
use numpy::{IntoPyArray, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors;
use crate::image::Image;
use crate::labels::Labels;
use crate::laid;
use crate::names::named;
use crate::scene_bsdf::SceneBsdf;
use crate::values::Stock;
use crate::watched::{self, WorkProgress};

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

/// A scene that is ready to be rendered.
#[pyclass(frozen, module = "hairline._hairline")]
pub(crate) struct Built {
    scene: Scene,
    parts: Arc<OnceLock<SceneIndex>>,
    smooth: Arc<Mutex<Option<Arc<ScratchTables>>>>,
    description: Description,
    folder: PathBuf,
    stock: Arc<Stock>,
}

#[pymethods]
impl Built {
    /// Number of scratches of each object.
    fn scratch_counts(&self) -> Vec<usize> {
        let objects = self.scene.objects.iter();
        objects.map(|object| object.scratches.len()).collect()
    }

    /// The straight pieces of an object's scratches, by name.
    fn laid<'py>(&self, py: Python<'py>, object: &str) -> PyResult<Bound<'py, PyDict>> {
        laid::laid(py, &self.scene, object)
    }

    /// The reflection of an object at any of its points.
    fn bsdf(&self, py: Python<'_>, object: &str) -> PyResult<SceneBsdf> {
        py.detach(|| SceneBsdf::new(&self.scene, object))
    }

    /// Labels of the picture; see `Scene.labels`.
    fn labels(&self, host: &Bound<'_, PyAny>) -> PyResult<Labels> {
        let ended = watched::run(host, |told| {
            told.begin("labelling");
            hairline_work::labels::labels(&self.scene, &|| told.is_cancelled())
        })?;
        match (ended.made, ended.interrupt) {
            (_, Some(interrupt)) => Err(interrupt),
            (Some(labels), None) => Ok(Labels::new(labels, self.scene.clone())),
            (None, None) => Err(errors::internal()),
        }
    }

    /// The corners of the box around all objects, metres.
    fn bounds_m(&self) -> ([f32; 3], [f32; 3]) {
        laid::bounds_m(&self.scene)
    }

    /// About how much memory its pictures take, and how much there is, bytes.
    fn memory_bytes(&self) -> (f64, Option<f64>) {
        let objects = self.scene.objects.iter();
        let [scratches, segments] = objects.fold([0, 0], |[scratches, segments], object| {
            [
                scratches + object.scratches.len(),
                segments + object.segments.len(),
            ]
        });
        let surfaces = Estimate::from_description(&self.description, &self.folder).bytes();
        let all = surfaces + scratches_bytes(scratches, segments) + textures_bytes(&self.scene);
        (all, available_bytes().map(|bytes| bytes as f64))
    }

    /// Renders the picture; see `Scene.render`.
    fn render(
        &self,
        backend: &str,
        samples: u32,
        shadows: Option<bool>,
        bounces: Option<u32>,
        transparent: bool,
        host: &Bound<'_, PyAny>,
    ) -> PyResult<Image> {
        let py = host.py();
        let transport = backend::transport(shadows, bounces)
            .map_err(|BouncesWithoutShadows| refused(bounces))?;
        let task = Task {
            mask: Mask::default(),
            method: None,
            backend: named(
                "backend",
                backend,
                &[
                    ("auto", Backend::Auto),
                    ("gpu", Backend::Gpu),
                    ("cpu", Backend::Cpu),
                ],
            )?,
            samples,
            transport,
            is_filtered: true,
            is_transparent: transparent || self.description.cuts_out(),
        };
        let notes = task.notes();
        let ended = watched::run(host, |told| {
            let mut painter = Painter::open(&self.scene, task, told)?;
            told.begin("rendering");
            let cancelled = || told.is_cancelled();
            painter.render(&self.scene, &cancelled, &|share| told.set(share))
        })?;
        let Rendered {
            image,
            samples,
            wanted,
        } = match (ended.made, &ended.interrupt) {
            (Ok(rendered), _) => rendered,
            (Err(_), Some(interrupt)) => return Err(interrupt.clone_ref(py)),
            (Err(failure), None) => return Err(errors::of_failure(py, &failure)),
        };
        let is_whole = samples == wanted;
        let has_some = image.depth_m.iter().any(|depth| *depth > 0.0)
            || image.base.iter().flatten().any(|value| *value > 0.0);
        match ended.interrupt {
            Some(interrupt) if !is_whole && !has_some => Err(interrupt),
            _ => Ok(Image::new(image, self.display(), notes, is_whole)),
        }
    }

    /// The scene in bands of the spectrum, three at a time.
    fn in_bands(&self, py: Python<'_>, bands_nm: Vec<[f64; 2]>) -> PyResult<Vec<Self>> {
        let scenes = hairline_document::in_bands(&self.scene, &bands_nm);
        let scenes = scenes.map_err(|error| errors::of_scene(py, &error))?;
        let built = |scene| Self {
            scene,
            parts: Arc::default(),
            smooth: Arc::default(),
            description: self.description.clone(),
            folder: self.folder.clone(),
            stock: self.stock.clone(),
        };
        Ok(scenes.into_iter().map(built).collect())
    }

    /// Light of the base and of the scratches with all digits: height x width x 3 each, by the closed forms without shadows. The scratches of a layer
    /// count `weight` times.
    fn light<'py>(
        &self,
        layer: Option<u32>,
        weight: f64,
        host: &Bound<'py, PyAny>,
    ) -> PyResult<[Bound<'py, PyArray3<f64>>; 2]> {
        let ended = watched::run(host, |told| {
            let weight = |of| if layer == Some(of) { weight } else { 1.0 };
            let tables = self.smooth_tables();
            unrounded_light(&self.scene, tables, &weight, &|| told.is_cancelled())
        })?;
        if let Some(interrupt) = ended.interrupt {
            return Err(interrupt);
        }
        let light = ended.made.ok_or_else(errors::internal)?;
        let [width, height] = self.scene.render.size_px.map(|px| px as usize);
        let of = |part: usize| {
            let values = light.iter().flat_map(|parts| parts[part].to_array());
            let values: Vec<f64> = values.collect();
            values.into_pyarray(host.py()).reshape([height, width, 3])
        };
        Ok([of(0)?, of(1)?])
    }

    /// Samples by Monte Carlo; see `Scene.reference`.
    #[expect(
        clippy::too_many_arguments,
        reason = "the wrapper in Python names them"
    )]
    fn reference(
        &self,
        model: &str,
        samples: Option<u32>,
        time_s: Option<f64>,
        shadows: bool,
        bounces: u32,
        mask: &str,
        sample_seed: u64,
        resume: Option<&Bound<'_, Image>>,
        rows: Option<(u32, u32)>,
        host: &Bound<'_, PyAny>,
    ) -> PyResult<Image> {
        let py = host.py();
        let models = [("separable", Model::Separable), ("full", Model::Full)];
        let masks = [
            ("energy", Mask::Energy),
            ("linear", Mask::Linear),
            ("density", Mask::Density),
        ];
        let settings = Settings {
            model: named("model", model, &models)?,
            mask: named("mask", mask, &masks)?,
            bounces,
            shadows,
            seed: sample_seed,
        };
        let fingerprint =
            reference::fingerprint(&self.description, &self.folder, &self.stock.arrays);
        let fingerprint =
            fingerprint.map_err(|error| errors::of_failure(py, &Failure::Work(error)))?;
        let notes = identity::notes(&settings, &fingerprint);
        let [width, height] = self.scene.render.size_px;
        let rows = rows.map(|(first, end)| first.min(height)..end.min(height));
        let size_px = [
            width,
            rows.as_ref().map_or(height, |rows| rows.len() as u32),
        ];
        let earlier = resume
            .map(|image| image.get().to_resume(size_px, &notes))
            .transpose()?;
        // Longer than a duration can be is for ever.
        let time = time_s.map(|s| Duration::try_from_secs_f64(s).unwrap_or(Duration::MAX));
        let limits = Limits::new(samples, time, Duration::MAX);
        let ended = watched::run(host, |told| {
            self.sample(settings, earlier, rows, &limits, told)
        })?;
        let (image, is_whole) = ended
            .made
            .map_err(|failure| errors::of_failure(py, &failure))?;
        let noise = image.noise.as_ref();
        let is_empty = noise.is_none_or(|noise| noise.samples.iter().all(|n| *n == 0));
        match ended.interrupt {
            Some(interrupt) if is_empty => Err(interrupt),
            _ => Ok(Image::new(image, self.display(), notes, is_whole)),
        }
    }
}

impl Built {
    fn display(&self) -> Display {
        Display {
            exposure_ev: self.scene.camera.exposure_ev,
            tone_map: self.scene.render.tone_map,
        }
    }

    /// Tables of the scene with all digits.
    fn smooth_tables(&self) -> Arc<ScratchTables> {
        let mut kept = self.smooth.lock().unwrap_or_else(|left| left.into_inner());
        match kept.as_ref().filter(|tables| tables.are_of(&self.scene)) {
            Some(tables) => tables.clone(),
            None => (kept.insert(Arc::new(ScratchTables::new(&self.scene).smooth()))).clone(),
        }
    }

    /// Returns the picture, and whether each pixel has its samples. Samples `rows` alone, where they are given.
    fn sample(
        &self,
        settings: Settings,
        earlier: Option<hairline_image::Image>,
        rows: Option<Range<u32>>,
        limits: &Limits,
        told: &WorkProgress,
    ) -> Result<(hairline_image::Image, bool), Failure> {
        told.begin("sorting scratches");
        let parts = self
            .parts
            .get_or_init(|| SceneIndex::new(&self.scene))
            .clone();
        let mut integrator = Integrator::from_parts(&self.scene, settings, parts);
        if let Some(rows) = rows {
            integrator = integrator.of_rows(rows);
        }
        let mut image = earlier.unwrap_or_else(|| integrator.start());
        told.begin("sampling");
        let cancelled = || told.is_cancelled();
        let end = reference::sample(&integrator, &mut image, limits, &cancelled, told, &|_| {
            Ok(())
        })?;
        Ok((image, end == reference::End::Complete))
    }
}

fn refused(bounces: Option<u32>) -> PyErr {
    errors::of_argument(
        "bounces",
        format!("found {}", bounces.unwrap_or(0)),
        "add shadows=True: without them the light that an object hides would be counted beside its own",
    )
}
