//! The choice of a method: Hairline's own, or that of 2018 with its switches.

use crate::cpu::OnCpu;
use crate::switches::PublishedMethod;
use hairline_cpu::method::ShadingMethod;
use hairline_optics::mask::Mask;
use std::sync::Arc;

/// The method by which scratches are rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Method {
    /// The method of 2018 with its switches; `None` is Hairline's own.
    pub published: Option<PublishedMethod>,
    /// Energy that the base loses to the scratches.
    pub mask: Mask,
}

impl Method {
    /// The published method: BVH, anti-aliasing, the fast sine integral, the density mask.
    pub const PUBLISHED: Self = Self {
        published: Some(PublishedMethod::DEFAULT),
        mask: Mask::Density,
    };

    /// The method for [`hairline_cpu::closed_form::RenderOptions::method`].
    pub fn on_cpu(&self) -> Option<Arc<dyn ShadingMethod>> {
        let published = self.published?;
        Some(Arc::new(OnCpu::new(published)))
    }

    /// The method for [`hairline_gpu::Renderer::upload`].
    pub fn on_gpu(&self) -> hairline_gpu::Method {
        hairline_gpu::Method {
            mask: self.mask,
            other: self.published.map(|published| Arc::new(published) as _),
        }
    }
}
