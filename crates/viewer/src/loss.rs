//! The loss of the device that draws the window: nothing more can be shown in it, so that unsaved work is kept for the next
//! start, and the opener of the window is told.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// Told of the loss from any thread, heard by the window's next pass.
#[derive(Clone, Debug, Default)]
pub(crate) struct WindowLoss(Arc<State>);

#[derive(Debug, Default)]
struct State {
    reason: OnceLock<String>,
    device: OnceLock<wgpu::Device>,
    /// The window has closed: that its device goes is no loss.
    closed: AtomicBool,
}

impl WindowLoss {
    /// The device is lost, for the driver's reason. The first reason stays.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn tell(&self, reason: &str) {
        if !self.0.closed.load(Ordering::Acquire) {
            let _ = self.0.reason.set(reason.to_owned());
        }
    }

    /// The window closes; whatever is told from now on is not a loss.
    pub fn close(&self) {
        self.0.closed.store(true, Ordering::Release);
    }

    /// The device that draws the window.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn watch(&self, device: &wgpu::Device) {
        let _ = self.0.device.set(device.clone());
    }

    /// The reason, once it is lost.
    pub fn reason(&self) -> Option<&str> {
        // A loss is told to those who poll; the window's own calls need not.
        if let Some(device) = self.0.device.get() {
            let _ = device.poll(wgpu::PollType::Poll);
        }
        self.0.reason.get().map(String::as_str)
    }
}
