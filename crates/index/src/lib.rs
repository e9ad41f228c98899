//! Finding what lies where: scratches under a footprint, triangles along a ray. Trees are built by obvhs; the walk over
//! scratches is stackless, the same on the CPU and in a shader.

pub mod scratch_index;
pub mod triangle_index;

pub use scratch_index::{IndexedSegment, ObjectScratches, ScratchIndex, ScratchNode};
pub use triangle_index::{Hit, TriangleIndex};
