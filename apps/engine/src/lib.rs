//! What the package for other engines computes on the processor, by Hairline's own code: scratches on meshes, the textures that shaders look up, maps of
//! environments. `cargo xtask package` puts it beside packages/hairline-shaders, which calls it.
#![cfg(target_arch = "wasm32")]

mod base_tables;
mod maps;
mod metals;
mod scratches;

use hairline_optics::section::Section;
use hairline_scene::Error;
use hairline_scene::description::Scratches;
use serde_json::{Value, json};
use wasm_bindgen::JsError;

/// An error as JavaScript throws it.
fn thrown(error: Error) -> JsError {
    JsError::new(&error.to_string())
}

fn parsed(text: &str) -> Result<Value, JsError> {
    serde_json::from_str(text).map_err(|error| JsError::new(&error.to_string()))
}

/// The cross section that the key `profile` of a layer has.
fn section(profile: Value) -> Result<Section, JsError> {
    let layer = json!({ "object": "mesh", "pattern": "random", "count": 1, "profile": profile });
    let mut layers = Scratches::from_json(json!([layer])).map_err(thrown)?;
    Ok(layers.remove(0).profile)
}
