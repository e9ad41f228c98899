//! Quiet graphics drivers.

/// Mesa's Vulkan drivers look for a Wayland display, and complain on stderr on machines that have none. With a folder
/// to look in, they find nothing there and are quiet.
///
/// Call it first in `main`, while there is one thread.
pub fn quiet_the_search_for_wayland() {
    if cfg!(target_os = "linux") && std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        #[expect(unsafe_code, reason = "sound at the start, while there is one thread")]
        unsafe {
            std::env::set_var("XDG_RUNTIME_DIR", "/nonexistent");
        }
    }
}
