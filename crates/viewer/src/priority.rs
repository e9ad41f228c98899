//! Priorities of threads on one core.

#[cfg(not(target_arch = "wasm32"))]
use thread_priority::{ThreadPriority, ThreadPriorityValue, set_current_thread_priority};

/// Priority from 0 to 99: the interface, and a software driver that draws it, come first. Not so low that a busy machine would let what is
/// painted or exported starve.
#[cfg(not(target_arch = "wasm32"))]
const PRIORITY: u8 = 40;

/// Gives this thread, and those that it starts if the system hands the priority on, a lower priority than the interface's threads. A browser
/// has one thread, whose turns `progressive::in_turn` keeps short.
pub(crate) fn lower() {
    #[cfg(not(target_arch = "wasm32"))]
    if let Ok(priority) = ThreadPriorityValue::try_from(PRIORITY) {
        // If the system refuses, the interface is a little less smooth.
        let _ = set_current_thread_priority(ThreadPriority::Crossplatform(priority));
    }
}
