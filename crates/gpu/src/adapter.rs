//! The adapters of a machine, what each can do, and the choice among them.
//!
//! Everything here is possible under WebGPU: the one optional feature that is asked for is the device's clock, which only
//! measurements miss where it is absent, and no limit above WebGPU's defaults is needed, except by scenes that outgrow one
//! buffer.

use crate::error::Error;

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
    pub(crate) handle: wgpu::Adapter,
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

    /// Whether it is reached by OpenGL, which has less than the other interfaces.
    pub(crate) fn is_opengl(&self) -> bool {
        self.backend == "gl"
    }

    pub(crate) fn usable(&self) -> Result<(), Error> {
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
pub(crate) fn shortcoming(
    limits: &wgpu::Limits,
    downlevel: &wgpu::DownlevelCapabilities,
) -> Option<String> {
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
