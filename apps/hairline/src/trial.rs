//! Where there is no GPU: whether a software driver or the CPU renderer would finish first, found out by letting both
//! render the same few rows.
//!
//! Rows and not a small picture: the time goes into the scratches under a pixel, and a small picture has as many of them
//! under fewer pixels.

use std::future::Future;
use std::ops::Range;
use std::pin::pin;
use std::sync::Arc;
use std::task::Poll;
use std::time::{Duration, Instant};

use hairline_gpu::{Error, Gpu, GpuScene, RenderOptions, Renderer};
use hairline_image::Image;
use hairline_index::ScratchIndex;
use hairline_optics::method::{Gather, Method};
use hairline_reference::closed_form::{self, Prepared};
use hairline_scene::{Scene, ScratchTables};

use crate::backend::Task;
use crate::progress::Progress;

/// At so many places of the picture's height, evenly. Few, since a driver has a cost for each, and not one alone, which may be of
/// background.
const STRIPS: std::ops::RangeInclusive<u32> = 2..=5;
/// All of them together are no more than this part of the picture.
const PART: u32 = 8;

/// Pictures that the CPU renderer has sooner are not worth a trial: before its first row a software driver compiles the
/// shaders, for 4 s or so (lavapipe, Mesa 22.3), and nothing can interrupt it.
const WORTH_A_TRIAL_S: f64 = 40.0;

/// Who renders, and the reason in words.
pub struct Trial {
    pub winner: Winner,
    pub why: String,
}

/// Who renders.
pub enum Winner {
    Cpu,
    Driver(Box<ReadyDriver>),
}

/// A driver that has compiled the shaders and holds the scene.
pub struct ReadyDriver {
    renderer: Renderer,
    uploaded: GpuScene,
    scratches: Arc<ScratchIndex>,
    method: Method,
    /// The same for every scratch for itself, once it was asked for, where the method takes many together.
    one_by_one: Option<GpuScene>,
}

impl ReadyDriver {
    /// Compiles and uploads.
    pub async fn new(
        gpu: &Gpu,
        scene: &Scene,
        scratches: &Arc<ScratchIndex>,
        tables: &ScratchTables,
        method: &Method,
    ) -> Result<Self, Error> {
        let mut renderer = Renderer::new(gpu).await?;
        let uploaded = renderer.upload(scene, scratches, tables, method).await?;
        Ok(Self {
            renderer,
            uploaded,
            scratches: Arc::clone(scratches),
            method: *method,
            one_by_one: None,
        })
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        self.renderer.gpu()
    }

    /// Blocks until the picture is there.
    pub fn render(
        &mut self,
        scene: &Scene,
        samples: u32,
        progress: &dyn Fn(f64),
    ) -> Result<Image, Error> {
        let gpu = self.renderer.gpu().clone();
        let options = driver_options(samples);
        gpu.block_on(
            self.renderer
                .render(scene, &self.uploaded, &options, progress),
        )
    }

    /// The same with every scratch for itself, whatever the method. `scene` has the scratches and materials of the one that was
    /// uploaded.
    pub fn render_one_by_one(
        &mut self,
        scene: &Scene,
        samples: u32,
        progress: &dyn Fn(f64),
    ) -> Result<Image, Error> {
        if self.method.gather == Gather::Exact {
            return self.render(scene, samples, progress);
        }
        let method = Method {
            gather: Gather::Exact,
            ..self.method
        };
        let gpu = self.renderer.gpu().clone();
        let options = driver_options(samples);
        gpu.block_on(async {
            let uploaded = match &mut self.one_by_one {
                Some(uploaded) => uploaded,
                none => {
                    let tables = ScratchTables::new(scene);
                    let upload = self
                        .renderer
                        .upload(scene, &self.scratches, &tables, &method);
                    none.insert(upload.await?)
                }
            };
            self.renderer
                .render(scene, uploaded, &options, progress)
                .await
        })
    }
}

/// Lets both renderers work on the same rows, for a small share of the time that the pictures will take.
pub fn run(gpu: &Gpu, scene: &Scene, task: &Task, prepared: &Prepared) -> Trial {
    let Task {
        method,
        samples,
        pictures,
        ..
    } = task;
    let cpu = |why| Trial {
        winner: Winner::Cpu,
        why,
    };
    let driver = &gpu.adapter.name;
    let height = scene.render.size_px[1];
    let threads = rayon::current_num_threads() as u32;
    // All threads have work, and the CPU renderer does no rows twice.
    let rows = threads.next_multiple_of(closed_form::rows_together(*method));
    let Some(strips) = strips(height, rows) else {
        return cpu(format!("no GPU; the picture is too small to try {driver}"));
    };
    let _bar = Progress::start("measuring");
    let cpu_time = time_cpu(prepared, method, *samples, &strips);
    let whole_s = |strips_time: Duration| {
        let rows: usize = strips.iter().map(Range::len).sum();
        strips_time.as_secs_f64() * f64::from(height) * f64::from(*pictures) / rows as f64
    };
    let cpu_s = whole_s(cpu_time);
    if cpu_s < WORTH_A_TRIAL_S {
        return cpu(format!(
            "no GPU; {cpu_s:.1} s expected, too short to try {driver}"
        ));
    }
    match time_driver(gpu, scene, method, prepared, *samples, &strips, cpu_time) {
        Ok(Some((ready, time))) => Trial {
            winner: Winner::Driver(Box::new(ready)),
            why: format!(
                "no GPU; {:.0} s expected, and {cpu_s:.0} s by the CPU renderer",
                whole_s(time)
            ),
        },
        Ok(None) => cpu(format!(
            "no GPU; {cpu_s:.0} s expected, and {driver} is slower by measurement"
        )),
        Err(error) => cpu(format!("no GPU; {driver} failed: {error}")),
    }
}

/// Strips of so many rows; none if that is much of the picture.
fn strips(height: u32, rows: u32) -> Option<Vec<Range<u32>>> {
    let count = (height / PART / rows.max(1)).min(*STRIPS.end());
    (count >= *STRIPS.start()).then(|| {
        let strip = |i: u32| {
            let middle = (2 * i + 1) * height / (2 * count);
            let first = middle - rows / 2;
            first..first + rows
        };
        (0..count).map(strip).collect()
    })
}

fn time_cpu(prepared: &Prepared, method: &Method, samples: u32, strips: &[Range<u32>]) -> Duration {
    let start = Instant::now();
    for rows in strips {
        prepared.render_rows(
            &closed_form::RenderOptions {
                samples,
                method: *method,
            },
            rows.clone(),
            &|_| {},
        );
    }
    start.elapsed()
}

/// The driver, made ready, and its time for the strips; none if that is above `limit`.
fn time_driver(
    gpu: &Gpu,
    scene: &Scene,
    method: &Method,
    prepared: &Prepared,
    samples: u32,
    strips: &[Range<u32>],
    limit: Duration,
) -> Result<Option<(ReadyDriver, Duration)>, Error> {
    let options = driver_options(samples);
    gpu.block_on(async {
        let (scratches, tables) = (prepared.scratches(), prepared.tables());
        let mut ready = ReadyDriver::new(gpu, scene, scratches, tables, method).await?;
        let ReadyDriver {
            renderer, uploaded, ..
        } = &mut ready;
        // Drivers compile at the first use.
        let row = strips[0].start..strips[0].start + 1;
        renderer
            .render_rows(scene, uploaded, &driver_options(1), row, &|_| {})
            .await?;
        let start = Instant::now();
        let in_time = before(start + limit, async {
            for rows in strips {
                renderer
                    .render_rows(scene, uploaded, &options, rows.clone(), &|_| {})
                    .await?;
            }
            Ok(())
        });
        let in_time = in_time.await.transpose()?.is_some();
        Ok(in_time.then(|| (ready, start.elapsed())))
    })
}

fn driver_options(samples: u32) -> RenderOptions {
    RenderOptions {
        samples,
        ..Default::default()
    }
}

/// What `future` comes to; none, and it is dropped, if it goes on beyond `deadline`. It is looked at between submissions.
async fn before<T>(deadline: Instant, future: impl Future<Output = T>) -> Option<T> {
    let mut future = pin!(future);
    std::future::poll_fn(|context| match future.as_mut().poll(context) {
        Poll::Ready(value) => Poll::Ready(Some(value)),
        Poll::Pending if Instant::now() > deadline => Poll::Ready(None),
        Poll::Pending => Poll::Pending,
    })
    .await
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::task::{Context, Waker};

    #[test]
    fn strips_lie_in_the_picture_and_are_a_small_part_of_it() {
        for height in [1, 7, 96, 97, 720, 16384] {
            for rows in [1, 2, 4, 16, 32, 300] {
                let Some(strips) = strips(height, rows) else {
                    assert!(PART * STRIPS.start() * rows > height);
                    continue;
                };
                assert!(strips.iter().all(|strip| strip.len() == rows as usize));
                assert!(strips.iter().all(|strip| strip.end <= height));
                assert!(strips.windows(2).all(|pair| pair[0].end <= pair[1].start));
                assert!(strips.len() as u32 * rows * PART <= height);
            }
        }
        // The usual size by tiles.
        assert_eq!(strips(720, 32).map(|strips| strips.len()), Some(2));
    }

    #[test]
    fn a_driver_that_is_ready_renders_and_a_slow_one_is_left() {
        let Some(gpu) = hairline_gpu::headless::test_gpu() else {
            return;
        };
        let text = r#"
            camera = { position_m = [0.0, 0.0, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 1.0, 0.0] }
            render = { size_px = [64, 48] }
            material = [{ name = "m", kind = "mirror" }]
            object = [{ name = "o", material = "m", shape = { disk = { radius_m = 0.08 } } }]
            light = [{ kind = "sphere", center_m = [0.0, 0.0, 0.5], radius_m = 0.1, radiance = 5.0 }]
        "#;
        let scene = Scene::from_toml(text, "test", ".").unwrap_or_else(|error| panic!("{error}"));
        let prepared = Prepared::new(&scene);
        let method = Method::default();
        let strips = [10..14, 30..34];
        let time = |limit| time_driver(gpu, &scene, &method, &prepared, 2, &strips, limit);
        assert!(time(Duration::ZERO).unwrap().is_none());
        let (mut ready, time) = time(Duration::from_secs(600)).unwrap().unwrap();
        assert!(time > Duration::ZERO);
        let image = ready.render(&scene, 2, &|_| {}).unwrap();
        assert_eq!(image.size_px, [64, 48]);
        assert!(image.depth_m[image.index(32, 24)] > 0.0);
    }

    #[test]
    fn what_lasts_too_long_is_dropped() {
        fn block_on<T>(future: impl Future<Output = T>) -> T {
            let mut future = pin!(future);
            let mut context = Context::from_waker(Waker::noop());
            loop {
                if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
                    return value;
                }
            }
        }
        let soon = Instant::now() + Duration::from_millis(20);
        assert_eq!(block_on(before(soon, std::future::pending::<u8>())), None);
        assert_eq!(block_on(before(soon, async { 7 })), Some(7));
    }
}
