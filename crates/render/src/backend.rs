//! The renderer of a task: a graphics adapter or the CPU renderer.

mod fine;
mod on_gpu;

use std::cell::OnceCell;
use std::convert::Infallible;
use std::sync::Arc;

use anyhow::anyhow;
use hairline_cpu::closed_form::{self, Prepared};
use hairline_document::DEFAULT_TRANSPORT;
use hairline_gpu::{AdapterKind, AdapterRequest, Gpu, headless};
use hairline_image::{Batch, Image, Notes, filter_traced};
use hairline_index::{ScratchIndex, TriangleIndex, Watch};
use hairline_optics::mask::Mask;
use hairline_scene::{Scene, ScratchTables, Transport};

use crate::failure::Failure;
use crate::listener::Listener;
pub use fine::FINE_SAMPLES;
use on_gpu::OnGpu;

/// Choice of the renderer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// A GPU if there is one, else the CPU renderer.
    #[default]
    Auto,
    /// A graphics adapter, be it a GPU or a software driver.
    Gpu,
    /// The CPU renderer: needs no driver.
    Cpu,
}

/// A method in the place of Hairline's own, on both renderers.
#[derive(Clone)]
pub struct Method {
    /// The method on the CPU.
    pub on_cpu: Arc<dyn hairline_cpu::method::ShadingMethod>,
    /// The method on the GPU.
    pub on_gpu: Arc<dyn hairline_gpu::method::ShadingMethod>,
}

/// Settings of a rendering.
#[derive(Clone)]
pub struct Task {
    /// Energy that the base loses to the scratches.
    pub mask: Mask,
    /// A method in the place of Hairline's own.
    pub method: Option<Method>,
    /// Choice of the renderer.
    pub backend: Backend,
    /// Samples of each pixel on an edge.
    pub samples: u32,
    /// The ways of light.
    pub transport: Transport,
    /// Whether the light that rays found is filtered ([`filter_traced`]).
    pub is_filtered: bool,
    /// Whether the picture has [`Image::alpha`]: nothing is seen behind surfaces then, the environment neither.
    pub is_transparent: bool,
}

/// A picture that was rendered.
pub struct Rendered {
    /// The picture.
    pub image: Image,
    /// Samples of each pixel with shadows, or of each pixel on an edge.
    pub samples: u32,
    /// Number of samples in the task; the picture has fewer if the work was stopped.
    pub wanted: u32,
}

/// Bounces are asked for without shadows: the light that an object hides would be counted beside its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BouncesWithoutShadows;

/// Transport of light from the user's choices, with defaults for those that are left open.
///
/// # Errors
/// [`BouncesWithoutShadows`].
pub fn transport(
    shadows: Option<bool>,
    bounces: Option<u32>,
) -> Result<Transport, BouncesWithoutShadows> {
    if !shadows.unwrap_or(DEFAULT_TRANSPORT.shadows) {
        return match bounces {
            None | Some(0) => Ok(Transport::DIRECT),
            Some(_) => Err(BouncesWithoutShadows),
        };
    }
    Ok(Transport {
        shadows: true,
        bounces: bounces.unwrap_or(DEFAULT_TRANSPORT.bounces),
    })
}

impl Task {
    fn options(&self, samples: u32, batch: Option<Batch>) -> closed_form::RenderOptions {
        let Transport { shadows, bounces } = self.transport;
        closed_form::RenderOptions {
            samples,
            batch,
            shadows,
            bounces,
            mask: self.mask,
            method: self.method.as_ref().map(|it| it.on_cpu.clone()),
        }
    }

    fn method_on_gpu(&self) -> hairline_gpu::Method {
        hairline_gpu::Method {
            mask: self.mask,
            other: self.method.as_ref().map(|it| it.on_gpu.clone()),
        }
    }

    /// Notes on the settings in which the picture differs from the pure closed form. The method is left to the caller, who can name it.
    pub fn notes(&self) -> Notes {
        let Transport { shadows, bounces } = self.transport;
        let mut notes = Notes::new();
        if shadows {
            notes.insert("shadows".to_owned(), "on".to_owned());
        }
        if bounces > 0 {
            notes.insert("bounces".to_owned(), bounces.to_string());
        }
        notes
    }
}

/// A renderer that holds a scene with its trees and tables, for one picture or many.
pub struct Painter<'a> {
    scene: &'a Scene,
    task: Task,
    listener: &'a dyn Listener,
    on: OpenRenderer<'a>,
    /// Triangles for the alpha channel where a GPU renders; built when first needed.
    triangles: OnceCell<TriangleIndex>,
}

enum OpenRenderer<'a> {
    Cpu(Box<Prepared<'a>>),
    Gpu(Box<OnGpu>),
}

impl<'a> Painter<'a> {
    /// Builds the structures for rendering, chooses the renderer, and reports in one line which and why. `Auto` takes a GPU if there is one, else the CPU
    /// renderer.
    ///
    /// # Errors
    /// [`Failure::Work`] where the GPU that was asked for fails.
    pub fn open(scene: &'a Scene, task: Task, listener: &'a dyn Listener) -> Result<Self, Failure> {
        let on = match task.backend {
            Backend::Cpu => OpenRenderer::on_cpu(scene, "as asked", &task, listener),
            Backend::Gpu => {
                let gpu = open().map_err(advise)?;
                announce_gpu(&gpu, "as asked", listener);
                OpenRenderer::on_gpu(&gpu, scene, &task, listener).map_err(advise)?
            }
            Backend::Auto => OpenRenderer::best(scene, &task, listener),
        };
        Ok(Self {
            scene,
            task,
            listener,
            on,
            triangles: OnceCell::new(),
        })
    }

    /// A painter of a scene that differs in its observer alone: it shares the trees. None on a graphics adapter.
    pub fn seen_by<'b>(&self, scene: &'b Scene) -> Option<Painter<'b>>
    where
        'a: 'b,
    {
        let OpenRenderer::Cpu(first) = &self.on else {
            return None;
        };
        let (triangles, scratches) = (first.triangles().clone(), first.scratches().clone());
        let tables = ScratchTables::new(scene).into();
        let prepared = Prepared::from_parts(scene, triangles, scratches, tables);
        Some(Painter {
            scene,
            task: self.task.clone(),
            listener: self.listener,
            on: OpenRenderer::Cpu(Box::new(prepared)),
            triangles: OnceCell::new(),
        })
    }

    /// Renders `scene`, which is the one that this was opened with but for its camera. What fails on a graphics adapter that was
    /// not asked for is done on the CPU, from then on. Shadows and what is out of focus add up in batches of samples: once `is_stopped` says so there will be no
    /// further one, and the picture is that of the batches before. Without them a picture that was stopped on the CPU is black where
    /// it was not begun, and has no sample.
    ///
    /// # Errors
    /// [`Failure::Work`] where the GPU that was asked for fails, and where it is stopped before the first batch is there.
    pub fn render(
        &mut self,
        scene: &Scene,
        is_stopped: &(dyn Fn() -> bool + Sync),
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Rendered, Failure> {
        self.look_from(scene)?;
        if !self.task.is_transparent {
            return self.render_visible(scene, is_stopped, progress);
        }
        let alone = scene.before_nothing();
        let mut rendered = self.render_visible(&alone, is_stopped, progress)?;
        let Rendered {
            samples, wanted, ..
        } = rendered;
        let (counts, shadows) = ([samples, wanted], self.task.transport.shadows);
        let alpha =
            hairline_cpu::picture_alpha(scene, self.triangles(), counts, shadows, is_stopped);
        rendered.image.alpha = Some(alpha);
        Ok(rendered)
    }

    /// Makes the pieces of scratches ready for a camera that comes much nearer, or goes far away.
    fn look_from(&mut self, scene: &Scene) -> Result<(), Failure> {
        match &mut self.on {
            OpenRenderer::Cpu(prepared) => prepared.look_from(scene),
            OpenRenderer::Gpu(on) if !on.serves(scene) => {
                let gpu = on.gpu().clone();
                self.on =
                    OpenRenderer::on_gpu(&gpu, scene, &self.task, self.listener).map_err(advise)?;
            }
            OpenRenderer::Gpu(_) => {}
        }
        Ok(())
    }

    fn triangles(&self) -> &TriangleIndex {
        match &self.on {
            OpenRenderer::Cpu(prepared) => prepared.triangles(),
            OpenRenderer::Gpu(_) => {
                (self.triangles).get_or_init(|| TriangleIndex::build(self.scene))
            }
        }
    }

    /// Renders the scene with its background.
    fn render_visible(
        &mut self,
        scene: &Scene,
        is_stopped: &(dyn Fn() -> bool + Sync),
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Rendered, Failure> {
        let Task {
            transport, samples, ..
        } = self.task;
        let Some(mut batches) = transport.batches(&scene.camera, samples) else {
            return self.render_direct(scene, is_stopped, progress);
        };
        let wanted = batches.samples();
        let is_filtered = self.task.is_filtered;
        if !is_filtered {
            batches = batches.unfiltered();
        }
        batches.fill(progress, |batch, progress| {
            self.render_batch(scene, wanted, Some(batch), is_stopped, progress)
        })?;
        let samples = batches.done();
        let mut image = batches.into_image().ok_or_else(|| {
            Failure::Work(anyhow!(
                "interrupted before the first samples were done; there is nothing to write"
            ))
        })?;
        if is_filtered {
            filter_traced(&mut image);
        }
        image.traced = None;
        Ok(Rendered {
            image,
            samples,
            wanted,
        })
    }

    /// The closed forms alone. A graphics adapter finishes its picture.
    fn render_direct(
        &mut self,
        scene: &Scene,
        is_stopped: &(dyn Fn() -> bool + Sync),
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Rendered, Failure> {
        let samples = self.task.samples;
        let rows = 0..scene.render.size_px[1];
        let options = self.task.options(samples, None);
        let on_gpu = |on: &mut OnGpu| {
            let image = on.render_rows(scene, samples, None, rows, &|at| progress(at))?;
            Ok((image, true))
        };
        let (image, is_whole) = self.paint(on_gpu, |prepared| {
            let prepared = prepared.with_scene(scene);
            prepared.render_until(is_stopped, &options, progress)
        })?;
        Ok(Rendered {
            image,
            samples: if is_whole { samples } else { 0 },
            wanted: samples,
        })
    }

    /// Renders a batch of samples; none if it was stopped.
    fn render_batch(
        &mut self,
        scene: &Scene,
        samples: u32,
        batch: Option<Batch>,
        is_stopped: &(dyn Fn() -> bool + Sync),
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Option<Image>, Failure> {
        if is_stopped() {
            return Ok(None);
        }
        let rows = 0..scene.render.size_px[1];
        let options = self.task.options(samples, batch);
        let on_gpu = |on: &mut OnGpu| {
            let image = on.render_rows(scene, samples, batch, rows.clone(), &|at| progress(at))?;
            Ok(Some(image))
        };
        self.paint(on_gpu, |prepared| {
            let prepared = prepared.with_scene(scene);
            let rendered = prepared.render_unless(is_stopped, &options, rows.clone(), progress)?;
            Some(rendered.0)
        })
    }

    /// Renders with [`FINE_SAMPLES`] in every pixel: the closed forms' averages over a pixel must come near to this picture.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn render_finely(
        &mut self,
        scene: &Scene,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Image, Failure> {
        let options = self.task.options(1, None);
        let on_gpu = |on: &mut OnGpu| {
            let mut rows = |large: &Scene, rows, told: &(dyn Fn(f64) + Sync)| {
                on.render_rows(large, 1, None, rows, &|at| told(at))
            };
            fine::render(scene, &mut rows, progress)
        };
        self.paint(on_gpu, |prepared| {
            let mut rows = |large: &Scene, rows, told: &(dyn Fn(f64) + Sync)| {
                Ok::<_, Infallible>(prepared.with_scene(large).render_rows(&options, rows, told))
            };
            let Ok(image) = fine::render(scene, &mut rows, progress);
            image
        })
    }

    fn paint<T>(
        &mut self,
        on_gpu: impl FnOnce(&mut OnGpu) -> Result<T, hairline_gpu::Error>,
        on_cpu: impl FnOnce(&Prepared) -> T,
    ) -> Result<T, Failure> {
        if let OpenRenderer::Gpu(ready) = &mut self.on {
            match on_gpu(ready) {
                Ok(done) => return Ok(done),
                Err(error) if self.task.backend == Backend::Gpu => return Err(advise(error)),
                Err(error) => {
                    warn_of(ready.gpu(), &error, self.listener);
                    let on_cpu = prepared(self.scene, &self.task, self.listener);
                    self.on = OpenRenderer::Cpu(on_cpu);
                }
            }
        }
        match &self.on {
            OpenRenderer::Cpu(prepared) => Ok(on_cpu(prepared)),
            OpenRenderer::Gpu(_) => unreachable!("a GPU has returned or was left"),
        }
    }
}

impl<'a> OpenRenderer<'a> {
    fn on_cpu(scene: &'a Scene, why: &str, task: &Task, listener: &dyn Listener) -> Self {
        announce_cpu(why, listener);
        Self::Cpu(prepared(scene, task, listener))
    }

    fn on_gpu(
        gpu: &Gpu,
        scene: &Scene,
        task: &Task,
        listener: &dyn Listener,
    ) -> Result<Self, hairline_gpu::Error> {
        let method = task.method_on_gpu();
        let rebuild = |watch: &Watch| ScratchIndex::rebuild(scene, method.pieces(), None, watch);
        let sort = || Arc::new(sorted(listener, rebuild));
        let (scratches, tables) = rayon::join(sort, || ScratchTables::new(scene));
        let on = OnGpu::new(gpu, scene, &scratches, &tables, &method, task.transport)?;
        Ok(Self::Gpu(Box::new(on)))
    }

    /// A GPU if there is one, else the CPU renderer.
    fn best(scene: &'a Scene, task: &Task, listener: &dyn Listener) -> Self {
        match open() {
            Err(error) => Self::on_cpu(scene, &error.to_string(), task, listener),
            Ok(gpu) if gpu.adapter.kind == AdapterKind::Software => {
                let why = format!("no GPU; {} is a software driver", gpu.adapter.name);
                Self::on_cpu(scene, &why, task, listener)
            }
            Ok(gpu) => {
                announce_gpu(&gpu, "a GPU is there", listener);
                Self::on_gpu(&gpu, scene, task, listener).unwrap_or_else(|error| {
                    warn_of(&gpu, &error, listener);
                    Self::Cpu(prepared(scene, task, listener))
                })
            }
        }
    }
}

/// Builds trees and tables.
fn prepared<'a>(scene: &'a Scene, task: &Task, listener: &dyn Listener) -> Box<Prepared<'a>> {
    let pieces = task.method_on_gpu().pieces();
    Box::new(sorted(listener, |watch| {
        Prepared::watched(scene, pieces, watch)
    }))
}

/// Runs `sort` and returns its result. Nobody cancels it except by ending the process.
fn sorted<T>(listener: &dyn Listener, sort: impl FnOnce(&Watch) -> Option<T>) -> T {
    listener.begin("sorting scratches");
    let watch = Watch {
        progress: &|share| listener.set(share),
        ..Watch::default()
    };
    let built = sort(&watch).unwrap_or_else(|| unreachable!("nobody cancels it"));
    listener.end();
    built
}

/// The best adapter: GPUs come before software drivers.
fn open() -> Result<Gpu, hairline_gpu::Error> {
    headless::open(&AdapterRequest::default())
}

fn advise(error: hairline_gpu::Error) -> Failure {
    Failure::Work(anyhow!("{error}; --backend cpu needs no driver"))
}

fn announce_cpu(why: &str, listener: &dyn Listener) {
    let threads = match rayon::current_num_threads() {
        1 => String::from("1 thread"),
        threads => format!("{threads} threads"),
    };
    listener.tell(&format!("rendering on the CPU, {threads}: {why}"));
}

fn announce_gpu(gpu: &Gpu, why: &str, listener: &dyn Listener) {
    listener.tell(&format!("rendering on {}: {why}", gpu.adapter));
}

fn warn_of(gpu: &Gpu, error: &hairline_gpu::Error, listener: &dyn Listener) {
    let name = &gpu.adapter.name;
    listener.warn(&format!("{name} failed ({error}); the CPU renders instead"));
}
