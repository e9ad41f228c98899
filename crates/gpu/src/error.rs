//! Errors on the way to a picture from the GPU, in words for the person who waits for it.

/// A failure of the GPU renderer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// No adapter of this machine can render.
    #[error("no graphics driver can render here: {found}")]
    NoAdapter {
        /// Description of the adapters that were found.
        found: String,
    },
    /// The adapter refused to open a device, or its driver to compile a shader.
    #[error("{adapter} cannot render: {reason}")]
    Refused {
        /// Name of the adapter.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// The device went away: unplugged, reset by the system after a command that ran too long, or destroyed.
    #[error("the graphics device was lost: {reason}")]
    Lost {
        /// The driver's words.
        reason: String,
    },
    /// The device has no room left.
    #[error("{adapter} is out of memory at {what} ({needed_bytes} bytes)")]
    OutOfMemory {
        /// Name of the adapter.
        adapter: String,
        /// Name of the data to be stored.
        what: String,
        /// Size of the data, bytes; 0 where the driver did not say which allocation failed.
        needed_bytes: u64,
    },
    /// Something is larger than the adapter can ever hold in one piece.
    #[error("{what}: {needed} {unit}, but {adapter} allows {allowed}")]
    TooLarge {
        /// Name of the thing that is too large.
        what: String,
        /// Size that is needed.
        needed: u64,
        /// Largest size that is allowed.
        allowed: u64,
        /// Unit of both sizes.
        unit: &'static str,
        /// Name of the adapter.
        adapter: String,
    },
    /// A shader gave up a loop before its end, so that the picture would be wrong.
    #[error(
        "{adapter} cut the loops of {pixels} pixels short, so their picture would be wrong; render with fewer lights, or on \
         the CPU"
    )]
    IterationBudget {
        /// Name of the adapter.
        adapter: String,
        /// Shader invocations that gave up.
        pixels: u32,
    },
    /// A canvas lacks steps for which the device had too little memory: [`crate::Renderer::settle`] does them again.
    #[error("the picture lacks steps, since it was read before it was settled")]
    Unsettled,
    /// The graphics library refused a call: a mistake in this crate.
    #[error("the graphics library refused a call (a mistake in Hairline): {description}")]
    Validation {
        /// The library's words.
        description: String,
    },
}
