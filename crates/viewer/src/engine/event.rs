//! Events that the engine tells the interface.

use std::sync::Arc;

/// An event that went wrong or is worth a line, in the order of its coming.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// The description of this revision makes no scene; the last good one stays in the picture.
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

/// Callback by which the interface is told that something new is there.
pub type Wake = Arc<dyn Fn() + Send + Sync>;
