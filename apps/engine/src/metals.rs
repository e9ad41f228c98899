//! Metals, and the spectra of their scratches.

use hairline_document::description::Scratches;
use hairline_engine::{base_tables, scratch_table as table};
use hairline_optics::metal::Metal;
use hairline_optics::section::GrooveShape;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::{parsed, thrown};

pub(crate) fn metal_of(name: &str) -> Result<Metal, JsError> {
    let named = Metal::NAMED.iter().find(|(known, _)| *known == name);
    named.map(|(_, metal)| *metal).ok_or_else(|| {
        let all = Metal::NAMES.join(", ");
        let right = format!("must be one of {all}, or null for a colour");
        JsError::new(&format!("metal: found \"{name}\"; {right}"))
    })
}

/// Reflectance of a metal at normal incidence, linear Rec.709.
///
/// # Errors
/// A metal that is not known.
#[wasm_bindgen(js_name = metalColor)]
pub fn metal_color(name: &str) -> Result<Vec<f64>, JsError> {
    Ok(metal_of(name)?.reflectance_rgb(1.0).to_vec())
}

/// The curve of a metal among those of the base, or of one given by its colour.
///
/// # Errors
/// A metal that is not known.
#[wasm_bindgen(js_name = curveOf)]
pub fn curve_of(metal: Option<String>) -> Result<u32, JsError> {
    let metal = metal.map(|name| metal_of(&name)).transpose()?;
    Ok(base_tables::curve_of(metal))
}

/// The curve of a dielectric of a refractive index among those of the base.
#[wasm_bindgen(js_name = dielectricCurve)]
pub fn dielectric_curve(ior: f64) -> u32 {
    base_tables::dielectric_curve(ior)
}

/// Texels of the table of grooves in a metal, or in one given by its colour. `profile` is the key of a layer, as JSON; of `rows` see `Tree`.
///
/// # Errors
/// A metal or a cross section that is not known.
#[wasm_bindgen(js_name = scratchTable)]
pub fn scratch_table(
    metal: Option<String>,
    profile: &str,
    width_class: u8,
    rows: usize,
) -> Result<Vec<u32>, JsError> {
    let metal = metal.map(|name| metal_of(&name)).transpose()?;
    let shape = GrooveShape {
        section: Scratches::section_from_json(Some(parsed(profile)?)).map_err(thrown)?,
        width_class,
    };
    Ok(table(metal, &shape, rows).into_flattened())
}
