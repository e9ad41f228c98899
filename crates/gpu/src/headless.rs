//! Blocking for programs with a thread to spare: drive a future to its end and let the device work meanwhile. A
//! window or a browser has an event loop for this, and never calls it.

use std::future::Future;
use std::io::Write;
use std::pin::pin;
use std::sync::{Arc, OnceLock};
use std::task::{Context, Poll, Waker};

use hairline_image::Image;
use hairline_index::ScratchIndex;
use hairline_scene::{Scene, ScratchTables};

use crate::adapter::{self, Adapter, AdapterRequest};
use crate::device::Gpu;
use crate::error::Error;
use crate::method::Method;
use crate::renderer::{RenderOptions, Renderer};

impl Gpu {
    /// Blocks until `future`, which waits for this device, is done.
    pub fn block_on<T>(&self, future: impl Future<Output = T>) -> T {
        drive(future, || {
            if let Err(error) = self.device.poll(wgpu::PollType::wait_indefinitely()) {
                self.record_lost(error.to_string());
            }
        })
    }
}

/// Blocks until a device is open.
pub fn open(request: &AdapterRequest) -> Result<Gpu, Error> {
    drive(Gpu::open(request), || {})
}

/// Blocks until the adapters are listed.
pub fn adapters() -> Vec<Adapter> {
    drive(adapter::adapters(), || {})
}

/// Blocks until the picture is there: index, tables, upload, pipelines and all. `progress` is told the share of the
/// rendering that is done.
///
/// # Errors
/// As [`Renderer::new`], [`Renderer::upload`] and [`Renderer::render`].
pub fn render(
    gpu: &Gpu,
    scene: &Scene,
    method: &Method,
    options: &RenderOptions,
    progress: &dyn Fn(f64),
) -> Result<Image, Error> {
    let index = Arc::new(ScratchIndex::with_pieces(scene, method.pieces()));
    let tables = ScratchTables::new(scene);
    gpu.block_on(async {
        let mut renderer = Renderer::new(gpu).await?;
        let uploaded = renderer.upload(scene, &index, &tables, method).await?;
        renderer.render(scene, &uploaded, options, progress).await
    })
}

fn drive<T>(future: impl Future<Output = T>, work: impl Fn()) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        match future.as_mut().poll(&mut context) {
            Poll::Ready(value) => return value,
            Poll::Pending => {
                work();
                // Another thread may hold the callback that this future waits for.
                std::thread::yield_now();
            }
        }
    }
}

/// The one device that all tests of a process share; none if the machine has no adapter.
///
/// # Panics
/// With `HAIRLINE_REQUIRE_GPU=1` in the environment, if there is none: then a test must not be skipped.
pub fn test_gpu() -> Option<&'static Gpu> {
    static SHARED: OnceLock<Result<Gpu, Error>> = OnceLock::new();
    match SHARED.get_or_init(open_for_tests) {
        Ok(gpu) => Some(gpu),
        Err(error)
            if std::env::var_os("HAIRLINE_REQUIRE_GPU").is_some_and(|value| value == "1") =>
        {
            panic!("HAIRLINE_REQUIRE_GPU is set, but {error}")
        }
        Err(error) => {
            skip(&error.to_string());
            None
        }
    }
}

/// Prints to stderr that the test of this thread is skipped.
pub fn skip(why: &str) {
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    let line = format!("skipped: {test}: {why}\n");
    // Not eprintln: the test harness hides what it prints unless the test fails.
    let _ = std::io::stderr().write_all(line.as_bytes());
}

/// GL is left out: its context serves one thread at a time, and tests run on many.
fn open_for_tests() -> Result<Gpu, Error> {
    match open(&AdapterRequest::default())? {
        gpu if gpu.adapter.is_opengl() => Err(Error::NoAdapter {
            found: format!("only {}", gpu.adapter),
        }),
        gpu => Ok(gpu),
    }
}
