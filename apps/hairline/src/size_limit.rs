//! How large a picture may be.

/// As scene files allow.
pub const SIDE_MAX_PX: u32 = 16384;
