//! Rows of grooves, and the tables of what they send.

use hairline_document::{description, object_of_gratings};
use hairline_engine::LaidGrating;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::metals::metal_of;
use crate::{parsed, thrown};

/// A grating on a mesh.
#[wasm_bindgen]
pub struct Grooves(LaidGrating);

#[wasm_bindgen]
impl Grooves {
    /// Where they run which way: `kind` of HAIRLINE_scratches.
    pub fn kind(&self) -> String {
        self.0.field.kind.to_owned()
    }

    /// Direction or axis, centre in metres, least and greatest radius in metres, curvature, coverage, standard deviation of angles: eleven numbers.
    pub fn numbers(&self) -> Vec<f64> {
        let field = &self.0.field;
        let more = [field.curvature_per_m, field.coverage, field.angle_std_rad];
        [&field.axis[..], &field.center_m, &field.radii_m, &more].concat()
    }

    /// Texels of the table, four words each.
    pub fn texels(&self) -> Vec<u32> {
        self.0.texels.as_flattened().to_vec()
    }
}

/// Makes the gratings of a mesh in metres. `rows` is JSON, rows with the keys of `[[grating]]`, without pictures.
///
/// # Errors
/// What is wrong with a row; grooves in spots.
#[wasm_bindgen(js_name = layGratings)]
pub fn lay_gratings(
    rows: &str,
    metal: Option<String>,
    coherence_um: f64,
) -> Result<Vec<Grooves>, JsError> {
    let metal = metal.map(|name| metal_of(&name)).transpose()?;
    let rows = description::Grating::from_json(parsed(rows)?).map_err(thrown)?;
    let laid = LaidGrating::of_object(object_of_gratings(&rows), metal, coherence_um);
    let laid = (0..).zip(laid).map(|(i, grating)| {
        let made = grating.map(Grooves);
        made.ok_or_else(|| {
            let right = "must lie along a direction or texture coordinates, or about an axis";
            JsError::new(&format!("grating[{i}].pattern: found spots; {right}"))
        })
    });
    laid.collect()
}
