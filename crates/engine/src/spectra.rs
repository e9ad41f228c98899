//! Spectra of scratches, as the texture that shaders look them up in.

use hairline_optics::metal::Metal;
use hairline_optics::section::GrooveShape;
use hairline_optics::table::{ENGINE_COLUMNS, ENGINE_ROWS, ScratchTable};

/// The table of a metal's grooves of a shape: [`ENGINE_COLUMNS`] x [`ENGINE_ROWS`] texels of `rgba32uint`. Without a metal it is that of grooves in a
/// coat, or in a metal given by its colour. Takes some tenths of a second.
pub fn scratch_table(metal: Option<Metal>, shape: &GrooveShape) -> Vec<[u32; 4]> {
    let reflectance = |nm| metal.map_or(1.0, |metal| metal.reflectance(1.0, nm));
    ScratchTable::of_shape(shape, reflectance).resampled(ENGINE_COLUMNS, ENGINE_ROWS)
}
