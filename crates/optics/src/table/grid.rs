//! The places of a table's entries, over u and depth.

use crate::scratch::DEPTH_MAX_NM;

/// Columns, over u.
pub const COLUMNS: usize = 1024;
/// Rows, over depth.
pub const ROWS: usize = 512;
/// Columns of the tables that other engines look up. Their rows end at the deepest groove.
pub const ENGINE_COLUMNS: usize = 512;
/// Most rows over depth of a grating's table as other engines look it up; tables by incidence keep all [`ROWS`].
pub const ENGINE_GRATING_ROWS: usize = 256;
/// Rows for each nanometre of depth; the first row is depth 0.
pub(super) const ROWS_PER_NM: f64 = (ROWS - 1) as f64 / DEPTH_MAX_NM;
/// The u of the middle column. Columns are even in u/(u + U_HALF_UM), so that the last one lies at infinity: fine where
/// the colours are (one fringe spans about 0.5 um of u), coarse where they have blurred into the tail.
pub(crate) const U_HALF_UM: f64 = 2.0;

/// Rows of a table that holds all depths down to this one.
pub fn rows_down_to(depth_nm: f64) -> usize {
    ((depth_nm * ROWS_PER_NM).ceil() as usize + 1).clamp(2, ROWS)
}

/// Depth of the last of so many rows.
pub fn last_depth_nm(rows: usize) -> f64 {
    (rows - 1) as f64 / ROWS_PER_NM
}
