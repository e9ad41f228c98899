//! What renders: a GPU, the CPU renderer, or a graphics driver that computes on the CPU.

use std::time::Instant;

use anyhow::anyhow;
use hairline_gpu::{AdapterRequest, Gpu, KindRequest, headless};
use hairline_image::Image;
use hairline_reference::closed_form;
use hairline_scene::Scene;

use crate::cli::Backend;
use crate::failure::Failure;
use crate::progress::Progress;

/// Renders, and says on stderr in one line on what and why. The scene comes back as it was.
pub fn render(scene: &mut Scene, backend: Backend, samples: u32) -> Result<Image, Failure> {
    match backend {
        Backend::Cpu => {
            announce_cpu("as asked");
            Ok(render_on_cpu(scene, samples))
        }
        Backend::Gpu => {
            let gpu = open(KindRequest::Any).map_err(|error| Failure::Work(error.into()))?;
            announce_gpu(&gpu, "as asked");
            with_progress(|| render_on_gpu(&gpu, scene, samples))
                .map_err(|error| Failure::Work(anyhow!("{error}; --backend cpu needs no driver")))
        }
        Backend::Auto => Ok(render_on_the_faster(scene, samples)),
    }
}

/// A GPU if there is one; else the CPU renderer or a software driver, by trial. What fails on a graphics adapter is
/// done on the CPU.
fn render_on_the_faster(scene: &mut Scene, samples: u32) -> Image {
    let (gpu, why) = match open(KindRequest::Hardware) {
        Ok(gpu) => (gpu, "a GPU is there".to_owned()),
        Err(_) => match open(KindRequest::Software) {
            Ok(gpu) => match software_is_faster(&gpu, scene, samples) {
                Ok(why) => (gpu, why),
                Err(why) => {
                    announce_cpu(&why);
                    return render_on_cpu(scene, samples);
                }
            },
            Err(error) => {
                announce_cpu(&error.to_string());
                return render_on_cpu(scene, samples);
            }
        },
    };
    announce_gpu(&gpu, &why);
    with_progress(|| render_on_gpu(&gpu, scene, samples)).unwrap_or_else(|error| {
        announce_cpu(&format!("the other failed: {error}"));
        render_on_cpu(scene, samples)
    })
}

fn open(kind: KindRequest) -> Result<Gpu, hairline_gpu::Error> {
    headless::open(&AdapterRequest {
        kind,
        ..AdapterRequest::default()
    })
}

fn announce_cpu(why: &str) {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    eprintln!("rendering on the CPU, {threads} threads: {why}");
}

fn announce_gpu(gpu: &Gpu, why: &str) {
    eprintln!("rendering on {}: {why}", gpu.adapter);
}

fn render_on_cpu(scene: &Scene, samples: u32) -> Image {
    let progress = Progress::start("rendering");
    closed_form::render(scene, &closed_form::RenderOptions { samples }, &|share| {
        progress.set(share);
    })
}

fn with_progress<T>(work: impl FnOnce() -> T) -> T {
    let _bar = Progress::start("rendering");
    work()
}

/// The one call of the GPU renderer.
fn render_on_gpu(gpu: &Gpu, scene: &Scene, samples: u32) -> Result<Image, hairline_gpu::Error> {
    let _ = (scene, samples);
    Err(hairline_gpu::Error::Refused {
        adapter: gpu.adapter.name.clone(),
        reason: "its renderer is not wired yet".to_owned(),
    })
}

/// Whether a software driver would finish before the CPU renderer, by what small pictures of the scene take on both;
/// and the reason, in words, either way.
fn software_is_faster(gpu: &Gpu, scene: &mut Scene, samples: u32) -> Result<String, String> {
    let _bar = Progress::start("measuring");
    let driver_s = expected_s(scene, |scene| {
        render_on_gpu(gpu, scene, samples).map(|_| ())
    })
    .map_err(|error| format!("{} failed: {error}", gpu.adapter.name))?;
    let options = closed_form::RenderOptions { samples };
    let cpu_s = expected_s(scene, |scene| {
        closed_form::render(scene, &options, &|_| {});
        Ok::<(), std::convert::Infallible>(())
    })
    .unwrap_or_else(|never| match never {});
    let (driver, words) = (&gpu.adapter.name, "expected from small pictures");
    if driver_s < cpu_s {
        Ok(format!(
            "no GPU; {words}: {driver_s:.1} s, and {cpu_s:.1} s by the CPU renderer"
        ))
    } else {
        Err(format!(
            "no GPU; {words}: {cpu_s:.1} s, and {driver_s:.1} s by {driver}"
        ))
    }
}

/// The time that the whole picture will take in seconds: from two small ones, so that what does not depend on the size (trees,
/// pipelines) is told apart from what does.
fn expected_s<E>(
    scene: &mut Scene,
    mut render: impl FnMut(&Scene) -> Result<(), E>,
) -> Result<f64, E> {
    let full_px = scene.render.size_px;
    let mut timed = |divisor: u32| {
        scene.render.size_px = full_px.map(|n| (n / divisor).max(1));
        let start = Instant::now();
        let result = render(scene);
        let pixels = f64::from(scene.render.size_px[0]) * f64::from(scene.render.size_px[1]);
        scene.render.size_px = full_px;
        result.map(|()| (start.elapsed().as_secs_f64(), pixels))
    };
    let (small_s, small_pixels) = timed(16)?;
    let (larger_s, larger_pixels) = timed(8)?;
    let pixels = f64::from(full_px[0]) * f64::from(full_px[1]);
    let per_pixel_s = (larger_s - small_s).max(0.0) / (larger_pixels - small_pixels).max(1.0);
    Ok(larger_s + per_pixel_s * (pixels - larger_pixels))
}
