//! Set-up: which adapters there are, which one renders, and the device on it.
//!
//! Everything here is possible under WebGPU: the one optional feature that is asked for is the device's clock, which only
//! measurements miss where it is absent, and no limit above WebGPU's defaults is needed, except by scenes that outgrow one
//! buffer.

use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, Mutex, OnceLock};

use crate::error::Error;
use crate::pipeline_cache::PipelineCache;

/// Kind of machine behind an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum AdapterKind {
    /// A GPU with its own memory.
    Discrete,
    /// A GPU that shares memory with the CPU.
    Integrated,
    /// A GPU lent to a virtual machine.
    Virtual,
    /// The driver does not say.
    Unknown,
    /// A driver that computes on the CPU, such as lavapipe.
    Software,
}

/// An adapter and its properties.
#[derive(Clone, Debug)]
pub struct Adapter {
    /// The driver's name for it.
    pub name: String,
    /// Kind of the adapter.
    pub kind: AdapterKind,
    /// The interface it is reached by: "vulkan", "metal", "dx12", "gl".
    pub backend: String,
    /// Driver and version, as far as known.
    pub driver: String,
    /// The largest array that a shader can see in one piece, bytes.
    pub max_storage_binding_bytes: u64,
    /// The largest picture side, pixels.
    pub max_texture_px: u32,
    /// Reason why it cannot render, if it cannot.
    pub shortcoming: Option<String>,
    handle: wgpu::Adapter,
}

/// Choice among the adapters.
#[derive(Clone, Debug, Default)]
pub struct AdapterRequest {
    /// Hardware or software.
    pub kind: KindRequest,
    /// Part of the adapter's name, any case.
    pub name: Option<String>,
    /// Stay within WebGPU's default limits even if the adapter allows more, as a browser would.
    pub default_limits: bool,
}

/// Kinds of adapters to consider.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum KindRequest {
    /// A GPU if there is one, else a software driver.
    #[default]
    Any,
    /// GPUs only.
    Hardware,
    /// Software drivers only.
    Software,
}

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

impl AdapterKind {
    /// One word for people.
    pub fn label(self) -> &'static str {
        match self {
            Self::Discrete => "discrete GPU",
            Self::Integrated => "integrated GPU",
            Self::Virtual => "virtual GPU",
            Self::Unknown => "adapter of unknown kind",
            Self::Software => "software",
        }
    }
}

impl std::fmt::Display for Adapter {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            out,
            "{} ({}, {}",
            self.name,
            self.kind.label(),
            self.backend
        )?;
        if !self.driver.is_empty() {
            write!(out, ", {}", self.driver)?;
        }
        write!(out, ")")
    }
}

/// Lists the adapters of this machine, the preferred ones first. In a browser: the one that it lends.
///
/// GL is asked only where nothing newer reaches a GPU: the same card is nearly always there by a newer interface too, with
/// less overhead. The environment variable `WGPU_BACKEND` narrows the choice ("vulkan", "gl", ...).
pub(crate) async fn adapters() -> Vec<Adapter> {
    let mut adapters = adapters_by(!wgpu::Backends::GL).await;
    if adapters
        .iter()
        .all(|a| a.kind == AdapterKind::Software || a.shortcoming.is_some())
    {
        adapters.extend(adapters_by(wgpu::Backends::GL).await);
    }
    adapters.sort_by_key(|adapter| (adapter.kind, adapter.is_opengl()));
    adapters
}

/// The adapters that these of the environment's interfaces reach.
async fn adapters_by(backends: wgpu::Backends) -> Vec<Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.backends &= backends;
    if descriptor.backends.is_empty() {
        return Vec::new();
    }
    let instance = wgpu::Instance::new(descriptor);
    #[cfg(not(target_arch = "wasm32"))]
    let found = instance.enumerate_adapters(wgpu::Backends::all()).await;
    #[cfg(target_arch = "wasm32")]
    let found = instance
        .request_adapter(&Default::default())
        .await
        .into_iter()
        .collect::<Vec<_>>();
    found.into_iter().map(Adapter::new).collect()
}

impl Adapter {
    /// Describes an adapter, for a window that had to choose by its surface.
    pub fn new(handle: wgpu::Adapter) -> Self {
        let info = handle.get_info();
        let limits = handle.limits();
        let kind = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => AdapterKind::Discrete,
            wgpu::DeviceType::IntegratedGpu => AdapterKind::Integrated,
            wgpu::DeviceType::VirtualGpu => AdapterKind::Virtual,
            wgpu::DeviceType::Other => AdapterKind::Unknown,
            wgpu::DeviceType::Cpu => AdapterKind::Software,
        };
        let driver = [info.driver.as_str(), info.driver_info.as_str()]
            .into_iter()
            .filter(|s| !s.is_empty());
        Self {
            // Browsers keep it to themselves.
            name: match info.name.is_empty() {
                true => "unnamed GPU".to_owned(),
                false => info.name,
            },
            kind,
            backend: info.backend.to_string(),
            driver: driver.collect::<Vec<_>>().join(" "),
            max_storage_binding_bytes: limits.max_storage_buffer_binding_size,
            max_texture_px: limits.max_texture_dimension_2d,
            shortcoming: shortcoming(&limits, &handle.get_downlevel_capabilities()),
            handle,
        }
    }

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

    /// Descriptor with which a device must be opened to render: no more than WebGPU's default limits if `default_limits`, else with the
    /// largest buffers that the adapter has; and the device's clock, if it has one.
    pub fn device_descriptor(&self, default_limits: bool) -> wgpu::DeviceDescriptor<'static> {
        wgpu::DeviceDescriptor {
            label: Some("hairline"),
            required_features: self.handle.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: if default_limits {
                wgpu::Limits::defaults()
            } else {
                raised_limits(&self.handle.limits())
            },
            ..Default::default()
        }
    }
}

impl Adapter {
    /// Whether it is reached by OpenGL, which has less than the other interfaces.
    pub(crate) fn is_opengl(&self) -> bool {
        self.backend == "gl"
    }

    fn usable(&self) -> Result<(), Error> {
        match &self.shortcoming {
            None => Ok(()),
            Some(shortcoming) => Err(Error::Refused {
                adapter: self.name.clone(),
                reason: shortcoming.clone(),
            }),
        }
    }
}

/// Reason why an adapter cannot render: a limit below WebGPU's defaults, or no compute shaders.
fn shortcoming(limits: &wgpu::Limits, downlevel: &wgpu::DownlevelCapabilities) -> Option<String> {
    let mut missing = Vec::new();
    wgpu::Limits::defaults().check_limits_with_fail_fn(limits, false, |name, needed, allowed| {
        missing.push(format!("{name} is {allowed}, not {needed}"));
    });
    for (flag, name) in [
        (wgpu::DownlevelFlags::COMPUTE_SHADERS, "compute shaders"),
        (
            wgpu::DownlevelFlags::VERTEX_STORAGE,
            "storage buffers in vertex shaders",
        ),
    ] {
        if !downlevel.flags.contains(flag) {
            missing.push(format!("it has no {name}"));
        }
    }
    (!missing.is_empty()).then(|| missing.join("; "))
}

/// WebGPU's default limits, with larger buffers, since a large scene outgrows the default sizes.
fn raised_limits(allowed: &wgpu::Limits) -> wgpu::Limits {
    wgpu::Limits {
        max_buffer_size: allowed.max_buffer_size,
        max_storage_buffer_binding_size: allowed.max_storage_buffer_binding_size,
        ..wgpu::Limits::defaults()
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

/// Errors that no scope caught, kept until they are taken. Without a handler the graphics library would panic.
#[derive(Clone, Default)]
struct Faults {
    first: Arc<Mutex<Option<Error>>>,
    /// Listener that is told at once when the device is lost.
    on_lost: Arc<OnceLock<LossListener>>,
}

type LossListener = Box<dyn Fn(&str) + Send + Sync>;

impl Faults {
    fn watch(&self, device: &wgpu::Device, adapter: &str) {
        let (faults, adapter) = (self.clone(), adapter.to_owned());
        device.on_uncaptured_error(Arc::new(move |error| {
            faults.record(match error {
                wgpu::Error::OutOfMemory { .. } => Error::OutOfMemory {
                    adapter: adapter.clone(),
                    what: "a command".to_owned(),
                    needed_bytes: 0,
                },
                wgpu::Error::Validation { description, .. }
                | wgpu::Error::Internal { description, .. } => Error::Validation { description },
            });
        }));
        let faults = self.clone();
        device.set_device_lost_callback(move |reason, message| {
            let reason = if message.is_empty() {
                format!("{reason:?}").to_lowercase()
            } else {
                message
            };
            if let Some(tell) = faults.on_lost.get() {
                tell(&reason);
            }
            faults.record(Error::Lost { reason });
        });
    }

    /// The first error is the cause, later ones follow from it; but a lost device explains everything.
    fn record(&self, error: Error) {
        let mut slot = self
            .first
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        if slot.is_none() || matches!(error, Error::Lost { .. }) {
            *slot = Some(error);
        }
    }

    fn take(&self) -> Result<(), Error> {
        let mut slot = self
            .first
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        match &*slot {
            Some(Error::Lost { .. }) => Err(slot.clone().expect("matched above")),
            Some(_) => Err(slot.take().expect("matched above")),
            None => Ok(()),
        }
    }
}
