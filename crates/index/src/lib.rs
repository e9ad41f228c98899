//! Finding what lies where: scratches under a footprint, triangles along a ray. Trees are built by obvhs; the walk over
//! scratches is stackless, the same on the CPU and in a shader.

mod depth_spread;
pub mod groove_index;
mod layer_runs;
pub mod scratch_index;
pub mod segment_tree;
pub mod triangle_beam;
pub mod triangle_index;
pub mod triangle_lists;
pub mod watch;

pub use groove_index::Groove;
pub use scratch_index::{IndexedSegment, ScratchIndex};
pub use segment_tree::{ScratchNode, SegmentTree};
pub use triangle_beam::TriangleBeam;
pub use triangle_index::{Hit, TriangleIndex};
pub use triangle_lists::TriangleLists;
pub use watch::Watch;
