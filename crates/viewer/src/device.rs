//! The device that draws the window, opened so that it renders too.

use std::sync::Arc;

use eframe::egui_wgpu::{RenderState, WgpuSetup, WgpuSetupCreateNew};
use hairline_gpu::{Adapter, AdapterKind, Error, Gpu};

/// With what the renderer needs, so that it can share the device. A browser's OpenGL has less, and draws the window alone.
pub(crate) fn setup() -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    let without_renderer = Arc::clone(&setup.device_descriptor);
    setup.device_descriptor = Arc::new(move |handle| {
        let adapter = Adapter::new(handle.clone());
        match adapter.shortcoming {
            Some(_) if cfg!(target_arch = "wasm32") => without_renderer(handle),
            _ => adapter.device_descriptor(false),
        }
    });
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
