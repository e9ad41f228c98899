//! Buffers and textures by the names that shaders declare them under.

use wgpu::BindingResource;

/// What passes may bind. The last one of a name counts.
#[derive(Clone, Default)]
pub(crate) struct Resources(Vec<(&'static str, Resource)>);

#[derive(Clone)]
enum Resource {
    Buffer(wgpu::Buffer),
    Texture(wgpu::TextureView),
}

impl Resources {
    #[must_use]
    pub(crate) fn buffer(mut self, name: &'static str, buffer: &wgpu::Buffer) -> Self {
        self.0.push((name, Resource::Buffer(buffer.clone())));
        self
    }

    #[must_use]
    pub(crate) fn texture(mut self, name: &'static str, view: &wgpu::TextureView) -> Self {
        self.0.push((name, Resource::Texture(view.clone())));
        self
    }

    /// Adds all of another set.
    #[must_use]
    pub(crate) fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    pub(crate) fn get(&self, name: &str) -> Option<BindingResource<'_>> {
        let (_, found) = self.0.iter().rev().find(|(own, _)| *own == name)?;
        Some(match found {
            Resource::Buffer(buffer) => buffer.as_entire_binding(),
            Resource::Texture(view) => BindingResource::TextureView(view),
        })
    }
}
