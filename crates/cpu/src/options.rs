//! What a renderer is asked.

use hairline_image::Batch;
use hairline_index::method::Method;

/// How to render, beside what the scene says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// Jittered samples of a pixel on an edge or a crease; all other pixels, and all of them for 1, take one through the
    /// centre.
    pub samples: u32,
    /// Which of the samples, and of the rays to each light; none: all. The pictures of all batches add up to the picture
    /// ([`hairline_image::Batches`]).
    pub batch: Option<Batch>,
    /// Whether objects hide lights and the environment from one another. `samples` rays go to each light; the method of 2018 has none.
    pub shadows: bool,
    /// How often light may go from one object to another on its way. Only with shadows: what an object hides would be counted twice.
    pub bounces: u32,
    /// By which method scratches are computed.
    pub method: Method,
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
            method: Method::default(),
        }
    }
}
