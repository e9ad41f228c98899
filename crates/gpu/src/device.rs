//! An open device: its memory, and its errors.

use std::sync::Arc;
use std::sync::atomic::AtomicUsize;

use crate::adapter::{Adapter, AdapterKind, AdapterRequest, KindRequest, adapters, shortcoming};
use crate::error::Error;
use crate::faults::Faults;
use crate::pipeline_cache::PipelineCache;

/// An open device. Renderers, window and tests share one; clones are the same device.
#[derive(Clone)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Queue of the device.
    pub queue: wgpu::Queue,
    /// The adapter that it was opened on.
    pub adapter: Adapter,
    /// Pipelines that were compiled on it, which its renderers share.
    pub(crate) pipelines: PipelineCache,
    pub(crate) reads: Arc<AtomicUsize>,
    faults: Faults,
}

impl Adapter {
    /// Opens a device.
    pub async fn open(self, default_limits: bool) -> Result<Gpu, Error> {
        let descriptor = self.device_descriptor(default_limits);
        self.open_by(descriptor).await
    }

    /// Opens a device whose shaders see arrays of at most so many bytes.
    #[cfg(all(test, not(target_arch = "wasm32")))]
    pub(crate) async fn open_with_arrays(self, bytes: u64) -> Result<Gpu, Error> {
        let mut descriptor = self.device_descriptor(true);
        descriptor.required_limits.max_storage_buffer_binding_size = bytes;
        self.open_by(descriptor).await
    }

    async fn open_by(self, descriptor: wgpu::DeviceDescriptor<'static>) -> Result<Gpu, Error> {
        self.usable()?;
        let (device, queue) = self
            .handle
            .request_device(&descriptor)
            .await
            .map_err(|error| Error::Refused {
                adapter: self.name.clone(),
                reason: error.to_string(),
            })?;
        Ok(Gpu::from_parts(self, device, queue))
    }
}

impl Gpu {
    /// Opens the best adapter that `request` admits.
    pub async fn open(request: &AdapterRequest) -> Result<Self, Error> {
        let adapters = adapters().await;
        let admitted = |adapter: &Adapter| {
            let kind = match request.kind {
                KindRequest::Any => true,
                KindRequest::Hardware => adapter.kind != AdapterKind::Software,
                KindRequest::Software => adapter.kind == AdapterKind::Software,
            };
            let name = request.name.as_deref().unwrap_or("").to_lowercase();
            kind && adapter.name.to_lowercase().contains(&name)
        };
        let found = describe(&adapters);
        let mut refusal = Error::NoAdapter { found };
        for adapter in adapters
            .into_iter()
            .filter(|a| a.shortcoming.is_none() && admitted(a))
        {
            match adapter.open(request.default_limits).await {
                Ok(gpu) => return Ok(gpu),
                Err(error) => refusal = error,
            }
        }
        Err(refusal)
    }

    /// Shares the device of a window, which opened it by [`Adapter::device_descriptor`]: what is rendered on it can be shown
    /// without a copy.
    ///
    /// A device has one place for who hears of its errors and one for who hears of its loss. This takes both, in place of
    /// any that were there (eframe sets none), and hands what it hears to the next [`Gpu::check`], errors of the
    /// window's own calls included: a caller that sees [`Error::Validation`] cannot tell whose call it was. The window must
    /// not set its own callbacks later, or a loss is heard of only when [`Gpu::finished`] or a readback fails.
    ///
    /// # Errors
    /// [`Error::Refused`] if the adapter, or the limits that the device was opened with, are below WebGPU's defaults.
    pub fn from_window(
        adapter: wgpu::Adapter,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Result<Self, Error> {
        let mut adapter = Adapter::new(adapter);
        let downlevel = adapter.handle.get_downlevel_capabilities();
        adapter.shortcoming = shortcoming(&device.limits(), &downlevel);
        adapter.usable()?;
        Ok(Self::from_parts(adapter, device, queue))
    }

    fn from_parts(adapter: Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let faults = Faults::default();
        faults.watch(&device, &adapter.name);
        Self {
            device,
            queue,
            adapter,
            pipelines: PipelineCache::default(),
            reads: Arc::default(),
            faults,
        }
    }

    /// Sets the listener that is called with the driver's reason as soon as the device is lost, from any thread. The first one is
    /// heard.
    pub fn on_lost(&self, tell: impl Fn(&str) + Send + Sync + 'static) {
        let _ = self.faults.on_lost.set(Box::new(tell));
    }

    /// The limits that the device was opened with.
    pub fn limits(&self) -> wgpu::Limits {
        self.device.limits()
    }

    /// Bytes of the largest array that a shader can be given.
    pub(crate) fn largest_array(&self) -> u64 {
        let limits = self.limits();
        limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size)
    }

    /// Number of layers that a texture must have to be bound as an array of `count` layers. With OpenGL, wgpu makes an array only of a
    /// texture with more than one layer; another texture that is bound as an array reads as zeros.
    pub(crate) fn array_layers(&self, count: u32) -> u32 {
        let least = if self.adapter.is_opengl() { 2 } else { 1 };
        count.max(least)
    }

    /// The first thing that went wrong since the last call. A lost device stays lost.
    pub fn check(&self) -> Result<(), Error> {
        // Calls on a lost device fail one by one before the loss itself is reported, which polling brings about: once the device has no work left.
        let _ = self.device.poll(wgpu::PollType::Poll);
        let found = self.faults.take();
        if !matches!(found, Err(Error::Validation { .. })) {
            return found;
        }
        let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
        match self.faults.take() {
            Err(lost @ Error::Lost { .. }) => Err(lost),
            _ => found,
        }
    }

    /// A buffer of `size` bytes, or why there can be none. `what` names it in messages, and is its label.
    pub(crate) async fn buffer(
        &self,
        what: &str,
        size: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, Error> {
        let limits = self.limits();
        let allowed = if usage.contains(wgpu::BufferUsages::STORAGE) {
            limits
                .max_buffer_size
                .min(limits.max_storage_buffer_binding_size)
        } else {
            limits.max_buffer_size
        };
        if size > allowed {
            return Err(self.too_large(what, size, allowed, "bytes"));
        }
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let descriptor = wgpu::BufferDescriptor {
            label: Some(what),
            size,
            usage,
            mapped_at_creation: false,
        };
        let buffer = self.device.create_buffer(&descriptor);
        match scope.pop().await {
            Some(_) => Err(self.out_of_memory(what, size)),
            None => Ok(buffer),
        }
    }

    /// A texture of one layer and one level, that passes write or draw to; as [`Self::texture`].
    ///
    /// # Errors
    /// As [`Self::texture`].
    pub async fn target(
        &self,
        what: &str,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> Result<wgpu::Texture, Error> {
        let descriptor = wgpu::TextureDescriptor {
            label: Some(what),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        };
        self.texture(what, &descriptor).await
    }

    /// A texture, or why there can be none. `what` names it in messages.
    pub async fn texture(
        &self,
        what: &str,
        descriptor: &wgpu::TextureDescriptor<'_>,
    ) -> Result<wgpu::Texture, Error> {
        let limits = self.limits();
        let side = descriptor.size.width.max(descriptor.size.height);
        if side > limits.max_texture_dimension_2d {
            return Err(self.too_large(
                what,
                side.into(),
                limits.max_texture_dimension_2d.into(),
                "pixels a side",
            ));
        }
        let layers = descriptor.size.depth_or_array_layers;
        if layers > limits.max_texture_array_layers {
            return Err(self.too_large(
                what,
                layers.into(),
                limits.max_texture_array_layers.into(),
                "layers",
            ));
        }
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let texture = self.device.create_texture(descriptor);
        let texel_bytes: u32 = descriptor.format.block_copy_size(None).unwrap_or(4);
        let bytes = u64::from(descriptor.size.width)
            * u64::from(descriptor.size.height)
            * u64::from(layers * texel_bytes);
        match scope.pop().await {
            Some(_) => Err(self.out_of_memory(what, bytes)),
            None => Ok(texture),
        }
    }

    pub(crate) fn too_large(
        &self,
        what: &str,
        needed: u64,
        allowed: u64,
        unit: &'static str,
    ) -> Error {
        Error::TooLarge {
            what: what.to_owned(),
            needed,
            allowed,
            unit,
            adapter: self.adapter.name.clone(),
        }
    }

    fn out_of_memory(&self, what: &str, needed_bytes: u64) -> Error {
        Error::OutOfMemory {
            adapter: self.adapter.name.clone(),
            what: what.to_owned(),
            needed_bytes,
        }
    }

    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn record_lost(&self, reason: String) {
        self.faults.record(Error::Lost { reason });
    }
}

fn describe(adapters: &[Adapter]) -> String {
    if adapters.is_empty() {
        return "none is installed (on Linux: libvulkan1 and mesa-vulkan-drivers)".to_owned();
    }
    let lines = adapters.iter().map(|adapter| match &adapter.shortcoming {
        Some(shortcoming) => format!("{adapter} cannot: {shortcoming}"),
        None => format!("{adapter} was not asked for"),
    });
    lines.collect::<Vec<_>>().join(", ")
}
