//! On what it was measured.

use std::hint::black_box;
use std::time::Instant;

use hairline_gpu::AdapterKind;
use rayon::prelude::*;
use serde::Serialize;
use sysinfo::{CpuRefreshKind, RefreshKind, System};

use super::worker::Worker;

/// Adapter and processor.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// "gpu" or "cpu".
    pub backend: &'static str,
    /// None for the CPU renderer.
    pub adapter: Option<String>,
    pub adapter_kind: Option<&'static str>,
    pub driver: Option<String>,
    /// Whether times are the device's own: its passes, without what the host does around them.
    pub device_clock: bool,
    pub cpu: String,
    pub cpu_mhz: u64,
    pub threads: usize,
    /// What all threads together can read from memory; None on GPUs.
    pub bandwidth_gb_s: Option<f64>,
    pub system: String,
}

impl Machine {
    /// That `worker` works on.
    pub fn of(worker: &Worker) -> Self {
        let system = System::new_with_specifics(
            RefreshKind::nothing().with_cpu(CpuRefreshKind::nothing().with_frequency()),
        );
        let cpu = system.cpus().first();
        let adapter = worker.adapter();
        let on_the_cpu = adapter.is_none_or(|a| a.kind == AdapterKind::Software);
        Self {
            backend: if adapter.is_some() { "gpu" } else { "cpu" },
            adapter: adapter.map(|a| a.name.clone()),
            adapter_kind: adapter.map(|a| a.kind.label()),
            driver: adapter.map(|a| format!("{} ({})", a.driver, a.backend)),
            device_clock: worker.has_clock(),
            cpu: cpu.map_or_else(|| "unknown".to_owned(), |cpu| cpu.brand().trim().to_owned()),
            cpu_mhz: cpu.map_or(0, |cpu| cpu.frequency()),
            threads: rayon::current_num_threads(),
            bandwidth_gb_s: on_the_cpu.then(bandwidth_gb_s),
            system: System::long_os_version().unwrap_or_else(|| "unknown".to_owned()),
        }
    }

    /// Single-precision operations a second if every core did nothing but eight multiply-adds a cycle, which is what the
    /// registers hold that software drivers compute with. None on GPUs, which do not tell.
    pub fn peak_gflops(&self) -> Option<f64> {
        const LANES: f64 = 8.0;
        const MULTIPLY_ADD: f64 = 2.0;
        (self.bandwidth_gb_s.is_some() && self.cpu_mhz > 0)
            .then_some(self.threads as f64 * LANES * MULTIPLY_ADD * self.cpu_mhz as f64 * 1e-3)
    }

    /// In one line.
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

/// The best of three sums over an array that no cache holds.
fn bandwidth_gb_s() -> f64 {
    const WORDS: usize = 32 << 20;
    let array: Vec<u64> = (0..WORDS as u64).into_par_iter().collect();
    (0..3)
        .map(|_| {
            let start = Instant::now();
            let chunks = black_box(&array).par_chunks(1 << 16);
            black_box(
                chunks
                    .map(|chunk| chunk.iter().fold(0, |a: u64, b| a.wrapping_add(*b)))
                    .reduce(|| 0, u64::wrapping_add),
            );
            8e-9 * WORDS as f64 / start.elapsed().as_secs_f64().max(1e-9)
        })
        .fold(0.0, f64::max)
}
