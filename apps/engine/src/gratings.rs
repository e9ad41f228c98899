//! Rows of grooves, and the tables of what they send.

use hairline_engine::GratingTexels;
use hairline_scene::description::Grating;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::metals::metal_of;
use crate::{parsed, thrown};

/// A grating on a mesh.
#[wasm_bindgen]
pub struct LaidGrating(GratingTexels);

#[wasm_bindgen]
impl LaidGrating {
    /// The sixteen numbers of `Grooves` of grated_surface.wgsl.
    pub fn numbers(&self) -> Vec<f32> {
        self.0.numbers.to_vec()
    }

    /// Texels of its table, four words each.
    pub fn texels(&self) -> Vec<u32> {
        self.0.texels.as_flattened().to_vec()
    }
}

/// Makes the gratings of a mesh in metres. `rows` is JSON, rows with the keys of `[[grating]]`.
///
/// # Errors
/// What is wrong with a row; one that follows pictures, texture coordinates or spots.
#[wasm_bindgen(js_name = layGratings)]
pub fn lay_gratings(
    rows: &str,
    metal: Option<String>,
    coherence_um: f64,
) -> Result<Vec<LaidGrating>, JsError> {
    let metal = metal.map(|name| metal_of(&name)).transpose()?;
    let rows = Grating::from_json(parsed(rows)?).map_err(thrown)?;
    let laid = GratingTexels::lay(&rows, metal, coherence_um).map_err(thrown)?;
    let laid = (0..).zip(laid).map(|(i, grating)| {
        let found =
            format!("grating[{i}]: found one in spots, by texture coordinates or with a mask");
        let made = grating.map(LaidGrating);
        made.ok_or_else(|| {
            JsError::new(&format!(
                "{found}; must lie along a direction or about an axis"
            ))
        })
    });
    laid.collect()
}
