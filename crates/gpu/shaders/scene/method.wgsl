// The switches of the method of 2018. Pipelines are compiled for them. Twin: index/src/method.rs; src/variant.rs sets the numbers.

// Whether scratches are looked up in a list of each triangle, in place of the BVH.
override PUBLISHED_LISTS: bool = false;
// Whether a pixel averages its footprint, in place of the point in its middle.
override PUBLISHED_ANTI_ALIASING: bool = true;
override PUBLISHED_FAST_SI: bool = true;
// Mask by which the base loses energy. Twin: optics/src/mask.rs.
override METHOD_MASK: u32 = 0u;
const MASK_ENERGY: u32 = 0u;
const MASK_LINEAR: u32 = 1u;
const MASK_DENSITY: u32 = 2u;
