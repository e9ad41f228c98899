//! Spectra of scratches, as the texture that shaders look them up in.

use hairline_optics::metal::Metal;
use hairline_optics::section::GrooveShape;
use hairline_optics::table::{ENGINE_COLUMNS, ScratchTable};

/// The table of a metal's grooves of a shape: [`ENGINE_COLUMNS`] columns of `rgba32uint`, and two or more rows, as many as
/// [`ScratchTexels::table_rows`](crate::ScratchTexels::table_rows) says. Without a metal it is that of grooves in a coat, or in a metal given by its
/// colour. Takes less than a tenth of a second for narrow rectangles of 240 nm, a fifth of one for other sections.
pub fn scratch_table(metal: Option<Metal>, shape: &GrooveShape, rows: usize) -> Vec<[u32; 4]> {
    let reflectance = |nm| metal.map_or(1.0, |metal| metal.reflectance(1.0, nm));
    ScratchTable::first_rows(rows, shape, reflectance).resampled(ENGINE_COLUMNS, rows)
}
