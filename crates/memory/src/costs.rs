//! Bytes that one thing takes in the scene, its look-ups and its renderers together, on the safe side. Measured as the largest
//! resident size of whole renders on the CPU.

/// A triangle: the mesh, its trees, its copy on the device.
pub const TRIANGLE: f64 = 350.0;
/// A vertex, likewise.
pub const VERTEX: f64 = 200.0;
/// A triangle that scratches are laid on, besides.
pub const GROUND_TRIANGLE: f64 = 100.0;
/// An object without its triangles.
pub const OBJECT: f64 = 4096.0;
/// A segment of a scratch besides the scene: its effective form and its share of a tree, in main memory and once more on the
/// device.
pub const SEGMENT_RENDERED: u64 = 160;
/// A light.
pub const LIGHT: f64 = 7168.0;
/// A light as the sample points of a tile see it: once for each thread of the CPU.
pub const LIGHT_SEEN: f64 = 65_000.0;
/// A vertex of a polygon light.
pub const LIGHT_VERTEX: f64 = 512.0;
/// An environment map besides its pixels: blurred levels of one size for all maps, and the maps that they are made of.
pub const MAP: f64 = 2.2e8;
/// A pixel of an environment map with its blurred levels.
pub const MAP_PIXEL: f64 = 32.0;
/// A texel with its mip chain while it is made.
pub const TEXEL: f64 = 40.0;
/// A pixel of the picture with all its layers, the light that rays found, and the result of the filter.
pub const PICTURE_PIXEL: f64 = 480.0;
