//! What rough metal reflects.

use hairline_engine::base_tables::{self, Texels};
use wasm_bindgen::prelude::wasm_bindgen;

/// A texture of `rgba32float`.
#[wasm_bindgen]
pub struct BaseTable(Texels);

#[wasm_bindgen]
impl BaseTable {
    /// Shapes of lobes.
    pub fn shapes() -> Self {
        Self(base_tables::shapes())
    }

    /// Their albedo.
    pub fn albedo() -> Self {
        Self(base_tables::albedo())
    }

    /// Curves of reflectance over the angle.
    pub fn curves() -> Self {
        Self(base_tables::curves())
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.0.size[0]
    }

    /// Four numbers a texel, row by row.
    pub fn data(&self) -> Vec<f32> {
        self.0.texels.as_flattened().to_vec()
    }
}
