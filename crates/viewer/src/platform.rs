//! What this platform has. In a browser a command that needs what is not there is in no menu and has no key.

/// Whether paths lead to files, by dialogs of the system or by a line in the window. Not in a browser.
pub(crate) const HAS_FILES: bool = cfg!(not(target_arch = "wasm32"));

/// Whether work goes on beside the interface. Not in a browser: there the engine works in turn with it.
pub(crate) const HAS_THREADS: bool = cfg!(not(target_arch = "wasm32"));
