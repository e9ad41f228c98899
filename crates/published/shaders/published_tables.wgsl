// The switches of the method of 2018, for which pipelines are compiled, and its tables. Twins: src/method.rs, src/gpu.rs.

// Whether scratches are looked up in a list of each triangle, in place of the BVH.
override PUBLISHED_LISTS: bool = false;
// Whether a pixel averages its footprint, in place of the point in its middle.
override PUBLISHED_ANTI_ALIASING: bool = true;
override PUBLISHED_FAST_SI: bool = true;

// Bindings before these are those of other_method.wgsl. Wavelengths in x, materials in y; beside them the triangles of lights.
@group(3) @binding(5) var published_wavelengths: texture_2d<f32>;
// Empty without the lists.
@group(3) @binding(6) var triangle_lists: texture_2d<u32>;
// An array of ScratchNode. Empty with the lists.
@group(3) @binding(7) var scratch_nodes: texture_2d<u32>;
@group(3) @binding(8) var lobe_sptd: texture_2d<f32>;
