//! Limit on the size of a picture.

/// Largest width and height, the same as in scene files.
pub const SIDE_MAX_PX: u32 = 16384;
