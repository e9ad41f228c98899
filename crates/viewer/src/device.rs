//! The device that draws the window, opened so that it renders too.

use std::sync::Arc;

use eframe::egui_wgpu::{RenderState, WgpuSetup, WgpuSetupCreateNew};
use hairline_gpu::{Adapter, AdapterKind, Error, Gpu};

/// Choice of the renderer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Renderer {
    /// The window's GPU; where that is a driver that computes on the CPU, the CPU renderer, which is faster.
    #[default]
    Auto,
    /// A graphics adapter, be it a software driver.
    Gpu,
    /// The CPU renderer.
    Cpu,
}

/// Setup of the window's device with what the renderer needs, so that they can share it.
pub(crate) fn setup() -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.device_descriptor =
        Arc::new(|adapter| Adapter::new(adapter.clone()).device_descriptor(false));
    WgpuSetup::CreateNew(setup)
}

/// The window's device as one to render on.
///
/// # Errors
/// [`Error::Refused`] if it has less than the renderer needs.
pub(crate) fn shared(state: &RenderState) -> Result<Gpu, Error> {
    Gpu::from_window(
        state.adapter.clone(),
        state.device.clone(),
        state.queue.clone(),
    )
}

/// Whether a driver that computes on the CPU draws the window.
pub(crate) fn is_software(state: &RenderState) -> bool {
    Adapter::new(state.adapter.clone()).kind == AdapterKind::Software
}
