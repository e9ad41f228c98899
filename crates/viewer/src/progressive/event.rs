//! Events of the renderer for the interface.

use std::sync::Arc;

/// A failure or a note, in the order of time.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// The description of this revision makes no scene; the last good scene stays in the picture.
    NotBuilt {
        /// Revision of the description.
        revision: u64,
        /// Message with the key, the mistake and the right form.
        message: String,
    },
    /// The device was lost or refused the scene; the CPU paints from now on.
    FellBack {
        /// Message of the device.
        message: String,
    },
    /// A device that was lost is back.
    Recovered,
    /// A thread panicked, by a mistake of the program's. It goes on with the next change of the view or the scene.
    Panicked {
        /// Name of the work.
        what: &'static str,
        /// Message of the panic.
        message: String,
    },
}

/// Callback that wakes the interface when there is something new.
pub type Wake = Arc<dyn Fn() + Send + Sync>;
