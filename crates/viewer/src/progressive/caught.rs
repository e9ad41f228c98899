//! A panic in a thread of the renderer: told in the window, not a picture that stands still in silence.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::Event;
use super::request::Shared;

/// Returns the result of `work`. None if it panicked, which is told: the caller drops what the work may have left
/// half done.
pub(super) fn caught<T>(
    shared: &Shared,
    what: &'static str,
    work: impl FnOnce() -> T,
) -> Option<T> {
    catch_unwind(AssertUnwindSafe(work))
        .inspect_err(|panic| {
            shared.put_event(Event::Panicked {
                what,
                message: message(panic.as_ref()).to_owned(),
            });
        })
        .ok()
}

fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no reason is known")
}
