//! Surfaces for other engines: the scratches and gratings of a mesh as the textures that the shaders in `hairline-gpu`, folder `shaders/engine`, look up.
//! The packages for Bevy and for browsers are made of it.
//!
//! ```
//! use hairline_engine::Pieces;
//! use hairline_document::description::Scratches;
//! use hairline_document::{Arrays, MeshArrays, lay_on_mesh};
//!
//! let corners = vec![[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]];
//! let mesh = MeshArrays::new(corners, vec![[0, 1, 2]], None, None)?;
//! let layers = "[[scratches]]\nobject = 'mesh'\npattern = 'random'\ncount = 100";
//! let layers = Scratches::from_toml(layers, "layers".as_ref())?;
//! let object = lay_on_mesh(&mesh, &layers, &Arrays::default(), 1.0)?;
//! let pieces = Pieces::of_object(&object, 1.0);
//! let scratches = pieces.texels(20.0, 1.0)?;
//! assert_eq!(scratches.shapes.len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![warn(unreachable_pub)]

pub mod base_tables;
mod error;
mod gratings;
mod one_object;
mod pieces;
pub mod scratch_tree;
mod spectra;

pub use error::Error;
pub use gratings::{GratingField, GratingTexels, LaidGrating};
pub use pieces::Pieces;
pub use scratch_tree::ScratchTexels;
pub use spectra::scratch_table;
