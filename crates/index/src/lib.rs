//! Spatial look-ups: scratches under a footprint, triangles along a ray. Trees are built by obvhs; the walk over
//! scratches is stackless, the same on the CPU and in a shader.
//!
//! ```
//! use hairline_index::TriangleIndex;
//!
//! let text = r#"
//! camera = { position_m = [0.0, -0.2, 0.3], target_m = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0] }
//! render = { size_px = [48, 32] }
//! material = [{ name = "steel", kind = "metal", metal = "steel" }]
//! object = [{ name = "plate", shape = { disk = { radius_m = 0.08 } }, material = "steel" }]
//! scratches = [{ object = "plate", pattern = "random", count = 100 }]
//! light = [{ kind = "sphere", center_m = [0.0, 0.2, 0.3], radius_m = 0.05, radiance = 9.0 }]
//! "#;
//! let scene = hairline_document::from_toml(text, "plate.toml", ".")?;
//! let triangles = TriangleIndex::build(&scene);
//! let origin = scene.camera.position_m;
//! let hit = triangles.intersect(origin, (scene.camera.target_m - origin).normalize());
//! assert!((hit.unwrap().distance_m - origin.length()).abs() < 1e-6);
//! # Ok::<(), hairline_document::Error>(())
//! ```

#![warn(unreachable_pub)]

mod arcs;
mod coverage;
mod cutouts;
mod depth_spread;
pub mod groove_index;
mod hit;
mod indexed_segment;
mod layer_runs;
pub mod packed_profile;
pub mod scratch_index;
pub mod segment_tree;
mod tree;
mod triangle_beam;
pub(crate) mod triangle_index;
pub mod watch;

pub use arcs::{Pieces, TURN_MAX_RAD};
pub use coverage::Coverage;
pub use groove_index::Groove;
pub use hit::Hit;
pub use indexed_segment::{IndexedProfile, IndexedSegment};
pub use scratch_index::ScratchIndex;
pub use segment_tree::{ScratchNode, SegmentTree};
pub use triangle_beam::TriangleBeam;
pub use triangle_index::{TriangleIndex, TriangleNode, intersect_triangle};
pub use watch::Watch;
