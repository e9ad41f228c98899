// Mask by which the base loses energy. Pipelines are compiled for it; src/variant.rs sets the number. Twin: optics/src/mask.rs.

override METHOD_MASK: u32 = 0u;
const MASK_ENERGY: u32 = 0u;
const MASK_LINEAR: u32 = 1u;
const MASK_DENSITY: u32 = 2u;
