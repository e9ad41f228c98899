//! The machine on which a benchmark ran.

use serde::Serialize;
use sysinfo::{CpuRefreshKind, RefreshKind, System};

use super::worker::Worker;

/// Adapter and processor.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// "gpu" or "cpu".
    pub backend: &'static str,
    /// Name of the adapter; none for the CPU renderer.
    pub adapter: Option<String>,
    pub adapter_kind: Option<&'static str>,
    pub driver: Option<String>,
    /// Whether times are the device's own: its passes, without the host's work around them.
    pub device_clock: bool,
    pub cpu: String,
    pub threads: usize,
    pub system: String,
}

impl Machine {
    /// The machine that `worker` works on.
    pub fn describe(worker: &Worker) -> Self {
        let system =
            System::new_with_specifics(RefreshKind::nothing().with_cpu(CpuRefreshKind::nothing()));
        let cpu = system.cpus().first();
        let adapter = worker.adapter();
        Self {
            backend: if adapter.is_some() { "gpu" } else { "cpu" },
            adapter: adapter.map(|a| a.name.clone()),
            adapter_kind: adapter.map(|a| a.kind.label()),
            driver: adapter.map(|a| format!("{} ({})", a.driver, a.backend)),
            device_clock: worker.has_clock(),
            cpu: cpu.map_or_else(|| "unknown".to_owned(), |cpu| cpu.brand().trim().to_owned()),
            threads: rayon::current_num_threads(),
            system: System::long_os_version().unwrap_or_else(|| "unknown".to_owned()),
        }
    }

    /// Describes the machine in one line.
    pub fn in_words(&self) -> String {
        let cpu = format!("{}, {} threads", self.cpu, self.threads);
        match (&self.adapter, &self.driver) {
            (Some(adapter), driver) => format!(
                "{adapter}, {}, {}; {cpu}; {}",
                self.adapter_kind.unwrap_or("adapter"),
                driver.as_deref().unwrap_or("driver unknown"),
                self.system
            ),
            (None, _) => format!("the CPU renderer on {cpu}; {}", self.system),
        }
    }
}
