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

    /// Whether it computes on the cores that scenes are built on.
    pub(super) fn is_software(&self) -> bool {
        match self {
            Self::Cpu => true,
            Self::Gpu(gpu) | Self::Shared(gpu) => gpu.adapter.kind == AdapterKind::Software,
        }
    }

    /// Name in the status line.
    pub fn label(&self) -> String {
        match self {
            Self::Cpu => match pool::threads() {
                1 => String::from("CPU, 1 thread"),
                threads => format!("CPU, {threads} threads"),
            },
            Self::Gpu(gpu) | Self::Shared(gpu) => gpu.adapter.to_string(),
        }
    }
}
