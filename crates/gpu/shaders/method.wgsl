// By which of the known ways scratches are computed. Pipelines are compiled for it, and code for other ways goes away. Twin:
// optics/src/method.rs; src/variant.rs sets the numbers.

override METHOD_SPECTRUM: u32 = 0u;
const SPECTRUM_TABLE: u32 = 0u;
const SPECTRUM_SI_EXACT: u32 = 1u;
const SPECTRUM_SI_FAST: u32 = 2u;
// How many; none for the table.
override METHOD_WAVELENGTHS: u32 = 0u;

override METHOD_CHORDS: u32 = 0u;
const CHORDS_ROOTS: u32 = 0u;
const CHORDS_STEPS: u32 = 1u;

override METHOD_BAND: u32 = 0u;
const BAND_LINES: u32 = 0u;
const BAND_MIDDLE_LINE: u32 = 1u;

override METHOD_FOOTPRINT: u32 = 0u;
const FOOTPRINT_GAUSSIAN: u32 = 0u;
const FOOTPRINT_PUBLISHED: u32 = 1u;
const FOOTPRINT_OFF: u32 = 2u;

override METHOD_MASK: u32 = 0u;
const MASK_ENERGY: u32 = 0u;
const MASK_LINEAR: u32 = 1u;
const MASK_DENSITY: u32 = 2u;

override METHOD_SPHERE_BASE: u32 = 0u;
const SPHERE_BASE_COSINES: u32 = 0u;
const SPHERE_BASE_PIVOT: u32 = 1u;

override METHOD_GATHER: u32 = 0u;
const GATHER_EXACT: u32 = 0u;
const GATHER_CLUSTERS: u32 = 1u;
const GATHER_TALLY: u32 = 2u;

override METHOD_LOOKUP: u32 = 0u;
const LOOKUP_TILES: u32 = 0u;
const LOOKUP_BVH: u32 = 1u;
const LOOKUP_TRIANGLES: u32 = 2u;

override METHOD_LIGHT_AT: u32 = 0u;
const LIGHT_AT_PIXELS: u32 = 0u;
const LIGHT_AT_SCRATCHES: u32 = 1u;
