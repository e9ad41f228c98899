//! Features of the platform. In a browser, a command that needs a missing feature is in no menu and has no key.

/// Whether paths lead to files that other programs read and write. Not in a browser: there the viewer holds the files that the page was
/// given, and hands out those that it writes.
pub(crate) const HAS_DISK: bool = cfg!(not(target_arch = "wasm32"));

/// Whether work goes on beside the interface. Not in a browser: there the progressive renderer works in turn with it.
pub(crate) const HAS_THREADS: bool = cfg!(not(target_arch = "wasm32"));

/// Whether the window is in a page, which has a gallery of scenes and an address.
pub(crate) const HAS_PAGE: bool = cfg!(target_arch = "wasm32");

/// Shows the page's gallery of scenes.
pub(crate) fn show_gallery() {
    #[cfg(target_arch = "wasm32")]
    crate::script::gallery();
}

/// The address of the page, without a fragment; none where there is no page.
pub(crate) fn page_address() -> Option<String> {
    #[cfg(target_arch = "wasm32")]
    return crate::script::address();
    #[cfg(not(target_arch = "wasm32"))]
    None
}
