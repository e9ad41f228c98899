//! `hairline info`: the adapters of this machine, or the contents of a scene.

mod scene;

use std::fmt::{self, Write};

use hairline_console::print;
use hairline_gpu::headless;

use crate::cli;
use hairline_render::failure::Failure;

/// Prints to stdout.
pub fn run(arguments: &cli::Info) -> Result<(), Failure> {
    if let Some(path) = &arguments.scene {
        return scene::run(path, arguments.json);
    }
    let mut text = String::new();
    machine(&mut text).map_err(|error| Failure::Work(error.into()))?;
    print(&text)
}

fn machine(out: &mut String) -> fmt::Result {
    let adapters = headless::adapters();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    writeln!(out, "hairline {}", env!("CARGO_PKG_VERSION"))?;
    writeln!(out)?;
    writeln!(out, "graphics adapters, the preferred ones first:")?;
    if adapters.is_empty() {
        writeln!(
            out,
            "  none (on Linux, libvulkan1 and mesa-vulkan-drivers bring a software one)"
        )?;
    }
    for adapter in &adapters {
        writeln!(out, "  {adapter}")?;
        match &adapter.shortcoming {
            None => writeln!(
                out,
                "    can render: pictures up to {} px a side, {} in one array",
                adapter.max_texture_px,
                bytes_in_words(adapter.max_storage_binding_bytes)
            )?,
            Some(reason) => writeln!(out, "    cannot render: {reason}")?,
        }
    }
    writeln!(out)?;
    writeln!(out, "backends:")?;
    match adapters.iter().find(|a| a.shortcoming.is_none()) {
        Some(adapter) => writeln!(out, "  gpu  {adapter}")?,
        None => writeln!(out, "  gpu  not available")?,
    }
    writeln!(out, "  cpu  {threads} threads")
}

fn bytes_in_words(bytes: u64) -> String {
    match bytes {
        0..0x10_0000 => format!("{} KiB", bytes >> 10),
        0x10_0000..0x4000_0000 => format!("{} MiB", bytes >> 20),
        _ => format!("{} GiB", bytes >> 30),
    }
}
