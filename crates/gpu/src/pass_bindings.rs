//! What each pass binds in group 3, as a struct with a field for each resource that its shader declares. The build script makes them of the shaders.

use std::marker::PhantomData;

use wgpu::{BindingResource, BufferBinding, BufferSize};

use crate::shaders::{self, Module};

/// The bindings of a pass.
pub(crate) trait PassBindings {
    /// The same with other lifetimes: a pass outlives what it binds.
    type With<'a>;

    fn entries<'a>(bound: &Self::With<'a>) -> Vec<wgpu::BindGroupEntry<'a>>;
}

/// An entry point of a shader with the bindings `B`.
pub(crate) struct EntryPoint<B> {
    pub module: &'static Module,
    pub name: &'static str,
    bindings: PhantomData<B>,
}

impl<B> Clone for EntryPoint<B> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<B> Copy for EntryPoint<B> {}

impl<B> EntryPoint<B> {
    pub(crate) const fn new(module: &'static Module, name: &'static str) -> Self {
        Self {
            module,
            name,
            bindings: PhantomData,
        }
    }
}

/// Bindings of the pass of another method: its tables follow the arrays of samples.
pub(crate) struct WithTables<'a> {
    pub arrays: OtherMethod<'a>,
    pub tables: &'a [wgpu::TextureView],
}

impl PassBindings for WithTables<'static> {
    type With<'a> = WithTables<'a>;

    fn entries<'a>(bound: &Self::With<'a>) -> Vec<wgpu::BindGroupEntry<'a>> {
        let mut entries = OtherMethod::entries(&bound.arrays);
        let first = entries.len() as u32;
        let tables = (first..).zip(bound.tables);
        entries.extend(tables.map(|(binding, table)| wgpu::BindGroupEntry {
            binding,
            resource: BindingResource::TextureView(table),
        }));
        entries
    }
}

/// The first part of a buffer of uniforms: dispatches move on from there.
fn part(buffer: &wgpu::Buffer, bytes: u64) -> BindingResource<'_> {
    BindingResource::Buffer(BufferBinding {
        buffer,
        offset: 0,
        size: BufferSize::new(bytes),
    })
}

include!(concat!(env!("OUT_DIR"), "/passes.rs"));
