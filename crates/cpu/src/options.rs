//! Options of a rendering.

use crate::method::ShadingMethod;
use hairline_image::Batch;
use hairline_optics::mask::Mask;
use std::sync::Arc;

/// Options of a rendering besides the scene.
#[derive(Clone)]
pub struct RenderOptions {
    /// Jittered samples of a pixel on an edge or a crease; all other pixels, and all of them for 1, take one through the
    /// centre.
    pub samples: u32,
    /// Range of the samples, and of the rays to each light; none: all. The pictures of all batches add up to the picture
    /// ([`hairline_image::Batches`]).
    pub batch: Option<Batch>,
    /// Whether objects hide lights and the environment from one another. `samples` rays go to each light. Only for Hairline's own
    /// method.
    pub shadows: bool,
    /// Largest number of other objects on a path of light. Only with shadows: without them, the light that an object hides would be
    /// counted twice.
    pub bounces: u32,
    /// Energy that the base loses to the scratches.
    pub mask: Mask,
    /// A method in the place of Hairline's own.
    pub method: Option<Arc<dyn ShadingMethod>>,
}

impl RenderOptions {
    /// The samples to be taken, of all.
    pub(crate) fn batch(&self) -> Batch {
        self.batch.unwrap_or(Batch::all(self.samples.max(1)))
    }
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            samples: 1,
            batch: None,
            shadows: false,
            bounces: 0,
            mask: Mask::default(),
            method: None,
        }
    }
}
