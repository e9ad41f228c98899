//! Compute pipelines over a scene: passes ask for theirs one by one, and all are compiled at once, on all cores. A driver takes up to a
//! second for one.

use std::sync::{Arc, OnceLock};

#[cfg(not(target_arch = "wasm32"))]
use rayon::prelude::*;

use crate::bindings::Layouts;
use crate::device::Gpu;
use crate::error::Error;
use crate::shaders;
use crate::variant::{Constant, ShadeVariant};

/// A pipeline that is compiled with the others. Clones are the same.
#[derive(Clone, Default)]
pub(crate) struct Pipeline(Arc<OnceLock<wgpu::ComputePipeline>>);

impl Pipeline {
    /// # Panics
    /// Before [`Orders::compile`] is done; nobody has a pass by then.
    pub(crate) fn get(&self) -> &wgpu::ComputePipeline {
        self.0.get().expect("passes are handed out compiled")
    }
}

/// Orders of the passes over a scene for pipelines.
pub(crate) struct Orders<'a> {
    gpu: &'a Gpu,
    layouts: &'a Layouts,
    variant: &'a ShadeVariant,
    orders: Vec<Order>,
}

struct Order {
    /// Key of everything that the pipeline is compiled of.
    key: String,
    module: &'static shaders::Module,
    entry_point: &'static str,
    group_3: wgpu::BindGroupLayout,
    more: Vec<Constant>,
    pipeline: Pipeline,
}

impl<'a> Orders<'a> {
    pub(crate) fn new(gpu: &'a Gpu, layouts: &'a Layouts, variant: &'a ShadeVariant) -> Self {
        Self {
            gpu,
            layouts,
            variant,
            orders: Vec::new(),
        }
    }

    pub(crate) fn gpu(&self) -> &'a Gpu {
        self.gpu
    }

    pub(crate) fn variant(&self) -> &'a ShadeVariant {
        self.variant
    }

    /// Requests a pipeline over the frame, the scene, its textures and `group_3`; `more` constants are added to the variant's or replace them.
    pub(crate) fn pipeline(
        &mut self,
        (module, entry_point): (&'static shaders::Module, &'static str),
        group_3: &wgpu::BindGroupLayout,
        more: &[Constant],
    ) -> Pipeline {
        let pipeline = Pipeline::default();
        let variant = self.variant;
        self.orders.push(Order {
            key: format!("{} {entry_point} {more:?} {variant:?}", module.name),
            module,
            entry_point,
            group_3: group_3.clone(),
            more: more.to_vec(),
            pipeline: pipeline.clone(),
        });
        pipeline
    }

    /// Compiles all that the device has not compiled before. Two renderers that ask for the same at once both compile.
    ///
    /// # Errors
    /// As [`compiled`], the first that was asked for before others.
    pub(crate) async fn compile(mut self) -> Result<(), Error> {
        let gpu = self.gpu;
        self.orders.retain(|order| {
            let kept = gpu.pipelines.get(&order.key);
            kept.is_none_or(|pipeline| order.pipeline.0.set(pipeline).is_err())
        });
        for verdict in self.verdicts() {
            verdict.await?;
        }
        for order in self.orders {
            gpu.pipelines.keep(order.key, order.pipeline.get());
        }
        Ok(())
    }

    /// A browser has one thread, and compiles while it goes on. OpenGL has one context, and the graphics library panics where another
    /// thread holds it for a second or so.
    fn verdicts(&self) -> Vec<impl Future<Output = Result<(), Error>>> {
        let compile = |order: &Order| {
            let scopes = ErrorScopes::open(self.gpu);
            // Nobody else sets it.
            order.pipeline.0.set(self.create(order)).ok();
            scopes.verdict()
        };
        #[cfg(not(target_arch = "wasm32"))]
        if !self.gpu.adapter.is_opengl() {
            return self.orders.par_iter().map(compile).collect();
        }
        self.orders.iter().map(compile).collect()
    }

    fn create(&self, order: &Order) -> wgpu::ComputePipeline {
        let Self { gpu, layouts, .. } = self;
        let mut constants = self.variant.constants(order.module);
        constants.retain(|(name, _)| order.more.iter().all(|(other, _)| other != name));
        constants.extend(&order.more);
        let label = Some(order.module.name);
        let shader = shader(gpu, order.module);
        let groups = [
            &layouts.frame,
            &layouts.scene,
            &layouts.textures,
            &order.group_3,
        ];
        let layout = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &groups.map(Some),
                immediate_size: 0,
            });
        gpu.device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label,
                layout: Some(&layout),
                module: &shader,
                entry_point: Some(order.entry_point),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..Default::default()
                },
                cache: None,
            })
    }
}

/// A module with those that it needs.
pub(crate) fn shader(gpu: &Gpu, module: &'static shaders::Module) -> wgpu::ShaderModule {
    let text = shaders::compose(&[module]);
    gpu.device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(module.name),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        })
}

/// A compute pipeline whose only group has the bindings that its entry point uses.
pub(crate) fn alone(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    entry_point: &str,
) -> wgpu::ComputePipeline {
    gpu.device
        .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry_point),
            layout: None,
            module,
            entry_point: Some(entry_point),
            compilation_options: Default::default(),
            cache: None,
        })
}

/// Returns what `create` compiles, or the reason why the driver or the shader's own rules refuse it.
pub(crate) async fn compiled<T>(gpu: &Gpu, create: impl FnOnce() -> T) -> Result<T, Error> {
    let scopes = ErrorScopes::open(gpu);
    let created = create();
    scopes.verdict().await?;
    Ok(created)
}

/// Scopes that catch the errors of pipelines on this thread.
struct ErrorScopes<'a> {
    gpu: &'a Gpu,
    library: wgpu::ErrorScopeGuard,
    driver: wgpu::ErrorScopeGuard,
}

impl<'a> ErrorScopes<'a> {
    fn open(gpu: &'a Gpu) -> Self {
        Self {
            gpu,
            library: gpu.device.push_error_scope(wgpu::ErrorFilter::Validation),
            driver: gpu.device.push_error_scope(wgpu::ErrorFilter::Internal),
        }
    }

    /// Whether all that was created meanwhile may be used. What comes later is not heard, whenever this is awaited.
    fn verdict(self) -> impl Future<Output = Result<(), Error>> {
        let (driver, library) = (self.driver.pop(), self.library.pop());
        let gpu = self.gpu;
        async move {
            let (driver, library) = (driver.await, library.await);
            // A lost device refuses everything; that it is lost says more.
            gpu.check()?;
            if let Some(error) = driver {
                return Err(Error::Refused {
                    adapter: gpu.adapter.name.clone(),
                    reason: error.to_string(),
                });
            }
            if let Some(error) = library {
                return Err(Error::Validation {
                    description: error.to_string(),
                });
            }
            Ok(())
        }
    }
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
