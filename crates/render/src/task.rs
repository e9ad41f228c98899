//! Settings of a rendering.

use std::sync::Arc;

use hairline_cpu::closed_form;
use hairline_document::DEFAULT_TRANSPORT;
use hairline_image::{Batches, Notes};
use hairline_optics::mask::Mask;
use hairline_scene::{Camera, Transport};

/// A method in the place of Hairline's own, on both renderers.
#[derive(Clone)]
pub struct Method {
    /// The method on the CPU.
    pub on_cpu: Arc<dyn hairline_cpu::method::ShadingMethod>,
    /// The method on the GPU.
    pub on_gpu: Arc<dyn hairline_gpu::method::ShadingMethod>,
}

/// Settings of a rendering.
#[derive(Clone)]
pub struct Task {
    /// Energy that the base loses to the scratches.
    pub mask: Mask,
    /// A method in the place of Hairline's own.
    pub method: Option<Method>,
    /// Samples of each pixel on an edge.
    pub samples: u32,
    /// The ways of light.
    pub transport: Transport,
    /// Whether the light that rays found is filtered ([`hairline_image::filter_traced`]).
    pub is_filtered: bool,
    /// Whether the picture has [`hairline_image::Image::alpha`]: nothing is seen behind surfaces then, the environment neither.
    pub is_transparent: bool,
    /// Whether a lens takes as few samples as are asked for. Else it takes so many that its points are not seen one by one.
    pub has_coarse_lens: bool,
    /// Least number of pixels in a band. Between two bands it is asked whether the work goes on. None: the picture is rendered in one piece, and
    /// the CPU asks within it, from any thread.
    pub band_px: Option<u32>,
}

/// Bounces are asked for without shadows: the light that an object hides would be counted beside its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BouncesWithoutShadows;

/// Transport of light from the user's choices, with defaults for those that are left open.
///
/// # Errors
/// [`BouncesWithoutShadows`].
pub fn transport(
    shadows: Option<bool>,
    bounces: Option<u32>,
) -> Result<Transport, BouncesWithoutShadows> {
    if !shadows.unwrap_or(DEFAULT_TRANSPORT.shadows) {
        return match bounces {
            None | Some(0) => Ok(Transport::DIRECT),
            Some(_) => Err(BouncesWithoutShadows),
        };
    }
    Ok(Transport {
        shadows: true,
        bounces: bounces.unwrap_or(DEFAULT_TRANSPORT.bounces),
    })
}

impl Task {
    /// A filtered picture by Hairline's own method, in one piece.
    pub fn new(samples: u32, transport: Transport) -> Self {
        Self {
            mask: Mask::default(),
            method: None,
            samples,
            transport,
            is_filtered: true,
            is_transparent: false,
            has_coarse_lens: false,
            band_px: None,
        }
    }

    /// Batches in which the samples of a picture add up; none where it has all of them at once.
    pub(crate) fn batches(&self, camera: &Camera) -> Option<Batches> {
        let batches = match self.has_coarse_lens && camera.has_lens() {
            true => Some(Batches::new(self.samples)),
            false => self.transport.batches(camera, self.samples),
        };
        match self.is_filtered {
            true => batches,
            false => batches.map(Batches::unfiltered),
        }
    }

    /// Options of the CPU renderer, for all samples.
    pub fn options(&self) -> closed_form::RenderOptions {
        let Transport { shadows, bounces } = self.transport;
        closed_form::RenderOptions {
            samples: self.samples,
            batch: None,
            shadows,
            bounces,
            mask: self.mask,
            method: self.method.as_ref().map(|it| it.on_cpu.clone()),
        }
    }

    pub(crate) fn method_on_gpu(&self) -> hairline_gpu::Method {
        hairline_gpu::Method {
            mask: self.mask,
            other: self.method.as_ref().map(|it| it.on_gpu.clone()),
        }
    }

    /// Notes on the settings in which the picture differs from the pure closed form. The method is left to the caller, who can name it.
    pub fn notes(&self) -> Notes {
        let Transport { shadows, bounces } = self.transport;
        let mut notes = Notes::new();
        if shadows {
            notes.insert("shadows".to_owned(), "on".to_owned());
        }
        if bounces > 0 {
            notes.insert("bounces".to_owned(), bounces.to_string());
        }
        notes
    }
}
