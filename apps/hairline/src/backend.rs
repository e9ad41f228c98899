//! What renders: a GPU, the CPU renderer, or a graphics driver that computes on the CPU.

mod fine;

use std::sync::Arc;

use anyhow::anyhow;
use hairline_gpu::{AdapterKind, AdapterRequest, Gpu, headless};
use hairline_image::Image;
use hairline_index::{ScratchIndex, Watch};
use hairline_optics::method::{Gather, Lookup, Method};
use hairline_reference::closed_form::{self, Prepared};
use hairline_scene::{Scene, ScratchTables};

use crate::cli::Backend;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::trial::{self, ReadyDriver, Winner};
pub use fine::FINE_SAMPLES;

/// What is to be rendered, and how.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    /// By which method.
    pub method: Method,
    /// What the user wants to render.
    pub backend: Backend,
    /// For each pixel.
    pub samples: u32,
    /// How many pictures, each of the same size from another camera.
    pub pictures: u32,
}

/// A renderer that holds a scene with its trees and tables, for one picture or many.
pub struct Painter<'a> {
    scene: &'a Scene,
    task: Task,
    on: On<'a>,
}

enum On<'a> {
    Cpu(Box<Prepared<'a>>),
    Gpu(Box<ReadyDriver>),
}

impl<'a> Painter<'a> {
    /// Builds what rendering looks up, chooses what renders, and says on stderr in one line on what and why. `Auto` takes a GPU
    /// if there is one, else the CPU renderer or a software driver, by trial.
    ///
    /// # Errors
    /// [`Failure::Work`] where the GPU that was asked for fails.
    pub fn open(scene: &'a Scene, task: Task) -> Result<Self, Failure> {
        let on = match task.backend {
            Backend::Cpu => On::on_cpu(scene, &task.method, "as asked"),
            Backend::Gpu => {
                let gpu = open().map_err(advise)?;
                announce_gpu(&gpu, "as asked");
                On::on_gpu(&gpu, scene, &task.method).map_err(advise)?
            }
            Backend::Auto => On::the_faster(scene, &task),
        };
        Ok(Self { scene, task, on })
    }

    /// Renders `scene`, which is the one that this was opened with but for its camera. What fails on a graphics adapter that was
    /// not asked for is done on the CPU, from then on.
    ///
    /// # Errors
    /// [`Failure::Work`] where the GPU that was asked for fails.
    pub fn render(
        &mut self,
        scene: &Scene,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Image, Failure> {
        let Task {
            method, samples, ..
        } = self.task;
        let on_gpu = |ready: &mut ReadyDriver| ready.render(scene, samples, &|at| progress(at));
        self.paint(on_gpu, |prepared| {
            let options = closed_form::RenderOptions { samples, method };
            prepared.with_scene(scene).render(&options, progress)
        })
    }

    /// The same with [`FINE_SAMPLES`] in every pixel and each scratch for itself: what the closed forms' averages over a pixel must
    /// come near to.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn render_finely(
        &mut self,
        scene: &Scene,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Image, Failure> {
        let method = Method {
            gather: Gather::Exact,
            ..self.task.method
        };
        let on_gpu = |ready: &mut ReadyDriver| {
            ready.render_one_by_one(scene, FINE_SAMPLES, &|at| progress(at))
        };
        self.paint(on_gpu, |prepared| {
            fine::render(prepared, scene, &method, progress)
        })
    }

    fn paint(
        &mut self,
        on_gpu: impl FnOnce(&mut ReadyDriver) -> Result<Image, hairline_gpu::Error>,
        on_cpu: impl FnOnce(&Prepared) -> Image,
    ) -> Result<Image, Failure> {
        if let On::Gpu(ready) = &mut self.on {
            match on_gpu(ready) {
                Ok(image) => return Ok(image),
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

    fn on_gpu(gpu: &Gpu, scene: &Scene, method: &Method) -> Result<Self, hairline_gpu::Error> {
        let (scratches, tables) = rayon::join(
            || Arc::new(sorted(scene, method.lookup)),
            || ScratchTables::new(scene),
        );
        add_up(scene, &scratches, method);
        let ready = gpu.block_on(ReadyDriver::new(gpu, scene, &scratches, &tables, method))?;
        Ok(Self::Gpu(Box::new(ready)))
    }

    /// A GPU if there is one; else the CPU renderer or a software driver, by trial.
    fn the_faster(scene: &'a Scene, task: &Task) -> Self {
        let method = &task.method;
        match open() {
            Err(error) => Self::on_cpu(scene, method, &error.to_string()),
            Ok(gpu) if gpu.adapter.kind == AdapterKind::Software => {
                let prepared = prepared(scene, method);
                let trial = trial::run(&gpu, scene, task, &prepared);
                match trial.winner {
                    Winner::Cpu => {
                        announce_cpu(&trial.why);
                        Self::Cpu(prepared)
                    }
                    Winner::Driver(ready) => {
                        announce_gpu(&gpu, &trial.why);
                        Self::Gpu(ready)
                    }
                }
            }
            Ok(gpu) => {
                announce_gpu(&gpu, "a GPU is there");
                Self::on_gpu(&gpu, scene, method).unwrap_or_else(|error| {
                    warn_of(&gpu, &error);
                    Self::Cpu(prepared(scene, method))
                })
            }
        }
    }
}

/// Trees and tables, and what only some methods look up: now, and not again for each picture.
fn prepared<'a>(scene: &'a Scene, method: &Method) -> Box<Prepared<'a>> {
    let bar = Progress::start("sorting scratches");
    let prepared = watched(&bar, |watch| Prepared::watched(scene, method.lookup, watch));
    add_up(scene, prepared.scratches(), method);
    if method.lookup == Lookup::Triangles {
        prepared.triangle_lists();
    }
    Box::new(prepared)
}

fn sorted(scene: &Scene, lookup: Lookup) -> ScratchIndex {
    let bar = Progress::start("sorting scratches");
    watched(&bar, |watch| {
        ScratchIndex::rebuild(scene, lookup, None, watch)
    })
}

/// Builds the grids of many scratches, if the method has a use for them.
fn add_up(scene: &Scene, scratches: &ScratchIndex, method: &Method) {
    if method.gather.has_grids() {
        let bar = Progress::start("adding up scratches");
        watched(&bar, |watch| scratches.grids_watched(scene, watch));
    }
}

/// Work that a bar shows, and that nobody ends but by ending the process.
fn watched<T>(bar: &Progress, work: impl FnOnce(&Watch) -> Option<T>) -> T {
    let watch = Watch {
        progress: &|share| bar.set(share),
        ..Watch::default()
    };
    work(&watch).unwrap_or_else(|| unreachable!("nobody cancels it"))
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
    eprintln!("rendering on the CPU, {threads}: {why}");
}

fn announce_gpu(gpu: &Gpu, why: &str) {
    eprintln!("rendering on {}: {why}", gpu.adapter);
}

fn warn_of(gpu: &Gpu, error: &hairline_gpu::Error) {
    let name = &gpu.adapter.name;
    eprintln!("warning: {name} failed ({error}); the CPU renders instead");
}
