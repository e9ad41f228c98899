//! The renderer of the window's pictures.

use hairline_gpu::{AdapterKind, Gpu};

use hairline_scene::Transport;

use super::pool;

/// The renderer of the window's pictures.
#[derive(Clone)]
pub enum Backend {
    /// The CPU renderer, on threads of low priority.
    Cpu,
    /// A device other than the window's, whose pictures are copied: the window is on another adapter.
    Gpu(Gpu),
    /// The window's own device: its pictures are shown where they are.
    Shared(Gpu),
}

impl Backend {
    /// Part of the transport that is rendered while something moves. Passes that take longer than a movement are left out.
    pub fn counts_in_motion(&self, wanted: Transport) -> Transport {
        if self.is_software() {
            Transport::DIRECT
        } else {
            wanted
        }
    }

    /// The device, if it is not the CPU.
    pub(crate) fn gpu(&self) -> Option<&Gpu> {
        match self {
            Self::Cpu => None,
            Self::Gpu(gpu) | Self::Shared(gpu) => Some(gpu),
        }
    }

    /// Whether it computes on the cores that scenes are built on.
    pub(super) fn is_software(&self) -> bool {
        let gpu = self.gpu();
        gpu.is_none_or(|gpu| gpu.adapter.kind == AdapterKind::Software)
    }

    /// Name in the status line.
    pub fn label(&self) -> String {
        match (self.gpu(), pool::threads()) {
            (Some(gpu), _) => gpu.adapter.to_string(),
            (None, 1) => String::from("CPU, 1 thread"),
            (None, threads) => format!("CPU, {threads} threads"),
        }
    }
}
