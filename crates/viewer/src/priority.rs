//! Who goes first where threads want the same core.

#[cfg(not(target_arch = "wasm32"))]
use thread_priority::{ThreadPriority, ThreadPriorityValue, set_current_thread_priority};

/// Priority from 0 to 99: the interface, and a software driver that draws it, come first. Not so low that a busy machine would let what is
/// painted or exported starve.
#[cfg(not(target_arch = "wasm32"))]
const PRIORITY: u8 = 40;

/// Lets the interface's threads go before this one, and before those that it starts, where the system hands the priority on. A browser has one
/// thread, whose turns `engine::in_turn` keeps short.
pub(crate) fn lower() {
    #[cfg(not(target_arch = "wasm32"))]
    if let Ok(priority) = ThreadPriorityValue::try_from(PRIORITY) {
        // Where the system refuses, the interface is a little less smooth.
        let _ = set_current_thread_priority(ThreadPriority::Crossplatform(priority));
    }
}
