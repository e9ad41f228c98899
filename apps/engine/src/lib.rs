//! What the package for other engines computes on the processor, by Hairline's own code: scratches on meshes, the textures that shaders look up, maps of
//! environments. `cargo xtask package` puts it beside packages/hairline-shaders, which calls it.
#![cfg(target_arch = "wasm32")]

mod base_tables;
mod gratings;
mod maps;
mod metals;
mod scratches;

use serde_json::Value;
use wasm_bindgen::JsError;

/// An error as JavaScript throws it.
fn thrown(error: impl std::error::Error) -> JsError {
    JsError::new(&error.to_string())
}

fn parsed(text: &str) -> Result<Value, JsError> {
    serde_json::from_str(text).map_err(|error| JsError::new(&error.to_string()))
}
