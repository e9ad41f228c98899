//! What renders: a graphics adapter or the CPU renderer.

mod fine;
mod on_gpu;

use std::convert::Infallible;
use std::sync::Arc;

use anyhow::anyhow;
use hairline_cpu::closed_form::{self, Prepared};
use hairline_gpu::{AdapterKind, AdapterRequest, Gpu, headless};
use hairline_image::{Batch, Batches, Image};
use hairline_index::method::{Method, Structure};
use hairline_index::{ScratchIndex, Watch};
use hairline_scene::{Scene, ScratchTables, Transport};

use crate::cli::Backend;
use crate::console::tell;
use crate::failure::Failure;
use crate::progress::Progress;
pub use fine::FINE_SAMPLES;
use on_gpu::OnGpu;

/// What is to be rendered, and how.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    /// By which method.
    pub method: Method,
    /// What the user wants to render.
    pub backend: Backend,
    /// For each pixel on an edge.
    pub samples: u32,
    /// The ways of light.
    pub transport: Transport,
}

/// A picture that was rendered.
pub struct Rendered {
    pub image: Image,
    /// That each pixel has, of shadows, or where it has an edge.
    pub samples: u32,
    /// Fewer of them are there if it was stopped.
    pub wanted: u32,
}

/// A renderer that holds a scene with its trees and tables, for one picture or many.
pub struct Painter<'a> {
    scene: &'a Scene,
    task: Task,
    on: On<'a>,
}

enum On<'a> {
    Cpu(Box<Prepared<'a>>),
    Gpu(Box<OnGpu>),
}

impl<'a> Painter<'a> {
    /// Builds what rendering looks up, chooses what renders, and says on stderr in one line on what and why. `Auto` takes a GPU
    /// if there is one, else the CPU renderer.
    ///
    /// # Errors
    /// [`Failure::Work`] where the GPU that was asked for fails.
    pub fn open(scene: &'a Scene, task: Task) -> Result<Self, Failure> {
        let on = match task.backend {
            Backend::Cpu => On::on_cpu(scene, &task.method, "as asked"),
            Backend::Gpu => {
                let gpu = open().map_err(advise)?;
                announce_gpu(&gpu, "as asked");
                On::on_gpu(&gpu, scene, &task).map_err(advise)?
            }
            Backend::Auto => On::best(scene, &task),
        };
        Ok(Self { scene, task, on })
    }

    /// Renders `scene`, which is the one that this was opened with but for its camera. What fails on a graphics adapter that was
    /// not asked for is done on the CPU, from then on. Shadows add up in batches of samples: once `is_stopped` says so there will be no
    /// further one, and the picture is that of the batches before.
    ///
    /// # Errors
    /// [`Failure::Work`] where the GPU that was asked for fails, and where it is stopped before the first batch is there.
    pub fn render(
        &mut self,
        scene: &Scene,
        is_stopped: &(dyn Fn() -> bool + Sync),
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Rendered, Failure> {
        if !self.task.transport.shadows {
            let samples = self.task.samples;
            let image = self.render_batch(scene, samples, None, &|| false, progress)?;
            let image = image.unwrap_or_else(|| unreachable!("nobody stops it"));
            return Ok(Rendered {
                image,
                samples,
                wanted: samples,
            });
        }
        let mut batches = Batches::new(self.task.samples);
        let wanted = batches.samples();
        batches.fill(progress, |batch, progress| {
            self.render_batch(scene, wanted, Some(batch), is_stopped, progress)
        })?;
        let samples = batches.done();
        let image = batches.into_image().ok_or_else(|| {
            Failure::Work(anyhow!(
                "interrupted before the first samples were done; there is nothing to write"
            ))
        })?;
        Ok(Rendered {
            image,
            samples,
            wanted,
        })
    }

    /// None if it was stopped.
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
        let options = closed_form::RenderOptions {
            samples,
            batch,
            shadows: self.task.transport.shadows,
            bounces: self.task.transport.bounces,
            method: self.task.method,
        };
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

    /// The same with [`FINE_SAMPLES`] in every pixel: what the closed forms' averages over a pixel must come near to.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn render_finely(
        &mut self,
        scene: &Scene,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Image, Failure> {
        let options = closed_form::RenderOptions {
            samples: 1,
            batch: None,
            shadows: self.task.transport.shadows,
            bounces: self.task.transport.bounces,
            method: self.task.method,
        };
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
        if let On::Gpu(ready) = &mut self.on {
            match on_gpu(ready) {
                Ok(done) => return Ok(done),
                Err(error) if self.task.backend == Backend::Gpu => return Err(advise(error)),
                Err(error) => {
                    warn_of(ready.gpu(), &error);
                    self.on = On::Cpu(prepared(self.scene, &self.task.method));
                }
            }
        }
        match &self.on {
            On::Cpu(prepared) => Ok(on_cpu(prepared)),
            On::Gpu(_) => unreachable!("a GPU has returned or was left"),
        }
    }
}

impl<'a> On<'a> {
    fn on_cpu(scene: &'a Scene, method: &Method, why: &str) -> Self {
        announce_cpu(why);
        Self::Cpu(prepared(scene, method))
    }

    fn on_gpu(gpu: &Gpu, scene: &Scene, task: &Task) -> Result<Self, hairline_gpu::Error> {
        let sort = || Arc::new(sorted(|watch| ScratchIndex::rebuild(scene, None, watch)));
        let (scratches, tables) = rayon::join(sort, || ScratchTables::new(scene));
        let Task {
            method, transport, ..
        } = task;
        let on = OnGpu::new(gpu, scene, &scratches, &tables, method, *transport)?;
        Ok(Self::Gpu(Box::new(on)))
    }

    /// A GPU if there is one, else the CPU renderer.
    fn best(scene: &'a Scene, task: &Task) -> Self {
        let method = &task.method;
        match open() {
            Err(error) => Self::on_cpu(scene, method, &error.to_string()),
            Ok(gpu) if gpu.adapter.kind == AdapterKind::Software => {
                let why = format!("no GPU; {} is a software driver", gpu.adapter.name);
                Self::on_cpu(scene, method, &why)
            }
            Ok(gpu) => {
                announce_gpu(&gpu, "a GPU is there");
                Self::on_gpu(&gpu, scene, task).unwrap_or_else(|error| {
                    warn_of(&gpu, &error);
                    Self::Cpu(prepared(scene, method))
                })
            }
        }
    }
}

/// Trees and tables, and what only some methods look up: now, and not again for each picture.
fn prepared<'a>(scene: &'a Scene, method: &Method) -> Box<Prepared<'a>> {
    let prepared = sorted(|watch| Prepared::watched(scene, watch));
    if method
        .published
        .is_some_and(|it| it.structure == Structure::TriangleLists)
    {
        prepared.triangle_lists();
    }
    Box::new(prepared)
}

/// What `sort` builds, shown by a bar. Nobody ends it but by ending the process.
fn sorted<T>(sort: impl FnOnce(&Watch) -> Option<T>) -> T {
    let bar = Progress::start("sorting scratches");
    let watch = Watch {
        progress: &|share| bar.set(share),
        ..Watch::default()
    };
    sort(&watch).unwrap_or_else(|| unreachable!("nobody cancels it"))
}

/// The best adapter: GPUs come before software drivers.
fn open() -> Result<Gpu, hairline_gpu::Error> {
    headless::open(&AdapterRequest::default())
}

fn advise(error: hairline_gpu::Error) -> Failure {
    Failure::Work(anyhow!("{error}; --backend cpu needs no driver"))
}

fn announce_cpu(why: &str) {
    let threads = match rayon::current_num_threads() {
        1 => String::from("1 thread"),
        threads => format!("{threads} threads"),
    };
    tell(format_args!("rendering on the CPU, {threads}: {why}"));
}

fn announce_gpu(gpu: &Gpu, why: &str) {
    tell(format_args!("rendering on {}: {why}", gpu.adapter));
}

fn warn_of(gpu: &Gpu, error: &hairline_gpu::Error) {
    let name = &gpu.adapter.name;
    tell(format_args!(
        "warning: {name} failed ({error}); the CPU renders instead"
    ));
}
