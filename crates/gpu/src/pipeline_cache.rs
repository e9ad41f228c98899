//! The compute pipelines that a device has compiled: that takes seconds, so that all its renderers share them.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Pipelines by the source and constants that they were compiled of. Clones are the same cache.
#[derive(Clone, Default)]
pub(crate) struct PipelineCache(Arc<Mutex<HashMap<String, wgpu::ComputePipeline>>>);

impl PipelineCache {
    /// The pipeline with this key, if it was kept.
    pub(crate) fn get(&self, key: &str) -> Option<wgpu::ComputePipeline> {
        self.kept(|all| all.get(key).cloned())
    }

    /// Keeps a pipeline that was compiled without an error.
    pub(crate) fn keep(&self, key: String, pipeline: &wgpu::ComputePipeline) {
        self.kept(|all| all.insert(key, pipeline.clone()));
    }

    /// Never held while something is compiled or awaited.
    fn kept<T>(&self, look: impl FnOnce(&mut HashMap<String, wgpu::ComputePipeline>) -> T) -> T {
        look(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
