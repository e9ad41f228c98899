//! Scratches on surfaces: walks across the triangles of a mesh, from edge to edge, along directions, arcs and curves. Files, keys and
//! patterns by name are not known here: `hairline-document` makes layers of them.
//!
//! ```
//! use std::sync::Arc;
//!
//! use glam::{DMat4, DVec3, Vec3};
//! use hairline_laying::{Ground, Guide};
//! use hairline_scene::Mesh;
//!
//! let plate = Mesh {
//!     positions_m: vec![Vec3::ZERO, Vec3::X, Vec3::ONE.with_z(0.0), Vec3::Y],
//!     normals: vec![Vec3::Z; 4],
//!     triangles: vec![[0, 1, 2], [0, 2, 3]],
//!     ..Mesh::default()
//! };
//! let ground = Ground::new(Arc::new(plate), DMat4::IDENTITY);
//! let (start, _) = ground.closest().find(DVec3::new(0.2, 0.5, 0.1));
//! let guide = Guide::Towards { end_m: DVec3::new(0.8, 0.5, 0.0) };
//! let mut segments = Vec::new();
//! ground.walker().lay_from(start, &guide, 1.0, &mut segments);
//! // One on each triangle.
//! assert_eq!(segments.len(), 2);
//! ```

#![warn(unreachable_pub)]

mod closest;
mod curve;
mod cut;
mod edges;
mod eraser;
mod facet;
mod ground;
mod guide;
mod layer;
mod lines;
mod neighbours;
mod random;
mod ruler;
mod swirl;
#[cfg(test)]
mod test_meshes;
mod walk;

pub use closest::Closest;
pub use curve::Cubic;
pub use cut::{RemovedParts, ball, remaining_runs};
pub use edges::Edges;
pub use eraser::{Eraser, ErasingStroke};
pub use facet::{Facet, barycentric, normal as facet_normal};
pub use ground::Ground;
pub use guide::Guide;
pub use layer::{Groove, Laying};
pub use lines::{Outline, lay_outline, smooth_curve};
pub use random::Stream;
pub use ruler::Ruler;
pub use swirl::Lattice;
pub use walk::{Course, LONGEST_WAY, MeshPoint, Walker};
