//! Scenes that are ready to be rendered.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use hairline_cpu::unrounded_light;
use hairline_document::Description;
use hairline_document::estimate::{Estimate, scratches_bytes, textures_bytes};
use hairline_memory::available_bytes;
use hairline_optics::mask::Mask;
use hairline_reference::{Integrator, Model, SceneIndex, Settings};
use hairline_render::failure::Failure;
use hairline_render::reference::{self, Limits, identity};
use hairline_render::{Backend, BouncesWithoutShadows, Listener, Painter, Task};
use hairline_scene::{Scene, ScratchTables};
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

/// A scene that is ready to be rendered.
#[pyclass(frozen, module = "hairline._hairline")]
pub(crate) struct Built {
    pub scene: Scene,
    pub parts: Arc<OnceLock<SceneIndex>>,
    pub smooth: Arc<Mutex<Option<Arc<ScratchTables>>>>,
    pub description: Description,
    pub folder: PathBuf,
    pub stock: Arc<Stock>,
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
            hairline_render::labels::labels(&self.scene, &|| told.is_cancelled())
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
        let transport = hairline_render::transport(shadows, bounces)
            .map_err(|BouncesWithoutShadows| refused(bounces))?;
        let backends = [
            ("auto", Backend::Auto),
            ("gpu", Backend::Gpu),
            ("cpu", Backend::Cpu),
        ];
        let backend = named("backend", backend, &backends)?;
        let task = Task {
            is_transparent: transparent || self.description.cuts_out(),
            ..Task::new(samples, transport)
        };
        let notes = task.notes();
        let ended = watched::run(host, |told| {
            let mut painter = Painter::choose(&self.scene, backend, task, told)?;
            told.begin("rendering");
            painter.render_now(&self.scene, &|share| {
                told.set(share);
                !told.is_cancelled()
            })
        })?;
        let rendered = match (ended.made, &ended.interrupt) {
            (Ok(rendered), _) => rendered,
            (Err(_), Some(interrupt)) => return Err(interrupt.clone_ref(py)),
            (Err(failure), None) => return Err(errors::of_failure(py, &failure)),
        };
        let (is_whole, image) = (rendered.is_whole(), rendered.image);
        let has_some = image.depth_m.iter().any(|depth| *depth > 0.0)
            || image.base.iter().flatten().any(|value| *value > 0.0);
        match ended.interrupt {
            Some(interrupt) if !is_whole && !has_some => Err(interrupt),
            _ => Ok(Image::new(image, self.scene.display(), notes, is_whole)),
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
            _ => Ok(Image::new(image, self.scene.display(), notes, is_whole)),
        }
    }
}

impl Built {
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
