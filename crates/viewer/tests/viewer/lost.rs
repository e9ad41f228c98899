//! A device that is lost in the middle of the work: it is opened anew and the picture goes on, and the window says so.

use crate::common::{bare_disk, viewer_in, wait_built, wait_until};
use hairline_gpu::AdapterRequest;
use hairline_gpu::headless::{self, test_gpu};
use hairline_viewer::Options;
use hairline_viewer::progressive::Backend;

fn options(backend: Backend) -> Options {
    Options {
        scene: None,
        built_in: bare_disk().to_string().leak(),
        backend,
        state_dir: None,
        native_dialogs: false,
        transport: hairline_scene::Transport::DIRECT,
        examples: &hairline_viewer::examples::Examples::NONE,
    }
}

/// Loses the device of a viewer that has painted with it, turns the view and waits for a new picture and for `message`.
fn goes_on(backend: Backend, device: wgpu::Device, message: &str) {
    let mut harness = viewer_in(options(backend), [760.0, 400.0], 0.25);
    wait_built(&mut harness);
    wait_until(&mut harness, "a picture", |viewer| {
        viewer.renderer().latest().is_some()
    });
    let number = harness
        .state()
        .renderer()
        .latest()
        .map_or(0, |frame| frame.number);
    device.destroy();
    let document = harness.state_mut().document_mut();
    document.edit("Turn", |d| d.camera.position_m[0] += 0.1);
    let wanted = glam::DVec3::from(harness.state().document().description().camera.position_m);
    // A note goes by itself after a while, so it is looked for first.
    wait_until(&mut harness, "a message", |viewer| {
        viewer.messages().iter().any(|text| text.contains(message))
    });
    wait_until(&mut harness, "a picture after the loss", |viewer| {
        viewer
            .renderer()
            .latest()
            .is_some_and(|frame| frame.number > number && frame.view.camera.position_m == wanted)
    });
}

#[test]
fn a_device_of_its_own_is_opened_anew() {
    if test_gpu().is_none() {
        return;
    }
    let gpu = headless::open(&AdapterRequest::default()).unwrap();
    let device = gpu.device.clone();
    goes_on(Backend::Gpu(gpu), device, "is back");
}

#[test]
fn a_windows_device_gives_way_to_the_cpu() {
    if test_gpu().is_none() {
        return;
    }
    let gpu = headless::open(&AdapterRequest::default()).unwrap();
    let device = gpu.device.clone();
    // Its pictures are textures that no test can show; that they come is enough.
    goes_on(Backend::Shared(gpu), device, "CPU renders from now on");
}
