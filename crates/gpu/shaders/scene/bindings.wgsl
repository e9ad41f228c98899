// Bindings of the scene. Twin: src/bindings.rs. Group 3 is each pass's own.

@group(0) @binding(0) var<uniform> frame: Frame;

@group(1) @binding(0) var<storage, read> vertices: array<Vertex>;
@group(1) @binding(1) var<storage, read> objects: array<Object>;
// Arrays of Material, Light (and behind them vertices of polygons), ScratchSegment and ScratchNode; rows.wgsl reads them.
@group(1) @binding(2) var materials: texture_2d<u32>;
@group(1) @binding(3) var lights: texture_2d<u32>;
@group(1) @binding(4) var scratch_segments: texture_2d<u32>;
// One texel where the method does not traverse the BVH.
@group(1) @binding(5) var scratch_nodes: texture_2d<u32>;

@group(2) @binding(0) var scratch_tables: texture_2d_array<u32>;
@group(2) @binding(1) var lobe_albedo: texture_2d<f32>;
// The transformed cosine, and the look-ups of environments under it.
@group(2) @binding(2) var lobe_shapes: texture_2d<f32>;
@group(2) @binding(3) var lobe_sptd: texture_2d<f32>;
@group(2) @binding(4) var environment_background: texture_2d<f32>;
@group(2) @binding(5) var environment_levels: texture_2d<f32>;
@group(2) @binding(6) var textures: texture_2d_array<f32>;
// Wavelengths in x, materials in y; and for each triangle its scratches. One texel for Hairline's own method.
@group(2) @binding(7) var published_wavelengths: texture_2d<f32>;
@group(2) @binding(8) var triangle_lists: texture_2d<u32>;
// Curves of reflectance over the angle; fresnel.wgsl says how they lie.
@group(2) @binding(9) var fresnel_curves: texture_2d<f32>;
// environment_levels without what shines on scratches as lights do; the same where there is no such light.
@group(2) @binding(10) var levels_beside_windows: texture_2d<f32>;
