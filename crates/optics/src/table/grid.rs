//! The places of a table's entries, over u and depth.

/// Columns, over u.
pub const COLUMNS: usize = 1024;
/// Rows, over depth.
pub const ROWS: usize = 512;
/// Columns and rows of the tables that other engines look up: a quarter of the memory.
pub const ENGINE_COLUMNS: usize = 512;
/// Rows over depth. Tables by incidence keep all of theirs.
pub const ENGINE_ROWS: usize = 256;
/// The u of the middle column. Columns are even in u/(u + U_HALF_UM), so that the last one lies at infinity: fine where
/// the colours are (one fringe spans about 0.5 um of u), coarse where they have blurred into the tail.
pub(crate) const U_HALF_UM: f64 = 2.0;
