//! A device that goes away is an error wherever it happens, and the next one works.

use std::future::Future;
use std::pin::pin;
use std::task::{Context, Waker};

use crate::common::{Made, Stage, options, plates};
use hairline_gpu::headless::{self, test_gpu};
use hairline_gpu::{Error, Gpu, Renderer};
use hairline_image::{Display, ToneMap};

const DISPLAY: Display = Display {
    exposure_ev: 0.0,
    tone_map: ToneMap::Neutral,
};

fn open() -> Option<Gpu> {
    test_gpu()?;
    Some(headless::open(&Default::default()).unwrap())
}

fn is_lost<T>(result: Result<T, Error>) -> bool {
    matches!(result, Err(Error::Lost { .. }))
}

/// Destroys the device once `future` waits for it. None if it never does.
fn destroyed_within<T>(gpu: &Gpu, future: impl Future<Output = T>) -> Option<T> {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    let is_done = future.as_mut().poll(&mut context).is_ready();
    gpu.device.destroy();
    (!is_done).then(|| gpu.block_on(future))
}

#[test]
fn a_lost_device_is_an_error_everywhere() {
    for step in 0..4 {
        let Some(gpu) = open() else { return };
        let mut stage = Stage::new(&gpu, plates().scene());
        let mut canvas = stage.canvas([97, 64], 16 * 97);
        stage.paint(&mut canvas, 1, 2);
        // A new tree, so that there is something to upload.
        let edited = Made::new(stage.made.scene.clone());
        let Stage {
            renderer,
            made,
            uploaded,
            ..
        } = &mut stage;
        let scene = &made.scene;
        let options = options(2);
        let lost = match step {
            0 => {
                let sample = renderer.accumulate(scene, uploaded, &mut canvas, 1, 1, &options);
                destroyed_within(&gpu, sample).map(is_lost)
            }
            1 => destroyed_within(&gpu, renderer.read_shown(&canvas, &DISPLAY)).map(is_lost),
            2 => destroyed_within(&gpu, canvas.image()).map(is_lost),
            _ => destroyed_within(&gpu, edited.update(renderer, uploaded)).map(is_lost),
        };
        assert!(lost.unwrap_or(true), "step {step}");
        // Whatever waits next says the same.
        let next = async {
            renderer
                .accumulate(scene, uploaded, &mut canvas, 0, 0, &options)
                .await?;
            renderer
                .settle(scene, uploaded, &mut canvas, &options)
                .await
        };
        assert!(is_lost(gpu.block_on(next)), "after step {step}");
        let next = renderer.read_shown(&canvas, &DISPLAY);
        assert!(is_lost(gpu.block_on(next)), "after step {step}");
        assert!(is_lost(gpu.block_on(canvas.image())), "after step {step}");
        let next = edited.update(renderer, uploaded);
        assert!(is_lost(gpu.block_on(next)), "after step {step}");
        let next = renderer.canvas([64, 64], 64);
        assert!(is_lost(gpu.block_on(next)), "after step {step}");
    }
}

/// The window then takes a new device, a new renderer and the same scene, and uploads everything again.
#[test]
fn another_device_takes_over() {
    let Some(gpu) = open() else { return };
    let mut stage = Stage::new(&gpu, plates().scene());
    let picture = stage.made.render(&mut stage.renderer, &stage.uploaded);
    let expected = gpu.block_on(picture).unwrap();
    gpu.device.destroy();
    assert!(is_lost(gpu.check()) || is_lost(gpu.block_on(gpu.finished())));

    let gpu = open().unwrap();
    let made = &stage.made;
    let mut renderer = gpu.block_on(Renderer::new(&gpu)).unwrap();
    let fresh = gpu.block_on(made.upload(&mut renderer)).unwrap();
    gpu.block_on(made.update(&mut renderer, &mut stage.uploaded))
        .unwrap();
    for uploaded in [&fresh, &stage.uploaded] {
        let image = gpu.block_on(made.render(&mut renderer, uploaded)).unwrap();
        assert!(image == expected);
    }
}

/// A window opens the device by our description, and we share it.
#[test]
fn a_windows_device_is_shared() {
    let Some(shared) = test_gpu() else { return };
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let open = |lesser: bool| {
        shared.block_on(async {
            let adapter = instance.request_adapter(&Default::default()).await.unwrap();
            let described = hairline_gpu::Adapter::new(adapter.clone());
            let mut descriptor = described.device_descriptor(true);
            if lesser {
                descriptor
                    .required_limits
                    .max_storage_buffers_per_shader_stage = 4;
            }
            let (device, queue) = adapter.request_device(&descriptor).await.unwrap();
            Gpu::from_window(adapter, device, queue)
        })
    };
    let gpu = open(false).unwrap();
    let mut stage = Stage::new(&gpu, plates().scene());
    let picture = stage.made.render(&mut stage.renderer, &stage.uploaded);
    assert!(
        gpu.block_on(picture)
            .unwrap()
            .depth_m
            .iter()
            .any(|d| *d > 0.0)
    );
    // Somebody else's mistake on the same device is reported, and no panic.
    let _ = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("a mistake"),
        size: 16,
        usage: wgpu::BufferUsages::MAP_READ
            | wgpu::BufferUsages::MAP_WRITE
            | wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    assert!(matches!(gpu.check(), Err(Error::Validation { .. })));
    gpu.check().unwrap();

    let Err(refusal) = open(true) else {
        panic!("four storage buffers are not enough");
    };
    assert!(matches!(refusal, Error::Refused { .. }), "{refusal}");
}
