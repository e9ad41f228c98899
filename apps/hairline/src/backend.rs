//! What renders: a GPU, the CPU renderer, or a graphics driver that computes on the CPU.

use anyhow::anyhow;
use hairline_gpu::{AdapterKind, AdapterRequest, Gpu, headless};
use hairline_image::Image;
use hairline_optics::method::Method;
use hairline_reference::closed_form::{self, Prepared};
use hairline_scene::Scene;

use crate::cli::Backend;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::trial::{self, Winner};

/// Renders, and says on stderr in one line on what and why.
pub fn render(
    scene: &Scene,
    method: &Method,
    backend: Backend,
    samples: u32,
) -> Result<Image, Failure> {
    match backend {
        Backend::Cpu => {
            announce_cpu("as asked");
            Ok(render_on_cpu(&Prepared::new(scene), method, samples))
        }
        Backend::Gpu => {
            let advise = |error| Failure::Work(anyhow!("{error}; --backend cpu needs no driver"));
            let gpu = open().map_err(advise)?;
            announce_gpu(&gpu, "as asked");
            render_on_gpu(&gpu, scene, method, samples).map_err(advise)
        }
        Backend::Auto => Ok(render_on_the_faster(scene, method, samples)),
    }
}

/// A GPU if there is one; else the CPU renderer or a software driver, by trial. What fails on a graphics adapter is
/// done on the CPU.
fn render_on_the_faster(scene: &Scene, method: &Method, samples: u32) -> Image {
    match open() {
        Err(error) => {
            announce_cpu(&error.to_string());
            render_on_cpu(&Prepared::new(scene), method, samples)
        }
        Ok(gpu) if gpu.adapter.kind == AdapterKind::Software => {
            let prepared = Prepared::new(scene);
            let trial = trial::run(&gpu, scene, method, &prepared, samples);
            match trial.winner {
                Winner::Cpu => {
                    announce_cpu(&trial.why);
                    render_on_cpu(&prepared, method, samples)
                }
                Winner::Driver(mut ready) => {
                    announce_gpu(&gpu, &trial.why);
                    let progress = Progress::start("rendering");
                    let image = ready.render(scene, samples, &|share| progress.set(share));
                    drop(progress);
                    image.unwrap_or_else(|error| {
                        warn_of(&gpu, &error);
                        render_on_cpu(&prepared, method, samples)
                    })
                }
            }
        }
        Ok(gpu) => {
            announce_gpu(&gpu, "a GPU is there");
            render_on_gpu(&gpu, scene, method, samples).unwrap_or_else(|error| {
                warn_of(&gpu, &error);
                render_on_cpu(&Prepared::new(scene), method, samples)
            })
        }
    }
}

/// The best adapter: GPUs come before software drivers.
fn open() -> Result<Gpu, hairline_gpu::Error> {
    headless::open(&AdapterRequest::default())
}

fn announce_cpu(why: &str) {
    let threads = rayon::current_num_threads();
    eprintln!("rendering on the CPU, {threads} threads: {why}");
}

fn announce_gpu(gpu: &Gpu, why: &str) {
    eprintln!("rendering on {}: {why}", gpu.adapter);
}

fn warn_of(gpu: &Gpu, error: &hairline_gpu::Error) {
    let name = &gpu.adapter.name;
    eprintln!("warning: {name} failed ({error}); the CPU renders instead");
}

fn render_on_cpu(prepared: &Prepared, method: &Method, samples: u32) -> Image {
    let progress = Progress::start("rendering");
    let options = closed_form::RenderOptions {
        samples,
        method: *method,
    };
    prepared.render(&options, &|share| progress.set(share))
}

fn render_on_gpu(
    gpu: &Gpu,
    scene: &Scene,
    method: &Method,
    samples: u32,
) -> Result<Image, hairline_gpu::Error> {
    let progress = Progress::start("rendering");
    let options = hairline_gpu::RenderOptions {
        samples,
        ..Default::default()
    };
    headless::render(gpu, scene, method, &options, &|share| progress.set(share))
}
