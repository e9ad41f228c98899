//! Functions of the page's own script for the viewer, in its object `hairlinePage`.

use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

mod js {
    use super::{JsValue, wasm_bindgen};

    #[wasm_bindgen]
    extern "C" {
        #[wasm_bindgen(catch, js_namespace = hairlinePage)]
        pub(super) fn gallery() -> Result<(), JsValue>;
        #[wasm_bindgen(catch, js_namespace = hairlinePage)]
        pub(super) fn pick(endings: &str) -> Result<(), JsValue>;
        #[wasm_bindgen(catch, js_namespace = hairlinePage)]
        pub(super) fn save(name: &str, bytes: &[u8]) -> Result<(), JsValue>;
    }
}

/// Shows the gallery of scenes. A page without a script has none.
pub(crate) fn gallery() {
    let _ = js::gallery();
}

/// Asks for files to be read, of these endings, between commas.
pub(crate) fn pick(endings: &str) {
    let _ = js::pick(endings);
}

/// Hands out a file.
pub(crate) fn save(name: &str, bytes: &[u8]) {
    let _ = js::save(name, bytes);
}

/// The page's address, without a fragment.
pub(crate) fn address() -> Option<String> {
    let address = web_sys::window()?.location().href().ok()?;
    let whole = address.split('#').next()?;
    Some(whole.to_owned())
}
